"""Characteristics by segments: currents, slopes, kinks and tangents."""

from itertools import pairwise

import numpy as np
import pytest
from solved import LIMITS, Solved, single_line, tap

from tractionpower.kernels.ports import find_segment, linearise, port_current, port_integral, steepest
from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S, PORT, SEGMENT
from tractionpower.model.limits import system_voltages
from tractionpower.model.supply import Substation
from tractionpower.supply.characteristics import load_segments, source_segments

VOLTAGES = system_voltages(LIMITS, "dc3000")


def port(rows, scale=1.0):
    segments = np.array(rows, SEGMENT)
    ports = np.zeros(1, PORT)
    ports["segments"], ports["scale"] = len(rows), scale
    return segments, ports[0]


def current(rows, u, scale=1.0):
    segments, record = port(rows, scale)
    return port_current(segments, record, u)


def load(**more):
    return load_segments(tap("x", 1.0, **more), VOLTAGES)


def station(**more):
    return Substation(id="A", km=0.0, no_load_voltage_v=3600.0, internal_resistance_ohm=0.12, **more)


@pytest.mark.parametrize(
    ("u", "expected"), [(-5.0, 0.0), (0.0, 0.0), (1000.0, 750.0), (2000.0, 1500.0), (3000.0, 1000.0), (4500.0, 3e6 / 4500)]
)
def test_a_load_of_constant_power(u, expected):
    assert current(load(kw=3000.0), u) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("u", "expected"), [(1000.0, 400.0), (2000.0, 800.0), (3900.0, 800.0)])
def test_a_load_of_constant_current(u, expected):
    assert current(load(ampere=800.0), u) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("fold", "u", "expected"),
    [
        (None, 3000.0, -1000.0), (None, 3600.0, -3e6 / 3600), (None, 3750.0, -400.0), (None, 3900.0, 0.0), (None, 4100.0, 0.0),
        (3700.0, 3650.0, -3e6 / 3650), (3700.0, 3800.0, -3e6 / 3800 / 2),
        (3900.0, 3899.998, -3e6 / 3899.998), (3900.0, 3899.9995, -0.5 * 3e6 / 3899.9995), (3900.0, 3900.0, 0.0),
    ],
)  # fmt: skip
def test_feeding_back_is_folded_to_zero(fold, u, expected):
    assert current(load(kw=-3000.0, fold_back_from_v=fold), u) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_limits_none_hold_at_any_voltage():
    assert current(load(kw=3000.0, limits="none"), 300.0) == pytest.approx(10_000.0)
    assert current(load(kw=-3000.0, limits="none"), 6000.0) == pytest.approx(-500.0)


def test_a_rectifier_blocks_and_a_two_way_source_does_not():
    assert current(source_segments(station()), 3480.0) == pytest.approx(-1000.0)
    assert current(source_segments(station()), 3700.0) == pytest.approx(100.0 * BLOCKED_CONDUCTANCE_S, rel=1e-6)
    assert current(source_segments(station(conducts="both")), 3720.0) == pytest.approx(1000.0)
    assert current(source_segments(station(grid_voltage_pu=0.95)), 3300.0) == pytest.approx(-1000.0)


@pytest.mark.parametrize(
    "rows",
    [load(kw=3000.0), load(kw=-3000.0), load(ampere=-700.0, fold_back_from_v=3700.0), load(kw=-1.0, fold_back_from_v=3900.0),
     load(kw=500.0, limits="none"), load(kw=-500.0, limits="none"), source_segments(station())],
)  # fmt: skip
def test_characteristics_are_continuous_at_their_breaks(rows):
    segments, _ = port(rows)
    for before, after in pairwise(segments):
        u = float(after["from_v"])
        left, right = (float(s["a"] + s["b"] * u + (s["c"] / u if s["c"] else 0.0)) for s in (before, after))
        assert right == pytest.approx(left, rel=1e-6, abs=2e-6)


def test_the_scale_switches_a_port():
    assert current(load(kw=3000.0), 3000.0, scale=0.25) == pytest.approx(250.0)
    assert current(load(kw=3000.0), 3000.0, scale=0.0) == 0.0


def slope_at(rows, u, near_v):
    segments, record = port(rows)
    return steepest(segments, record, find_segment(segments, record, u), u, near_v)


def test_near_a_kink_the_larger_slope_counts():
    conducting = pytest.approx(1.0 / 0.12)
    assert slope_at(source_segments(station()), 3600.0, 1e-6) == conducting  # a diode at its no-load voltage conducts
    assert slope_at(source_segments(station()), 3600.0 + 0.9e-6, 1e-6) == conducting
    assert slope_at(source_segments(station()), 3600.1, 1e-6) == BLOCKED_CONDUCTANCE_S
    assert slope_at(load(kw=3000.0), 2000.0, 1e-6) == pytest.approx(3e6 / 2000.0**2)  # resistance below, falling above
    assert slope_at(load(kw=-3000.0), 2000.0, 1e-6) == pytest.approx(3e6 / 2000.0**2)  # rising current above
    assert slope_at(load(kw=-3000.0), 3900.0 - 0.5e-6, 1e-6) > 2.0


def test_the_tangent_touches():
    solved = Solved(*single_line([tap("x", 10.0, kw=4000.0)]))
    work, network = solved.work, solved.network
    work.ports["u"][2] = 3000.0
    linearise(network, work, 1.0, -1.0, 1e-6)
    assert work.ports["g"][2] == pytest.approx(-4e6 / 3000.0**2)
    assert work.ports["g"][2] * 3000.0 + work.ports["j"][2] == pytest.approx(4e6 / 3000.0)
    linearise(network, work, 0.0, -1.0, 1e-6)
    assert work.ports["g"][2] == 0.0
    assert work.ports["j"][2] == pytest.approx(4e6 / 3000.0)


def test_what_is_not_a_number_is_an_infinite_gap():
    solved = Solved(*single_line([tap("x", 10.0, kw=4000.0)]))
    solved.work.ports["u"][0] = np.nan
    assert linearise(solved.network, solved.work, 1.0, -1.0, 1e-6) == np.inf


@pytest.mark.parametrize("rows", [load(kw=3000.0), load(kw=-3000.0), source_segments(station())])
def test_the_integral_is_that_of_the_current(rows):
    segments, record = port(rows)
    grid = np.linspace(-50.0, 4200.0, 400_001)
    currents = [port_current(segments, record, u) for u in grid]
    assert port_integral(segments, record, -50.0, 4200.0) == pytest.approx(np.trapezoid(currents, grid), rel=1e-6)
    assert port_integral(segments, record, 4200.0, -50.0) == -port_integral(segments, record, -50.0, 4200.0)
