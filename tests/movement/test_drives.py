"""Drives as rows of tables."""

import numpy as np
import pytest
from small_trains import INVERTER, SERIES_MOTORS, TABLE, make_trains

from tractionpower.movement.compile import compile_trains


def compiled(**more):
    tables = compile_trains(make_trains(5.0, **more)).tables
    return tables, tables.trains[0]


def test_an_inverter_drive():
    brake = {"electric_effort_kn": 90.0, "electric_power_kw": 2400.0, "electric_above_kmh": 9.0, "rheostat_kw": 800.0}
    drive = INVERTER | {"max_current_a": 1200.0, "knee_factor": 0.8, "fold_back_from_v": 3700.0, "pull_out_kmh": 108.0}
    _, train = compiled(drive=drive, brake=brake, vehicles=[{"id": "car", "count": 2}])
    assert (train["start_n"], train["power_w"], train["efficiency"]) == (400e3, 6e6, 0.85)
    assert train["pull_out_w_mps"] == pytest.approx(6e6 * 30.0)
    assert (train["max_current_a"], train["knee_v"], train["lowest_v"]) == (2400.0, 2400.0, 2000.0)
    assert (train["brake_n"], train["brake_w"], train["brake_from_mps"], train["rheostat_w"]) == (180e3, 4.8e6, 2.5, 1.6e6)
    assert (train["fold_from_v"], train["fold_to_v"], train["brake_efficiency"]) == (3700.0, 3900.0, 0.85)
    assert train["regenerates"]


def test_pull_out_below_the_power_curve():
    _, train = compiled(drive=INVERTER | {"pull_out_kmh": 36.0})
    assert train["pull_out_w_mps"] == pytest.approx(200e3 * 100.0)


def test_the_system_gives_the_knee():
    _, train = compiled(drive=INVERTER | {"max_current_a": 1200.0})
    assert train["knee_v"] == pytest.approx(0.9 * 3000.0)
    for drive in (SERIES_MOTORS, TABLE):
        _, train = compiled(drive=drive | {"max_current_a": 1200.0})
        assert train["knee_v"] == 0.0


def test_notches_of_series_motors():
    groupings = [{"series": 4, "parallel": 1}, {"series": 2, "parallel": 2, "starting_current_a": 250.0}]
    relay = {"off_v": 2000.0, "on_v": 2200.0, "delay_s": 1.5}
    drive = SERIES_MOTORS | {"groupings": groupings, "relay": relay}
    tables, train = compiled(drive=drive, vehicles=[{"id": "car", "count": 2}])
    notches = tables.notches[train["first_notch"] : train["first_notch"] + train["notches"]]
    assert notches["series"].tolist() == [4, 4, 4, 2, 2, 2]
    assert notches["branches"].tolist() == [2, 2, 2, 4, 4, 4]
    assert notches["set_a"].tolist() == [300.0] * 3 + [250.0] * 3
    assert notches["full_field"].tolist() == [True, False, False] * 2
    per_m = 3.0 / (np.pi * 1.25)
    for notch, share in zip(notches, [1.0, 0.7, 0.5] * 2, strict=True):
        top = tables.motor[notch["first_point"] + notch["points"] - 1]
        emf = np.interp(share * notch["set_a"], [0, 100, 200, 300, 500], [0, 50, 75, 90, 105]) * per_m
        assert top["emf_vs_per_m"] == pytest.approx(emf)
        assert top["effort_n"] == pytest.approx(8 * 0.97 * emf * notch["set_a"])
    assert train["start_n"] == pytest.approx(8 * 0.97 * 90.0 * per_m * 300.0)
    assert (train["relay_off_v"], train["relay_on_v"], train["relay_s"]) == (2000.0, 2200.0, 1.5)
    assert not train["regenerates"]


def test_curves_of_a_table_by_voltage_and_speed():
    points = [(3300.0, 90.0, 50.0), (2000.0, 0.0, 80.0), (3300.0, 0.0, 120.0), (2000.0, 90.0, 30.0)]
    drive = {
        "kind": "table",
        "effort": [{"voltage_v": u, "speed_kmh": v, "effort_kn": f} for u, v, f in points],
        "current": [{"voltage_v": u, "speed_kmh": v, "current_a": 10 * f} for u, v, f in points],
    }
    tables, train = compiled(drive=drive, vehicles=[{"id": "car", "count": 3}])
    low, high = tables.curves[train["first_curve"] : train["first_curve"] + train["curves"]]
    assert (low["voltage_v"], high["voltage_v"]) == (2000.0, 3300.0)
    efforts = tables.points[high["first_effort"] : high["first_effort"] + high["efforts"]]
    assert efforts.tolist() == [(0.0, 360e3), (25.0, 150e3)]
    losses = tables.points[low["first_loss"] : low["first_loss"] + low["losses"]]
    assert losses.tolist() == [(0.0, 2000.0 * 2400.0), (25.0, 2000.0 * 900.0 - 25.0 * 90e3)]
    assert train["start_n"] == 360e3


def test_no_drive_and_no_limit_by_adhesion():
    _, train = compiled(drive=None)
    assert (train["drive"], train["brake_n"], train["regenerates"]) == (0, 0.0, False)
    _, train = compiled(adhesive_mass_t=50.0)
    assert train["adhesive_n"] == pytest.approx(50e3 * 9.80665)
