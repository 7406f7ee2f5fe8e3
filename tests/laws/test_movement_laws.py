"""Laws of the theoretical journey on random lines with random trains."""

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_trains import KINDS, random_study
from small_trains import DRIVES, Stepper, call, journey, make_run, make_trains, passing, run

from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import theoretical_journeys

LAW = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
SEEDS = st.integers(0, 10**6)
EARLIER_S = 0.15
"""Journeys in steps of a second: a weaker train may reach a limit within a step a little differently."""


def arrival(found: Any) -> float:
    return found.finished_s if found.status == "complete" else np.inf


def with_vehicle(scenario: Scenario, **changed: Any) -> Scenario:
    return scenario.model_copy(update={"vehicles": (scenario.vehicles[0].model_copy(update=changed),)})


@LAW
@given(seed=SEEDS, high_v=st.floats(2200.0, 3500.0), share=st.floats(0.85, 0.999))
def test_never_earlier_at_a_lower_voltage(seed, high_v, share):
    scenario = random_study(seed)
    low_v = max(high_v * share, 2050.0)
    assert arrival(journey(scenario, voltage_v=low_v)) >= arrival(journey(scenario, voltage_v=high_v)) - EARLIER_S


@LAW
@given(seed=SEEDS, share=st.floats(0.4, 0.95))
def test_never_earlier_with_a_lower_current_limit(seed, share):
    scenario = random_study(seed)
    drive = scenario.vehicles[0].drive
    found = []
    for limit in (1000.0, 1000.0 * share):
        limited = with_vehicle(scenario, drive=drive.model_copy(update={"max_current_a": limit}))
        found.append(arrival(journey(limited, voltage_v=2700.0)))
    assert found[1] >= found[0] - EARLIER_S


@LAW
@given(seed=SEEDS, more=st.floats(1.02, 1.4))
def test_a_heavier_train_is_not_faster(seed, more):
    # On level track: downhill a heavier train is the faster one.
    scenario = random_study(seed, slopes=[])
    heavier = with_vehicle(scenario, mass_t=scenario.vehicles[0].mass_t * more)
    assert arrival(journey(heavier)) >= arrival(journey(scenario)) - EARLIER_S


@LAW
@given(seed=SEEDS, voltage_v=st.floats(2100.0, 3800.0), step_s=st.sampled_from([0.2, 1.0, 3.0]))
def test_every_journey_keeps_its_ceiling_and_ledgers_and_ends(seed, voltage_v, step_s):
    found = journey(random_study(seed), voltage_v=voltage_v, step_s=step_s)
    assert found.status in {"complete", "stuck"}
    rows = found.rows
    piece = found.ceiling[np.searchsorted(found.ceiling["from_m"], rows["s_m"], side="right") - 1]
    assert (rows["v_mps"] ** 2 <= piece["w"] + piece["dw"] * (rows["s_m"] - piece["from_m"]) + 1e-7).all()
    assert (np.diff(rows["s_m"]) >= 0.0).all()
    assert all(np.isfinite(rows[name]).all() for name in rows.dtype.names)
    np.testing.assert_allclose(rows["voltage_v"] * rows["current_a"], rows["power_w"], rtol=1e-9, atol=1e-6)
    if step_s <= 1.0:
        assert found.ledgers()["mechanical"].gap_share < (1e-3 if found.formation.spread_m > 0.0 else 1e-2)
    assert found.ledgers()["pantograph_to_wheel"].closes
    came = [one.arrival_s for one in found.calls if not np.isnan(one.arrival_s)]
    assert came == sorted(came)
    if found.status == "complete":
        assert len(came) == len(found.calls)
        assert all(one.departure_s >= one.arrival_s for one in found.calls)


def mirrored(rows: list[tuple[float, float, float]], length: float, sign: float) -> list[tuple[float, float, float]]:
    return [(length - high, length - low, sign * value) for low, high, value in reversed(rows)]


@LAW
@given(seed=SEEDS, kind=st.sampled_from(KINDS))
def test_a_mirrored_line_gives_the_same_journey(seed, kind):
    rng = np.random.default_rng(seed)
    middle = sorted(np.round(rng.uniform(0.5, 5.5, 3), 3).tolist())
    edges = [-1.0, *middle, 7.0]
    slopes = [(a, b, round(rng.uniform(-12.0, 12.0), 1)) for a, b in itertools.pairwise(edges)]
    limits = [(a, b, round(rng.uniform(40.0, 140.0))) for a, b in itertools.pairwise(edges)]
    stations = {"A": middle[1], "P": middle[2] + 0.2, "Z": 6.0}
    calls = [call("A", min_dwell_s=15.0), passing("P"), call("Z")]
    train = {"drive": DRIVES[kind], "resistance": {"a_n": 3000.0, "c_n_per_kmh2": 0.5}}
    there = run(6.0, slopes=slopes, limits=limits, stations=stations, calls=calls, **train)
    back = run(6.0, slopes=mirrored(slopes, 6.0, -1.0), limits=mirrored(limits, 6.0, 1.0), backwards=True,
               stations={name: 6.0 - km for name, km in stations.items()}, calls=calls, **train)  # fmt: skip
    assert there.status == back.status
    assert arrival(back) == pytest.approx(arrival(there), abs=1e-6)
    assert len(there.rows) == len(back.rows)
    for name in ("s_m", "v_mps", "traction_n", "current_a"):
        np.testing.assert_allclose(back.rows[name], there.rows[name], rtol=1e-6, atol=1e-3)


@LAW
@given(seed=SEEDS, cut=st.floats(0.05, 0.95), kind=st.sampled_from(KINDS))
def test_a_gradient_row_cut_in_two_changes_nothing(seed, cut, kind):
    rng = np.random.default_rng(seed)
    middle = round(rng.uniform(1.0, 5.0), 3)
    slopes = [(-1.0, middle, round(rng.uniform(-10.0, 12.0), 1)), (middle, 7.0, round(rng.uniform(-10.0, 12.0), 1))]
    at = round(-1.0 + cut * (middle + 1.0), 3)
    halves = [(-1.0, at, slopes[0][2]), (at, middle, slopes[0][2]), slopes[1]]
    line = {"stations": {"Z": 6.0}, "calls": [call("Z")], "limits": [(-1.0, 7.0, 100.0)], "drive": DRIVES[kind]}
    whole, parted = (run(6.0, slopes=rows, **line) for rows in (slopes, halves))
    assert arrival(parted) == pytest.approx(arrival(whole), abs=1e-6)
    np.testing.assert_allclose(parted.rows["v_mps"], whole.rows["v_mps"], atol=1e-6)


@LAW
@given(order=st.permutations(range(4)))
def test_the_order_of_trains_does_not_matter(order):
    runs = [
        make_run(f"r{k}", 4.0, time=30.0 * k, calls=[call("A", min_dwell_s=5.0 * k), call("Z")], speed_kmh=10.0 * (k % 2))
        for k in range(4)
    ]
    stations = {"A": 2.0, "Z": 4.0}
    plain, mixed = (
        theoretical_journeys(make_trains(4.0, runs=trains, stations=stations, drive=DRIVES["series_motors"]))
        for trains in (runs, [runs[k] for k in order])
    )
    assert [one.run.id for one in plain] == [one.run.id for one in mixed]
    for one, other in zip(plain, mixed, strict=True):
        assert one.rows.tobytes() == other.rows.tobytes()
        assert one.calls == other.calls


@LAW
@given(seed=SEEDS, base_v=st.floats(1900.0, 4000.0))
def test_no_step_takes_from_the_line_without_a_use(seed, base_v):
    # Whatever the voltage does: what is taken is work, losses that are none but positive, auxiliaries and brakes.
    rng = np.random.default_rng(seed)
    stepper = Stepper(random_study(seed))
    kind = stepper.tables.trains[0]["drive"]
    for _ in range(150):
        row = stepper.step(base_v + rng.uniform(-200.0, 200.0))
        taken = row["wheel_w"] + row["drive_loss_w"] + row["starting_resistor_w"]
        assert taken >= -1e-6
        if row["wheel_w"] == 0.0:
            assert taken == pytest.approx(0.0, abs=1e-3)
        if kind == 1:
            assert taken == pytest.approx(row["wheel_w"] / 0.85, rel=1e-8, abs=1e-3)
        if row["voltage_v"] <= 2000.0 and kind == 1:
            assert row["traction_n"] == 0.0
        if stepper.gone:
            break


def random_driving(seed: int, scenario: Scenario) -> Scenario:
    """Return a random study whose train is driven by random rules, with planned times that it may keep or not."""
    rng = np.random.default_rng((11, seed))
    rules: dict[str, Any] = {"kind": "rules", "speed_percent": float(rng.uniform(40.0, 100.0))}
    if rng.random() < 0.6:
        rules["coast_from"] = [{"km": float(rng.uniform(0.0, 8.0))} for _ in range(rng.integers(1, 4))]
    if rng.random() < 0.5:
        rules["coast_before_stops_km"] = float(rng.uniform(0.2, 3.0))
    if rng.random() < 0.3:
        rules["effort_percent"] = float(rng.uniform(60.0, 100.0))
    if rng.random() < 0.4:
        rules["coast_down_to_kmh"] = float(rng.uniform(5.0, 60.0))
    plain = scenario.model_dump(by_alias=True)
    plain["timetable"]["trains"][0]["driving"] = rules
    for planned in plain["timetable"]["trains"][0]["calls"]:
        if rng.random() < 0.6:
            planned["arrival"] = float(np.round(rng.uniform(200.0, 1500.0)))
    return Scenario.model_validate(plain)


@LAW
@given(seed=SEEDS, voltage_v=st.floats(2400.0, 3400.0), step_s=st.sampled_from([0.2, 1.0]))
def test_a_plan_keeps_the_ceiling_and_is_never_earlier_than_flat_out(seed, voltage_v, step_s):
    level = seed % 2 == 0
    scenario = random_study(seed, **({"slopes": []} if level else {}))
    flat, found = (journey(study, voltage_v=voltage_v, step_s=step_s) for study in (scenario, random_driving(seed, scenario)))
    rows = found.rows
    piece = found.ceiling[np.searchsorted(found.ceiling["from_m"], rows["s_m"], side="right") - 1]
    assert (rows["v_mps"] ** 2 <= piece["w"] + piece["dw"] * (rows["s_m"] - piece["from_m"]) + 1e-7).all()
    assert arrival(found) >= arrival(flat) - EARLIER_S
    if step_s < 1.0 or found.formation.spread_m > 0.0:
        assert found.ledgers()["mechanical"].gap_share < 1e-2
    assert found.ledgers()["pantograph_to_wheel"].closes
    if flat.status == "complete" and level:  # on a hill a train that has coasted may lack the speed to get over it
        assert found.status == "complete"
