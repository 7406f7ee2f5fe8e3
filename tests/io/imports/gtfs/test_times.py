"""Times of trips: past midnight, backwards, a day too late, missing; told, and mended only when asked for."""

import pytest
from small_feeds import KM, codes, read, tables, trains, trip, with_trip


def times(found, name):
    return [(call.get("arrival"), call.get("departure")) for call in trains(found)[name]["calls"]]


def test_past_midnight(tmp_path):
    found = read(tmp_path, **with_trip("N1", "A 23:58:00", "B 24:00:00", "D 24:05:00"), **{})
    assert times(found, "N1") == [(None, "23:58:00"), (None, "24:00:00"), ("24:05:00", None)]
    assert 'end: "24:40:00"' in found.texts["study.yaml"]


def test_times_that_restart_at_midnight(tmp_path):
    changed = with_trip("N1", "A 23:58:00", "B 00:00:00", "C 00:02:00", "D 00:05:00")
    found = read(tmp_path, **changed)
    assert codes(found) == ["times_backwards"]
    assert "N1" in found.notes.problems[0].found
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1") == [(None, "23:58:00"), (None, "24:00:00"), (None, "24:02:00"), ("24:05:00", None)]
    assert any("over midnight" in row for row in mended.notes.repaired)


def test_one_time_a_day_too_late(tmp_path):
    changed = with_trip("N1", "A 17:02:00", "B 41:06:00", "C 17:10:00", "D 17:12:00")
    found = read(tmp_path, **changed)
    assert codes(found) == ["implausible_time"]
    assert "41:06:00" in found.notes.problems[0].found
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1") == [(None, "17:02:00"), (None, "17:06:00"), (None, "17:10:00"), ("17:12:00", None)]
    assert any("41:06:00 is a day late" in row for row in mended.notes.repaired)


def test_one_time_that_is_wrong_on_either_day_is_left_out(tmp_path):
    changed = with_trip("N1", "A 17:02:00", "B 41:00:00", "C 17:10:00", "D 17:12:00")
    assert codes(read(tmp_path, **changed)) == ["implausible_time"]
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1") == [(None, "17:02:00"), (None, "17:06:00"), (None, "17:10:00"), ("17:12:00", None)]
    assert [row for row in mended.notes.repaired if "midnight" in row] == []
    assert any("41:00:00 is neither between 17:02:00 and 17:10:00" in row for row in mended.notes.repaired)
    assert "tolerance_s: 30" in mended.texts["study.yaml"]  # the time that was filled in is no time of the feed


def test_repairs_that_did_not_help_are_not_told(tmp_path):
    changed = with_trip("N1", "A 23:50:00", "B 00:02:00", "C 00:04:00", "D 00:03:00")
    found = read(tmp_path, {"repair": True}, **changed)
    assert codes(found) == ["times_backwards"]
    assert found.notes.repaired == []
    assert "00:02:00 at B" in found.notes.problems[0].found  # as the feed has it


def test_the_last_time_a_day_too_late(tmp_path):
    changed = with_trip("N1", "A 17:02:00", "B 17:04:00", "D 41:06:00")
    assert codes(read(tmp_path, **changed)) == ["implausible_time"]
    assert times(read(tmp_path, {"repair": True}, **changed), "N1")[-1] == ("17:06:00", None)


def test_a_whole_trip_on_the_day_after(tmp_path):
    changed = with_trip("N1", "A 41:02:00", "D 41:06:00")
    found = read(tmp_path, **changed)
    assert codes(found) == ["late_in_the_day"]
    assert found.notes.problems[0].severity == "warning"
    assert times(found, "N1") == [(None, "41:02:00"), ("41:06:00", None)]
    assert "41:02:00" in found.texts["README.md"]
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1") == [(None, "17:02:00"), ("17:06:00", None)]


def test_backwards_in_between(tmp_path):
    changed = with_trip("N1", "A 10:00:00", "B 09:50:00", "C 10:04:00", "D 10:06:00")
    found = read(tmp_path, **changed)
    assert codes(found) == ["times_backwards"]
    assert found.notes.problems[0].place.startswith("stop_times.txt:")
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1")[1] == (None, "10:02:00")  # halfway
    assert any("left out" in row for row in mended.notes.repaired)


def test_backwards_at_the_end_is_not_mended(tmp_path):
    changed = with_trip("N1", "A 10:00:00", "B 10:02:00", "D 09:00:00")
    for repair in (False, True):
        assert codes(read(tmp_path, {"repair": repair}, **changed)) == ["times_backwards"]


def test_no_times_in_between(tmp_path):
    changed = with_trip("N1", "A 10:00:00", "B", "C", "D 10:09:00")
    found = read(tmp_path, **changed)
    assert codes(found) == []
    assert times(found, "N1")[1:3] == [(None, None), (None, None)]
    assert trains(found)["N1"]["calls"][1]["min_dwell_s"] == 20.0
    assert any("2 calls of 1 trip without times (N1)" in row for row in found.notes.assumed)
    mended = read(tmp_path, {"repair": True}, **changed)
    assert times(mended, "N1")[1:3] == [(None, "10:03:00"), (None, "10:06:00")]
    assert any("2 calls without times" in row for row in mended.notes.repaired)


@pytest.mark.parametrize("rows", [("A", "B 10:02:00", "D 10:06:00"), ("A 10:00:00", "B 10:02:00", "D")])
def test_no_time_at_an_end(tmp_path, rows):
    for repair in (False, True):
        assert codes(read(tmp_path, {"repair": repair}, **with_trip("N1", *rows))) == ["no_time"]


def test_no_times_at_all(tmp_path):
    changed = with_trip("N1", "A 10:00:00", "B 10:aa:00", "C 10:61:00", "D 10:06:00")
    found = read(tmp_path, **changed)
    assert set(codes(found)) == {"bad_time"}
    assert "2 such rows" in found.notes.problems[0].found
    assert times(read(tmp_path, {"repair": True}, **changed), "N1")[1:3] == [(None, "10:02:00"), (None, "10:04:00")]


def test_arrival_after_departure(tmp_path):
    assert codes(read(tmp_path, **with_trip("N1", "A 10:00:00", "B 10:03:00 10:02:00", "D 10:06:00"))) == ["times_backwards"]


def test_trips_with_equal_calls(tmp_path):
    changed = with_trip("T9", "A 06:00:00", "B 06:02:00", "C 06:04:00 06:05:00", "D 06:07:00")
    found = read(tmp_path, **changed)
    assert [(problem.code, problem.severity) for problem in found.notes.problems] == [("doubled_trip", "warning")]
    assert {"T1", "T9"} <= set(trains(found))
    mended = read(tmp_path, {"repair": True}, **changed)
    assert set(trains(mended)) == {"T1", "T2"}
    assert any("T9 as T1" in row for row in mended.notes.repaired)


def test_a_trip_id_twice(tmp_path):
    given = tables()
    found = read(tmp_path, trips=[*given["trips"], trip("T1")])
    assert codes(found) == ["doubled_trip"]
    assert found.texts == {}
    mended = read(tmp_path, {"repair": True}, trips=[*given["trips"], trip("T1")])
    assert sorted(trains(mended)) == ["T1", "T2"]


def test_calls_that_cannot_be_used(tmp_path):
    given = tables()["stop_times"]
    doubled = [*given, given[1]]
    assert codes(read(tmp_path, stop_times=doubled)) == ["doubled_call"]
    assert times(read(tmp_path, {"repair": True}, stop_times=doubled), "T1") == times(read(tmp_path / "b"), "T1")
    numbers = [given[0] | {"stop_sequence": "x"}, *given[1:]]
    assert codes(read(tmp_path, stop_times=numbers)) == ["bad_sequence"]
    unknown = [given[0], given[1] | {"stop_id": "Q"}, *given[2:]]
    found = read(tmp_path, stop_times=unknown)
    assert codes(found) == ["unknown_stop"]
    assert found.notes.problems[0].place == "stop_times.txt:3"


def test_trips_without_stops(tmp_path):
    given = tables()
    found = read(
        tmp_path,
        trips=[*given["trips"], trip("E1"), trip("E2")],
        stop_times=[*given["stop_times"], given["stop_times"][0] | {"trip_id": "E2"}],
    )
    assert [(problem.code, problem.severity) for problem in found.notes.problems] == [("trip_without_stops", "warning")]
    assert sorted(trains(found)) == ["T1", "T2"]
    assert any("E1, E2" in row for row in found.notes.ignored)


def test_calls_need_not_be_in_order_of_the_file(tmp_path):
    given = tables()
    assert times(read(tmp_path, stop_times=given["stop_times"][::-1]), "T1") == times(read(tmp_path / "b"), "T1")
    assert KM > 1.0
