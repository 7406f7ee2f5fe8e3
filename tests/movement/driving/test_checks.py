"""Checks of driving plans."""

import pytest
from small_trains import SERIES_MOTORS, call, make_trains

from tractionpower.movement.checks import check_movement

STOPS = {"stations": {"A": 0.0, "B": 8.0}, "calls": [call("A", departure=0.0), call("B")], "end": "stop"}


def told(**more):
    found = check_movement(make_trains(10.0, resistance={"a_n": 1000.0}, **STOPS | more))
    return {(problem.code, problem.path, problem.severity) for problem in found}


def test_a_mark_off_the_route_and_an_end_before_it():
    marks = [{"km": 12.0}, {"km": 4.0, "to_km": 3.0}, {"km": 2.0, "to_km": 3.0}, {"km": 2.0, "track": "9"}]
    path = "timetable.trains[x].driving.coast_from"
    assert told(driving={"kind": "rules", "coast_from": marks}) == {
        ("off_route", f"{path}[0].km", "error"),
        ("off_route", f"{path}[1].to_km", "error"),
        ("off_route", f"{path}[3].km", "error"),
    }


def test_a_power_cap_asks_for_an_inverter_drive():
    assert told(max_power_kw=500.0) == set()
    assert ("power_cap", "timetable.trains[x].max_power_kw", "error") in told(max_power_kw=500.0, drive=SERIES_MOTORS)


def test_nothing_to_drive_to():
    assert told(driving={"kind": "to_time"}) == {("nothing_to_drive_to", "timetable.trains[x].driving", "warning")}
    timed = [call("A", departure=0.0), call("B", arrival=900.0)]
    assert told(driving={"kind": "to_time"}, calls=timed) == set()


def test_coasting_before_stops_of_a_train_that_never_stops():
    path = "timetable.trains[x].driving.coast_before_stops_km"
    found = told(driving={"kind": "rules", "coast_before_stops_km": 2.0}, calls=[call("A", departure=0.0)], end="leave")
    assert found == {("no_stop_to_coast_to", path, "warning")}


@pytest.mark.parametrize(("kmh", "doubtful"), [(150.0, False), (170.0, True)])
def test_a_floor_above_the_speed_of_the_train(kmh, doubtful):
    found = told(driving={"kind": "rules", "coast_before_stops_km": 2.0, "coast_down_to_kmh": kmh})
    assert (("never_coasts", "timetable.trains[x].driving.coast_down_to_kmh", "warning") in found) == doubtful
