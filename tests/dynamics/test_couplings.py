"""Couplings as tables, their greatest stiffness and damping, loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_couplings import SPRING_8_9, TAN_35, coupling, points, trace, wedge

from tractionpower.dynamics.couplings import compile_couplings, greatest_damping, greatest_stiffness, loop

SPRING = {"loading": points(*SPRING_8_9)}


def test_equal_gears_are_compiled_once_behind_what_is_there():
    one = coupling(SPRING | {"damping_percent": 20.0}, slack_mm=30.0, damping_kns_per_m=4.0)
    other = coupling({"stiffness_kn_per_mm": 5.0}, buff=SPRING | {"damping_percent": 20.0})
    curves = [(0.0, 1.0), (1.0, 2.0)]
    rows, gears = compile_couplings([one, other, one], curves)
    assert rows[["draw", "buff"]].tolist() == [(0, 0), (1, 0), (0, 0)]
    assert rows[["half_slack_m", "damping_ns_per_m"]].tolist() == [(0.015, 4000.0), (0.0, 0.0), (0.015, 4000.0)]
    assert gears["first_load"].tolist() == [2, 8]
    assert curves[2:5] == [(0.0, 0.0), (0.05, 500e3), (0.1, 1750e3)]
    np.testing.assert_allclose(curves[5:8], [(0.0, 0.0), (0.05, 400e3), (0.1, 1400e3)])
    assert gears["first_unload"].tolist() == [5, 8]  # a spring without loss has one curve


STIFFEST = [
    ({"stiffness_kn_per_mm": 5.0}, {}, 5.0),
    (SPRING, {}, 25.0),
    (SPRING | {"in_series": 2}, {}, 12.5),
    (SPRING | {"wedge": wedge(0.4, 0.2)} | {"locked_stiffness_kn_per_mm": 600.0}, {}, 600.0),
    (SPRING | {"wedge": wedge(0.2)}, {}, 25.0 * TAN_35 / (TAN_35 - 0.2)),
    (SPRING | {"stroke_mm": 90.0, "solid_stiffness_kn_per_mm": 80.0}, {}, 80.0),
    (SPRING, {"slack_mm": -120.0}, 50.0),
    (SPRING, {"buff": {"stiffness_kn_per_mm": 40.0}, "slack_mm": 20.0}, 40.0),
]


@pytest.mark.parametrize(("draw", "more", "expected"), STIFFEST)
def test_greatest_stiffness_is_the_steepest_that_is_found(draw, more, expected):
    which = coupling(draw, **more)
    assert greatest_stiffness(which) == pytest.approx(1e6 * expected, rel=1e-12)
    way = np.linspace(-110.0, 110.0, 22_001)  # one side is unloaded, then the other loaded
    found = np.abs(np.diff(trace(which, way, 1.0)) / np.diff(way)).max()
    assert found == pytest.approx(expected, rel=1e-6)


def test_what_is_solid_can_be_left_out():
    which = coupling(SPRING | {"stroke_mm": 90.0, "solid_stiffness_kn_per_mm": 80.0})
    assert greatest_stiffness(which, solid=False) == pytest.approx(25e6)


@pytest.mark.parametrize(
    ("draw", "slack_mm"),
    [
        (SPRING | {"damping_percent": 40.0}, 0.0),
        (SPRING | {"damping_percent": 40.0, "blending_mps": 0.02}, 0.0),
        (SPRING | {"unloading": points((100.0, 900.0))}, -20.0),
        (SPRING | {"wedge": wedge(0.2)}, 0.0),
    ],
)
def test_greatest_damping_is_the_steepest_over_speed(draw, slack_mm):
    which = coupling(draw, slack_mm=slack_mm, damping_kns_per_m=7.0)
    expected = greatest_damping(which)
    blending = draw.get("blending_mps", 0.1)
    v = np.linspace(-1.2 * blending, 1.2 * blending, 241)
    ends = [-100.0, 0.0, 100.0] if slack_mm == 0.0 else [-90.0, 0.0, 90.0]  # gear at its last point
    found = max(np.abs(np.diff(trace(which, np.full(v.size, x), v)) / np.diff(v)).max() for x in ends)
    assert 1e3 * found <= expected * (1.0 + 1e-9)
    assert 1e3 * found >= expected * (1.0 - 1e-9) if slack_mm == 0.0 else 1e3 * found > 0.5 * expected
    assert greatest_damping(coupling(SPRING | {"locked_stiffness_kn_per_mm": 600.0, "damping_percent": 40.0})) == 0.0


@given(turns=st.lists(st.floats(-95.0, 95.0), min_size=1, max_size=6))
def test_a_loop_is_a_path_at_one_speed(turns):
    which = coupling(SPRING | {"damping_percent": 40.0, "locked_stiffness_kn_per_mm": 100.0}, slack_mm=30.0)
    rates = 0.2 * np.sign(np.diff(turns, prepend=0.0))
    np.testing.assert_array_equal(loop(which, turns, 0.2), trace(which, turns, rates))
