"""The ledgers of a train: they close for what the program computes, and do not for what is wrong."""

import pytest
from small_trains import BRAKE, DRIVES, call, run

from tractionpower.movement.ledgers import TrainLedger

STOPS = {"stations": {"B": 4.0, "Z": 10.0}, "calls": [call("B", min_dwell_s=20.0), call("Z")]}
HILLS = [(-1.0, 2.0, 0.0), (2.0, 6.0, 8.0), (6.0, 11.0, -12.0)]


@pytest.mark.parametrize("kind", ["inverter", "series_motors", "table"])
@pytest.mark.parametrize("form", ["time", "speed"])
def test_ledgers_close(kind, form):
    more = {"slopes": HILLS, "resistance": {"a_n": 2e3, "b_n_per_kmh": 10.0, "c_n_per_kmh2": 0.5}, "brake": BRAKE}
    journey = run(drive=DRIVES[kind], rotating_mass_factor=1.1, form=form, **STOPS, **more)
    ledgers = journey.ledgers()
    assert ledgers["mechanical"].gap_share < 3e-4
    assert ledgers["pantograph_to_wheel"].gap_share < 1e-12
    parts = ledgers["mechanical"].energy_j
    assert parts["kinetic"] == 0.0
    assert parts["potential"] == pytest.approx(200e3 * 9.80665 * (4 * 8.0 - (4 - 0.05) * 12.0), rel=1e-9)
    assert parts["brakes"] > 0.0


def test_tunnels_and_curves_are_resistance():
    tunnels = [{"from_km": 3.0, "to_km": 5.0, "kind": "single_track"}]
    curves = [{"from_km": 6.0, "to_km": 7.0, "radius_m": 705.0}]
    plain, hindered = (run(**STOPS, **more).ledgers()["mechanical"] for more in ({}, {"tunnels": tunnels, "curves": curves}))
    work = 200e3 * 9.80665 * (2e-3 * 2000.0 + 1e-3 * 1000.0)
    assert hindered.energy_j["resistance"] - plain.energy_j["resistance"] == pytest.approx(work, rel=1e-9)
    assert hindered.closes


@pytest.mark.parametrize(
    ("column", "factor", "name"),
    [
        ("wheel_w", 1.01, "mechanical"),
        ("brake_w", 0.97, "mechanical"),
        ("v_mps", 1.01, "mechanical"),
        ("current_a", 1.0001, "pantograph_to_wheel"),
        ("auxiliary_w", 1.001, "pantograph_to_wheel"),
        ("drive_loss_w", -1.0, "pantograph_to_wheel"),
    ],
)
def test_what_is_wrong_leaves_a_gap(column, factor, name):
    more = {"resistance": {"c_n_per_kmh2": 2.0}, "auxiliaries": {"power_kw": 100.0}, "brake": BRAKE}
    journey = run(**STOPS, **more)
    assert journey.ledgers()[name].closes
    journey.rows[column] *= factor
    assert not journey.ledgers()[name].closes


def test_a_drive_that_gives_more_than_it_takes_does_not_close():
    journey = run(**STOPS)
    journey.rows["drive_loss_w"] -= 2e6
    journey.rows["wheel_w"] += 2e6  # the sum is the same
    assert not journey.ledgers()["pantograph_to_wheel"].closes


def test_a_ledger_of_nothing_closes():
    assert TrainLedger({}, 1e-3).closes
    assert TrainLedger({"wheel": 0.0}, 1e-3).gap_share == 0.0
    assert not TrainLedger({"wheel": -1.0}, 1e-3).closes
