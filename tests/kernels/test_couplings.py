"""The force of couplings: losses of wedges and dampings in closed form, regimes, slack, memory, energy over random paths."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_couplings import SPRING_8_9, TAN_35, coupling, cycle, points, trace, wedge, work

from tractionpower.dynamics.couplings import coupling_tables, greatest_damping, loop
from tractionpower.kernels.chain_state import LINK

SPRING = {"loading": points(*SPRING_8_9)}
LOCKED = {"locked_stiffness_kn_per_mm": 600.0}
RELAXING = {"relaxing_stiffness_kn_per_mm": 0.6}
ARSHAD = SPRING | LOCKED | RELAXING | {"wedge": wedge(0.4, 0.2)}
PRELOADED = {
    "loading": points((0.0, 240.0), (90.0, 2553.0)),
    "unloading": points((0.0, 50.0), (90.0, 306.5)),
    "locked_stiffness_kn_per_mm": 250.0,
    "stroke_mm": 90.0,
}
GEARS = {
    "linear": {"stiffness_kn_per_mm": 5.0},
    "points": SPRING,
    "damped": SPRING | {"damping_percent": 40.0},
    "damped and solid": SPRING | {"damping_percent": 60.0, "stroke_mm": 70.0, "solid_stiffness_kn_per_mm": 90.0},
    "two curves": SPRING | {"unloading": points((40.0, 10.0), (100.0, 1000.0))},
    "locked": SPRING | LOCKED | {"damping_percent": 70.0},
    "wedge": SPRING | {"wedge": wedge(0.3)},
    "wedge, locked": ARSHAD,
    "wedge, solid": ARSHAD | {"stroke_mm": 60.0},
    "preloaded": PRELOADED,
    "two in series": PRELOADED | {"in_series": 2},
}
"""Gears that the checks let pass."""

WORK_8_9 = 38_750.0
"""Work of the spring alone up to 80 mm [J]: 50 x 500 / 2 + 30 x (500 + 1250) / 2."""


@pytest.mark.interpreted
@pytest.mark.parametrize(
    ("mu", "put_in", "back", "lost"), [(0.2, 54_244.0, 30_141.0, 0.44434), (0.4, None, None, 0.72714)], ids=["0.2", "0.4"]
)
def test_loss_of_a_wedge(mu, put_in, back, lost):
    found_in, found_back = cycle(coupling(SPRING | {"wedge": wedge(mu)}), 80.0, 17)
    assert found_in == pytest.approx(WORK_8_9 * TAN_35 / (TAN_35 - mu), rel=1e-12)
    assert found_back == pytest.approx(WORK_8_9 * TAN_35 / (TAN_35 + mu), rel=1e-12)
    assert 1.0 - found_back / found_in == pytest.approx(lost, abs=5e-6)
    if put_in is not None:
        assert (found_in, found_back) == (pytest.approx(put_in, abs=0.5), pytest.approx(back, abs=0.5))


@pytest.mark.interpreted
def test_peaks_of_a_wedge():
    forces = trace(coupling(SPRING | {"wedge": wedge(0.2)}), [80.0, 80.0], [1.0, -1.0])
    assert forces == pytest.approx([1749.8, 972.3], abs=0.05)


@given(
    angle=st.floats(10.0, 60.0),
    share=st.floats(0.01, 0.9),
    steps=st.lists(st.tuples(st.floats(1.0, 60.0), st.floats(1.0, 900.0)), min_size=1, max_size=6),
)
def test_loss_of_a_wedge_with_any_spring(angle, share, steps):
    # E tan/(tan - mu) in, E tan/(tan + mu) out, whatever the spring: 2 mu / (tan + mu) is lost.
    curve = np.cumsum([(0.0, 0.0), *steps], axis=0)
    tan = math.tan(math.radians(angle))
    mu = share * tan
    which = coupling({"loading": points(*curve.tolist()), "wedge": wedge(mu, angle_deg=angle)})
    way = np.r_[curve[:, 0], curve[::-1, 0]]
    forces = trace(which, way, np.repeat([1.0, -1.0], len(curve)))
    put_in, back = work(forces[: len(curve)], way[: len(curve)]), -work(forces[len(curve) :], way[len(curve) :])
    assert 1.0 - back / put_in == pytest.approx(2.0 * mu / (tan + mu), rel=1e-9)


def test_a_locked_wedge_loses_as_much_the_stiffer_it_locks():
    # The locked line cuts a triangle off the loop, whose width falls with 1/k.
    exact = 2.0 * 0.2 / (TAN_35 + 0.2)
    missing = []
    for locked in (1e3, 1e4, 1e5):
        draw = SPRING | {"wedge": wedge(0.4, 0.2), "locked_stiffness_kn_per_mm": locked}
        way = np.r_[np.linspace(0.0, 80.0, 1601), 80.0 - np.geomspace(1e-6, 80.0, 4001)]
        forces = trace(coupling(draw), way, np.repeat([1.0, -1.0], [1601, 4001]))
        put_in, back = work(forces[:1601], way[:1601]), -work(forces[1600:], way[1600:])
        missing.append(exact - (1.0 - back / put_in))
    assert missing[0] / missing[1] == pytest.approx(10.0, rel=0.1)
    assert missing[1] / missing[2] == pytest.approx(10.0, rel=0.1)
    assert 0.0 < missing[2] < 1e-4


@pytest.mark.interpreted
@pytest.mark.parametrize("percent", [0.0, 25.0, 60.0, 100.0])
@pytest.mark.parametrize("each_way", [3, 17, 200])
def test_loss_of_a_damping(percent, each_way):
    put_in, back = cycle(coupling(SPRING | {"damping_percent": percent}), 80.0, each_way, 0.1)
    assert put_in == pytest.approx(WORK_8_9, rel=1e-12)  # independent of the steps
    assert 1.0 - back / put_in == pytest.approx(percent / 100.0, abs=1e-12)


@pytest.mark.interpreted
def test_friction_over_speed():
    # Arshad et al., eq. 1: 0.4 at standstill, 0.2 from 0.1 m/s on, linear between.
    draw = SPRING | LOCKED | {"wedge": wedge(0.4, 0.2)}
    for speed, mu in ((0.0, 0.4), (0.05, 0.3), (0.1, 0.2), (3.0, 0.2)):
        assert trace(coupling(draw), 40.0, speed)[0] == pytest.approx(400.0 * TAN_35 / (TAN_35 - mu), rel=1e-12)
        returned = trace(coupling(draw), [40.0, 30.0], [1.0, -speed])[1]  # 10 mm back are beyond the locked line
        assert returned == pytest.approx(300.0 * TAN_35 / (TAN_35 + mu), rel=1e-12)


@pytest.mark.interpreted
def test_the_four_regimes():
    # Arshad et al., table 2, at a speed where mu is 0.2.
    which = coupling(ARSHAD)
    load, unload = TAN_35 / (TAN_35 - 0.2), TAN_35 / (TAN_35 + 0.2)
    loading = trace(which, [20.0, 60.0], 1.0)
    np.testing.assert_allclose(loading, [200.0 * load, 750.0 * load], rtol=1e-12)
    # Locked unloading: along 600 kN/mm, until the line meets the unloading curve 0.787 mm below.
    release = (750.0 * load - 750.0 * unload) / (600.0 - 25.0 * unload)
    down = trace(which, [60.0, 59.9, 59.5, 60.0 - release, 59.0, 55.0], [1.0, -1.0, -1.0, -1.0, -1.0, -1.0])
    np.testing.assert_allclose(down[:3], 750.0 * load - 600.0 * np.array([0.0, 0.1, 0.5]), rtol=1e-12)
    # Unloading release and unloading: the corner, then the curve.
    np.testing.assert_allclose(down[3:], unload * (750.0 - 25.0 * np.array([release, 1.0, 5.0])), rtol=1e-12)
    # Loaded again it goes back along the locked line, to the loading curve and no further.
    again = trace(which, [60.0, 55.0, 55.2, 60.0], [1.0, -1.0, 1.0, 1.0])
    np.testing.assert_allclose(again[2:], [unload * 625.0 + 600.0 * 0.2, 750.0 * load], rtol=1e-12)


@pytest.mark.interpreted
def test_unloading_never_falls_below_the_relaxing_stiffness():
    draw = {"loading": points((50.0, 100.0)), "damping_percent": 90.0} | RELAXING
    np.testing.assert_allclose(trace(coupling(draw), [50.0, 40.0, 10.0], [1.0, -1.0, -1.0]), [100.0, 24.0, 6.0], rtol=1e-12)


@pytest.mark.interpreted
def test_slack_is_a_dead_zone():
    which = coupling(SPRING, slack_mm=30.0)
    stretch = np.array([-25.0, -15.0, -14.999, 0.0, 14.999, 15.0, 25.0])
    np.testing.assert_allclose(trace(which, stretch, 0.0), [-100.0, 0.0, 0.0, 0.0, 0.0, 0.0, 100.0], rtol=1e-12)


@pytest.mark.interpreted
def test_a_damper_acts_in_the_slack_too():
    which = coupling(SPRING, slack_mm=30.0, damping_kns_per_m=60.0)
    np.testing.assert_allclose(trace(which, [0.0, 25.0, -25.0], [0.5, 0.5, -0.5]), [30.0, 130.0, -130.0], rtol=1e-12)


@pytest.mark.interpreted
def test_a_preload_rises_along_the_locked_line():
    which = coupling(PRELOADED)
    up = trace(which, [0.0, 0.5, 0.9, 2.0, 90.0], 1.0)
    np.testing.assert_allclose(up, [0.0, 125.0, 225.0, 240.0 + 25.7 * 2.0, 2553.0], rtol=1e-12)
    down = trace(which, [90.0, 40.0, 1.0, 0.1, 0.0], [1.0, -1.0, -1.0, -1.0, -1.0])
    np.testing.assert_allclose(down[1:], [50.0 + 2.85 * 40.0, 52.85, 25.0, 0.0], rtol=1e-12)  # 25 = 250 x 0.1


@pytest.mark.interpreted
def test_beyond_the_stroke_it_is_solid_and_loses_nothing():
    which = coupling(PRELOADED)
    forces = trace(which, [90.0, 92.0, 91.0, 90.0], [1.0, 1.0, -1.0, -1.0])
    np.testing.assert_allclose(forces, 2553.0 + 250.0 * np.array([0.0, 2.0, 1.0, 0.0]), rtol=1e-12)


@pytest.mark.interpreted
def test_preloaded_against_each_other_both_sides_act():
    which = coupling({"stiffness_kn_per_mm": 5.0}, buff={"stiffness_kn_per_mm": 3.0}, slack_mm=-20.0)
    # Within 10 mm either side of the middle: 5 (x + 10) - 3 (10 - x); beyond it one side alone.
    np.testing.assert_allclose(trace(which, [-12.0, -10.0, 0.0, 4.0, 10.0, 12.0], 0.0), [-66.0, -60.0, 20.0, 52.0, 100.0, 110.0])


def test_two_in_series_deflect_twice_as_much():
    way = np.array([0.2, 3.0, 50.0, 48.0, 20.0, 60.0, 93.0, 0.1])
    rate = np.sign(np.diff(way, prepend=0.0))
    one, two = coupling(PRELOADED), coupling(PRELOADED | {"in_series": 2})
    np.testing.assert_allclose(trace(two, 2.0 * way, rate), trace(one, way, rate), rtol=1e-12)


@pytest.mark.interpreted
@pytest.mark.parametrize("name", GEARS)
def test_what_is_told_is_what_is_committed(name):
    # `coupling_force` and `commit_coupling` agree, and the former changes nothing: each instant is traced twice.
    which = coupling(GEARS[name], slack_mm=10.0, damping_kns_per_m=20.0)
    way, links = np.array([20.0, 60.0, 58.0, 30.0, -40.0, -20.0]), np.zeros(1, LINK)
    rate = np.sign(np.diff(way, prepend=0.0))
    for x, v in zip(way, rate, strict=True):
        told = trace(which, x, v, links)
        assert 1e-3 * links["force_n"] == told
        assert trace(which, x, v, links) == pytest.approx(told, rel=1e-12)
    np.testing.assert_allclose(1e-3 * links["stretch_m"], way[-1:] * 1e-6)
    assert links["draw_n"] == links["draw_m"] == 0.0
    assert links["buff_m"] == pytest.approx(15e-3)


turns = st.lists(st.floats(-95.0, 95.0), min_size=1, max_size=8)


@pytest.mark.parametrize("name", GEARS)
@given(turns=turns, speed=st.floats(0.02, 2.0), pieces=st.integers(2, 30))
def test_memory_does_not_depend_on_the_steps(name, turns, speed, pieces):
    which = coupling(GEARS[name], slack_mm=10.0)
    ends = np.r_[0.0, turns]
    rate = speed * np.sign(np.diff(ends))
    coarse = trace(which, ends[1:], rate)
    fine = np.concatenate([np.linspace(a, b, pieces + 1)[1:] for a, b in pairwise(ends)])
    found = trace(which, fine, np.repeat(rate, pieces))[pieces - 1 :: pieces]
    np.testing.assert_allclose(found, coarse, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("name", GEARS)
@given(turns=turns, speed=st.floats(0.02, 2.0))
def test_pulling_mirrors_pushing(name, turns, speed):
    which = coupling(GEARS[name], slack_mm=10.0, damping_kns_per_m=20.0)
    rate = speed * np.sign(np.diff(turns, prepend=0.0))
    np.testing.assert_array_equal(trace(which, np.negative(turns), -rate), -trace(which, turns, rate))


@pytest.mark.parametrize("name", GEARS)
@given(turns=turns, speeds=st.lists(st.floats(0.005, 1.0), min_size=9, max_size=9))
def test_no_path_gives_energy(name, turns, speeds):
    # From the free state and back to it, at any speeds; the integral is exact up to the square of the steps.
    which = coupling(GEARS[name], slack_mm=10.0)
    lost, fed = dissipated(which, turns, speeds)
    assert lost > -1e-4 * fed - 1e-6


def dissipated(which, turns, speeds, pieces=400):
    """Return the work that stays in a coupling over a path out and back to 0, and all that was put in on it [J]."""
    ends = np.r_[0.0, turns, 0.0]
    way = np.concatenate([np.linspace(a, b, pieces + 1) for a, b in pairwise(ends)])
    rate = np.repeat(np.sign(np.diff(ends)) * speeds[: ends.size - 1], pieces + 1)  # each way begins at its own speed
    forces = trace(which, way, rate)
    parts = 0.5 * (forces[1:] + forces[:-1]) * np.diff(way)
    return float(parts.sum()), float(parts[parts > 0.0].sum())


def test_friction_that_falls_with_speed_needs_a_locked_stiffness():
    # What `wedge_without_locked_stiffness` refuses: loaded fast at mu 0.2, unloaded slowly at nearly 0.4.
    free = coupling(SPRING | {"wedge": wedge(0.4, 0.2)})
    lost, fed = dissipated(free, [80.0], [1.0, 0.001])
    assert lost < -0.5 * fed
    lost, fed = dissipated(coupling(ARSHAD), [80.0], [1.0, 0.001])
    assert lost > 0.4 * fed


@pytest.mark.parametrize("name", GEARS)
def test_force_is_continuous_where_it_bends(name):
    # Around every kink of x and v, at rest and committed elsewhere: no jump.
    which = coupling(GEARS[name], slack_mm=10.0)
    tables = coupling_tables(which)
    row = tables.gears[0]
    kinks = {0.0, *(tables.curves["x"]), *([row["stroke_m"]] if np.isfinite(row["stroke_m"]) else [])}
    speeds = (0.0, row["blending_mps"], -row["blending_mps"])
    for x in {1e3 * kink + 5.0 for kink in kinks} | {5.3, 33.0}:
        for v in speeds:
            for e, dv in ((1e-7, 0.0), (0.0, 1e-9)):
                links = np.zeros(1, LINK)
                trace(which, [60.0], [1.0], links)
                low, high = (trace(which, x + s * e, v + s * dv, links.copy())[0] for s in (-1.0, 1.0))
                assert high == pytest.approx(low, abs=1.5e-3)


def test_damping_of_the_parts_in_series_burns_its_share_and_never_pulls():
    """A linear spring of 10 kN/mm with 100 kN s/m in series parts: loaded 40 mm at 0.5 m/s and unloaded again."""
    stiff = {"stiffness_kn_per_mm": 10.0, "locked_damping_kns_per_m": 100.0}
    made = coupling(stiff, slack_mm=20.0)
    x = np.concatenate([np.linspace(0.0, 0.05, 2001), np.linspace(0.05, 0.0, 2001)[1:]])
    force = loop(made, 1e3 * x, 0.5)
    opening = force[2001:]
    assert force[:400] == pytest.approx(0.0)  # in the slack nothing resists
    assert force[2000] == pytest.approx(10.0 * 40.0 + 100.0 * 0.5)
    assert opening.min() == 0.0
    # 2 c v over the way, but where the spring is weaker than the damper, which takes what the spring gives
    weak = 100.0 * 0.5 / 10.0  # mm
    burnt = 50.0 * 40.0 + 50.0 * (40.0 - weak) + 0.5 * 50.0 * weak
    middle = 0.5 * (force[1:] + force[:-1])
    assert (middle * np.diff(1e3 * x)).sum() == pytest.approx(burnt, rel=2e-3)
    assert greatest_damping(made) == pytest.approx(1e5)
