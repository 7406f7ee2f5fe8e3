"""The cases of train dynamics that ship: each reads without a warning, says what it assumes, and does what its README tells."""

import re
from pathlib import Path

import numpy as np
import pytest
from chains import Chained

from tractionpower.dynamics.session import Session
from tractionpower.io.dynamics_files import load_case
from tractionpower.model.dynamics.case import DynamicsScenario

CASES = Path(__file__).parents[2] / "rollingstock" / "dynamics"
OWN = ("drive-50", "emergency-stop", "heavy-haul-200", "russian-start", "zobory-hill")


def scenario_of(name, **run):
    data = load_case(CASES / name).scenario.model_dump()
    start = {key: run.pop(key) for key in ("speed_kmh",) if key in run}
    data["case"]["run"] |= run
    data["case"]["start"] |= start
    return DynamicsScenario.model_validate(data)


def computed(name, until_s=1e9, **run):
    chained = Chained(scenario_of(name, **run))
    chained.before_j = chained.kinetic_j()
    chained.advance(until_s)
    return chained


@pytest.fixture(scope="module")
def hill():
    return computed("zobory-hill")


@pytest.fixture(scope="module")
def heavy():
    return computed("heavy-haul-200", record_every_s=1.0)


@pytest.mark.parametrize("name", OWN)
def test_a_case_reads_without_a_warning_and_says_what_is_assumed(name):
    loaded = load_case(CASES / name)
    assert loaded.problems == ()
    assert loaded.name == name
    assert "ssumed" in loaded.scenario.case.source
    told = (CASES / name / "README.md").read_text(encoding="utf-8")
    assert re.search(rf"tractionpower dynamics (run|drive) {name}\b", told)
    assert "assumed" in told


def test_masses_and_lengths_are_those_of_the_readmes():
    for name, mass_t, length_m in (("heavy-haul-200", 20_380, 2441), ("emergency-stop", 1632, 651), ("drive-50", 2680, 708)):
        chain = Chained(scenario_of(name)).chain
        assert float(chain.vehicles["mass_kg"].sum()) / 1e3 == pytest.approx(mass_t, abs=5.0)
        assert float(chain.chain["length_m"][0]) == pytest.approx(length_m, abs=1.0)


def test_the_hill_is_climbed_at_its_balancing_speed_and_the_train_stops_behind_it(hill):
    time, v = hill.rows["time_s"], 3.6 * hill.vehicle_rows["v_mps"][:, 0]
    climbing = v[(time > 170.0) & (time < 240.0)]
    np.testing.assert_allclose(climbing, 57.0, atol=1.0)
    # by hand: the power of the highest level against 7 permille, curves of 450 m on 650 of 1100 m, and the running resistance
    weight_kn = 9.80665 * 1274.0
    needed = weight_kn * (7.0 + 650.0 / (450.0 - 55.0) * 650.0 / 1100.0)
    needed += (weight_kn - 785.0) * (1.6 + 5.7 * 0.565**2) + 785.0 * (0.65 + 0.00932 * 56.5) + 516.0 + 0.355 * 56.5**2
    assert 3600.0 * 2220.0 / 56.5 == pytest.approx(needed, rel=0.02)
    assert v[-1] == 0.0
    assert 5300.0 < float(hill.movers["s_m"][0]) < 6500.0
    assert (v[time < 515.0][50:] > 0.0).all()
    gap, whole = hill.ledger_gap(hill.before_j)
    assert abs(gap) <= 1e-6 * whole


def test_time_at_levels_and_speeds_is_that_of_the_commands(hill):
    counted = hill.state.drive_speed.sum(axis=1)
    assert counted.sum() == pytest.approx(550.0, abs=0.01)
    assert counted[15] == pytest.approx(252.0 - 46.0, abs=0.02)
    assert hill.state.brake_speed.sum(axis=1)[12] == pytest.approx(550.0 - 506.0, abs=0.02)
    for bins in (hill.state.force, hill.state.acceleration, hill.state.brake_speed):
        assert bins.sum() == pytest.approx(550.0, abs=0.01)


@pytest.mark.parametrize(("speed_kmh", "pushed_kn", "metres"), [(60.0, 300.0, 276.0), (30.0, 390.0, 91.0)])
def test_an_emergency_stop_pushes_as_such_trains_are_said_to(speed_kmh, pushed_kn, metres):
    chained = computed("emergency-stop", speed_kmh=speed_kmh)
    pushed = -float(chained.links["least_n"].min()) / 1e3
    assert 100.0 < pushed < 400.0  # the recalled band
    assert pushed == pytest.approx(pushed_kn, rel=0.02)
    assert 5 < int(chained.links["least_n"].argmin()) < 40  # within the train, not at its ends
    assert (chained.movers["v_mps"] == 0.0).all()
    assert float(chained.movers["s_m"][0] - chained.movers["start_m"][0]) == pytest.approx(metres, rel=0.01)
    braked = chained.vehicle_rows["cylinder_pa"] > 1e4
    first = chained.rows["time_s"][np.argmax(braked, axis=0)]
    assert (np.diff(first) >= 0.0).all()
    assert first[-1] - first[0] == pytest.approx((651.0 - 17.0) / 250.0, abs=0.05)


def test_half_the_step_changes_no_extreme_of_the_emergency_stop():
    whole, half = (computed("emergency-stop", step_s=step_s) for step_s in (0.004, 0.002))
    np.testing.assert_allclose(whole.links["least_n"].min(), half.links["least_n"].min(), rtol=1e-3)
    np.testing.assert_allclose(whole.links["greatest_n"].max(), half.links["greatest_n"].max(), rtol=5e-3)


def test_forces_of_the_heavy_haul_train_are_of_the_known_size(heavy):
    gap, whole = heavy.ledger_gap(heavy.before_j)
    assert abs(gap) <= 1e-6 * whole
    assert 500e3 < heavy.links["greatest_n"].max() < 1500e3
    assert -1500e3 < heavy.links["least_n"].min() < -500e3
    assert int(heavy.links["least_n"].argmin()) in range(95, 110)  # ahead of and behind the locomotives in the middle
    v = heavy.vehicle_rows["v_mps"][:, 0]
    assert v.min() >= -0.05
    assert 60.0 < 3.6 * v.max() < 70.0
    assert (heavy.movers["v_mps"] == 0.0).all()


def test_half_the_step_changes_no_extreme_of_the_start_of_the_heavy_haul_train():
    whole, half = (computed("heavy-haul-200", 90.0, step_s=step_s) for step_s in (0.005, 0.0025))
    np.testing.assert_allclose(whole.links["greatest_n"].max(), half.links["greatest_n"].max(), rtol=0.01)


def test_the_slack_runs_out_from_the_head_to_the_tail():
    chained = computed("russian-start")
    first = chained.rows["time_s"][np.argmax(chained.vehicle_rows["v_mps"] > 0.05, axis=0)]
    assert (np.diff(first) >= 0.0).all()  # one wagon after the other begins to move
    assert first[-1] > first[0] + 10.0
    # all 71 couplings have given their 50 mm
    gaps = -np.diff(chained.movers["s_m"]) - np.diff(chained.chain.vehicles["behind_m"])
    assert gaps.min() > 0.0249
    assert 560e3 < chained.links["greatest_n"].max() < 900e3


def test_the_train_to_be_driven_stands_until_it_is_driven():
    session = Session(scenario_of("drive-50"), live=True)
    session.advance(5.0)
    assert (session.state.movers["v_mps"] == 0.0).all()
    session.set(drive=6)
    session.advance(40.0)
    assert session.state.movers["v_mps"].min() > 0.5
    session.set(drive=0, brake="full_service")
    session.advance(80.0)
    assert (session.state.movers["v_mps"] == 0.0).all()
    assert not session.has_ended
