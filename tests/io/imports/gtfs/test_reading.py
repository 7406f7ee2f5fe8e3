"""A feed becomes a study that reads and checks: every rail trip of the day once, all that was assumed told."""

import math
from pathlib import Path

import pytest
from small_feeds import KM, calls, codes, plain, read, shape, stop, tables, trains, trip, with_trip, write_feed

import tractionpower
from tractionpower.io.imports.gtfs.reading import identifiers, read_gtfs
from tractionpower.io.text_files import write_files


def errors(folder, found):
    """Write the files of an import as a study and return what is wrong with it."""
    assert found.texts, found.notes.problems
    write_files(folder / "study", found.texts)
    problems = tractionpower.check(tractionpower.load(folder / "study"))
    return [problem for problem in problems if problem.code != "faster_than_train"]  # the times of the small feed are made up


def test_a_small_feed(tmp_path):
    found = read(tmp_path)
    assert found.notes.problems == []
    assert sorted(found.texts) == ["README.md", "line.yaml", "study.yaml", "supply.yaml", "timetable.yaml"]
    assert trains(found)["T1"] == {
        "id": "T1",
        "train": "en57",
        "route": [{"track": "1", "from_km": 0.0, "to_km": pytest.approx(3 * KM, abs=1e-3)}],
        "calls": [
            {"station": "A", "departure": "06:00:00"},
            {"station": "B", "departure": "06:02:00", "min_dwell_s": 20.0},
            {"station": "C", "arrival": "06:04:00", "departure": "06:05:00", "min_dwell_s": 20.0},
            {"station": "D", "arrival": "06:07:00"},
        ],
    }
    west = trains(found)["T2"]
    assert west["route"] == [{"track": "2", "from_km": pytest.approx(3 * KM, abs=1e-3), "to_km": 0.0}]
    assert [call["station"] for call in west["calls"]] == ["D", "C", "B", "A"]
    stations = plain(found, "line.yaml")["stations"]
    assert [(each["id"], each["name"]) for each in stations] == [(name, f"Stop {name}") for name in "ABCD"]
    assert [each["km"] for each in stations] == pytest.approx([0.0, KM, 2 * KM, 3 * KM], abs=1e-3)
    assert plain(found, "study.yaml")["clock"] == {"start": "05:50:00", "end": "07:40:00", "step_s": 1.0}
    assert errors(tmp_path, found) == []


def test_all_is_told(tmp_path):
    found = read(tmp_path, {"train": "en97", "speed_kmh": 80.0})
    told = found.texts["README.md"]
    for words in (
        "2 trips by rail of the day, 8 calls",
        "4 stations",
        "2023-06-07, a Wednesday, is the first such day",
        "route Z1 (Z), route_type 3, is no rail: 1 trip",
        "1 trip by rail of other days",
        "every stop lasts 20 s at least",
        "whole minutes",
        "speed limit 80 km/h",
        "run by the train en97",
        "the whole supply",
    ):
        assert words in told, words
    assert all(row in told for rows in (found.notes.read, found.notes.assumed, found.notes.ignored) for row in rows)


def test_a_train_that_nobody_knows(tmp_path):
    found = read(tmp_path, {"train": "en99"})
    (problem,) = found.notes.problems
    assert (problem.code, problem.remedy, found.texts) == ("unknown_train", "did you mean en97?", {})
    own = tmp_path / "study" / "rollingstock" / "trains"
    own.mkdir(parents=True)
    (own / "en99.yaml").write_text("format: 1\n", encoding="utf-8")
    assert trains(read(tmp_path, {"train": "en99", "folder": tmp_path / "study"}))["T1"]["train"] == "en99"


def test_whole_minutes_set_the_tolerance(tmp_path):
    assert plain(read(tmp_path), "study.yaml")["feasibility"] == {"tolerance_s": 30.0}
    seconds = read(tmp_path, **with_trip("T3", "A 10:00:00", "B 10:02:17", "D 10:07:00"))
    assert "feasibility" not in plain(seconds, "study.yaml")


def test_trips_that_are_too_fast_are_told(tmp_path):
    assert not any("may be faster" in row for row in read(tmp_path).notes.assumed)
    found = read(tmp_path, **with_trip("T3", "A 10:00:00", "B 10:01:00", "C 10:02:00", "D 10:09:00"))
    (told,) = [row for row in found.notes.assumed if "may be faster" in row]
    # at 0.5 m/s2, with 20 s at B and at C, where it leaves 120 s after A by the plan
    late = 2 * (2 * math.sqrt(1000.0 * KM / 0.5) + 20.0) - 120.0
    assert "1 of 3 trips" in told
    assert f"T3 would be {late:.0f} s late" in told
    assert f"{KM * 60:.0f} km/h on average" in told
    assert any("may be faster" in row for row in read(tmp_path, {"speed_kmh": 45.0}).notes.assumed)


def test_times_to_the_second_are_not_called_rounded(tmp_path):
    found = read(tmp_path, **with_trip("T3", "A 10:00:00", "B 10:02:17", "D 10:07:00"))
    assert "whole minutes" not in found.texts["README.md"]
    assert trains(found)["T3"]["calls"][1]["departure"] == "10:02:17"


def test_options_of_track_and_dwell(tmp_path):
    found = read(tmp_path, {"double": ("A..C",), "min_dwell_s": 90.0, "name": "Mine"})
    line = plain(found, "line.yaml")
    assert line["name"] == "Mine"
    assert [(row["id"], row["to_km"]) for row in line["tracks"]] == [
        ("1", pytest.approx(3 * KM, abs=1e-3)),
        ("2", pytest.approx(2 * KM, abs=1e-3)),
    ]
    km = line["tracks"][1]["to_km"]
    assert line["connections"] == [{"from": {"track": "1", "km": km}, "to": {"track": "2", "km": km}}]
    east, west = trains(found)["T1"], trains(found)["T2"]
    assert [leg["track"] for leg in east["route"]] == ["1"]
    assert [leg["track"] for leg in west["route"]] == ["1", "2"]
    assert [call.get("min_dwell_s") for call in east["calls"]] == [None, 90.0, 60.0, None]  # where 60 s are planned, no more
    assert errors(tmp_path, found) == []


def test_a_single_track(tmp_path):
    found = read(tmp_path, {"double": ("none",)})
    assert [row["id"] for row in plain(found, "line.yaml")["tracks"]] == ["1"]
    assert trains(found)["T2"]["route"][0]["track"] == "1"
    assert errors(tmp_path, found) == []


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"double": ("A..X",)}, "bad_double"),
        ({"double": ("A",)}, "bad_double"),
        ({"min_dwell_s": float("nan")}, "bad_option"),
        ({"speed_kmh": 0.0}, "bad_option"),
        ({"routes": ("X",)}, "unknown_routes"),
        ({"agencies": ("X",)}, "unknown_agencies"),
    ],
)
def test_bad_options(tmp_path, options, code):
    found = read(tmp_path, options)
    assert code in codes(found)
    assert found.texts == {}


def test_routes_and_agencies_can_be_chosen(tmp_path):
    changed = with_trip("X1", "A 10:00:00", "B 10:03:00", route="R2")
    agencies = [*tables()["agency"], {"agency_id": "7", "agency_name": "Other"}]
    routes = [*tables()["routes"], {"route_id": "R2", "agency_id": "7", "route_short_name": "X", "route_type": "106"}]
    source = write_feed(tmp_path / "feed", **changed, routes=routes, agency=agencies)
    assert sorted(trains(read_gtfs(source))) == ["T1", "T2", "X1"]
    for options in ({"routes": ("X",)}, {"routes": ("R2",)}, {"agencies": ("Other",)}, {"agencies": ("7",)}):
        found = read_gtfs(source, **options)
        assert sorted(trains(found)) == ["X1"]
        assert "route R1, not asked for: 3 trips by rail" in found.notes.ignored


def test_extended_types_are_rail_and_metros_are_not(tmp_path):
    kinds = (2, 100, 109, 117, 118, 1, 401)
    given = tables()
    routes = [{"route_id": f"K{k}", "route_short_name": f"K{k}", "route_type": f"{k}"} for k in kinds]
    times = [row for k in kinds for row in calls(f"N{k}", f"A {k // 10}:{k % 60}:00", f"B {k // 10}:59:59")]
    found = read(
        tmp_path,
        routes=[*given["routes"], *routes],
        trips=[*given["trips"], *(trip(f"N{k}", route=f"K{k}") for k in kinds)],
        stop_times=[*given["stop_times"], *times],
    )
    assert set(trains(found)) == {"T1", "T2", "N2", "N100", "N109", "N117"}
    assert sum("is no rail" in row for row in found.notes.ignored) == 4


def test_frequencies_become_services(tmp_path):
    frequencies = [
        {"trip_id": "T1", "start_time": "05:00:00", "end_time": "06:00:00", "headway_secs": "600", "exact_times": "1"},
        {"trip_id": "T1", "start_time": "06:00:00", "end_time": "06:50:00", "headway_secs": "900", "exact_times": "0"},
    ]
    found = read(tmp_path, frequencies=frequencies)
    services = plain(found, "timetable.yaml")["services"]
    assert set(trains(found)) == {"T2"}
    # a start at the end of the interval is none: 05:50 and 06:45 are the last ones
    times = [(row["id"], row["first"], row["last"], row["headway_s"]) for row in services]
    assert times == [("T1 (1)", "05:00:00", "05:50:00", 600.0), ("T1 (2)", "06:00:00", "06:45:00", 900.0)]
    assert services[0]["calls"][0]["departure"] == "00:00:00"
    assert services[0]["calls"][2]["arrival"] == "00:04:00"
    assert any("equal intervals" in row for row in found.notes.assumed)
    assert [problem for problem in errors(tmp_path, found) if problem.severity == "error"] == []


def test_bad_frequencies(tmp_path):
    row = {"trip_id": "T1", "start_time": "07:00:00", "end_time": "06:00:00", "headway_secs": "600"}
    assert codes(read(tmp_path, frequencies=[row])) == ["bad_frequency"]


def test_blocks_become_rotations(tmp_path):
    given = tables()
    added = [
        trip("T1", block_id="x"),
        trip("T2", "west", block_id="x", direction_id="1"),
        trip("T5", block_id="x"),
        trip("T6", block_id="x"),
    ]
    times = calls("T5", "A 07:10:00", "D 07:20:00") + calls("T6", "A 07:15:00", "D 07:25:00")
    found = read(tmp_path, trips=added, stop_times=[*given["stop_times"], *times])
    assert plain(found, "timetable.yaml")["rotations"] == [{"id": "x", "runs": ["T1", "T2", "T5"]}]
    assert any("T5 to T6" in row for row in found.notes.ignored)
    assert [problem for problem in errors(tmp_path, found) if problem.severity == "error"] == []


def test_a_passing_is_no_stop(tmp_path):
    given = tables()
    rows = [row | ({"pickup_type": "1", "drop_off_type": "1"} if row["trip_id"] == "T1" else {}) for row in given["stop_times"]]
    called = trains(read(tmp_path, stop_times=rows))["T1"]["calls"]
    assert called[1] == {"station": "B", "arrival": "06:02:00", "stops": False}
    assert called[2] == {"station": "C", "arrival": "06:04:00", "departure": "06:05:00", "min_dwell_s": 20.0}  # it stands there


def test_a_branch(tmp_path):
    stops = [*tables()["stops"], stop("E", 1.5, 0.01), stop("F", 1.5, 0.015)]
    changed = with_trip("Y1", "A 10:00:00", "B 10:02:00", "E 10:05:00", "F 10:07:00", shape_id="north")
    back = with_trip("Y2", "F 11:00:00", "E 11:02:00", "C 11:05:00", "D 11:07:00", shape_id="south")
    changed["trips"] += back["trips"][-1:]
    changed["stop_times"] += back["stop_times"][-4:]
    shapes = shape("north", (0, 0), (1.5, 0), (1.5, 0.015)) + shape("south", (1.5, 0.015), (1.5, 0), (3, 0))
    found = read(tmp_path, stops=stops, shapes=[*tables()["shapes"], *shapes], **changed)
    line = plain(found, "line.yaml")
    assert [row["id"] for row in line["tracks"]] == ["1", "2", "3", "4"]
    branch = {row["id"]: row for row in line["tracks"]}["3"]
    length = 0.015 * 111.229  # a degree of latitude at 50 degrees
    assert branch["to_km"] - branch["from_km"] == pytest.approx(length, abs=0.06)
    out, home = trains(found)["Y1"]["route"], trains(found)["Y2"]["route"]
    assert [leg["track"] for leg in out] == ["1", "3"]
    assert out[0]["to_km"] == pytest.approx(1.5 * KM, abs=0.06)
    assert [leg["track"] for leg in home] == ["4", "1"]
    whole = sum(abs(leg["to_km"] - leg["from_km"]) for leg in out)
    assert whole == pytest.approx(1.5 * KM + length, abs=0.06)
    tracks = {row["id"]: row["tracks"] for row in line["stations"]}
    assert tracks == {name: ["1", "2"] for name in "ABCD"} | {"E": ["3", "4"], "F": ["3", "4"]}
    assert [problem for problem in errors(tmp_path, found) if problem.severity == "error"] == []


def test_a_ring_is_refused(tmp_path):
    stops = [*tables()["stops"], stop("E", 1.5, 0.03)]
    shapes = [*tables()["shapes"], *shape("round", (0, 0), (0.5, 0), (1.5, 0.03), (2.5, 0), (3, 0))]
    found = read(
        tmp_path, stops=stops, shapes=shapes, **with_trip("Y1", "A 10:00:00", "E 10:05:00", "D 10:10:00", shape_id="round")
    )
    assert codes(found) == ["ring"]
    assert "trips by B, C leave the line" in found.notes.problems[0].found  # the longer way is the line
    assert found.texts == {}
    circle = shape("circle", (0, 0), (1, 0), (1, 0.02), (0, 0.02), (0, 0))
    stops = [stop("A", 0), stop("B", 1), stop("C", 1, 0.02), stop("D", 0, 0.02)]
    changed = {
        "trips": [trip("T1", "circle")],
        "stop_times": calls("T1", "A 6:00:00", "B 6:05:00", "C 6:10:00", "D 6:15:00", "A 6:20:00"),
    }
    assert codes(read(tmp_path, stops=stops, shapes=circle, **changed)) == ["way_differs"]


def test_lines_that_do_not_touch(tmp_path):
    stops = [*tables()["stops"], stop("E", 0, 0.5), stop("F", 2, 0.5)]
    shapes = [*tables()["shapes"], *shape("far", (0, 0.5), (2, 0.5))]
    found = read(tmp_path, stops=stops, shapes=shapes, **with_trip("Y1", "E 10:00:00", "F 10:05:00", shape_id="far"))
    assert any("2 networks that do not touch" in row for row in found.notes.assumed)
    assert [problem for problem in errors(tmp_path, found) if problem.severity == "error"] == []


def test_without_shapes(tmp_path):
    fast = with_trip("F1", "A 10:00:00", "D 10:05:00")
    stops = [stop("A", 0), stop("B", 1, 0.002), stop("C", 2, 0.002), stop("D", 3)]  # off the straight line of the fast train
    found = read(tmp_path, stops=stops, shapes=None, **fast)
    assert any("3 trips without a shape: straight lines" in row for row in found.notes.assumed)
    assert trains(found)["F1"]["route"] == trains(found)["T1"]["route"]
    assert len(plain(found, "line.yaml")["stations"]) == 4
    assert errors(tmp_path, found) == []


def test_platforms_are_one_station(tmp_path):
    by_parent = [
        stop("A", 0),
        stop("B", 1, parent_station="PB"),
        stop("C", 2),
        stop("D", 3),
        stop("B2", 1.001, 0.0002, parent_station="PB"),
    ]
    by_parent.append(stop("PB", 1, location_type="1"))
    times = [
        row | ({"stop_id": "B2"} if (row["trip_id"], row["stop_id"]) == ("T2", "B") else {}) for row in tables()["stop_times"]
    ]
    found = read(tmp_path, stops=by_parent, stop_times=times)
    assert [row["id"] for row in plain(found, "line.yaml")["stations"]] == ["A", "PB", "C", "D"]
    by_name = [
        row | {"parent_station": "", "stop_name": "Town" if row["stop_id"] in ("B", "B2") else row["stop_name"]}
        for row in by_parent
    ]
    found = read(tmp_path / "named", stops=by_name[:-1], stop_times=times)
    assert [row["id"] for row in plain(found, "line.yaml")["stations"]] == ["A", "B", "C", "D"]
    assert any("Town" in row for row in found.notes.assumed)


def test_identifiers_are_allowed_and_different():
    assert identifiers(["a[1]", "a(1)", "b"]) == {"a[1]": "a(1)", "a(1)": "a(1) (2)", "b": "b"}


def test_the_same_feed_gives_the_same_bytes(tmp_path):
    given = tables()
    turned = {name: rows[::-1] for name, rows in given.items()}
    turned["shapes"] = given["shapes"]
    assert read(tmp_path).texts == read(tmp_path / "turned", **turned).texts


def test_nothing_is_there(tmp_path):
    found = read_gtfs(Path(tmp_path / "none"))
    assert codes(found) == ["missing_file"]
    assert found.texts == {}


def test_two_calls_at_one_station_are_one(tmp_path):
    stops = [*tables()["stops"], stop("C2", 2.001, parent_station="C")]
    found = read(tmp_path, stops=stops, **with_trip("P1", "A 10:00:00", "C 10:04:00", "C2 10:09:00", "D 10:11:00"))
    called = trains(found)["P1"]["calls"]
    assert called[1] == {"station": "C", "arrival": "10:04:00", "departure": "10:09:00", "min_dwell_s": 20.0}
    assert any("1 call at the same station" in row for row in found.notes.assumed)


def test_points_of_shapes_that_are_nowhere(tmp_path):
    bad = [*tables()["shapes"], {"shape_id": "east", "shape_pt_sequence": "9", "shape_pt_lat": "inf", "shape_pt_lon": "20"}]
    found = read(tmp_path, shapes=bad)
    assert [(problem.code, problem.severity) for problem in found.notes.problems] == [("bad_shape", "warning")]
    assert trains(found)["T1"] == trains(read(tmp_path / "b"))["T1"]
