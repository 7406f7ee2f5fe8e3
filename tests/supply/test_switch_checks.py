"""Feeders and switches name what exists and join what can be joined."""

import pytest
from small_supplies import CONTACT, assert_only, end, problems_of, small_line, station


def feeder(**row):
    return {"at": "M", "track": "1", "side": "low_km", "resistance_ohm": 0.01} | row


def switch(first, second, **more):
    return {"id": "Q", "from": first, "to": second, "resistance_ohm": 0.01} | more


def test_the_small_supply_is_in_order():
    assert problems_of() == []
    rows = [feeder(), feeder(side="high_km", state="open", trip_current_a=3000.0, reclose_after_s=10.0), feeder(side="return")]
    assert problems_of(feeders=rows, switches=[switch(end(), end("2"))]) == []


@pytest.mark.parametrize(
    ("row", "code", "field", "words"),
    [
        (feeder(at="N"), "unknown_station", ".at", ["no substation or section cabin 'N'", "A, B, C, M"]),
        (feeder(track="3"), "unknown_track", ".track", ["no track 3"]),
        (feeder(track="3", km=4.0), "unknown_track", ".track", ["no track 3"]),
        (feeder(km=30.0), "off_track", ".km", ["km 30 is not on track 1"]),
        (feeder(at="A"), "no_contact_line", ".side", ["no contact line on the side of lower km", "km 0", "high_km"]),
        (feeder(at="B", side="high_km"), "no_contact_line", ".side", ["side of higher km at km 20", "low_km"]),
        (feeder(at="C", side="return"), "cabin_return", ".side", ["section cabin C", "bonds"]),
        (feeder(side="return", trip_current_a=3000.0), "return_trip", "", ["return feeder M 1 return"]),
    ],
)
def test_rows_that_name_no_feeder(row, code, field, words):
    assert_only(problems_of(feeders=[row]), code, f"supply.feeders[0]{field}", *words)


def test_a_feeder_to_another_track_says_where():
    substations = [station("A", 0.0), station("M", 8.0, tracks=["1"]), station("B", 20.0)]
    words = ("M at km 8 does not stand on track 2", "tracks: 1", "give km")
    assert_only(
        problems_of(substations=substations, feeders=[feeder(track="2")]), "feeder_track", "supply.feeders[0].track", *words
    )
    assert problems_of(substations=substations, feeders=[feeder(track="2", km=8.2)]) == []


def test_two_rows_of_one_feeder_and_two_places_on_one_track():
    assert_only(problems_of(feeders=[feeder(), feeder()]), "duplicate_id", "supply.feeders[1]", "'M 1 low_km' stands 2 times")
    rows = [feeder(km=7.9), feeder(side="high_km", km=8.1)]
    assert_only(problems_of(feeders=rows), "feeder_places", "supply.feeders[1].km", "track 1 at km 8.1 here, at km 7.9")


def test_a_return_feeder_where_no_rails_are():
    line = small_line(tracks=[{"id": "1", "from_km": 0.0, "to_km": 20.0}, {"id": "2", "from_km": 0.0, "to_km": 25.0}])
    row = feeder(at="B", track="2", side="return", km=24.0)
    assert "no_return_circuit" in [problem.code for problem in problems_of(line, feeders=[row])]


@pytest.mark.parametrize(
    ("first", "code", "path", "words"),
    [
        (end("3"), "unknown_track", "from.track", ["no track 3"]),
        (end(km=21.0), "off_track", "from.km", ["km 21"]),
        ({"busbar": "X"}, "unknown_station", "from.busbar", ["'X'", "A, B, C, M"]),
        (end(km=0.0, side="low_km"), "names_no_section", "from.side", ["names no section", "lower km of track 1", "high_km"]),
        (end(km=8.0), "side_needed", "from.side", ["track 1 is cut at km 8", "low_km | high_km"]),
        (end(km=12.0), "side_needed", "from.side", ["track 1 is cut at km 12"]),
    ],
)
def test_ends_of_switches(first, code, path, words):
    assert_only(problems_of(switches=[switch(first, end("2", 3.0))]), code, f"supply.switches[Q].{path}", *words)


def test_an_end_without_contact_line_names_no_section():
    problems = problems_of(contact_lines=[CONTACT | {"tracks": ["1"]}], switches=[switch(end(), end("2"))])
    assert_only(problems, "names_no_section", "supply.switches[Q].to.km", "no contact line on track 2 at km 5")


def test_a_side_is_not_needed_where_there_is_but_one():
    assert problems_of(switches=[switch(end(km=0.0), end("2", 3.0))]) == []


def test_a_side_is_needed_in_a_state_that_comes_later():
    points = [{"id": "P", "track": "1", "km": 5.0, "state": "closed"}]
    switches = [switch(end(), end("2", 3.0))]
    assert problems_of(section_points=points, switches=switches) == []
    events = [{"time": "07:00", "device": "P", "state": "open"}]
    problems = problems_of(section_points=points, switches=switches, switch_events=events)
    assert_only(
        problems, "side_needed", "supply.switches[Q].from.side", "from 07:00:00 on the contact line of track 1 is cut at km 5"
    )


@pytest.mark.parametrize(
    "ends",
    [
        (end(), end()),
        (end(), end(km=5.0005)),
        (end(side="low_km"), end(side="high_km")),
        (end(km=8.0, side="low_km"), end(km=8.0, side="low_km")),
        ({"busbar": "M"}, {"busbar": "M"}),
    ],
)
@pytest.mark.parametrize("ohm", [0.0, 0.01])
def test_a_switch_that_joins_nothing(ends, ohm):
    problems = problems_of(switches=[switch(*ends, resistance_ohm=ohm)])
    assert_only(problems, "switch_joins_nothing", "supply.switches[Q]", "both ends of switch Q are the same place")


def test_a_busbar_that_ties_nothing():
    substations = [station("A", 0.0), station("M", 8.0, state="bypassed"), station("B", 20.0)]
    switches = [switch({"busbar": "M"}, end())]
    words = ("the busbar of M, which is bypassed, ties nothing",)
    problems = problems_of(substations=substations, switches=switches)
    assert_only(problems, "busbar_out", "supply.switches[Q].from.busbar", *words, severity="warning")
    events = [{"time": "07:00", "device": "M", "state": "in_service"}]
    assert problems_of(substations=substations, switches=switches, switch_events=events) == []


def test_settings_without_a_trip():
    substations = [station("A", 0.0), station("M", 8.0, reclose_after_s=10.0), station("B", 20.0)]
    problems = problems_of(substations=substations)
    words = ("reclose_after_s without trip_current_a", "never trips")
    assert_only(problems, "trip_without_current", "supply.substations[M]", *words, severity="warning")
    substations[1] = station("M", 8.0, trip_current_a=3000.0, reclosures=3)
    problems = problems_of(substations=substations)
    assert_only(problems, "reclosure_without_time", "supply.substations[M]", "stays open", severity="warning")
    substations[1] = station("M", 8.0, trip_current_a=3000.0, reclosures=3, reclose_after_s=5.0)
    assert problems_of(substations=substations, feeders=[feeder(trip_current_a=2000.0, reclose_after_s=20.0)]) == []
    problems = problems_of(substations=substations, feeders=[feeder(reclose_after_s=20.0)])
    assert_only(problems, "trip_without_current", "supply.feeders[0]", "those of its station hold", severity="warning")
