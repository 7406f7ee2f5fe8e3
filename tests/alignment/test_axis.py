"""Kilometres and metres of a track: exact without breaks, inverse of each other, through jumps forward and back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.alignment.axis import compile_axes, tracks_at
from tractionpower.model.line import ChainageBreak, Line, Track


def axis(*jumps, low=0.0, high=20.0):
    breaks = tuple(ChainageBreak(at_km=at, continues_as_km=after) for at, after in jumps)
    return compile_axes(Line(tracks=(Track(id="1", from_km=low, to_km=high),), chainage_breaks=breaks))["1"]


def test_without_breaks_the_metre_is_exact():
    plain = axis(low=3.7, high=223.8)
    places = np.array([3.7, 10.123, 100.1, 223.8])
    assert [plain.metre(km) for km in places] == [(km - 3.7) * 1000.0 for km in places]
    assert plain.metre(places).tolist() == [plain.metre(float(km)) for km in places]
    assert plain.length_m == plain.metre(223.8)
    assert (plain.from_km, plain.to_km) == (3.7, 223.8)
    assert isinstance(plain.metre(4.0), float)
    assert isinstance(plain.contains(4.0), bool)


def test_a_jump_forward_has_no_length():
    jumped = axis((10.0, 12.0))
    assert jumped.length_m == 18_000.0
    assert [jumped.metre(km) for km in (10.0, 11.0, 12.0, 13.0)] == [10_000.0, 10_000.0, 10_000.0, 11_000.0]
    assert jumped.contains(np.array([9.0, 10.0, 11.0, 12.0, 20.5])).tolist() == [True, True, False, True, False]
    assert (jumped.km(10_000.0), jumped.km(10_001.0)) == (10.0, 12.001)


def test_a_jump_back_doubles_kilometres_and_the_first_is_meant():
    doubled = axis((10.0, 9.5))
    assert doubled.length_m == 20_500.0
    assert (doubled.metre(9.7), doubled.metre(10.5)) == (pytest.approx(9_700.0), pytest.approx(11_000.0))
    assert doubled.km(10_200.0) == pytest.approx(9.7)
    assert doubled.contains(9.7)


def test_breaks_count_in_the_order_of_their_place_and_only_on_their_tracks():
    tracks = (
        Track(id="1", from_km=0.0, to_km=20.0),
        Track(id="2", from_km=0.0, to_km=20.0),
        Track(id="3", from_km=0.0, to_km=4.0),
    )
    breaks = (
        ChainageBreak(at_km=15.0, continues_as_km=16.0),
        ChainageBreak(at_km=5.0, continues_as_km=7.0, tracks=("2",)),
    )
    axes = compile_axes(Line(tracks=tracks, chainage_breaks=breaks))
    assert {name: item.length_m for name, item in axes.items()} == {"1": 19_000.0, "2": 17_000.0, "3": 4_000.0}
    assert tracks_at(axes, 6.0) == ("1",)
    assert tracks_at(axes, 3.0) == ("1", "2", "3")
    assert tracks_at(axes, 3.0, ("3", "1", "9", "3")) == ("3", "1")


def test_impossible_breaks_and_second_tracks_are_left_out():
    tracks = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="1", from_km=0.0, to_km=7.0))
    breaks = tuple(
        ChainageBreak(at_km=at, continues_as_km=after, tracks=("1",)) for at, after in ((30.0, 31.0), (5.0, 25.0), (6.0, -1.0))
    )
    assert compile_axes(Line(tracks=tracks, chainage_breaks=breaks))["1"].length_m == 20_000.0


@pytest.mark.parametrize(
    ("method", "value"), [("metre", -0.1), ("metre", 20.1), ("metre", float("nan")), ("km", -1.0), ("km", 2e4 + 1)]
)
def test_what_is_off_the_track_is_refused(method, value):
    with pytest.raises(ValueError, match="of track 1"):
        getattr(axis(), method)(value)
    with pytest.raises(ValueError, match="of track 1"):
        getattr(axis(), method)(np.array([1.0, value]))


def test_rounding_at_the_ends_is_forgiven():
    plain = axis(low=0.1, high=0.3)
    assert plain.metre(0.1 + 0.2) == plain.length_m
    assert plain.km(plain.length_m + 1e-9) == 0.3


def test_the_part_of_a_stretch_on_the_track():
    jumped = axis((10.0, 12.0), low=2.0)
    assert jumped.stretch_m(0.0, 4.0) == (0.0, 2_000.0)
    assert jumped.stretch_m(9.0, 13.0) == (7_000.0, 9_000.0)
    assert jumped.stretch_m(10.5, 11.5) is None
    assert jumped.stretch_m(20.0, 30.0) is None


@st.composite
def axes(draw):
    """Draw an axis with up to four jumps, forward and back, on whole tens of metres."""
    at = sorted(draw(st.sets(st.integers(100, 1900), max_size=4)))
    jumps, start = [], 0
    for place, size in zip(at, draw(st.lists(st.integers(-90, 90), min_size=4, max_size=4)), strict=False):
        if place > start and start <= place + size < 2000:
            jumps.append((place / 100.0, (place + size) / 100.0))
            start = max(place, place + size)
    return axis(*jumps)


@given(axes(), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=20))
@settings(derandomize=True, deadline=None)
def test_metre_and_km_are_inverse(drawn, shares):
    metres = np.array(shares) * drawn.length_m
    places = drawn.km(metres)
    assert drawn.contains(places).all()
    assert np.abs(drawn.km(drawn.metre(places)) - places).max() < 1e-9
    assert (drawn.metre(places) <= metres + 1e-6).all()  # equal, or the first occurrence of a doubled kilometre
    if (np.diff(np.append(drawn.start_km, 1e9)) > 0).all() and (drawn.start_km[1:] >= drawn.end_km[:-1]).all():
        assert np.abs(drawn.metre(places) - metres).max() < 1e-6


@given(axes(), st.lists(st.floats(0.0, 20.0), min_size=2, max_size=20))
@settings(derandomize=True, deadline=None)
def test_metres_rise_with_kilometres(drawn, places):
    assert (np.diff(drawn.metre(np.sort(places))) >= 0.0).all()
