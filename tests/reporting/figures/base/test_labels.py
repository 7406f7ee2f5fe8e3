"""Labels that fit and ticks of a clock."""

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.reporting.figures.base.labels import clock, clock_ticks, fitting

PLACES = st.lists(st.tuples(st.floats(0.0, 100.0), st.booleans()), max_size=30)


@settings(deadline=None, derandomize=True)
@given(labels=PLACES, gap=st.floats(0.1, 50.0))
def test_labels_keep_their_distance_and_none_could_be_added(labels, gap):
    places, important = [place for place, _ in labels], [stops for _, stops in labels]
    kept = fitting(places, important, gap)
    shown = [places[k] for k in kept]
    assert shown == sorted(shown)
    assert all(b - a >= gap for a, b in itertools.pairwise(shown))
    for k in set(range(len(places))) - set(kept):
        assert any(abs(places[k] - place) < gap for place in shown)


def test_stops_come_before_places_that_are_passed():
    assert fitting([0.0, 1.0, 2.0, 3.0], [False, True, False, True], 1.5) == [1, 3]
    assert fitting([], [], 1.0) == []


def test_wide_labels_need_more_room_than_narrow_ones():
    assert fitting([0.0, 1.0, 2.0, 3.0], [False] * 4, [1.0, 1.0, 1.0, 1.0]) == [0, 1, 2, 3]
    assert fitting([0.0, 1.0, 2.0, 3.0], [False, True, False, False], [1.0, 3.0, 1.0, 1.0]) == [1, 3]


@settings(deadline=None, derandomize=True)
@given(begin=st.floats(0.0, 1e5), width=st.floats(5.0, 2e5))
def test_ticks_of_a_clock_are_round_evenly_spaced_and_few(begin, width):
    ticks = clock_ticks(begin, begin + width)
    steps = {b - a for a, b in itertools.pairwise(ticks)}
    assert len(steps) <= 1
    assert len(ticks) <= 11
    assert all(begin <= tick <= begin + width for tick in ticks)
    assert len(ticks) >= 2 or width < 120.0 or width > 86400.0 or len(clock_ticks(begin, begin + width, 20)) >= 2


def test_an_hour_has_ticks_at_ten_minutes_and_a_minute_has_seconds():
    assert clock_ticks(6 * 3600.0, 7 * 3600.0) == [6 * 3600.0 + 600.0 * k for k in range(7)]
    assert clock_ticks(1.0, 61.0) == [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]


@pytest.mark.parametrize(("seconds", "ticks", "shown"), [(21600.0, [21600.0], "06:00"), (21610.0, [21610.0], "06:00:10")])
def test_times(seconds, ticks, shown):
    assert clock(seconds, ticks) == shown
