"""Units of a substation: one that is out changes the slope of the busbar and not its voltage without load."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.model.change import apply_changes
from tractionpower.model.library import Library
from tractionpower.model.supply import Substation
from tractionpower.supply.characteristics import (
    dissipative_resistance,
    internal_resistance,
    no_load_voltage,
    source_segments,
)

OHMS = st.floats(1e-3, 5.0)
UNITS = st.integers(1, 6).flatmap(lambda n: st.tuples(st.just(n), st.integers(1, n)))
BY_UNIT = {"unit_resistance_ohm": 0.2, "grid_resistance_ohm": 0.02, "dissipative_resistance_ohm": 0.06, "units": 2}
HALVES = {"internal_resistance_ohm": 0.12, "grid_resistance_ohm": 0.02, "dissipative_resistance_ohm": 0.03, "units": 2}


def plant(units, in_service=None, **how):
    more = {"dissipative_resistance_ohm": None} | how
    return Substation(id="A", km=0.0, no_load_voltage_v=3500.0, units=units, units_in_service=in_service, **more)


def current(substation, voltage_v):
    """Return what a substation feeds at a voltage of its busbar [A], by its segments."""
    _, a, b, c = next(row for row in reversed(source_segments(substation)) if voltage_v >= row[0])
    return -(a + b * voltage_v + (c / voltage_v if c else 0.0))


@settings(derandomize=True, deadline=None)
@given(UNITS, OHMS, st.floats(0.0, 2.0), st.floats(0.5, 1.5))
def test_a_unit_out_changes_the_slope_and_not_the_voltage_without_load(units, unit_ohm, grid_ohm, grid_pu):
    n, k = units
    substation = plant(n, k, unit_resistance_ohm=unit_ohm, grid_resistance_ohm=grid_ohm, grid_voltage_pu=grid_pu)
    no_load_v = 3500.0 * grid_pu
    assert no_load_voltage(substation) == no_load_voltage(plant(n, unit_resistance_ohm=unit_ohm, grid_voltage_pu=grid_pu))
    assert current(substation, no_load_v * (1.0 - 1e-12)) == pytest.approx(0.0, abs=1e-5)
    fallen_v = no_load_v - 100.0
    assert 100.0 / current(substation, fallen_v) == pytest.approx(unit_ohm / k + grid_ohm, rel=1e-9)


@settings(derandomize=True, deadline=None)
@given(UNITS, OHMS, st.floats(0.0, 2.0), st.floats(0.0, 1.0))
def test_both_ways_to_give_a_plant_are_one(units, unit_ohm, grid_ohm, heat):
    n, k = units
    by_unit = {"unit_resistance_ohm": unit_ohm, "dissipative_resistance_ohm": heat * unit_ohm}
    whole = {"internal_resistance_ohm": unit_ohm / n + grid_ohm, "dissipative_resistance_ohm": heat * unit_ohm / n}
    if whole["internal_resistance_ohm"] <= grid_ohm:  # the units vanish beside the grid, in floating point
        return
    one, other = (plant(n, k, grid_resistance_ohm=grid_ohm, **how) for how in (by_unit, whole))
    assert one.plant_resistance_ohm == pytest.approx(other.plant_resistance_ohm, rel=1e-12)
    assert internal_resistance(one) == pytest.approx(internal_resistance(other), rel=1e-9)
    assert dissipative_resistance(one) == pytest.approx(dissipative_resistance(other), rel=1e-12)
    assert dissipative_resistance(one) == pytest.approx(heat * unit_ohm / k, rel=1e-12)


def run_with(units_in_service=None, **how):
    """Return the rows of substation A of a run with a load beside it and B far away."""
    plant_a = {"units_in_service": units_in_service} | (how or BY_UNIT)
    stations = [station("A", 0.0, internal_resistance_ohm=None) | plant_a, station("B", 20.0)]
    results, outcome, _ = run_in_memory(make_scenario(load("x", 2.0), load("y", 16.0, "2"), substations=stations))
    assert outcome.run["status"] == "complete"
    return results.table("substations").set_index("substation").loc["A"]


@pytest.mark.parametrize("units_in_service", [1, 2])
def test_a_run_shows_slope_and_heat_of_the_units_in_service(units_in_service):
    rows = run_with(units_in_service)
    ohm = 0.2 / units_in_service + 0.02
    np.testing.assert_allclose((3600.0 - rows["voltage_v"]) / rows["current_a"], ohm, rtol=2e-4)  # tables have single precision
    np.testing.assert_allclose(rows["loss_kw"], 0.06 / units_in_service * rows["current_a"] ** 2 / 1000.0, rtol=1e-5)
    assert (rows["current_a"] > 300.0).all()


def test_a_run_is_the_same_whichever_way_the_plant_is_given():
    for units in (None, 1):
        one, other = run_with(units, **BY_UNIT), run_with(units, **HALVES)
        columns = ["voltage_v", "current_a", "power_kw", "loss_kw"]
        np.testing.assert_allclose(one[columns], other[columns], rtol=1e-6)


def test_no_unit_in_service_is_the_state_rectifiers_out():
    none, out = run_with(0), run_with(**BY_UNIT, state="rectifiers_out")
    np.testing.assert_array_equal(none[["current_a", "voltage_v", "loss_kw"]], out[["current_a", "voltage_v", "loss_kw"]])
    assert (none["current_a"] == 0.0).all()
    assert none["voltage_v"].between(2000.0, 3600.0).all()  # its busbar still ties the tracks


def test_another_number_of_units_is_another_plant():
    stations = [{k: v for k, v in station("A", 0.0, **BY_UNIT).items() if k != "internal_resistance_ohm"}]
    changed = apply_changes(make_scenario(substations=stations), ["supply.substations[A].units=4"], Library())
    (substation,) = changed.supply.substations
    assert internal_resistance(substation) == pytest.approx(0.2 / 4 + 0.02)
    assert dissipative_resistance(substation) == pytest.approx(0.06 / 4)
