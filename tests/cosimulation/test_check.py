"""All checks of a scenario, gathered."""

import pytest
from small_studies import load, make_scenario

from tractionpower.cosimulation.check import check_scenario


def problems_of(*loads, **more):
    return {problem.path: problem for problem in check_scenario(make_scenario(*loads, **more))}


def test_a_sound_scenario_has_none():
    assert problems_of(load("x")) == {}


def test_an_unknown_conductor_is_found():
    wires = [{"from_km": 0.0, "to_km": 20.0, "type": "C120-2D"}]
    assert problems_of(load("x"), contact_lines=wires)["supply.contact_lines[0].type"].code == "unknown_conductor"


def test_problems_of_line_supply_clock_and_output_come_together():
    scenario = make_scenario(
        load("x", 50.0),
        clock={"step_s": 4.0, "warm_up": 9.0},
        output={"every_s": 6.0, "tables": ["loads", "laods"]},
    )
    line = scenario.line.model_copy(update={"stations": (scenario.line.stations or ())})
    gradients = [{"from_km": 0.0, "to_km": 5.0, "permille": 1.0}, {"from_km": 4.0, "to_km": 20.0, "permille": 2.0}]
    line = type(line).model_validate(line.model_dump(by_alias=True) | {"gradients": gradients})
    found = check_scenario(scenario.model_copy(update={"line": line}))
    assert {problem.path.split(".")[0] for problem in found} == {"line", "supply", "clock", "output"}
    assert {problem.code for problem in found} >= {"overlap", "off_track", "warm_up", "output_interval", "unknown_table"}


@pytest.mark.parametrize(("every", "remedy"), [(1.5, "write 2,"), (0.5, "write 1,"), (7.4, "write 7,")])
def test_an_interval_of_rows_is_a_whole_multiple_of_the_step(every, remedy):
    problem = problems_of(load("x"), output={"every_s": every})["output.every_s"]
    assert remedy in problem.remedy
    assert problem.severity == "error"


@pytest.mark.parametrize(("step_s", "every"), [(0.1, 0.3), (0.02, 1.0), (0.7, 2.1), (1.0, None)])
def test_rounding_of_an_interval_is_no_problem(step_s, every):
    assert problems_of(load("x"), clock={"step_s": step_s}, output={"every_s": every}) == {}


def test_an_unknown_table_is_told_with_those_that_exist():
    problem = problems_of(load("x"), output={"tables": ["loads", "laods"]})["output.tables[1]"]
    assert problem.found == "'laods'"
    assert "substations, feeders, cabins, switches, loads, profile, rails, rail_profile, earthing" in problem.allowed


@pytest.mark.parametrize(("warm_up", "told"), [(8.0, False), (8.5, True), (9.9, True)])
def test_a_warm_up_leaves_a_step(warm_up, told):
    # steps of 4 s start at 0, 4 and 8 s
    assert ("clock.warm_up" in problems_of(load("x"), clock={"step_s": 4.0, "warm_up": warm_up})) == told


def test_switching_outside_the_clock():
    cabin = [{"id": "C", "km": 10.0, "state": "open"}]
    events = [{"time": time, "device": "C", "state": state} for time, state in ((0.0, "closed"), (5.0, "open"), (10.0, "closed"))]
    clock = {"start": 1.0, "end": 10.0}
    found = problems_of(section_cabins=cabin, switch_events=events, clock=clock)
    assert list(found) == ["supply.switch_events[0].time", "supply.switch_events[2].time"]
    assert {(problem.code, problem.severity) for problem in found.values()} == {("event_outside_clock", "warning")}
    assert "00:00:00, before the run" in found["supply.switch_events[0].time"].found
    assert "00:00:10, after the run" in found["supply.switch_events[2].time"].found
    assert "00:00:01 to 00:00:10" in found["supply.switch_events[0].time"].allowed


def test_connections_are_no_problem_of_their_own():
    scenario = make_scenario(load("x"))
    ends = [{"track": "1", "km": 4.0}, {"track": "2", "km": 4.5}]
    line = scenario.line.model_validate(scenario.line.model_dump() | {"connections": [{"from": ends[0], "to": ends[1]}]})
    assert check_scenario(scenario.model_copy(update={"line": line})) == []
