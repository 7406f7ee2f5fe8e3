"""Differences from the base, and the best and worst."""

import math

import pytest

from tractionpower.studies.sweep.differences import FIGURES, PLACES, change_of, differences, extremes

NAN = math.nan
ROWS = [
    {"case": "base", "lowest_voltage_v": 3000.0, "line_loss_kwh": 10.0, "energy_kwh": 100.0, "late_trains": 0, "trips": 2},
    {"case": "a", "lowest_voltage_v": 2700.0, "line_loss_kwh": None, "energy_kwh": 90.0, "late_trains": 3, "trips": 2},
    {
        "case": "b",
        "lowest_voltage_v": 3000.0 * (1 + 1e-13),
        "line_loss_kwh": 5.0,
        "energy_kwh": NAN,
        "late_trains": 0,
        "trips": 2,
    },
]


def test_differences_of_all_figures_that_both_have():
    found = {(row["case"], row["figure"]): row for row in differences(ROWS, ROWS[0])}
    assert {key for key in found if key[0] == "a"} == {
        ("a", name) for name in ("lowest_voltage_v", "energy_kwh", "late_trains", "trips")
    }
    assert ("b", "energy_kwh") not in found
    assert not any(case == "base" for case, _ in found)
    low = found["a", "lowest_voltage_v"]
    assert (low["base"], low["value"], low["difference"], low["percent"]) == (3000.0, 2700.0, -300.0, -10.0)
    assert found["a", "late_trains"]["difference"] == 3.0
    assert math.isnan(found["a", "late_trains"]["percent"])
    assert found["b", "line_loss_kwh"]["percent"] == -50.0


def test_what_differs_by_rounding_only_is_the_same():
    assert {row["difference"] for row in differences(ROWS, ROWS[0]) if row["figure"] == "lowest_voltage_v"} == {-300.0, 0.0}
    assert change_of(1e-3, 1.1e-3) == (pytest.approx(1e-4), pytest.approx(10.0))


def test_infinite_lateness_has_no_per_cent():
    assert change_of(math.inf, math.inf)[0] == 0.0
    difference, percent = change_of(10.0, math.inf)
    assert difference == math.inf
    assert percent == math.inf or math.isnan(percent)


def test_the_best_voltage_is_the_highest_and_the_best_loss_the_lowest():
    found = extremes(ROWS)
    assert found["lowest_voltage_v"]["worst"] == {"case": "a", "value": 2700.0}
    assert found["line_loss_kwh"] == {"best": {"case": "b", "value": 5.0}, "worst": {"case": "base", "value": 10.0}}
    assert set(found["energy_kwh"]) == {"lowest", "highest"}
    assert "trips" not in found


def test_places_and_times_are_no_figures():
    assert set(PLACES).isdisjoint(FIGURES)
    assert {"lowest_voltage_v", "worst_late_s", "trips", "energy_kwh"} <= set(FIGURES)
