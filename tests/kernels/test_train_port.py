"""Ports of trains against the characteristic that they stand for, at all voltages, over whole runs."""

import numpy as np
import pytest
from random_trains import random_study
from small_trains import BRAKE, DRIVES, INVERTER, SERIES_MOTORS, TABLE, Stepper, call, make_trains

from tractionpower.kernels.demand import demand_current
from tractionpower.kernels.jit import njit
from tractionpower.kernels.ports import find_segment, port_current
from tractionpower.kernels.tables import PORT, SEGMENT
from tractionpower.kernels.train_port import BREAKS, ROOM, write_port
from tractionpower.kernels.train_step import wish

VOLTAGES = np.concatenate((np.linspace(1.0, 1999.0, 40), np.linspace(2000.0, 4300.0, 1151)))


@njit
def compare(tables, state, clock, port, segments, scratch, found):
    """Fill the currents of the port, of the train, and the segment, over the voltages of `found`."""
    wish(tables, state, 0, clock[0], clock[1])
    write_port(tables, state, 0, port[0], segments, segments.shape[0], scratch)
    for n in range(found.shape[0]):
        u = found[n, 0]
        found[n, 1] = port_current(segments, port[0], u)
        found[n, 2], _ = demand_current(tables, tables.trains[0], state.trials[0], state.demands[0], u)
        found[n, 3] = find_segment(segments, port[0], u)


def gaps(scenario, volts, steps=150, h=1.0):
    """Yield voltages, currents of the port and of the train while it runs at `volts`, which may be a function of the step."""
    stepper = Stepper(scenario)
    port, segments = np.zeros(1, PORT), np.zeros(ROOM + 20, SEGMENT)
    port["scale"] = 1.0
    found = np.zeros((len(VOLTAGES), 4))
    for n in range(steps):
        found[:, 0] = VOLTAGES
        compare(stepper.tables, stepper.state, (stepper.time_s, h), port, segments, np.zeros(BREAKS), found)
        kept = segments[: int(port["segments"][0])]
        assert kept["from_v"][0] == -np.inf
        assert (np.diff(kept["from_v"]) >= 0.0).all()
        yield stepper, found, kept
        stepper.step(volts(n) if callable(volts) else volts, h)
        if stepper.gone:
            return


def at_breaks(kept):
    """Return the jumps of the current at the break voltages [A]."""
    low, high = kept[1:-1], kept[2:]
    u = high["from_v"]
    with np.errstate(all="ignore"):
        jumps = (high["a"] - low["a"]) + (high["b"] - low["b"]) * u + (high["c"] - low["c"]) / u
    return jumps[np.isfinite(u)]


STOPS = {"stations": {"A": 3.0, "Z": 6.0}, "calls": [call("A", min_dwell_s=10.0), call("Z")]}
LINE = {"limits": [(-1.0, 1.5, 60.0), (1.5, 2.0, 40.0), (2.0, 7.0, 110.0)], "slopes": [(-1.0, 7.0, 4.0)], **STOPS}
PLAIN = {
    "inverter": {"drive": INVERTER},
    "limited inverter": {"drive": INVERTER | {"max_current_a": 900.0, "knee_factor": 0.9}},
    "inverter that brakes": {"drive": INVERTER, "brake": BRAKE},
    "series motors at full effort": {"drive": SERIES_MOTORS, "limits": [(-1.0, 7.0, 400.0)]},
    "no drive": {"drive": None, "speed_kmh": 60.0},
}


@pytest.mark.parametrize("name", PLAIN)
@pytest.mark.parametrize("volts", [2150.0, 2900.0, 3700.0])
@pytest.mark.parametrize("heating_kw", [0.0, 200.0])
def test_plain_characteristics_are_met_exactly(name, volts, heating_kw):
    brakes = "brakes" in name and heating_kw > 0.0  # heating while the line refuses power is fitted
    scenario = make_trains(6.0, auxiliaries={"power_kw": 120.0, "heating_kw": heating_kw}, **LINE | PLAIN[name])
    exact = 0
    for stepper, found, _ in gaps(scenario, volts):
        demand, gap = stepper.state.demands[0], np.abs(found[:, 1] - found[:, 2])
        mixed = demand["need_w"] > 0.0 and demand["gained_w"] > 0.0
        is_part = stepper.tables.trains[0]["drive"] == 2 and gap.max() >= 1e-6  # a duty cycle
        if mixed or is_part or (brakes and demand["gained_w"] > 0.0):
            near = np.abs(VOLTAGES - volts) < 100.0
            assert gap[near].max() < 0.5 + 0.02 * np.abs(found[near, 2]).max()
        else:
            exact += 1
            assert gap.max() < 1e-6, (stepper.time_s, VOLTAGES[gap.argmax()])
    assert exact > 50


@pytest.mark.parametrize("seed", range(24))
def test_random_trains_meet_their_characteristic(seed):
    rng = np.random.default_rng(seed)
    base = rng.uniform(2050.0, 3700.0)
    h = float(rng.choice([0.5, 1.0, 5.0]))
    worst = []
    for stepper, found, kept in gaps(random_study(seed), lambda _: base + rng.uniform(-60.0, 60.0), 120, h):
        last = float(stepper.mover["voltage_v"])
        near = np.abs(VOLTAGES - last) < 150.0
        gap = np.abs(found[:, 1] - found[:, 2])[near]
        worst.append(gap.max() / (1.0 + np.abs(found[near, 2]).max()))
        assert worst[-1] < 0.02, (stepper.time_s, last)
        assert np.abs(at_breaks(kept)).max(initial=0.0) < 1e-6 * (1.0 + np.abs(found[:, 2]).max())
    assert np.mean(worst) < 2e-3


@pytest.mark.parametrize("kind", ["series_motors", "table"])
def test_duty_cycles_are_fitted_closely(kind):
    scenario = make_trains(6.0, drive=DRIVES[kind], resistance={"a_n": 5000.0}, limits=[(-1.0, 7.0, 70.0)])
    for _, found, _ in gaps(scenario, 2900.0, 250):
        near = np.abs(VOLTAGES - 2900.0) < 100.0
        np.testing.assert_allclose(found[near, 1], found[near, 2], rtol=2e-3, atol=0.2)


def test_a_table_bends_at_its_voltages():
    rows = [(2000.0, 400.0), (2600.0, 700.0), (3000.0, 1000.0)]
    table = TABLE | {
        "effort": [{"speed_kmh": v, "voltage_v": u, "effort_kn": u * i / 1e6 * 10.0} for u, i in rows for v in (0.0, 200.0)],
        "current": [{"speed_kmh": v, "voltage_v": u, "current_a": i} for u, i in rows for v in (0.0, 200.0)],
    }
    scenario = make_trains(9.0, drive=table, speed_kmh=72.0, mass_t=1e4)
    _, found, _ = next(gaps(scenario, 2900.0))
    np.testing.assert_allclose(np.interp([2300.0, 2800.0, 3000.0], found[:, 0], found[:, 1]), [550.0, 850.0, 1000.0], rtol=1e-9)


LIMITED_LINE = [{"from_km": -1.0, "to_km": 7.0, "max_current_a": 600.0, "standstill_current_a": 30.0}]
POWERS = [
    {"voltage_v": volts, "power_kw": kw} for volts, kw in ((2000.0, 600.0), (2700.0, 1800.0), (3000.0, 3000.0), (4000.0, 3000.0))
]
AWKWARD = {
    "table at low voltage": {"drive": TABLE},
    "limited table at low voltage": {"drive": TABLE | {"max_current_a": 700.0}},
    "power table that crosses the knee": {"drive": INVERTER | {"power_over_voltage": POWERS, "max_current_a": 900.0}},
    "auxiliaries that the line cuts": {"drive": INVERTER, "train_current_limits": LIMITED_LINE},
}


@pytest.mark.parametrize("name", AWKWARD)
def test_kinks_within_a_regime_and_below_the_lowest_voltage_are_met(name):
    scenario = make_trains(6.0, auxiliaries={"power_kw": 120.0, "heating_kw": 80.0}, **LINE | AWKWARD[name])
    worst = 0.0
    for _, found, _ in gaps(scenario, 2800.0, 250):
        worst = max(worst, np.abs(found[:, 1] - found[:, 2]).max())
    assert worst < (1.2 if "table at" in name else 0.05)  # A; what has no segment's form is fitted


@pytest.mark.parametrize("volts", [1500.0, 1900.0, 2500.0])
@pytest.mark.parametrize("more", [{}, {"max_current_a": 700.0}])
def test_below_the_lowest_voltage_a_table_drive_gives_no_more_than_it_takes(volts, more):
    stepper = Stepper(make_trains(6.0, drive=TABLE | more, auxiliaries={"power_kw": 120.0}, **LINE))
    for _ in range(60):
        row = stepper.step(volts)
        assert row["drive_loss_w"] >= -1e-6 * abs(row["power_w"])
