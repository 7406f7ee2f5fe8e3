"""Characteristics of the fixed devices as segments I(U) = a + b U + c/U, counted as taken from the line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S
from tractionpower.model.limits import SystemVoltages
from tractionpower.model.loads import Load
from tractionpower.model.supply import Substation

Segments = list[tuple[float, float, float, float]]
"""Rows (from_v, a, b, c) with rising `from_v`; the first holds downwards without end."""

NO_FLOOR_V = 0.0
CEILING_RAMP_V = 1e-3
"""Width of a hard ceiling [V]."""

_DOWN = float("-inf")


def source_segments(substation: Substation) -> Segments:
    """Return I(U) of a substation: ``-max(0, (E - U)/R)``, or linear when it conducts both ways.

    A blocked rectifier keeps a tiny conductance, so that a network whose rectifiers all block does not float.
    """
    e = no_load_voltage(substation)
    g = 1.0 / internal_resistance(substation)
    conducting = (_DOWN, -e * g, g, 0.0)
    if substation.conducts == "both":
        return [conducting]
    return [conducting, (e, -e * BLOCKED_CONDUCTANCE_S, BLOCKED_CONDUCTANCE_S, 0.0)]


def internal_resistance(substation: Substation) -> float:
    """Return the internal resistance with the units that are in service [ohm]; with none, that of all.

    R(k) = R_unit/k + R_grid: the transformers and rectifiers of k units in parallel, behind the one grid.
    """
    k = substation.units_in_service or substation.units
    grid = substation.grid_resistance_ohm
    return (substation.plant_resistance_ohm - grid) * substation.units / k + grid


def dissipative_resistance(substation: Substation) -> float | None:
    """Return the dissipative part of the internal resistance with the units in service [ohm], None where not given.

    The grid is taken to dissipate nothing.
    """
    k, given = substation.units_in_service or substation.units, substation.plant_dissipative_ohm
    return None if given is None else given * substation.units / k


def dissipative_resistances(substations: Sequence[Substation]) -> NDArray[np.float64]:
    """Return the dissipative parts of the internal resistances with the units in service [ohm]; NaN where not given."""
    given = (dissipative_resistance(substation) for substation in substations)
    return np.array([np.nan if ohm is None else ohm for ohm in given], float)


def no_load_voltage(substation: Substation) -> float:
    """Return the no-load voltage E at the present grid voltage [V]."""
    return substation.no_load_voltage_v * substation.grid_voltage_pu


def load_segments(load: Load, voltages: SystemVoltages) -> Segments:
    """Return I(U) of a fixed load, with the limits of its voltage range or, for ``limits: none``, without.

    Constant between U_min2 and U_max2, below linear in U to zero at 0 V; what feeds back is reduced linearly from
    `fold_back_from_v` (default U_max1) to zero at U_max2. All of it is proportional to power or current, so a profile
    is the characteristic of its greatest value times a factor (`load_steps`).
    """
    low = floor_voltage(load, voltages) or voltages.u_min2
    value = greatest_demand(load)
    if is_power(load):
        power = 1000.0 * value
        constant: tuple[float, float, float] = (0.0, 0.0, power)
        at_low = power / low
    else:
        constant = (value, 0.0, 0.0)
        at_low = value
    segments: Segments = [(_DOWN, 0.0, 0.0, 0.0), (0.0, 0.0, at_low / low, 0.0), (low, *constant)]
    if load.limits == "range" and at_low < 0.0:
        high = voltages.u_max2
        from_v = min(load.fold_back_from_v or voltages.u_max1, high - CEILING_RAMP_V)
        a, _, c = constant
        width = high - from_v
        # (a + c/U) (high - U)/width
        segments += [(from_v, (a * high - c) / width, -a / width, c * high / width), (high, 0.0, 0.0, 0.0)]
    return segments


def is_power(load: Load) -> bool:
    """Tell whether a load is given by its power; else by its current."""
    return load.power_kw is not None if load.profile is None else load.profile[0].power_kw is not None


def greatest_demand(load: Load) -> float:
    """Return the power [kW] or current [A] of a load, of a profile the one with the greatest absolute value."""
    if load.profile is not None:
        return max((row.value for row in load.profile), key=abs)
    return load.power_kw if load.power_kw is not None else load.current_a or 0.0


def load_steps(load: Load) -> list[tuple[float, float]]:
    """Return from when [s after midnight] which part of its greatest demand a load takes; before the first nothing."""
    base = greatest_demand(load)
    if load.profile is None or base == 0.0:
        return [(_DOWN, 1.0)]
    return [(row.time, row.value / base) for row in load.profile]


def floor_voltage(load: Load, voltages: SystemVoltages) -> float:
    """Return the voltage below which a load without limits counts as not served [V]; 0 for a load with limits.

    No solution on the upper branch lies there: one load alone folds at half the no-load voltage.
    """
    return NO_FLOOR_V if load.limits == "range" else 0.05 * voltages.u_n
