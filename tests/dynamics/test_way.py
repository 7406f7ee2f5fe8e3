import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tractionpower.dynamics.way import compile_way, half_length, slope_ramps
from tractionpower.kernels import way as kernel
from tractionpower.model.dynamics.case import CaseTrack

FINE_M = 0.25

# small kernels are compiled into their callers only
row_at, slope_at, height_at, bend_resistance = (
    getattr(function, "py_func", function)
    for function in (kernel.row_at, kernel.slope_at, kernel.height_at, kernel.bend_resistance)
)


def track(**rows):
    return CaseTrack.model_validate(rows)


def along(way, places):
    slopes = way[0].view(np.recarray)
    row, found = 0, []
    for s in places:
        row = row_at(slopes, s, row)
        found.append((slope_at(slopes, row, s), height_at(slopes, row, s)))
    return np.array(found).T


def resisting(way, places):
    bends, bend = (rows.view(np.recarray) for rows in way[1:])
    row, found = 0, []
    for s in places:
        row = row_at(bends, s, row)
        found.append(bend_resistance(bends, bend, row, s))
    return np.array(found)


def test_a_break_of_ten_permille_takes_forty_metres():
    way = compile_way(track(gradients=[{"from_m": 100.0, "to_m": 900.0, "permille": 10.0}]))
    slope, _ = along(way, [79.9, 80.0, 90.0, 100.0, 120.0, 120.1, 500.0])
    assert slope * 1000.0 == pytest.approx([0.0, 0.0, 2.5, 5.0, 10.0, 10.0, 10.0], abs=1e-9)
    assert way[0]["change_per_m"][1] == pytest.approx(0.25e-3)  # 1000/4000 permille per metre


rows = st.lists(st.tuples(st.floats(5.0, 400.0), st.floats(-30.0, 30.0)), min_size=1, max_size=6)


@given(rows=rows, radius=st.sampled_from([0.0, 500.0, 4000.0, 10_000.0]))
def test_rounding_keeps_the_height_behind_the_last_break(rows, radius):
    gradients, at = [], 0.0
    for length, permille in rows:
        gradients.append({"from_m": at, "to_m": at + length, "permille": permille})
        at += length
    declared = track(gradients=gradients, rounding_radius_m=radius)
    end = max([at, *(ramp.to_m for ramp in slope_ramps(declared))]) + 10.0
    _, height = along(compile_way(declared), [end])
    sharp = sum(length * permille / 1000.0 for length, permille in rows)
    assert height[0] == pytest.approx(sharp, abs=1e-9)


def test_height_is_the_integral_of_the_slope():
    way = compile_way(track(gradients=[
        {"from_m": 0.0, "to_m": 200.0, "permille": 12.0}, {"from_m": 200.0, "to_m": 260.0, "permille": -20.0},
        {"from_m": 300.0, "to_m": 500.0, "permille": 5.0},
    ]))  # fmt: skip
    places = np.arange(-100.0, 600.0, FINE_M)
    slope, height = along(way, places)
    summed = np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * FINE_M)))
    assert height - height[0] == pytest.approx(summed, abs=2e-6)


def test_without_gradients_and_curves_the_track_is_level_and_straight():
    way = compile_way(track())
    slope, height = along(way, [-1e4, 0.0, 1e4])
    assert not slope.any() and not height.any() and not resisting(way, [-5.0, 0.0, 5.0]).any()


@pytest.mark.parametrize(("radius", "n_per_kn"), [(1000.0, 650 / 945), (300.0, 650 / 245), (250.0, 500 / 220)])
def test_curves_resist_as_roeckl_says(radius, n_per_kn):
    way = compile_way(track(curves=[{"from_m": 100.0, "to_m": 300.0, "radius_m": radius, "turns": "left"}]))
    assert resisting(way, [99.0, 200.0, 301.0]) * 1000.0 == pytest.approx([0.0, n_per_kn, 0.0])


def test_curvature_is_linear_in_the_transition():
    transitions = [{"radius_m": 200.0, "half_length_m": 40.0}, {"radius_m": 600.0, "half_length_m": 20.0}]
    declared = track(
        curves=[{"from_m": 100.0, "to_m": 300.0, "radius_m": 400.0}],
        transitions=transitions,
        curve_resistance={"a_n_m_per_kn": 700.0},  # proportional to the curvature
    )
    assert half_length(declared, 400.0) == 30.0
    found = resisting(compile_way(declared), [70.0, 85.0, 100.0, 130.0, 200.0, 300.0, 330.0]) * 1000.0
    assert found == pytest.approx([0.0, 1.75 / 4, 1.75 / 2, 1.75, 1.75, 1.75 / 2, 0.0], abs=1e-12)


def test_tunnels_add_two_or_one_newton_per_kilonewton():
    way = compile_way(track(tunnels=[
        {"from_m": 0.0, "to_m": 100.0, "kind": "single_track"}, {"from_m": 100.0, "to_m": 150.0, "kind": "double_track"},
    ]))  # fmt: skip
    assert resisting(way, [-1.0, 50.0, 120.0, 151.0]) * 1000.0 == pytest.approx([0.0, 2.0, 1.0, 0.0])
