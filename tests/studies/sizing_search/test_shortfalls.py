"""What a case misses, told from its rows."""

import math

import pytest
from small_studies import load, make_scenario

from tractionpower.studies.sizing_search.shortfalls import NOT_RUN, Asked

ROW = {
    "case": "base", "kind": "base", "grid": "normal", "status": "complete", "reason": "", "lowest_voltage_v": 2800.0,
    "lowest_voltage_track": "1", "lowest_voltage_km": 7.5, "lowest_voltage_s": 60.0,
    "useful_zone_v": 2900.0, "useful_zone": "A–B",
    "useful_train_v": 2850.0, "useful_train": "x", "worst_late_s": 0.0, "worst_late_train": "",
}  # fmt: skip


def facts(devices=(), **more):
    asked = Asked(make_scenario(load("x")))
    return asked.facts(ROW | more, [{"device": name, "utilisation_percent": percent} for name, percent in devices])


def test_a_case_within_all_limits_misses_nothing():
    found = facts([("A unit", 99.9), ("B unit", 100.0), ("rails", math.nan), ("C unit", None)])
    assert found.shortfalls == ()
    assert found.utilisation == {"A unit": 99.9, "B unit": 100.0}
    assert found.excess == 0.0


def test_devices_beyond_their_rating_are_told_with_their_excess():
    (found,) = facts([("A unit", 125.0), ("B unit", 60.0)]).shortfalls
    assert (found.what, found.subject) == ("device", "A unit")
    assert found.excess == pytest.approx(0.25)
    assert "125 %" in found.words


@pytest.mark.parametrize(("volts", "missed"), [(2000.0, 0), (1999.95, 0), (1999.0, 1), (math.nan, 0), (None, 0)])
def test_the_lowest_voltage_is_held_against_u_min2_within_a_tenth_of_a_volt(volts, missed):
    found = facts(lowest_voltage_v=volts, kind="substation").shortfalls
    assert len(found) == missed
    for item in found:
        assert (item.what, item.track, item.km) == ("low voltage", "1", 7.5)


def test_the_mean_useful_voltage_is_asked_of_normal_operation():
    low = {"useful_zone_v": 2600.0, "useful_train_v": 2500.0}
    assert [item.what for item in facts(**low).shortfalls] == ["useful voltage"] * 2
    assert facts(**low, kind="unit").shortfalls == ()
    assert facts(**low, grid="low").shortfalls == ()


def test_the_timetable_is_asked_of_normal_operation():
    late = {"worst_late_s": 90.0, "worst_late_train": "x"}
    (found,) = facts(**late).shortfalls
    assert (found.what, found.km) == ("late trains", 7.5)
    assert facts(**late, kind="substation").shortfalls == ()


def test_a_run_that_did_not_complete_is_worse_than_any_other_miss():
    found = facts(status="flagged", reason="3 steps", lowest_voltage_v=1500.0).shortfalls
    assert found[0].excess == NOT_RUN > found[1].excess
