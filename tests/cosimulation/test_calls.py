"""Calls as rows: what is planned and what takes place, at the ends of a run and between."""

import math
from dataclasses import replace

import numpy as np
import pytest
from fake_journeys import make_journey, make_line

from tractionpower.cosimulation.calls import call_rows, late_at_end, overdue_by, time_at_stops
from tractionpower.results.trains import CallRow
from tractionpower.studies.journeys import route_end

START = 6 * 3600.0


def rows_of(journey):
    return call_rows(journey.run.id, journey.calls, route_end(journey))


def test_a_run_begins_without_an_arrival_and_ends_without_a_departure():
    rows = rows_of(make_journey(make_line(), "7"))
    assert [(row.station, row.kind) for row in rows] == [
        ("A", "departure"), ("B", "arrival"), ("B", "departure"), ("C", "pass"), ("D", "arrival"),
    ]  # fmt: skip
    assert {row.train for row in rows} == {"7"}
    arrival, departure = rows[1:3]
    assert (arrival.planned_s, departure.planned_s) == (START + 300.0, START + 330.0)
    assert departure.dwell_s == pytest.approx(30.0)
    assert math.isnan(arrival.dwell_s)
    assert departure.actual_s == arrival.actual_s + 30.0
    assert math.isnan(rows[3].planned_s)


def test_calls_that_a_stuck_train_does_not_reach_have_their_plan_only():
    rows = rows_of(make_journey(make_line(), "7", stuck_m=3000.0))
    last = rows[-1]
    assert (last.station, last.planned_s) == ("D", START + 660.0)
    assert math.isnan(last.actual_s)
    assert math.isnan(last.late_s)


def test_a_passing_time_is_held_against_the_plan():
    journey = make_journey(make_line(), "7")
    (passing,) = [call for call in journey.calls if call.kind == "pass"]
    passing = replace(passing, planned_departure_s=START + 400.0, arrival_s=START + 390.0)
    (row,) = rows_of(replace(journey, calls=(passing,)))
    assert (row.kind, row.late_s) == ("pass", -10.0)


def test_a_planned_departure_at_the_end_is_a_row():
    journey = make_journey(make_line(), "7")
    last = replace(journey.calls[-1], planned_departure_s=START + 700.0, departure_s=journey.finished_s)
    assert [row.kind for row in rows_of(replace(journey, calls=(last,)))] == ["arrival", "departure"]


def test_time_at_stops_counts_from_when_the_train_is_on_the_line():
    journey = make_journey(make_line(), "7")
    stops = [call for call in journey.calls if call.kind == "stop"]
    begin = replace(stops[0], at_m=0.0, arrival_s=float("nan"), departure_s=journey.start_s + 12.0)
    assert time_at_stops([begin], journey.start_s, journey.finished_s) == 12.0
    (middle,) = [call for call in stops if call.station == "B"]
    assert time_at_stops([middle], journey.start_s, journey.finished_s) == pytest.approx(30.0)


def test_late_at_the_end_is_that_of_the_last_call_with_a_time():
    rows = [CallRow("7", "A", "departure", 10.0, 15.0), CallRow("7", "B", "arrival", 60.0, 61.0), CallRow("7", "C", "pass")]
    assert late_at_end(rows, 100.0) == 1.0
    assert np.isnan(late_at_end(rows[2:], 100.0))


def test_a_call_that_is_not_reached_in_time_counts_as_late():
    rows = [CallRow("7", "A", "departure", 10.0, 10.0), CallRow("7", "B", "arrival", 60.0), CallRow("7", "C", "arrival", 90.0)]
    assert [overdue_by(rows, end) for end in (50.0, 60.0, 75.0, 100.0)] == [0.0, 0.0, 15.0, 40.0]
    assert [late_at_end(rows, end) for end in (50.0, 75.0)] == [0.0, 15.0]
