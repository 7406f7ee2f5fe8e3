"""Zones of the mean useful voltage: feeding sections of lines and branches, ends, sidings, given zones that overlap."""

import numpy as np
import pytest
from coupled import couple, run

from tractionpower.alignment.axis import compile_axes
from tractionpower.cosimulation.feeding_zones import ZoneMap, lay_zones
from tractionpower.cosimulation.places import Placed
from tractionpower.cosimulation.useful_voltage_checks import check_useful_voltage
from tractionpower.io.scenario_files import load
from tractionpower.model.base import format_time
from tractionpower.model.sizing import Sizing


def plant(name, km, **more):
    return {"id": name, "km": km, "no_load_voltage_v": 3500.0, "internal_resistance_ohm": 0.1} | more


def stretches_of(scenario):
    return {zone.id: zone.stretches for zone in lay_zones(scenario)}


def asking(scenario, **useful_voltage):
    return scenario.model_copy(update={"sizing": Sizing.model_validate({"useful_voltage": useful_voltage})})


def parts_at(scenario, track, *kms):
    """Return the names of the zones that hold each kilometre."""
    zones, tracks = lay_zones(scenario), tuple(sorted(each.id for each in scenario.line.tracks))
    found = ZoneMap(zones, tracks, compile_axes(scenario.line))
    count = len(kms)
    placed = Placed(np.full(count, tracks.index(track)), np.array(kms, float), np.ones(count, np.int64))
    return [[zone.id for zone, parts in zip(zones, found.members, strict=True) if part in parts] for part in found.part(placed)]


def test_sections_between_neighbours_and_the_ends_of_the_line():
    scenario = couple(run("E"), substations=[plant("X", 2.0), plant("Y", 9.0, tracks=["1"]), plant("Z", 17.0)])
    assert stretches_of(scenario) == {
        "X low_km": (("1", 0.0, 2000.0), ("2", 0.0, 2000.0)),
        "X–Y": (("1", 2000.0, 9000.0),),
        "Y–Z": (("1", 9000.0, 17000.0),),
        "Z high_km": (("1", 17000.0, 20000.0), ("2", 17000.0, 20000.0)),
        "X–Z": (("2", 2000.0, 17000.0),),
    }
    assert parts_at(scenario, "1", 0.0, 1.999, 2.0, 16.9, 20.0) == [["X low_km"], ["X low_km"], ["X–Y"], ["Y–Z"], ["Z high_km"]]
    assert parts_at(scenario, "2", 9.5) == [["X–Z"]]


def test_a_substation_at_the_end_of_the_line_leaves_nothing_beyond_it():
    assert list(stretches_of(couple(run("E")))) == ["A–B"]
    assert parts_at(couple(run("E")), "2", 0.0, 20.0) == [["A–B"], ["A–B"]]


@pytest.mark.parametrize("state", ["rectifiers_out", "bypassed", "open"])
def test_an_outage_changes_no_zone(state):
    plants = [plant("X", 2.0), plant("Y", 9.0), plant("Z", 17.0)]
    normal = couple(run("E"), substations=plants)
    out = couple(run("E"), substations=[plants[0], plants[1] | {"state": state}, plants[2]])
    assert lay_zones(out) == lay_zones(normal)


def test_a_siding_lies_in_the_zones_of_its_line():
    tracks = [{"id": "1", "from_km": 0.0, "to_km": 20.0}, {"id": "3", "from_km": 4.0, "to_km": 6.0}]
    link = {"from": {"track": "1", "km": 4.0}, "to": {"track": "3", "km": 4.0}}
    scenario = couple(run("E"), tracks=tracks, connections=[link])
    assert stretches_of(scenario) == {"A–B": (("1", 0.0, 20000.0), ("3", 0.0, 2000.0))}


def test_a_branch_has_zones_of_its_own_by_the_feeders_that_lead_to_it():
    zones = stretches_of(load("lines/y-junction"))
    assert zones["Rozjazd low_km"] == (("3", 0.0, 14000.0),)
    assert zones["Rozjazd high_km"] == (("3", 14000.0, 14600.0),)
    assert [track for track, _, _ in zones["Zachod–Rozjazd"]] == ["1", "2"]


def test_a_line_that_no_substation_feeds_is_one_zone_and_equal_names_are_told_apart():
    scenario = couple(
        run("E"),
        substations=[plant("X", 0.0, tracks=["1"]), plant("Y", 9.0, tracks=["1"])],
        connections=[{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 1.0}}],
        contact_lines=[{"tracks": [t], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05} for t in "12"],
        return_circuit=[{"tracks": [t], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.01} for t in "12"],
        section_cabins=[],
    )
    assert stretches_of(scenario) == {
        "X–Y": (("1", 0.0, 9000.0),), "Y high_km": (("1", 9000.0, 20000.0),), "track 2": (("2", 0.0, 20000.0),),
    }  # fmt: skip
    both = couple(
        run("E"),
        substations=[plant("X", 0.0), plant("Y", 9.0)],
        connections=[{"from": {"track": "1", "km": 8.0}, "to": {"track": "2", "km": 1.0}}],
        contact_lines=[{"tracks": [t], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05} for t in "12"],
        return_circuit=[{"tracks": [t], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.01} for t in "12"],
        section_cabins=[],
        stations=[],
    )
    assert list(stretches_of(both)) == ["X–Y (1)", "Y high_km (1)", "X–Y (2)", "Y high_km (2)"]


def test_given_zones_may_overlap_and_leave_gaps():
    zones = [
        {"id": "all", "from_km": 1.0, "to_km": 19.0},
        {"id": "west", "from_km": 2.0, "to_km": 6.0, "tracks": ["1"]},
        {"id": "beyond", "from_km": 18.0, "to_km": 25.0, "tracks": ["1"]},
    ]
    scenario = asking(couple(run("E")), zones=zones)
    assert parts_at(scenario, "1", 0.5, 1.0, 2.5, 6.0, 18.5, 20.0) == [
        [],
        ["all"],
        ["all", "west"],
        ["all"],
        ["all", "beyond"],
        ["beyond"],
    ]
    assert parts_at(scenario, "2", 2.5, 19.5) == [["all"], []]
    assert check_useful_voltage(scenario) == []


def test_kilometres_that_jump():
    jump = {"chainage_breaks": [{"at_km": 8.0, "continues_as_km": 9.5}]}
    scenario = asking(couple(run("E"), **jump), zones=[{"id": "z", "from_km": 7.0, "to_km": 10.0}])
    assert stretches_of(scenario)["z"][0] == ("1", 7000.0, 8500.0)
    assert parts_at(scenario, "1", 6.9, 7.9, 9.6, 10.1) == [[], ["z"], ["z"], []]


def test_what_cannot_be_is_told_all_at_once():
    zones = [
        {"id": "z", "from_km": 1.0, "to_km": 2.0, "tracks": ["9"]}, {"id": "z", "from_km": 30.0, "to_km": 31.0},
    ]  # fmt: skip
    windows = [{"from": "00:05:00", "to": "00:20:00"}, {"from": "03:00:00", "to": "04:00:00"}]
    scenario = asking(couple(run("E")), zones=zones, windows=windows, line_class="high_speed")
    problems = check_useful_voltage(scenario)
    assert [(problem.code, problem.severity) for problem in problems] == [
        ("unknown_track", "error"), ("duplicate_id", "error"), ("off_track", "error"),
        ("window_outside_clock", "warning"), ("window_outside_clock", "warning"),
    ]  # fmt: skip
    assert format_time(600.0) in problems[3].allowed
    other = scenario.model_copy(update={"limits": tuple(row for row in scenario.limits if row.name != "u_useful_high_speed")})
    assert check_useful_voltage(other)[-1].code == "no_limit"
