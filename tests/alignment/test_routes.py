"""Routes: faults of their legs, where a train stops on them, and what lacks a speed limit."""

import pytest

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.path import compile_path
from tractionpower.alignment.routes import (
    check_route,
    check_speed_limits,
    name_stretches,
    speed_limit_gaps,
    stop_distance,
)
from tractionpower.model.line import ChainageBreak, Connection, Line, SpeedLimit, Station, Track, TrackPoint
from tractionpower.model.timetable import Leg

PATH = "timetable.trains[R1].route"


def legs(*items):
    return tuple(Leg(track=track, from_km=low, to_km=high) for track, low, high in items)


def joined(first, first_km, second, second_km):
    return Connection(from_=TrackPoint(track=first, km=first_km), to=TrackPoint(track=second, km=second_km))


@pytest.fixture
def network(line):
    """The line with a branch of its own kilometrage, which falls towards km 3 of track 1."""
    tracks = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0))
    return line(
        tracks=(*tracks, Track(id="branch", from_km=100.0, to_km=105.0)),
        connections=(joined("1", 10.0, "2", 10.0), joined("1", 3.0, "branch", 100.0)),
        chainage_breaks=(ChainageBreak(at_km=15.0, continues_as_km=16.0, tracks=("1", "2")),),
    )


def problems(network, *items):
    return check_route(PATH, legs(*items), network, compile_axes(network))


@pytest.mark.parametrize(
    "items",
    [
        [("1", 0.0, 20.0)],
        [("1", 0.0, 10.0), ("2", 10.0, 20.0)],
        [("2", 20.0, 10.0), ("1", 10.0, 0.0)],
        [("1", 0.0, 9.9992), ("2", 10.0009, 20.0)],
        [("1", 0.0, 3.0), ("branch", 100.0, 105.0)],
        [("branch", 105.0, 100.0), ("1", 3.0, 0.0)],
        [("branch", 105.0, 100.0), ("1", 3.0, 8.0)],
        [("1", 0.0, 4.0), ("1", 4.0, 7.0)],
        [("1", 0.0, 15.0), ("1", 16.0, 20.0)],
    ],
)
def test_routes_in_order(network, items):
    assert problems(network, *items) == []


@pytest.mark.parametrize(
    ("items", "code", "path", "words"),
    [
        ([("7", 0.0, 20.0)], "unknown_track", "[0].track", ["no track 7", "tracks: 1, 2, branch"]),
        ([("1", 0.0, 20.5)], "off_track", "[0].to_km", ["km 20.5 is not on track 1", "from km 16 to km 20"]),
        ([("1", 15.5, 20.0)], "off_track", "[0].from_km", ["km 15.5 is not on track 1"]),
        ([("1", 15.0, 16.0)], "empty_leg", "[0]", ["km 15 and km 16 are one place of track 1"]),
        ([("1", 0.0, 10.0), ("9", 10.0, 12.0), ("2", 12.0, 13.0)], "unknown_track", "[1].track", ["no track 9"]),
        ([("1", 0.0, 9.998), ("2", 9.998, 20.0)], "legs_apart", "[1]",
         ["begins on track 2 at km 9.998, the one before ends on track 1 at km 9.998", "line.connections"]),
        ([("1", 0.0, 9.0), ("1", 9.002, 20.0)], "legs_apart", "[1]", ["track 1 at km 9.002"]),
        ([("1", 0.0, 3.0), ("branch", 105.0, 100.0)], "legs_apart", "[1]", ["track branch at km 105"]),
    ],
)  # fmt: skip
def test_faulty_routes(network, items, code, path, words):
    found = problems(network, *items)
    assert [(item.code, item.path, item.severity) for item in found] == [(code, PATH + path, "error")]
    assert all(word in str(found[0]) for word in words)


def test_a_route_that_turns_round_on_a_track_is_doubtful(network):
    found = problems(network, ("1", 0.0, 8.0), ("1", 8.0, 0.0))
    assert [(item.code, item.path, item.severity) for item in found] == [("turns_round", PATH + "[1]", "warning")]


# --- stops -------------------------------------------------------------------------------------------------------


def compiled(*items, category=None, **lists):
    tracks = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0))
    line = Line(tracks=tracks, **lists)
    return compile_path(line, compile_axes(line), legs(*items), category, 0.0)


STOPS = {"1 increasing": 10.1, "1": 9.9, "2 decreasing": 10.3}


@pytest.mark.parametrize(
    ("leg", "tracks", "distance"),
    [
        (("1", 0.0, 20.0), None, 10_100.0),
        (("1", 20.0, 0.0), None, 10_100.0),  # km 9.9, from the other side
        (("2", 20.0, 0.0), None, 9_700.0),
        (("2", 0.0, 20.0), None, 10_000.0),
        (("2", 0.0, 20.0), ("1",), None),
        (("1", 0.0, 20.0), ("1",), 10_100.0),
        (("1", 0.0, 10.0), None, None),  # the route ends before the place where it would stop
    ],
)
def test_where_a_train_stops(leg, tracks, distance):
    found = stop_distance(compiled(leg), Station(id="C", km=10.0, tracks=tracks, stop_km=STOPS))
    assert found == (None if distance is None else pytest.approx(distance))


def test_a_station_at_the_ends_of_a_route_and_one_passed_twice():
    path = compiled(("1", 5.0, 8.0), ("2", 8.0, 5.0))
    assert stop_distance(path, Station(id="A", km=5.0)) == 0.0
    assert stop_distance(path, Station(id="A", km=5.0), from_m=1.0) == path.length_m
    assert stop_distance(path, Station(id="B", km=6.0, tracks=("2",))) == 5000.0
    assert stop_distance(path, Station(id="Z", km=9.0)) is None


# --- speed limits ------------------------------------------------------------------------------------------------


def test_stretches_without_a_limit():
    limits = (
        SpeedLimit(from_km=0.0, to_km=4.0, kmh=100),
        SpeedLimit(from_km=6.0, to_km=20.0, kmh=100, direction="decreasing"),
        SpeedLimit(from_km=12.0, to_km=20.0, kmh=100, category="freight"),
    )
    up = compiled(("1", 2.0, 10.0), ("2", 10.0, 15.0), speed_limits=limits)
    assert speed_limit_gaps(up) == [(2000.0, 13_000.0)]
    problems = check_speed_limits("timetable.trains[R1].route", up)
    assert [(item.code, item.path, item.severity) for item in problems] == [
        ("no_speed_limit", "timetable.trains[R1].route", "error")
    ]
    assert "track 1 from km 4 to km 10; track 2 from km 10 to km 15" in problems[0].found
    assert speed_limit_gaps(compiled(("1", 2.0, 15.0), speed_limits=limits, category="freight")) == [(2000.0, 10_000.0)]
    down = compiled(("1", 15.0, 0.0), speed_limits=limits)
    assert speed_limit_gaps(down) == [(9000.0, 11_000.0)]
    assert name_stretches(down, speed_limit_gaps(down)) == ["track 1 from km 6 to km 4"]


def test_a_route_with_limits_throughout_and_one_with_none():
    assert check_speed_limits("x", compiled(("1", 2.0, 15.0), speed_limits=(SpeedLimit(from_km=0.0, to_km=20.0, kmh=9),))) == []
    assert speed_limit_gaps(compiled(("1", 2.0, 15.0))) == [(0.0, 13_000.0)]


def test_many_gaps_are_shortened():
    limits = tuple(SpeedLimit(from_km=float(km), to_km=km + 0.5, kmh=100) for km in range(10))
    (problem,) = check_speed_limits("x", compiled(("1", 0.0, 9.5), speed_limits=limits))
    assert "from km 3.5 to km 4; ... (9 in all)" in problem.found
