"""How a delay is split: reserve first absorbs what is lost in the section, then what the train brought along."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tractionpower.studies.feasibility.parts import LOSSES, ORIGINS, Elapsed, carry_on, start_lateness

SECONDS = st.floats(-500.0, 500.0)
RUNNING = st.floats(0.0, 2000.0)


def on_time(late_s=0.0):
    return start_lateness(late_s, {})


def told(lateness):
    return {name: value for name, value in lateness.parts.items() if value}


def test_reserve_absorbs_driving_then_current_limit_then_voltage():
    # shortest 100, 5 by the limit, 7 by voltage, 11 by driving: 123 in all
    for planned, expected in (
        (123.0, {}),
        (115.0, {"voltage": 7.0, "current_limit": 1.0}),  # the reserve of 15 takes 11 and 4
        (105.0, {"voltage": 7.0, "current_limit": 5.0, "driving": 6.0}),
        (118.0, {"voltage": 5.0}),
        (90.0, {"voltage": 7.0, "current_limit": 5.0, "driving": 11.0, "timetable": 10.0}),
    ):
        lateness = carry_on(on_time(), Elapsed(planned, 100.0, 105.0, 112.0, 123.0))
        assert told(lateness) == pytest.approx(expected)
        assert lateness.late_s == pytest.approx(123.0 - planned)


def test_what_is_left_of_the_reserve_recovers_knock_on_of_every_origin_alike():
    late = carry_on(on_time(), Elapsed(100.0, 110.0, 110.0, 140.0, 140.0))  # 10 by the timetable, 30 by voltage
    assert late.origins == pytest.approx(dict.fromkeys(ORIGINS, 0.0) | {"timetable": 10.0, "voltage": 30.0})
    after = carry_on(late, Elapsed(120.0, 100.0, 100.0, 108.0, 108.0))  # 12 of the reserve of 20 are left
    assert told(after) == pytest.approx({"knock_on": 28.0})
    assert after.origins == pytest.approx(dict.fromkeys(ORIGINS, 0.0) | {"timetable": 7.0, "voltage": 21.0})


def test_a_train_that_is_early_may_lose_what_it_is_early():
    lateness = carry_on(on_time(-8.0), Elapsed(100.0, 100.0, 100.0, 120.0, 120.0))
    assert told(lateness) == pytest.approx({"voltage": 12.0})
    assert carry_on(on_time(-8.0), Elapsed(100.0, 100.0, 100.0, 105.0, 105.0)).late_s == pytest.approx(-3.0)


def test_a_gain_on_higher_voltage_counts_as_reserve():
    lateness = carry_on(on_time(20.0), Elapsed(100.0, 100.0, 102.0, 90.0, 90.0))  # 2 by the limit, 12 gained
    assert told(lateness) == pytest.approx({"knock_on": 10.0})


def test_a_dwell_longer_than_planned_is_a_delay_and_a_shorter_one_recovers():
    assert told(carry_on(on_time(), Elapsed(0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 30.0))) == {"dwell": 20.0}
    assert told(carry_on(on_time(25.0), Elapsed(0.0, 0.0, 0.0, 0.0, 0.0, 60.0, 40.0))) == {"knock_on": 5.0}
    # it came early and waits for its time
    assert carry_on(on_time(-15.0), Elapsed(0.0, 0.0, 0.0, 0.0, 0.0, 60.0, 75.0)).late_s == 0.0


@given(SECONDS, st.lists(st.tuples(RUNNING, RUNNING, RUNNING, RUNNING, RUNNING, RUNNING, RUNNING), min_size=1, max_size=6))
def test_parts_add_up_over_any_chain(late_s, sections):
    lateness = start_lateness(late_s, {"voltage": 3.0, "dwell": 1.0})
    expected = late_s
    for times in sections:
        elapsed = Elapsed(*times)
        expected += elapsed.actual - elapsed.planned + elapsed.dwell - elapsed.planned_dwell
        lateness = carry_on(lateness, elapsed)
        assert lateness.late_s == pytest.approx(expected, abs=1e-6)
        for split in (lateness.parts, lateness.origins):
            assert min(split.values()) >= 0.0
            assert sum(split.values()) == pytest.approx(max(expected, 0.0), abs=1e-6)
        assert set(lateness.parts) == {"knock_on", *LOSSES}
