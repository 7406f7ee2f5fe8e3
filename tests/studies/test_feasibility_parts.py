"""How a delay is split: chains that follow the same rules and differ in one thing, each later than the one before."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tractionpower.studies.feasibility.parts import ON_TIME, ORIGINS, Stage, ruled, split

SECONDS = st.floats(-500.0, 500.0)
RUNNING = np.array([100.0, 100.0, 105.0, 112.0])  # 5 s by the limit, 7 s by voltage
ACTUAL = 123.0  # 11 s by driving


def told(parts):
    return {name: value for name, value in parts.items() if value}


def stop(running, dwell=0.0, planned_dwell=None, departure=None):
    planned_dwell = dwell if planned_dwell is None else planned_dwell
    return Stage(running, np.array([planned_dwell, dwell, dwell, dwell]), departure)


def test_what_a_section_gives_goes_to_running_alone_first_then_to_limits_voltage_and_driving():
    times = ruled(np.zeros(4), [stop(RUNNING)], np.zeros(4))
    for planned, expected in (
        (123.0, {}),
        (115.0, {"driving": 8.0}),
        (110.0, {"voltage": 2.0, "driving": 11.0}),
        (102.0, {"current_limit": 3.0, "voltage": 7.0, "driving": 11.0}),
        (90.0, {"timetable": 10.0, "current_limit": 5.0, "voltage": 7.0, "driving": 11.0}),
    ):
        lateness = split(ACTUAL - planned, times.arrived_s[0] - planned, ON_TIME.origins)
        assert told(lateness.parts) == told(lateness.origins) == pytest.approx(expected)
        assert lateness.late_s == ACTUAL - planned


def test_a_slack_recovers_every_chain_by_the_rules():
    # planned 100 and 130, two sections alike: 5, 7 and 11 s more than 100 in each; 30 s of slack at the second
    times = ruled(np.zeros(4), [stop(RUNNING, departure=100.0), stop(RUNNING)], np.zeros(4))
    first = split(ACTUAL - 100.0, times.left_s[0] - 100.0, ON_TIME.origins)
    assert told(first.origins) == pytest.approx({"current_limit": 5.0, "voltage": 7.0, "driving": 11.0})
    second = split(2 * ACTUAL - 230.0, times.arrived_s[1] - 230.0, first.origins)  # 246 against 200, 210, 224
    assert told(second.parts) == pytest.approx({"knock_on": 11.0, "driving": 5.0})
    assert told(second.origins) == pytest.approx({"driving": 16.0})


def test_a_pass_does_not_hold_a_train_and_a_stop_does():
    # planned 150 at the place in the middle, 220 at the end; alone 200
    for stage, late in ((Stage(RUNNING, None, 150.0), -20.0), (stop(RUNNING, departure=150.0), 30.0)):
        times = ruled(np.zeros(4), [stage, stop(RUNNING)], np.zeros(4))
        assert times.arrived_s[1][1] - 220.0 == late


def test_a_dwell_shorter_than_it_can_be_is_a_cause_of_its_own():
    # arrives at 110 in place of 100; planned dwell 20, shortest 30
    times = ruled(np.zeros(4), [stop(np.full(4, 110.0), dwell=30.0, planned_dwell=20.0, departure=120.0)], np.zeros(4))
    lateness = split(20.0, times.left_s[0] - 120.0, ON_TIME.origins | {"timetable": 10.0})
    assert told(lateness.parts) == {"knock_on": 10.0, "dwell": 10.0}
    assert told(lateness.origins) == {"timetable": 10.0, "dwell": 10.0}


def test_a_gain_on_higher_voltage_makes_up_for_what_the_timetable_lacks():
    lateness = split(4.0, np.array([10.0, 10.0, 12.0, 4.0]), ON_TIME.origins)
    assert told(lateness.parts) == {"timetable": 4.0}
    assert split(-3.0, np.array([10.0, 10.0, 12.0, -3.0]), ON_TIME.origins).delay_s == 0.0


@given(st.lists(st.tuples(SECONDS, SECONDS, SECONDS, SECONDS, SECONDS), min_size=1, max_size=6))
def test_parts_add_up_over_any_chain(calls):
    before = ON_TIME
    for late, *chains in calls:
        lateness = split(late, np.array(chains), before.origins)
        for parts in (lateness.parts, lateness.origins):
            assert min(parts.values()) >= 0.0
            assert sum(parts.values()) == pytest.approx(max(late, 0.0), abs=1e-6)
        assert set(lateness.parts) == {"knock_on", *ORIGINS}
        before = lateness
