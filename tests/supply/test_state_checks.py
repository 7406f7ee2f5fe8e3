"""Every state of the switches: what nothing feeds, and loops without resistance."""

import pytest
from small_supplies import assert_only, end, problems_of, small_line, station

BYPASS = {"id": "Q", "from": end(km=8.0, side="low_km"), "to": end(km=8.0, side="high_km"), "state": "open"}
OPEN = [
    {"at": "M", "track": "1", "side": "high_km", "state": "open"},
    {"at": "C", "track": "1", "side": "low_km", "state": "open"},
]
CLOSE = [{"time": "07:10:00", "device": "Q", "state": "closed"}]


def points(*kms, state="open"):
    return [{"id": f"P{km:g}", "track": track, "km": km, "state": state} for km in kms for track in "1"]


def loops(**changes):
    return [problem for problem in problems_of(**changes) if problem.code == "zero_resistance_loop"]


# --- what nothing feeds


def test_units_out_feed_nothing():
    substations = [station("A", 0.0), station("M", 8.0, units=2, units_in_service=0), station("B", 20.0)]
    assert problems_of(substations=substations) == []
    found = problems_of(substations=substations, section_points=points(5.0, 15.0), section_cabins=[])
    assert found == []  # the busbar of M still ties track 1 with track 2
    alone = [station("M", 8.0, units=2, units_in_service=0), station("B", 20.0)]
    assert problems_of(substations=alone[:1])[0].code == "no_source"
    alone[0]["tracks"] = ["1"]
    cut = problems_of(substations=alone, section_points=points(5.0, 10.0))
    assert_only(cut[:1], "dead_stretch", "supply.contact_lines[0]", "track 1 from km 0 to km 10", severity="warning")


def test_open_feeders_leave_a_stretch_dead():
    problems = problems_of(feeders=OPEN)
    assert_only(problems, "dead_stretch", "supply.contact_lines[0]", "track 1 from km 8 to km 12", severity="warning")
    assert problems_of(feeders=OPEN[:1]) == []


def test_a_switch_feeds_a_stretch():
    tie = {"id": "Q", "from": end("1", 9.0), "to": end("2", 9.0)}
    assert problems_of(feeders=OPEN, switches=[tie]) == []
    assert [problem.code for problem in problems_of(feeders=OPEN, switches=[tie | {"state": "open"}])] == ["dead_stretch"]
    to_busbar = {"id": "Q", "from": end("1", 9.0), "to": {"busbar": "M"}}
    assert problems_of(feeders=OPEN, switches=[to_busbar]) == []


def test_a_connection_of_the_line_feeds_a_branch():
    branch = {"id": "9", "from_km": 0.0, "to_km": 4.0}
    tracks = [{"id": track, "from_km": 0.0, "to_km": 20.0} for track in "12"] + [branch]
    substations = [station(name, km, tracks=["1", "2"]) for name, km in (("A", 0.0), ("M", 8.0), ("B", 20.0))]
    cut_off = problems_of(small_line(tracks=tracks), substations=substations)
    assert {problem.code for problem in cut_off} >= {"dead_stretch"}
    joined = small_line(tracks=tracks, connections=[{"from": {"track": "1", "km": 5.0}, "to": {"track": "9", "km": 0.0}}])
    rows = [{"tracks": list("12"), "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05}]
    wires = [*rows, {"tracks": ["9"], "from_km": 0.0, "to_km": 4.0, "resistance_ohm_per_km": 0.05}]
    assert problems_of(joined, substations=substations, contact_lines=wires, return_circuit=wires) == []
    bare = problems_of(joined, substations=substations, contact_lines=rows)
    assert_only(bare, "connection_without_line", "line.connections[0]", "no contact line on track 9 at km 0", severity="warning")


def test_a_connection_where_the_line_is_cut():
    tracks = [{"id": "1", "from_km": 0.0, "to_km": 20.0}, {"id": "2", "from_km": 0.0, "to_km": 20.0}]
    line = small_line(tracks=tracks, connections=[{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 9.0}}])
    words = ("track 1 is cut at km 8", "joins rails only")
    assert_only(problems_of(line), "connection_at_cut", "line.connections[0].from", *words, severity="warning")


def test_a_stretch_that_dies_by_events_is_told_once():
    events = [
        {"time": "07:00:00", "device": "M 1 high_km", "state": "open"},
        {"time": "07:10:00", "device": "C 1 low_km", "state": "open"},
        {"time": "07:20:00", "device": "C 1 low_km", "state": "closed"},
        {"time": "07:30:00", "device": "C 1 low_km", "state": "open"},
        {"time": "07:40:00", "device": "M 2 high_km", "state": "open"},
    ]
    problems = problems_of(switch_events=events)
    words = ("from 07:10:00 on no substation in service reaches track 1 from km 8 to km 12",)
    assert_only(problems, "dead_stretch", "supply.switch_events[1]", *words, severity="warning")


def test_what_dies_later_is_told_without_what_was_dead_before():
    events = [
        {"time": "07:00:00", "device": "M", "state": "open"},
        {"time": "07:00:00", "device": "C", "state": "open"},
        {"time": "08:00:00", "device": "B", "state": "rectifiers_out"},
    ]
    found = [(problem.path, problem.found) for problem in problems_of(switch_events=events)]
    assert found == [
        ("supply.switch_events[1]", "from 07:00:00 on no substation in service reaches tracks 1, 2 from km 8 to km 12"),
        ("supply.switch_events[2]", "from 08:00:00 on no substation in service reaches tracks 1, 2 from km 12 to km 20"),
    ]


# --- loops


def test_busbars_alone_make_no_loop():
    assert loops() == []
    assert loops(switches=[BYPASS]) == []


def test_a_bypass_of_a_station_in_service():
    found = loops(switches=[BYPASS | {"state": "closed"}])
    words = ("a loop without resistance: feeder M 1 low_km, feeder M 1 high_km, switch Q", "give one of them a resistance")
    assert_only(found, "zero_resistance_loop", "supply.switches[Q]", *words)
    assert loops(switches=[BYPASS | {"state": "closed", "resistance_ohm": 0.001}]) == []
    row = {"at": "M", "track": "1", "side": "low_km", "resistance_ohm": 0.01}
    assert loops(switches=[BYPASS | {"state": "closed"}], feeders=[row]) == []
    cable = {"at": "M", "track": "1", "side": "low_km", "cable": "YAKY", "length_m": 300.0}
    assert loops(switches=[BYPASS | {"state": "closed"}], feeders=[cable]) == []


def test_a_loop_that_events_close():
    found = loops(switches=[BYPASS], switch_events=CLOSE)
    assert_only(found, "zero_resistance_loop", "supply.switches[Q]", "from 07:10:00 on a loop without resistance")
    out_before = [{"time": "07:00:00", "device": "M", "state": "open"}, *CLOSE]
    assert loops(switches=[BYPASS], switch_events=out_before) == []
    back_too_early = [*out_before, {"time": "07:30:00", "device": "M", "state": "in_service"}]
    assert_only(
        loops(switches=[BYPASS], switch_events=back_too_early), "zero_resistance_loop", "supply.switches[Q]", "from 07:30:00 on"
    )


@pytest.mark.parametrize(("state", "told"), [("closed", 1), ("open", 0)])
def test_a_switch_across_a_section_point(state, told):
    across = {"id": "Q", "from": end(side="low_km"), "to": end(side="high_km")}
    found = loops(section_points=points(5.0, state=state), switches=[across])
    assert len(found) == told
    assert all("switch Q lies across a contact line that is not cut there" in problem.found for problem in found)
    assert loops(section_points=points(5.0, state=state), switches=[across | {"resistance_ohm": 0.001}]) == []


def test_two_ties_side_by_side():
    ties = [{"id": name, "from": end("1", 5.0), "to": end("2", 5.0)} for name in "QR"]
    assert_only(loops(switches=ties), "zero_resistance_loop", "supply.switches[R]", "switch Q, switch R")
    apart = [ties[0], {"id": "R", "from": end("1", 5.1), "to": end("2", 5.1)}]
    assert loops(switches=apart) == []  # 100 m of contact line lie in that loop


def test_a_tie_beside_a_connection_of_the_line():
    line = small_line(connections=[{"from": {"track": "1", "km": 5.0}, "to": {"track": "2", "km": 5.0}}])
    tie = {"id": "Q", "from": end("1", 5.0), "to": end("2", 5.0)}
    assert_only(loops(line=line, switches=[tie]), "zero_resistance_loop", "supply.switches[Q]", "switch Q")


def test_two_stations_at_one_place():
    cabins = [{"id": "C", "km": 8.0}]
    assert_only(loops(section_cabins=cabins), "zero_resistance_loop", "supply.section_cabins[C]", "feeder C", "feeder M")
    assert loops(section_cabins=[cabins[0] | {"feeder_resistance_ohm": 0.001}]) == []
    assert loops(section_cabins=[cabins[0] | {"state": "bypassed"}]) == []
