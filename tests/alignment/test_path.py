"""Routes as paths: heights, curves and tunnels by hand, limits against their definition, places there and back."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.path import compile_path
from tractionpower.model.line import (
    ChainageBreak,
    Curve,
    CurveResistance,
    Gradient,
    Line,
    PowerOff,
    SpeedLimit,
    Track,
    TrainCurrentLimit,
    Tunnel,
)
from tractionpower.model.timetable import Leg

TRACKS = (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0))


def compiled(*legs, category=None, behind_m=0.0, tracks=TRACKS, **lists):
    """Compile a route, given as (track, from km, to km), on a line with some lists."""
    line = Line(tracks=tracks, **lists)
    route = [Leg(track=track, from_km=low, to_km=high) for track, low, high in legs]
    return compile_path(line, compile_axes(line), route, category, behind_m)


def at(path, name, *places):
    """Return an integral of a path at places [m]."""
    return pytest.approx(np.interp(places, path.at_m, getattr(path, name)), abs=1e-9)


@pytest.fixture
def falling():
    """Two legs against the kilometres, the first through a jump from km 15 to km 16, and 3 km behind the start."""
    return compiled(
        ("2", 18.0, 14.0),
        ("1", 14.0, 10.0),
        behind_m=3000.0,
        chainage_breaks=(ChainageBreak(at_km=15.0, continues_as_km=16.0),),
        gradients=(
            Gradient(from_km=0.0, to_km=15.0, permille=4.0, tracks=("2",)),
            Gradient(from_km=15.0, to_km=20.0, permille=-8.0, tracks=("2",)),
            Gradient(from_km=0.0, to_km=12.0, permille=5.0, tracks=("1",)),
            Gradient(from_km=12.0, to_km=20.0, permille=-2.0, tracks=("1",)),
        ),
    )


def test_heights_by_hand_against_the_kilometres_on_two_tracks_through_a_jump(falling):
    # km 18 to 16: 2 km of +8 permille; km 15 to 14: 1 km of -4; track 1 to km 12: 2 km of +2; to km 10: 2 km of -5.
    assert [0.0, 16.0, 12.0, 16.0, 6.0] == at(falling, "height_m", 0.0, 2000.0, 3000.0, 5000.0, 7000.0)
    assert falling.length_m == 7000.0
    assert falling.at_m.tolist() == [-3000.0, -2000.0, 0.0, 2000.0, 3000.0, 5000.0, 7000.0]


def test_behind_the_start_the_track_counts_as_far_as_it_exists(falling):
    assert [-4.0, -16.0, -16.0] == at(falling, "height_m", -500.0, -2000.0, -3000.0)


def test_behind_a_start_near_the_low_end_of_a_track():
    path = compiled(("1", 1.0, 0.0), behind_m=1500.0, gradients=(Gradient(from_km=0.0, to_km=20.0, permille=6.0),))
    assert [9.0, 0.0, -6.0] == at(path, "height_m", -1500.0, 0.0, 1000.0)


def test_a_list_that_ends_within_a_millimetre_of_the_route_ends_there():
    path = compiled(("1", 0.0, 20.0), gradients=(Gradient(from_km=0.0, to_km=20.0 - 5e-7, permille=6.0),))
    assert path.at_m.tolist() == [0.0, 20_000.0]
    assert [120.0] == at(path, "height_m", 20_000.0)


def test_places_by_hand(falling):
    assert [falling.place(s) for s in (0.0, 1500.0, 2500.0, 3000.0, 7000.0)] == [
        ("2", 18.0), ("2", 16.5), ("2", 14.5), ("1", 14.0), ("1", 10.0),
    ]  # fmt: skip
    legs, km = falling.places(np.array([-500.0, 2500.0, 3500.0, 6000.0]))
    assert (legs.tolist(), km.tolist()) == ([0, 0, 1, 1], [18.5, 14.5, 13.5, 11.0])
    assert falling.direction_at(10.0) == "decreasing"


def test_distances_by_hand(falling):
    assert [falling.distance("2", km) for km in (18.0, 17.0, 16.0, 15.0, 14.0)] == [0.0, 1000.0, 2000.0, 2000.0, 3000.0]
    assert [falling.distance("1", km) for km in (14.0, 10.0, 9.999)] == [3000.0, 7000.0, None]
    assert [falling.distance("2", km) for km in (18.001, 15.5, 13.0)] == [None, None, None]
    assert falling.distance("3", 14.0) is None


def test_the_end_of_a_leg_is_one_number_for_all_who_ask():
    path = compiled(("1", 0.1, 0.7))
    assert path.distance("1", 0.7 + 1e-10) == path.distance("1", 0.7) == path.length_m
    assert path.distance("1", 0.1 - 1e-10) == 0.0


def test_a_place_that_the_route_passes_twice():
    path = compiled(("1", 5.0, 8.0), ("2", 8.0, 6.0), ("1", 6.0, 9.0))
    assert (path.distance("1", 7.0), path.distance("1", 7.0, from_m=2001.0)) == (2000.0, 6000.0)
    assert path.distance("1", 5.5, from_m=600.0) is None
    assert [path.direction_at(s) for s in (2999.0, 3000.0, 5000.0)] == ["increasing", "decreasing", "increasing"]


def test_curves_by_hand():
    curves = (
        Curve(from_km=1.0, to_km=2.0, radius_m=800.0),
        Curve(from_km=2.0, to_km=2.4, radius_m=300.0),
        Curve(from_km=2.5, to_km=3.0, radius_m=299.0),
    )
    sums = np.cumsum([1000.0 * 0.650 / 745.0, 400.0 * 0.650 / 245.0, 500.0 * 0.500 / 269.0])
    rising = compiled(("1", 0.0, 4.0), curves=curves)
    assert [0.0, sums[0] / 2, *sums, sums[2]] == at(rising, "curve_m", 1000.0, 1500.0, 2000.0, 2400.0, 3000.0, 4000.0)
    falling = compiled(("1", 4.0, 0.0), curves=curves)
    assert [sums[2] - sums[1], sums[2]] == at(falling, "curve_m", 1500.0, 4000.0)


def test_the_curve_formula_of_the_line():
    curves = (Curve(from_km=1.0, to_km=2.0, radius_m=500.0), Curve(from_km=2.0, to_km=3.0, radius_m=100.0))
    own = compiled(("1", 0.0, 4.0), curves=curves, curve_resistance=CurveResistance(a=690.0))
    assert [1.38, 1.38 + 6.9] == at(own, "curve_m", 2000.0, 4000.0)
    shifted = compiled(("1", 0.0, 4.0), curves=curves, curve_resistance=CurveResistance(a=700.0, b_m=100.0))
    assert [1.75, 1.75] == at(shifted, "curve_m", 2000.0, 4000.0)  # no value at 100 m: check_line refuses it


def test_tunnels_by_hand():
    tunnels = (
        Tunnel(from_km=1.0, to_km=2.0, kind="single_track", tracks=("1",)),
        Tunnel(from_km=3.0, to_km=3.5, kind="single_track"),
        Tunnel(from_km=4.0, to_km=6.0, kind="double_track"),
    )
    path = compiled(("1", 5.0, 0.0), behind_m=400.0, tunnels=tunnels)
    assert [0.0, 500.0, 500.0, 1500.0, 1500.0] == at(path, "single_tunnel_m", 1500.0, 2000.0, 3000.0, 4000.0, 5000.0)
    assert [-400.0, 0.0, 1000.0, 1000.0] == at(path, "double_tunnel_m", -400.0, 0.0, 1000.0, 5000.0)
    other = compiled(("2", 5.0, 0.0), behind_m=400.0, tunnels=tunnels)
    assert [500.0] == at(other, "single_tunnel_m", 5000.0)


def test_a_level_line_without_lists():
    path = compiled(("1", 2.0, 3.0), behind_m=100.0)
    assert path.at_m.tolist() == [-100.0, 0.0, 1000.0]
    assert not path.height_m.any()
    assert (path.limit_from_m.tolist(), np.isnan(path.limit_mps).tolist()) == ([0.0], [True])
    assert (path.current_from_m.tolist(), path.max_current_a.tolist()) == ([0.0], [np.inf])


# --- limits ------------------------------------------------------------------------------------------------------


LIMITS = (
    SpeedLimit(from_km=0.0, to_km=20.0, kmh=144),
    SpeedLimit(from_km=4.0, to_km=8.0, kmh=108, tracks=("1",)),
    SpeedLimit(from_km=6.0, to_km=10.0, kmh=72, direction="increasing"),
    SpeedLimit(from_km=5.0, to_km=7.0, kmh=126, category="freight"),
    SpeedLimit(from_km=6.5, to_km=9.0, kmh=90, category="freight", direction="decreasing"),
    SpeedLimit(from_km=0.0, to_km=20.0, kmh=18, category="works"),
)


@pytest.mark.parametrize(
    ("leg", "category", "places", "limits"),
    [
        (("1", 0.0, 20.0), None, [0, 4000, 6000, 10000], [40, 30, 20, 40]),
        (("1", 20.0, 0.0), None, [0, 12000, 16000], [40, 30, 40]),
        (("2", 0.0, 20.0), "tram", [0, 6000, 10000], [40, 20, 40]),
        (("1", 0.0, 20.0), "freight", [0, 4000, 5000, 7000, 10000], [40, 30, 35, 20, 40]),
        (("2", 20.0, 0.0), "freight", [0, 11000, 13500, 15000], [40, 25, 35, 40]),
        (("1", 5.0, 3.0), "works", [0], [5]),
    ],
)
def test_limits_by_direction_track_and_category_by_hand(leg, category, places, limits):
    path = compiled(leg, category=category, speed_limits=LIMITS)
    assert path.limit_from_m.tolist() == places
    assert path.limit_mps == pytest.approx(limits)


def test_a_place_without_a_limit_is_not_a_number():
    limits = (SpeedLimit(from_km=2.0, to_km=4.0, kmh=36), SpeedLimit(from_km=5.0, to_km=20.0, kmh=36, direction="increasing"))
    path = compiled(("1", 1.0, 6.0), speed_limits=limits)
    assert path.limit_from_m.tolist() == [0.0, 1000.0, 3000.0, 4000.0]
    np.testing.assert_array_equal(path.limit_mps, [np.nan, 10.0, np.nan, 10.0])


def test_rows_that_meet_within_a_millimetre_leave_no_gap():
    limits = (SpeedLimit(from_km=0.0, to_km=8.0 - 4e-7, kmh=36), SpeedLimit(from_km=8.0 + 4e-7, to_km=20.0 - 5e-7, kmh=72))
    path = compiled(("1", 0.0, 20.0), speed_limits=limits)
    assert path.limit_from_m == pytest.approx([0.0, 8000.0], abs=1e-3)
    assert path.limit_mps.tolist() == [10.0, 20.0]


def test_train_currents_by_hand():
    rows = (
        TrainCurrentLimit(from_km=0.0, to_km=10.0, max_current_a=3000, standstill_current_a=200),
        TrainCurrentLimit(from_km=8.0, to_km=12.0, max_current_a=2000),
        TrainCurrentLimit(from_km=9.0, to_km=12.0, max_current_a=2500, standstill_current_a=100, tracks=("1",)),
    )
    path = compiled(("1", 15.0, 5.0), train_current_limits=rows)
    assert path.current_from_m.tolist() == [0.0, 3000.0, 6000.0, 7000.0]
    assert path.max_current_a.tolist() == [np.inf, 2000.0, 2000.0, 3000.0]
    assert path.standstill_current_a.tolist() == [np.inf, 100.0, 200.0, 200.0]


def test_stretches_without_power_by_hand():
    rows = (
        PowerOff(from_km=8.0, to_km=8.03, kind="neutral"),
        PowerOff(from_km=9.0, to_km=12.0, kind="coast", tracks=("1",)),
        PowerOff(from_km=10.0, to_km=11.0, kind="lower_pantograph"),
    )
    path = compiled(("1", 15.0, 5.0), power_off=rows)
    assert path.power_from_m.tolist() == pytest.approx([0.0, 3000.0, 4000.0, 5000.0, 6000.0, 6970.0, 7000.0])
    assert path.power_kind.tolist() == [0, 1, 2, 1, 0, 2, 0]
    assert compiled(("2", 15.0, 5.0), power_off=rows).power_kind.tolist() == [0, 2, 0, 2, 0]


row_of_a_limit = st.builds(
    lambda low, size, kmh, tracks, direction, category: SpeedLimit(
        from_km=float(low), to_km=float(low + size), kmh=float(kmh), tracks=tracks, direction=direction, category=category
    ),
    st.integers(0, 19), st.integers(1, 10), st.integers(1, 5), st.sampled_from([None, ("1",), ("2",), ("1", "2")]),
    st.sampled_from([None, "increasing", "decreasing"]), st.sampled_from([None, None, "freight", "works"]),
)  # fmt: skip


def permitted(rows, track, km, direction, category):
    """Return what the rows permit at a place [m/s], straight from their definition."""
    here = [
        row
        for row in rows
        if row.from_km < km < row.to_km and (row.tracks is None or track in row.tracks) and row.direction in {None, direction}
    ]
    own = [row.kmh for row in here if row.category == category and category is not None]
    return min(own or [row.kmh for row in here if row.category is None], default=np.nan) / 3.6


@given(st.lists(row_of_a_limit, max_size=12), st.sampled_from([None, "freight"]), st.booleans())
@settings(derandomize=True, deadline=None)
def test_limits_are_those_of_their_definition(rows, category, up):
    legs = (("1", 0.0, 9.0), ("2", 9.0, 20.0)) if up else (("2", 20.0, 9.0), ("1", 9.0, 0.0))
    path = compiled(*legs, category=category, speed_limits=tuple(rows))
    places = np.arange(500.0, 20_000.0, 1000.0)
    found = path.limit_mps[np.searchsorted(path.limit_from_m, places, side="right") - 1]
    expected = [permitted(rows, *path.place(s), path.direction_at(s), category) for s in places]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert path.limit_from_m[0] == 0.0
    assert (np.diff(path.limit_from_m) > 0.5).all()
    again = compiled(*legs, category=category, speed_limits=tuple(rows[::-1]))
    np.testing.assert_array_equal(again.limit_mps, path.limit_mps)


# --- laws --------------------------------------------------------------------------------------------------------


jumps = st.lists(st.tuples(st.integers(200, 1800), st.integers(-90, 90)), max_size=3, unique_by=lambda jump: jump[0] // 200)
ends = st.tuples(st.integers(0, 2000), st.integers(0, 2000)).filter(lambda pair: pair[0] != pair[1])


@given(jumps, st.lists(ends, min_size=1, max_size=2), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=10))
@settings(derandomize=True, deadline=None)
def test_a_place_leads_back_to_its_distance(jumps, legs, shares):
    breaks = tuple(ChainageBreak(at_km=at / 100.0, continues_as_km=(at + size) / 100.0) for at, size in jumps)
    line = Line(tracks=TRACKS, chainage_breaks=breaks)
    axes = compile_axes(line)
    named = [(track, low / 100.0, high / 100.0) for track, (low, high) in zip("12", legs, strict=False)]
    assume(all(abs(axes[track].metre(high) - axes[track].metre(low)) > 1.0 for track, low, high in named))
    path = compiled(*named, chainage_breaks=breaks)
    doubled = any(size < 0 for _, size in jumps)
    for s in np.array(shares) * path.length_m:
        track, km = path.place(s)
        found = path.distance(track, km)
        if found is None or abs(found - s) > 2e-3:
            assert doubled  # a second occurrence: its kilometre means the first, on the route or not
        if found is not None and found < path.legs[-1].start_m - 1.0:
            assert path.place(found) == (track, pytest.approx(km, abs=2e-6))


@given(
    st.lists(st.tuples(st.integers(1, 19), st.integers(-30, 30), st.integers(60, 900)), min_size=1, max_size=8),
    st.integers(0, 3000),
)
@settings(derandomize=True, deadline=None)
def test_a_mirrored_line_gives_the_same_path(rows, behind_m):
    cuts = [0, *sorted({row[0] for row in rows}), 20]
    stretches = list(zip(cuts, cuts[1:], [*rows, rows[0]], strict=False))

    def route(turn, legs):
        def ends(low, high):
            pair = sorted((turn(float(low)), turn(float(high))))
            return {"from_km": pair[0], "to_km": pair[1]}

        sign = 1.0 if turn(1.0) > turn(0.0) else -1.0
        way = "increasing" if sign > 0 else "decreasing"
        return compiled(
            *[(track, turn(low), turn(high)) for track, low, high in legs],
            behind_m=float(behind_m),
            gradients=tuple(Gradient(**ends(low, high), permille=sign * row[1]) for low, high, row in stretches),
            curves=tuple(Curve(**ends(low, high), radius_m=float(row[2])) for low, high, row in stretches),
            speed_limits=tuple(
                SpeedLimit(**ends(low, high), kmh=float(row[2]) / 2, direction=way) for low, high, row in stretches
            ),
        )

    legs = (("1", 2.0, 11.0), ("2", 11.0, 18.5))
    plain, mirrored = route(lambda km: km, legs), route(lambda km: 20.0 - km, legs)
    for name in ("at_m", "height_m", "curve_m", "limit_from_m", "limit_mps"):
        np.testing.assert_allclose(getattr(mirrored, name), getattr(plain, name), rtol=0, atol=1e-9)
