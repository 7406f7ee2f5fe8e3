"""Checks of the line: each fault gives one problem with its code, its place and what a person needs to mend it."""

import pytest

from tractionpower.alignment.checks import check_line
from tractionpower.model.line import (
    ChainageBreak,
    Connection,
    Curve,
    CurveResistance,
    Gradient,
    Line,
    PowerOff,
    SpeedLimit,
    Station,
    Track,
    TrackPoint,
    TrainCurrentLimit,
    Tunnel,
)


def assert_only(line, code, path, *words, severity="error"):
    """Assert that the line has one problem and that this is it."""
    problems = check_line(line)
    assert len(problems) == 1, [str(problem) for problem in problems]
    assert (problems[0].code, problems[0].path, problems[0].severity) == (code, path, severity)
    for word in words:
        assert word in str(problems[0])


def point(track, km):
    return TrackPoint(track=track, km=km)


def test_a_line_in_order_has_no_problem(line):
    assert check_line(line()) == []
    assert check_line(Line(tracks=(Track(id="1", from_km=0.0, to_km=1.0),))) == []


def test_a_level_line_without_limits_has_no_problem(line):
    assert check_line(line(gradients=(), speed_limits=())) == []


def test_two_tracks_of_one_id(line, parts):
    extra = Track(id="1", from_km=0.0, to_km=5.0)
    assert_only(line(tracks=(*parts["tracks"], extra)), "duplicate_id", "line.tracks[2]", "'1'", "2 times", "its own id")


def test_two_stations_of_one_id(line):
    stations = (Station(id="A", km=0.0), Station(id="A", km=3.0))
    assert_only(line(stations=stations), "duplicate_id", "line.stations[A]", "'A'", "its own id")


@pytest.mark.parametrize(
    ("station", "code", "path", "words"),
    [
        (Station(id="X", km=21.0), "off_track", "km", ["no track exists at km 21", "tracks 1, 2 from km 0 to km 20"]),
        (Station(id="X", km=21.0, tracks=("2",)), "off_track", "km", ["km 21 is not on track 2", "allowed: track 2 from km 0"]),
        (Station(id="X", km=1.0, tracks=("1", "7")), "unknown_track", "tracks", ["no track 7", "tracks: 1, 2"]),
        (Station(id="X", km=1.0, tracks=()), "no_tracks", "tracks", ["empty", "leave it out"]),
        (Station(id="X", km=1.0, tracks=("1", "1")), "duplicate_track", "tracks", ["track 1", "more than once"]),
        (Station(id="X", km=1.0, stop_km={"2": 20.5}), "off_track", "stop_km[2]", ["km 20.5 is not on track 2"]),
        (Station(id="X", km=1.0, stop_km={"3 decreasing": 2}), "unknown_track", "stop_km[3 decreasing]", ["no track 3"]),
        (Station(id="X", km=1.0, stop_km={"1 up": 2}), "unknown_track", "stop_km[1 up]", ["no track 1 up"]),
    ],
)
def test_stations_off_their_tracks(line, station, code, path, words):
    assert_only(line(stations=(station,)), code, f"line.stations[X].{path}", *words)


ROWS = {
    "gradients": lambda **k: Gradient(permille=1, **k),
    "curves": lambda **k: Curve(radius_m=300, **k),
    "tunnels": lambda **k: Tunnel(kind="double_track", **k),
    "speed_limits": lambda **k: SpeedLimit(kmh=50, **k),
    "train_current_limits": lambda **k: TrainCurrentLimit(max_current_a=2000, **k),
    "power_off": lambda **k: PowerOff(kind="neutral", **k),
}


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize(
    ("row", "code", "path", "words"),
    [
        ({"from_km": 6.0, "to_km": 7.0, "tracks": ("8",)}, "unknown_track", ".tracks", ["no track 8"]),
        ({"from_km": 20.0, "to_km": 21.0}, "off_track", ".to_km", ["no track exists at km 21"]),
        ({"from_km": -1.0, "to_km": 0.0, "tracks": ("1", "2")}, "off_track", ".from_km", ["km -1 is not on tracks 1, 2"]),
        ({"from_km": 21.0, "to_km": 22.0, "tracks": ("1",)}, "off_track", "", ["km 21 is not on track 1; km 22 is not"]),
    ],
)
def test_rows_name_tracks_that_exist_and_stay_on_them(line, parts, name, row, code, path, words):
    rows = parts.get(name, ())
    assert_only(line(**{name: (*rows, ROWS[name](**row))}), code, f"line.{name}[{len(rows)}]{path}", *words)


@pytest.mark.parametrize("name", ["gradients", "curves", "tunnels"])
def test_overlaps(line, parts, name):
    rows = (*parts[name], ROWS[name](from_km=1.5, to_km=4.5, tracks=("1",)))
    problems = check_line(line(**{name: rows}))
    assert {(problem.code, problem.severity) for problem in problems} == {("overlap", "error")}
    first = problems[0]
    assert first.path == f"line.{name}[{len(rows) - 1}]"
    assert "track 1 from km " in first.found
    assert "let one end where the other begins" in first.remedy


def test_an_overlap_on_two_tracks_is_one_problem(line):
    curves = (Curve(from_km=1.0, to_km=3.0, radius_m=500), Curve(from_km=2.5, to_km=4.0, radius_m=700))
    words = ("rows 0 and 1 both hold on tracks 1, 2 from km 2.5 to km 3",)
    assert_only(line(curves=curves), "overlap", "line.curves[1]", *words)


def test_rows_on_different_tracks_and_limits_may_overlap(line, parts):
    tunnels = (*parts["tunnels"], Tunnel(from_km=4.0, to_km=5.0, kind="single_track", tracks=("2",)))
    limits = (*parts["speed_limits"], SpeedLimit(from_km=1.0, to_km=2.0, kmh=40))
    assert check_line(line(tunnels=tunnels, speed_limits=limits)) == []


def test_a_gap_of_gradients(line, parts):
    gap = line(gradients=parts["gradients"][:2])
    assert_only(
        gap, "gap", "line.gradients", "no gradient on track 2 from km 12.5 to km 20", "level is assumed", severity="warning"
    )


def test_a_gap_of_speed_limits(line):
    limits = (SpeedLimit(from_km=0.0, to_km=8.0, kmh=160), SpeedLimit(from_km=9.0, to_km=20.0, kmh=160))
    words = ("no speed limit on tracks 1, 2 from km 8 to km 9;", "a train that runs there is refused")
    assert_only(line(speed_limits=limits), "gap", "line.speed_limits", *words, severity="warning")


def test_a_gap_of_speed_limits_in_one_direction(line, parts):
    up = SpeedLimit(from_km=0.0, to_km=20.0, kmh=160, direction="increasing")
    words = ("tracks 1, 2 from km 0 to km 20 for trains that run with decreasing km",)
    assert_only(line(speed_limits=(up,)), "gap", "line.speed_limits", *words, severity="warning")


def test_rows_of_a_category_serve_only_its_trains(line):
    limits = (SpeedLimit(from_km=0.0, to_km=20.0, kmh=80, category="freight"),)
    assert_only(
        line(speed_limits=limits), "gap", "line.speed_limits", "category freight serve only its trains", severity="warning"
    )


def test_a_curve_at_whose_radius_the_formula_of_the_line_has_no_value(line):
    words = ("at a radius of 500 m", "allowed: above b = 500 m", "line.curve_resistance.b_m")
    formula = CurveResistance(a=700.0, b_m=500.0)
    assert_only(line(curve_resistance=formula), "curve_radius", "line.curves[1].radius_m", *words)
    assert check_line(line(curve_resistance=CurveResistance(a=700.0, b_m=499.0))) == []


@pytest.mark.parametrize(
    ("item", "code", "path", "words"),
    [
        (ChainageBreak(at_km=30.0, continues_as_km=31.0), "off_track", "at_km", ["km 30 lies inside no track"]),
        (ChainageBreak(at_km=30.0, continues_as_km=31.0, tracks=("1", "2")), "chainage_break", "at_km",
         ["the kilometrage of tracks 1, 2 cannot jump at km 30", "above km 0, below km 20"]),
        (ChainageBreak(at_km=15.0, continues_as_km=25.0, tracks=("2",)), "chainage_break", "continues_as_km",
         ["track 2 cannot jump to km 25", "below km 20"]),
        (ChainageBreak(at_km=15.0, continues_as_km=-1.0, tracks=("2",)), "chainage_break", "continues_as_km", ["from km 0"]),
        (ChainageBreak(at_km=15.0, continues_as_km=16.0, tracks=("5",)), "unknown_track", "tracks", ["no track 5"]),
    ],
)  # fmt: skip
def test_chainage_breaks_off_the_track(line, item, code, path, words):
    assert_only(line(chainage_breaks=(item,)), code, f"line.chainage_breaks[0].{path}", *words)


def test_a_break_in_kilometres_that_another_leaves_out(line):
    breaks = (ChainageBreak(at_km=15.0, continues_as_km=17.0), ChainageBreak(at_km=16.0, continues_as_km=18.0))
    assert_only(
        line(chainage_breaks=breaks), "chainage_break", "line.chainage_breaks[1].at_km", "above km 17", "the break before"
    )


def test_rows_through_a_break_are_in_order_and_left_out_kilometres_are_not(line):
    breaks = (ChainageBreak(at_km=15.0, continues_as_km=17.0),)
    assert check_line(line(chainage_breaks=breaks)) == []
    words = ("no track exists at km 16", "from km 0 to km 15; tracks 1, 2 from km 17 to km 20")
    assert_only(line(chainage_breaks=breaks, stations=(Station(id="X", km=16.0),)), "off_track", "line.stations[X].km", *words)


@pytest.mark.parametrize(
    ("ends", "code", "path", "words"),
    [
        ((point("1", 21.0), point("2", 5.0)), "off_track", "from.km", ["km 21 is not on track 1"]),
        ((point("1", 5.0), point("2", -0.5)), "off_track", "to.km", ["km -0.5 is not on track 2"]),
        ((point("1", 5.0), point("4", 5.0)), "unknown_track", "to.track", ["no track 4"]),
    ],
)
def test_connections_lie_on_tracks(line, ends, code, path, words):
    connection = Connection(from_=ends[0], to=ends[1])
    assert_only(line(connections=(connection,)), code, f"line.connections[0].{path}", *words)


def test_long_lists_of_tracks_are_shortened(line):
    tracks = tuple(Track(id=str(number), from_km=float(number), to_km=50.0) for number in range(30))
    long = line(tracks=tracks, gradients=(), speed_limits=(), tunnels=(), stations=(Station(id="X", km=60.0),))
    assert_only(long, "off_track", "line.stations[X].km", "... (30 in all)")


# --- connections and rings


def connected(*pairs):
    ends = [({"track": a, "km": x}, {"track": b, "km": y}) for (a, x), (b, y) in pairs]
    tracks = [{"id": track, "from_km": 0.0, "to_km": 20.0} for track in "12"]
    return Line.model_validate({"tracks": tracks, "connections": [{"from": one, "to": other} for one, other in ends]})


def test_a_connection_from_a_place_to_itself():
    (problem,) = check_line(connected((("1", 5.0), ("1", 5.0))))
    assert (problem.code, problem.path, problem.severity) == ("connection_to_itself", "line.connections[0]", "error")
    assert "track 1: km 5" in problem.found
    assert check_line(connected((("1", 5.0), ("2", 5.0)), (("1", 5.0), ("1", 5.1)))) == []


def test_both_kilometres_of_a_chainage_break_are_one_place():
    breaks = [{"at_km": 7.0, "continues_as_km": 9.0, "tracks": ["1"]}]
    line = connected((("1", 7.0), ("1", 9.0)))
    line = Line.model_validate(line.model_dump(by_alias=True) | {"chainage_breaks": breaks})
    assert [problem.code for problem in check_line(line)] == ["connection_to_itself"]


def test_the_same_connection_twice():
    (problem,) = check_line(connected((("1", 5.0), ("2", 5.0)), (("2", 5.0), ("1", 5.0))))
    assert (problem.code, problem.path) == ("duplicate_connection", "line.connections[1]")
    assert "row 0" in problem.found


def test_a_ring_of_kilometres():
    line = Line.model_validate(
        {"tracks": [{"id": "1", "from_km": 5.0, "to_km": 20.0}], "chainage_breaks": [{"at_km": 12.0, "continues_as_km": 3.0}]}
    )
    (problem,) = check_line(line)
    assert (problem.code, problem.path) == ("chainage_break", "line.chainage_breaks[0].continues_as_km")
    assert "cannot jump to km 3: it would run in a ring, past km 5 where the piece before begins" in problem.found
    assert "from km 5" in problem.allowed


# --- what is allowed and doubtful


def test_current_limits_that_overlap_are_doubtful(line):
    rows = (TrainCurrentLimit(from_km=0.0, to_km=10.0, max_current_a=2000.0),
            TrainCurrentLimit(from_km=8.0, to_km=12.0, max_current_a=1500.0, tracks=("2",)))  # fmt: skip
    words = ("rows 0 and 1 both hold on track 2 from km 8 to km 10", "the lower limit holds")
    assert_only(line(train_current_limits=rows), "overlap", "line.train_current_limits[1]", *words, severity="warning")
    apart = (rows[0], rows[1].model_copy(update={"from_km": 10.0}))
    assert check_line(line(train_current_limits=apart)) == []


def test_more_current_at_standstill_than_in_motion_is_doubtful(line):
    row = TrainCurrentLimit(from_km=0.0, to_km=10.0, max_current_a=200.0, standstill_current_a=300.0)
    path = "line.train_current_limits[0].standstill_current_a"
    words = ("300 A at standstill, above 200 A", "up to max_current_a, 200 A")
    assert_only(line(train_current_limits=(row,)), "standstill_current", path, *words, severity="warning")
    assert check_line(line(train_current_limits=(row.model_copy(update={"standstill_current_a": 200.0}),))) == []


def test_stretches_without_power_of_two_kinds_that_overlap_are_doubtful(line):
    rows = (PowerOff(from_km=3.0, to_km=5.0, kind="coast"), PowerOff(from_km=4.0, to_km=6.0, kind="neutral"))
    words = ("rows 0 (coast) and 1 (neutral) both hold on tracks 1, 2 from km 4 to km 5", "what takes more away holds")
    assert_only(line(power_off=rows), "overlap", "line.power_off[1]", *words, severity="warning")
    assert check_line(line(power_off=(rows[0], rows[1].model_copy(update={"kind": "coast"})))) == []


def test_kilometres_that_exist_twice_are_doubtful(line):
    path, words = "line.chainage_breaks[0].continues_as_km", ("km 14 to km 15 exist twice on tracks 1, 2", "first occurrence")
    breaks = (ChainageBreak(at_km=15.0, continues_as_km=14.0),)
    assert_only(line(chainage_breaks=breaks), "doubled_km", path, *words, severity="warning")
