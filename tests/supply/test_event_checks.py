"""Events of switching name devices and states that exist, and do not contradict each other."""

import time

import pytest
from small_supplies import assert_only, end, problems_of, small_line, small_supply, station

from tractionpower.supply.event_checks import states_of
from tractionpower.supply.site import survey

PARTS = {
    "section_points": [{"id": "P", "track": "1", "km": 3.0, "state": "closed"}],
    "switches": [{"id": "Q", "from": end(), "to": end("2"), "resistance_ohm": 0.01, "state": "open"}],
    "feeders": [{"at": "M", "track": "2", "side": "return", "resistance_ohm": 0.01}],
}


def event(device, state=None, time="07:00:00", **more):
    return {"time": time, "device": device} | ({"state": state} if state else {}) | more


def check(*events, **changes):
    return problems_of(**(PARTS | changes), switch_events=list(events))


def test_events_of_all_kinds_are_in_order():
    events = [
        event("P", "open"),
        event("P", "closed", "07:10:00"),
        event("Q", "closed", "06:00:00"),
        event("M", "rectifiers_out", "08:00:00"),
        event("A", units_in_service=0, time="09:00:00"),
        event("C", "bypassed", "09:00:00"),
        event("M 1 low_km", "open", "10:00:00"),
        event("M 2 return", "open", "10:00:00"),
    ]
    assert check(*events) == []


@pytest.mark.parametrize(
    ("given", "code", "field", "words"),
    [
        (event("Mx", "open"), "unknown_device", "device", ["no device 'Mx'", "substation, section cabin"]),
        (event("M 1 lowkm", "open"), "unknown_device", "device", ["did you mean M 1 low_km?"]),
        (event("M 7 low_km", "open"), "unknown_device", "device", ["M has no feeder 'M 7 low_km'", "M 1 low_km, M 1 high_km"]),
        (event("A 1 low_km", "open"), "unknown_device", "device", ["A has no feeder", "A 1 high_km"]),
        (event("M 1 return", "open"), "unknown_device", "device", ["needs a row in feeders"]),
        (event("P", "opened"), "unknown_state", "state", ["P cannot be 'opened'", "open | closed", "did you mean open?"]),
        (event("C", "in_service"), "unknown_state", "state", ["closed | bypassed | open"]),
        (event("C", units_in_service=1), "unknown_state", "units_in_service", ["no substation"]),
        (event("M", units_in_service=3), "too_many_units", "units_in_service", ["3 units", "has 2", "0 to 2"]),
    ],
)
def test_events_that_cannot_be(given, code, field, words):
    assert_only(check(given), code, f"supply.switch_events[0].{field}", *words)


def test_a_name_of_two_devices():
    problems = check(event("Q", "open"), section_points=[{"id": "Q", "track": "1", "km": 3.0, "state": "closed"}])
    assert_only(problems, "ambiguous_device", "supply.switch_events[0].device", "2 devices (in section_points, switches)")


def test_events_that_contradict():
    words = ("2 events of P at 07:00:00 (open, closed)", "contradict")
    assert_only(check(event("P", "open"), event("P", "closed")), "events_contradict", "supply.switch_events[1]", *words)
    assert check(event("M", "rectifiers_out"), event("M", units_in_service=1)) == []  # one says what, the other how many


def test_an_event_that_changes_nothing():
    assert_only(check(event("P", "closed")), "no_change", "supply.switch_events[0]", "P is 'closed' already", severity="warning")
    problems = check(event("Q", "closed", "08:00:00"), event("Q", "closed", "07:30:00"))
    assert_only(problems, "no_change", "supply.switch_events[0]", "already at 08:00:00", severity="warning")
    problems = check(event("M", units_in_service=2))
    assert_only(problems, "no_change", "supply.switch_events[0]", "with 2 units in service already", severity="warning")
    problems = check(event("M 1 high_km", "closed"))
    assert_only(problems, "no_change", "supply.switch_events[0]", "M 1 high_km is 'closed' already", severity="warning")


def test_states_follow_the_clock_and_equal_ones_are_one():
    events = [
        event("P", "open", "07:10"),
        event("P", "closed", "07:20"),
        event("C", "open", "07:00"),
        event("C", "closed", "07:30"),
    ]
    site = survey(small_supply(**PARTS, switch_events=events), small_line())
    found = [(state.supply.section_points[0].state, state.supply.section_cabins[0].state) for _, state in states_of(site)]
    assert found == [("closed", "closed"), ("closed", "open"), ("open", "open"), ("closed", "open"), ("closed", "closed")]
    states = [state for _, state in states_of(site)]
    assert states[1] is states[3]
    assert states[4] is site


def test_a_day_of_many_events_is_checked_fast():
    """2000 events of forty stations; the limit is far above what it takes, and far below what grows with the square."""
    substations = [station(f"S{k}", 0.5 * k, units=2) for k in range(40)]
    events = [event(f"S{k % 40}", units_in_service=1 + (k // 40) % 2, time=18.0 * k) for k in range(40, 2040)]
    started = time.perf_counter()
    problems = problems_of(substations=substations, section_cabins=[], switch_events=events)
    assert time.perf_counter() - started < 20.0
    assert {problem.code for problem in problems} == {"no_change"}
