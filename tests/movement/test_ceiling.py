"""The speed ceiling by hand, against a brute-force reference every 0.1 m, and its laws."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.path import compile_path
from tractionpower.kernels.train_tables import PIECE
from tractionpower.model.line import Gradient, Line, SpeedLimit, Track
from tractionpower.model.timetable import Leg
from tractionpower.movement.ceiling import compile_ceiling

TRAIN = {
    "length_m": 100.0,
    "max_mps": 40.0,
    "rate_mps2": 0.5,
    "weight_per_inertia": 9.0,
    "spread_m": 100.0,
    "stops_m": (),
    "end_stops": False,
}


def path_of(*, limits=((0.0, 4.0, 40.0),), slopes=(), length_km=4.0, behind_m=400.0):
    """Compile a route with limits [km, km, m/s] and slopes [km, km, permille]; the track begins 1 km before it."""
    line = Line(
        tracks=(Track(id="1", from_km=-1.0, to_km=10.0),),
        speed_limits=tuple(SpeedLimit(from_km=low, to_km=high, kmh=3.6 * mps) for low, high, mps in limits),
        gradients=tuple(Gradient(from_km=low, to_km=high, permille=permille) for low, high, permille in slopes),
    )
    return compile_path(line, compile_axes(line), (Leg(track="1", from_km=0.0, to_km=length_km),), None, behind_m)


def ceiling(path, **changes):
    return compile_ceiling(path, **(TRAIN | changes))


def squares(pieces, s):
    """Return the square of the ceiling at distances, as the driver reads it."""
    piece = pieces[np.searchsorted(pieces["from_m"], s, side="right") - 1]
    return piece["w"] + piece["dw"] * (s - piece["from_m"])


def before(pieces):
    """Return the square of the ceiling at the end of each piece but the last."""
    return pieces["w"][:-1] + pieces["dw"][:-1] * np.diff(pieces["from_m"])


def rows(pieces):
    return [tuple(round(float(value), 6) for value in piece) for piece in pieces]


# --- by hand -----------------------------------------------------------------------------------------------------


def test_a_limit_holds_until_the_tail_has_cleared_it():
    pieces = ceiling(path_of(limits=((0.0, 1.0, 30.0), (1.0, 2.0, 20.0), (2.0, 4.0, 50.0))))
    # From 30 to 20 m/s at 0.5 m/s2 takes (900 - 400) / 1 = 500 m; beyond km 2 the 100 m of the train; the train runs 40 m/s.
    assert rows(pieces) == [
        (0.0, 900.0, 0.0), (500.0, 900.0, -1.0), (1000.0, 400.0, 0.0), (2100.0, 1600.0, 0.0), (4000.0, 1600.0, 0.0),
    ]  # fmt: skip
    assert pieces.dtype == PIECE


def test_stops_and_the_end():
    pieces = ceiling(path_of(limits=((0.0, 4.0, 20.0),)), stops_m=(1000.0, 1100.0, 0.0), end_stops=True)
    assert rows(pieces) == [
        (0.0, 400.0, 0.0), (600.0, 400.0, -1.0), (1000.0, 100.0, -1.0), (1100.0, 400.0, 0.0), (3600.0, 400.0, -1.0),
        (4000.0, 0.0, 0.0),
    ]  # fmt: skip
    assert rows(ceiling(path_of(limits=((0.0, 4.0, 20.0),)))) == [(0.0, 400.0, 0.0), (4000.0, 400.0, 0.0)]


def test_slopes_act_through_weight_over_inertia():
    # 10 permille against a ratio of 9 m/s2 (rotating masses) is 0.09 m/s2: more on a rise, less on a fall.
    for permille, rate in ((10.0, 0.59), (-10.0, 0.41), (-80.0, 0.05)):
        pieces = ceiling(path_of(slopes=((-1.0, 5.0, permille),), limits=((0.0, 4.0, 15.0),)), end_stops=True)
        assert rows(pieces)[1] == (round(4000.0 - 225.0 / (2 * rate), 6), 225.0, -2 * rate)


def test_the_slope_acts_under_the_whole_train_or_under_its_front():
    path = path_of(slopes=((0.0, 2.0, 0.0), (2.0, 4.0, 20.0)), limits=((0.0, 4.0, 30.0),))
    # Stop 50 m into the rise: half of the train is on it there, a quarter in the mean of these 50 m.
    spread = ceiling(path, stops_m=(2050.0,))
    assert squares(spread, np.array([2000.0, 1900.0])) == pytest.approx([100 * (0.5 + 9 * 0.005), 54.5 + 100.0])
    point = ceiling(path, stops_m=(2050.0,), spread_m=0.0)
    assert squares(point, np.array([2000.0, 1900.0])) == pytest.approx([100 * 0.68, 68.0 + 100.0])


def test_the_track_behind_the_start_counts():
    slopes = ((-1.0, 0.0, 20.0), (0.0, 4.0, 0.0))
    level = ceiling(path_of(slopes=slopes, behind_m=0.0), stops_m=(100.0,))
    rising = ceiling(path_of(slopes=slopes), stops_m=(100.0,))
    assert (squares(level, 0.0), squares(rising, 0.0)) == (pytest.approx(100.0), pytest.approx(100.0 + 200 * 9 * 0.01))


def test_without_a_limit_the_train_runs_at_its_own():
    assert rows(ceiling(path_of(limits=((1.0, 2.0, 50.0),)))) == [(0.0, 1600.0, 0.0), (4000.0, 1600.0, 0.0)]


def test_a_lower_limit_within_the_braking_to_a_stop():
    pieces = ceiling(path_of(limits=((0.0, 3.9, 30.0), (3.9, 4.0, 20.0))), end_stops=True)
    assert rows(pieces) == [(0.0, 900.0, 0.0), (3100.0, 900.0, -1.0), (3900.0, 100.0, -1.0), (4000.0, 0.0, 0.0)]


def test_a_short_gap_between_lower_limits_is_filled_by_a_long_train():
    limits = ((0.0, 1.0, 10.0), (1.0, 1.3, 30.0), (1.3, 4.0, 20.0))
    assert rows(ceiling(path_of(limits=limits), length_m=300.0)) == [
        (0.0, 100.0, 0.0),
        (1300.0, 400.0, 0.0),
        (4000.0, 400.0, 0.0),
    ]


def test_a_stop_within_rounding_of_a_change_is_one_place():
    limits = ((0.0, 2.0 + 3e-13, 30.0), (2.0 + 3e-13, 4.0, 20.0))
    slopes = ((-1.0, 1.9 + 2e-13, 1.0), (1.9 + 2e-13, 2.0, 0.0), (2.0, 4.0, -1.0))
    pieces = ceiling(path_of(limits=limits, slopes=slopes), stops_m=(2000.0, 4000.0 - 2e-10), length_m=100.0 + 1e-9)
    assert np.diff(pieces["from_m"]).min() > 1.0
    assert rows(pieces) == [
        (0.0, 900.0, 0.0), (1115.029470, 900.0, -1.018), (1900.0, 100.9, -1.009), (2000.0, 400.0, 0.0),
        (3592.668024, 400.0, -0.982), (4000.0, 0.0, 0.0),
    ]  # fmt: skip


def test_tail_clearing_within_rounding_of_another_change_is_one_place():
    limits = ((0.0, 1.0, 20.0), (1.0, 1.1, 30.0), (1.1, 2.0, 25.0), (2.0, 4.0, 40.0))
    pieces = ceiling(path_of(limits=limits), length_m=100.0 + 1e-7)
    assert pieces["from_m"] == pytest.approx([0.0, 1100.0, 2100.0, 4000.0], abs=1e-6)
    assert pieces["w"].tolist() == pytest.approx([400.0, 625.0, 1600.0, 1600.0])
    braking = ceiling(path_of(limits=limits), length_m=100.0 + 1e-7, stops_m=(1150.0,))
    assert braking["from_m"] == pytest.approx([0.0, 750.0, 1000.0, 1100.0, 1150.0, 2100.0, 4000.0], abs=1e-6)


def test_a_slope_that_changes_within_rounding_of_a_limit_cuts_no_sliver():
    slopes = ((-1.0, 2.0 + 1e-10, 4.0), (2.0 + 1e-10, 4.0, 0.0))
    pieces = ceiling(path_of(limits=((0.0, 2.0, 30.0), (2.0, 4.0, 29.0)), slopes=slopes), stops_m=(2200.0,))
    assert rows(pieces)[1:5] == [
        (1350.373134, 900.0, -1.072),
        (2000.0, 203.6, -1.036),
        (2100.0, 100.0, -1.0),
        (2200.0, 841.0, 0.0),
    ]


def test_rounding_cuts_no_level_ceiling():
    slopes = [(0.31 * number, 0.31 * (number + 1), (-1) ** number * 3.7 * number) for number in range(12)]
    assert len(ceiling(path_of(slopes=slopes, limits=((0.0, 4.0, 17.3),)), rate_mps2=0.37)) == 2


# --- random routes -----------------------------------------------------------------------------------------------


STEP = 0.1


@st.composite
def routes(draw):
    """Draw limits, slopes, stops on whole metres of a route of 2 km, and a train."""
    places = st.lists(st.integers(1, 1999), max_size=6, unique=True).map(lambda cuts: [0, *sorted(cuts), 2000])
    limits = [(low / 1000, high / 1000, draw(st.integers(5, 40))) for low, high in itertools.pairwise(draw(places))]
    slopes = [(low / 1000, high / 1000, draw(st.integers(-30, 30))) for low, high in itertools.pairwise(draw(places))]
    slopes[0] = (-1.0, *slopes[0][1:])
    stops = draw(st.lists(st.integers(0, 2000), max_size=3, unique=True))
    length = draw(st.integers(5, 600))
    train = {
        "length_m": float(length),
        "spread_m": float(length) if draw(st.booleans()) else 0.0,
        "max_mps": float(draw(st.integers(10, 45))),
        "rate_mps2": draw(st.sampled_from([0.2, 0.5, 1.1])),
        "stops_m": tuple(map(float, stops)),
        "end_stops": draw(st.booleans()),
    }
    return {"limits": limits, "slopes": slopes, "length_km": 2.0, "behind_m": 700.0}, train


def stepwise(lists, s):
    """Return the value of a list of (from km, to km, value) at places [m]; level before the track."""
    value = np.zeros(len(s))
    for low, high, number in lists:
        value[(s >= 1000 * low) & (s < 1000 * high)] = number
    return value


def reference(route, train):
    """Return the square of the ceiling every 0.1 m, from limits and slopes themselves by loops backwards."""
    reach = int(1000 / STEP)
    middles = (np.arange(-reach, int(2000 / STEP)) + 0.5) * STEP
    limit = np.minimum(stepwise(route["limits"], middles), train["max_mps"])
    limit[middles < 0] = train["max_mps"]
    window = int(train["length_m"] / STEP)
    static = np.lib.stride_tricks.sliding_window_view(limit, window + 1)[reach - window :].min(axis=1) ** 2
    slope = np.where(middles > -700.0, stepwise(route["slopes"], middles), 0.0) / 1000.0
    if train["spread_m"]:
        height = np.concatenate(([0.0], np.cumsum(slope * STEP)))
        height = 0.5 * (height[1:] + height[:-1])
        slope[window:] = (height[window:] - height[:-window]) / train["spread_m"]
    rate = np.maximum(train["rate_mps2"] + 9.0 * slope, 0.1 * train["rate_mps2"])[reach:]
    fall = 2.0 * rate * STEP
    stops = {round(s / STEP) for s in train["stops_m"]}
    curve = 0.0 if train["end_stops"] or len(static) in stops else np.inf
    speeds = np.empty(len(static))
    for cell in range(len(static) - 1, -1, -1):  # `curve` is the ceiling at the end of the cell
        speeds[cell] = min(static[cell], curve + 0.5 * fall[cell])
        curve = 0.0 if cell in stops else min(static[cell], curve + fall[cell])
    return middles[reach:], speeds, rate


@given(routes())
@settings(derandomize=True, deadline=None, max_examples=40)
def test_the_ceiling_is_that_of_the_reference(drawn):
    route, train = drawn
    pieces = ceiling(path_of(**route), **train)
    s, expected, rate = reference(route, train)
    found = squares(pieces, s)
    if not train["spread_m"]:
        np.testing.assert_allclose(found, expected, rtol=0, atol=1.1 * STEP * rate.max())
        return
    # The reference lets the slope grow on within a piece; the pieces take its mean, which is the same at their ends.
    assert np.abs(found - expected).max() <= 0.5 * np.ptp(rate) * train["length_m"] + STEP * rate.max()
    knots = np.array([1000 * low for low, _, _ in route["slopes"]])
    ends = np.concatenate((knots, knots + train["length_m"], train["stops_m"], (2000.0,)))
    at_ends = np.unique(np.rint(ends[(ends > 0) & (ends <= 2000)] / STEP).astype(int)) - 1  # the cells before them
    if rate.min() > 0.1 * train["rate_mps2"]:  # held at the least deceleration, means differ
        np.testing.assert_allclose(found[at_ends], expected[at_ends], rtol=0, atol=1.1 * STEP * rate.max())


@given(routes())
@settings(derandomize=True, deadline=None)
def test_it_jumps_upwards_only_and_comes_to_a_stand_at_stops(drawn):
    route, train = drawn
    pieces = ceiling(path_of(**route), **train)
    ends = before(pieces)
    assert (np.diff(pieces["from_m"]) > 0.0).all()
    assert (pieces["from_m"][0], pieces["from_m"][-1], pieces["dw"][-1]) == (0.0, 2000.0, 0.0)
    assert (pieces["w"][1:] - ends).min() > -1e-9
    assert pieces["w"][-1] == pytest.approx(ends[-1], abs=1e-9)
    assert (pieces["dw"] <= 0.0).all()
    assert (pieces["w"] <= train["max_mps"] ** 2 + 1e-9).all()
    stops = {s for s in (*train["stops_m"], 2000.0 if train["end_stops"] else 0.0) if s > 0}
    assert {float(s) for s in pieces["from_m"][1:][np.abs(ends) < 1e-9]} == stops
    assert (pieces["w"][:-1] > 0.0).all()


@given(routes(), st.integers(0, 1900), st.integers(1, 30))
@settings(derandomize=True, deadline=None)
def test_one_more_limit_never_raises_it(drawn, start, mps):
    route, train = drawn
    train["spread_m"] = 0.0  # else a cut more makes the mean slope of a piece another one
    s = np.arange(0.5, 2000.0)
    slower = {**route, "limits": [*route["limits"], (start / 1000, start / 1000 + 0.1, mps)]}
    rise = squares(ceiling(path_of(**slower), **train), s) - squares(ceiling(path_of(**route), **train), s)
    assert rise.max() <= 1e-6


def test_a_mirrored_line_gives_the_same_ceiling():
    def compiled(sign):
        def ends(low, high):
            return dict(zip(("from_km", "to_km"), sorted((sign * low, sign * high)), strict=True))

        way = "increasing" if sign > 0 else "decreasing"
        line = Line(
            tracks=(Track(id="1", **ends(0.0, 10.0)),),
            speed_limits=(
                SpeedLimit(**ends(0.0, 10.0), kmh=120.0),
                SpeedLimit(**ends(3.0, 4.0), kmh=70.0, direction=way),
                SpeedLimit(**ends(6.0, 7.0), kmh=30.0, direction="decreasing" if sign > 0 else "increasing"),
            ),
            gradients=(Gradient(**ends(0.0, 2.7), permille=sign * 12.0), Gradient(**ends(2.7, 10.0), permille=sign * -7.0)),
        )
        leg = Leg(track="1", from_km=sign * 1.0, to_km=sign * 9.5)
        return compile_path(line, compile_axes(line), (leg,), None, 300.0)

    plain, mirrored = (
        ceiling(compiled(sign), length_m=250.0, spread_m=250.0, stops_m=(5000.0,), end_stops=True) for sign in (1.0, -1.0)
    )
    assert len(plain) == len(mirrored) > 8
    for name in PIECE.names:
        np.testing.assert_allclose(mirrored[name], plain[name], rtol=0, atol=1e-8)
