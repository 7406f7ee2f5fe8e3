"""Units that the figures of train dynamics are drawn in: those of the tables, or those of North American railways."""

from __future__ import annotations

from dataclasses import dataclass

from tractionpower.reporting.texts import mark


@dataclass(frozen=True, slots=True)
class Measure:
    """A unit that a quantity is shown in.

    Attributes
    ----------
    unit
        How it is written.
    per
        How many of it make one unit of the tables.
    digits
        Digits that a number in a sentence has.
    """

    unit: str
    per: float
    digits: int = 1


METRIC: dict[str, Measure] = {
    "speed": Measure("km/h", 1.0),
    "force": Measure("kN", 1.0),
    "effort": Measure("kN", 1.0),
    "acceleration": Measure("m/s²", 1.0, 2),
    "distance": Measure("m", 1.0),
    "deflection": Measure("mm", 1.0),
    "pressure": Measure("bar", 1.0, 2),
    "energy": Measure("kWh", 1.0, 2),
}
"""Units of the tables."""

POUND_KN = 0.45359237 * 9.80665 / 1000.0
"""A pound-force [kN]."""

FOOT_M = 0.3048
MILE_KM = 1.609344

IMPERIAL: dict[str, Measure] = {
    "speed": Measure("mph", 1.0 / MILE_KM),
    "force": Measure("kip", 1.0 / (1000.0 * POUND_KN)),  # 1000 lbf
    "effort": Measure("lbf", 1.0 / POUND_KN, 0),
    "acceleration": Measure("mph/s", 3.6 / MILE_KM, 2),
    "distance": Measure("ft", 1.0 / FOOT_M, 0),
    "deflection": Measure("in", 1.0 / 25.4, 2),
    "pressure": Measure("psi", 100.0 / (POUND_KN / 0.0254**2), 1),  # 100 kPa over a pound on a square inch
    "energy": Measure("kWh", 1.0, 2),
}
"""Units of the case of Arshad et al., and of North American railways."""

WORDS = {
    "speed": mark("speed"),
    "force": mark("force"),
    "effort": mark("effort"),
    "acceleration": mark("acceleration"),
    "distance": mark("distance"),
    "deflection": mark("deflection"),
    "pressure": mark("pressure"),
    "energy": mark("energy"),
}
"""What the quantities are called."""


def measures(units: str) -> dict[str, Measure]:
    """Return the measures of ``metric`` or ``imperial``.

    >>> round(measures("imperial")["speed"].per * 100.0, 2), round(measures("imperial")["pressure"].per, 4)
    (62.14, 14.5038)
    """
    return IMPERIAL if units == "imperial" else METRIC
