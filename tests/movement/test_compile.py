"""Trains of a scenario as tables: order, calls, ends, pools."""

import numpy as np
import pytest
from small_trains import call, make_run, make_trains, passing

from tractionpower.kernels.train_tables import LEAVE, STAY, STOP_THERE
from tractionpower.movement.compile import compile_trains

STATIONS = {"A": 0.0, "B": 2.0, "C": 5.0}


def planned(**more):
    return compile_trains(make_trains(5.0, stations=STATIONS, runs=[make_run("x", 5.0, **more)])).runs[0]


@pytest.mark.parametrize(
    ("more", "end", "route_m"),
    [
        ({}, LEAVE, 5000.0),
        ({"calls": [call("B"), call("C")]}, STOP_THERE, 5000.0),
        ({"calls": [call("B"), call("C")], "end": "leave"}, LEAVE, 5000.0),
        ({"calls": [call("B"), call("C")], "end": "stay"}, STAY, 5000.0),
        ({"calls": [passing("B"), passing("C")]}, LEAVE, 5000.0),
        ({"end": "stop"}, STOP_THERE, 5000.0),
    ],
)
def test_ends(more, end, route_m):
    found = planned(**more)
    assert (found.end, found.route_m) == (end, route_m)


def test_runs_are_in_order_and_can_be_chosen():
    runs = [make_run(name, 5.0, time=60.0 * k) for k, name in enumerate(["b", "10", "a", "9"])]
    scenario = make_trains(5.0, runs=runs)
    assert compile_trains(scenario).names == ("10", "9", "a", "b")
    chosen = compile_trains(scenario, ["b", "9"])
    assert chosen.names == ("9", "b")
    assert chosen.tables.trains["start_s"].tolist() == [180.0, 0.0]
    assert len(compile_trains(make_trains(5.0), []).tables.trains) == 0


def test_equal_trains_share_pools_but_not_calls():
    runs = [make_run(name, 5.0, calls=[call("B"), call("C")]) for name in ("x", "y")]
    tables = compile_trains(make_trains(5.0, runs=runs, stations=STATIONS)).tables
    one, two = tables.trains
    for name in ("first_piece", "first_knot", "first_limit", "first_curve", "first_notch"):
        assert one[name] == two[name]
    assert (one["first_stop"], two["first_stop"], len(tables.stops)) == (0, 2, 4)


def test_calls_where_the_route_comes_to_them():
    found = planned(calls=[call("A", departure=30.0, min_dwell_s=5.0), passing("B"), call("C")])
    assert [one.at_m for one in found.calls] == [0.0, 2000.0, 5000.0]
    back = planned(backwards=True, calls=[call("C"), call("B"), call("A")])
    assert [one.at_m for one in back.calls] == [0.0, 3000.0, 5000.0]
    stops = compile_trains(
        make_trains(
            5.0, stations=STATIONS, runs=[make_run("x", 5.0, calls=[call("A", departure=30.0, min_dwell_s=5.0), call("C")])]
        )
    ).tables.stops
    assert stops.tolist() == [(0.0, 30.0, 5.0, True), (5000.0, -np.inf, 0.0, True)]


def test_the_ceiling_ends_at_the_route():
    tables = compile_trains(make_trains(5.0, limits=[(-1.0, 6.0, 72.0)], end="stop")).tables
    assert tables.pieces.tolist() == [(0.0, 400.0, 0.0), (4600.0, 400.0, -1.0), (5000.0, 0.0, 0.0)]


def test_line_current_limits():
    assert compile_trains(make_trains(5.0)).tables.trains[0]["limits"] == 0
    limits = [{"from_km": 1.0, "to_km": 2.0, "max_current_a": 900.0, "standstill_current_a": 200.0}]
    rows = compile_trains(make_trains(5.0, train_current_limits=limits)).tables.limits
    assert rows["from_m"].tolist() == [0.0, 1000.0, 2000.0]
    assert rows["max_a"].tolist() == [1e300, 900.0, 1e300]
    assert rows["standstill_a"].tolist() == [1e300, 200.0, 1e300]
