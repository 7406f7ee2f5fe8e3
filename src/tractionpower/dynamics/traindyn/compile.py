"""Characteristics of a train as rows of numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import UsageError
from tractionpower.kernels.point_mass import EFFORT
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.dynamics.point_mass import SpecificResistance, TrainCharacteristics

KMH = 3.6

SINGLE_TRACK_TUNNEL, DOUBLE_TRACK_TUNNEL = 2e-3, 1e-3
"""Resistance of a tunnel over weight [N/N] (TrainDyn, 2.2.1)."""


def compile_effort(characteristics: TrainCharacteristics) -> NDArray[np.void]:
    """Return the points of the tractive characteristic; none where it is an effort and a power."""
    return np.array([(p.speed_kmh / KMH, 1e3 * p.effort_kn) for p in characteristics.effort], EFFORT)


def write_characteristics(characteristics: TrainCharacteristics, row: NDArray[np.void]) -> None:
    """Write characteristics into the row of a train, a record of `POINT_MASS` (TrainDyn, eq. 9 and 10)."""
    mass = 1e3 * characteristics.mass_t
    row["inertia_kg"] = mass * characteristics.inertia_factor
    row["weight_n"] = mass * GRAVITY
    own, hauled = characteristics.resistance, characteristics.hauled_resistance or characteristics.resistance
    parts = (_newtons(own, characteristics.locomotive_mass_t), _newtons(hauled, characteristics.hauled_mass_t))
    row["a_n"], row["b_ns_per_m"], row["c_ns2_per_m2"] = (sum(column) for column in zip(*parts, strict=True))
    row["start_n"] = 1e3 * (characteristics.starting_effort_kn or 0.0)
    row["power_w"] = 1e3 * (characteristics.power_kw or 0.0)
    row["brake_mps2"] = characteristics.braking_mps2


def _newtons(resistance: SpecificResistance, mass_t: float) -> tuple[float, float, float]:
    """Return a [N], b [N s/m], c [N s2/m2] of vehicles of some mass."""
    weight_kn = mass_t * GRAVITY
    return (
        weight_kn * resistance.a_n_per_kn,
        weight_kn * resistance.b_n_per_kn_per_kmh * KMH,
        weight_kn * resistance.c_n_per_kn_per_kmh2 * KMH**2,
    )


def arc_resistance(radius_m: float, law: tuple[float, float] | None = None) -> float:
    """Return the resistance of an arc over weight [N/N], a / (R - b) in N/kN (TrainDyn, eq. 15).

    Parameters
    ----------
    radius_m
        Radius [m].
    law
        a [N m/kN] and b [m]; None: Roeckl, (650, 55) from a radius of 300 m on, (500, 30) below.

    Raises
    ------
    UsageError
        If the formula has no value at the radius.
    """
    a, b = law if law is not None else (650.0, 55.0) if radius_m >= 300.0 else (500.0, 30.0)
    if not radius_m > b:
        raise UsageError(
            f"an arc with a radius of {radius_m:g} m has no resistance by {a:g}/(R - {b:g}); it must be above {b:g} m"
        )
    return a / (1e3 * (radius_m - b))
