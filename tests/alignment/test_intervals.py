"""Stretches on tracks: union, difference, cuts, overlaps and gaps, alone and through chainage breaks."""

import itertools

from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.intervals import Patch, cut, find_gaps, find_overlaps, merge, place_rows, subtract
from tractionpower.model.line import ChainageBreak, Curve, Line, Track

intervals = st.lists(
    st.tuples(st.integers(0, 50), st.integers(1, 20)).map(lambda pair: (float(pair[0]), float(sum(pair)))), max_size=8
)


def metres(items):
    return {metre for start, end in items for metre in range(int(start), int(end))}


@given(intervals, intervals)
@settings(derandomize=True, deadline=None)
def test_union_and_difference_are_those_of_sets(first, second):
    assert metres(merge(first)) == metres(first)
    assert metres(subtract(first, second)) == metres(first) - metres(second)
    union = merge(first)
    assert all(before[1] < after[0] for before, after in itertools.pairwise(union))


@given(intervals, st.lists(st.integers(0, 70).map(float)))
@settings(derandomize=True, deadline=None)
def test_a_cut_loses_nothing(first, places):
    union = merge(first)
    pieces = cut(union, places)
    assert merge(pieces) == union
    assert not any(start < place < end for start, end in pieces for place in places)


def test_rounding_is_no_gap_and_no_overlap():
    assert merge([(0.0, 1.0), (1.0005, 2.0)]) == [(0.0, 2.0)]
    assert subtract([(0.0, 2.0)], [(0.0, 1.9995)]) == []
    assert cut([(0.0, 2.0)], [0.0, 1.9999, 5.0]) == [(0.0, 2.0)]


def line(*breaks):
    tracks = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=5.0, to_km=20.0))
    return compile_axes(Line(tracks=tracks, chainage_breaks=breaks))


def rows(*kms, tracks=None):
    return list(enumerate(Curve(from_km=low, to_km=high, radius_m=500, tracks=tracks) for low, high in kms))


def test_gaps_and_overlaps_name_tracks_kilometres_and_rows():
    axes = line()
    placed = place_rows(rows((0.0, 8.0), (7.0, 9.0), (10.0, 20.0)), axes)
    assert find_gaps(placed, axes) == [Patch(("1", "2"), 9.0, 10.0)]
    assert find_overlaps(placed, axes) == [Patch(("1", "2"), 7.0, 8.0, (0, 1))]
    assert str(find_gaps(placed, axes)[0]) == "tracks 1, 2 from km 9 to km 10"


def test_a_long_row_hides_no_overlap_behind_a_short_one():
    axes = line()
    placed = place_rows(rows((0.0, 20.0), (1.0, 2.0), (3.0, 4.0), tracks=("1", "9")), axes)
    assert [item.rows for item in find_overlaps(placed, axes)] == [(0, 1), (0, 2)]
    assert placed["2"] == []


def test_left_out_kilometres_are_no_gap_and_a_row_may_span_a_break():
    axes = line(ChainageBreak(at_km=10.0, continues_as_km=12.0))
    apart = place_rows(rows((0.0, 10.0), (12.0, 20.0)), axes)
    assert find_gaps(apart, axes) == []
    assert find_overlaps(apart, axes) == []
    assert find_gaps(place_rows(rows((0.0, 20.0)), axes), axes) == []


def test_doubled_kilometres_belong_to_the_row_before_and_after_the_break():
    axes = line(ChainageBreak(at_km=10.0, continues_as_km=9.5))
    placed = place_rows(rows((0.0, 10.0), (10.0, 20.0)), axes)
    assert find_gaps(placed, axes) == []
    assert find_overlaps(placed, axes) == []
