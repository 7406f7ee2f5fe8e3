"""Units as they are written in the files of Arshad et al., and what they are in the units of the declarations."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal

FOOT_M = 0.3048
MILE_KM = 1.609344
INCH_M = 0.0254
POUND_KG = 0.45359237
POUND_N = 4.4482216152605
SHORT_TON_T = 0.90718474
PSI_BAR = POUND_N / INCH_M**2 * 1e-5
LB_PER_TON = 0.5
"""Resistance of 1 lb per short ton of 2000 lb [N/kN]."""

Dimension = Literal[
    "time", "length", "stiffness", "damping", "angle", "speed", "pressure", "share", "force", "power", "mass", "area",
    "resistance", "speed_resistance", "curve_resistance", "grade", "degrees", "number", "count",
]  # fmt: skip

UNITS: dict[Dimension, dict[str, float]] = {
    "time": {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "min": 60.0},
    "length": {
        "m": 1.0, "metre": 1.0, "metres": 1.0, "meter": 1.0, "meters": 1.0, "km": 1000.0, "mm": 1e-3,
        "ft": FOOT_M, "feet": FOOT_M, "foot": FOOT_M, "in": INCH_M, "mi": 1000.0 * MILE_KM, "mile": 1000.0 * MILE_KM,
        "miles": 1000.0 * MILE_KM,
    },  # [m]
    "stiffness": {"n/mm": 1e-3, "kn/mm": 1.0, "mn/m": 1.0, "n/m": 1e-6, "lb/in": POUND_N / INCH_M * 1e-6},  # [kN/mm]
    "damping": {"ns/mm": 1.0, "kns/m": 1.0, "ns/m": 1e-3, "lbs/in": POUND_N / INCH_M * 1e-3},  # [kN s/m]
    "angle": {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "°": 1.0},
    "speed": {"m/s": 1.0, "km/h": 1.0 / 3.6, "kmh": 1.0 / 3.6, "mph": MILE_KM / 3.6, "ft/s": FOOT_M},  # [m/s]
    "pressure": {"psi": PSI_BAR, "psig": PSI_BAR, "bar": 1.0, "kpa": 0.01},  # [bar], gauge
    "share": {"": 1.0, "%": 0.01, "percent": 0.01},
    "force": {"kn": 1.0, "n": 1e-3, "lb": POUND_N * 1e-3, "lbf": POUND_N * 1e-3, "kip": POUND_N, "kips": POUND_N},  # [kN]
    "power": {"kw": 1.0, "mw": 1000.0, "hp": 550.0 * FOOT_M * POUND_N * 1e-3},  # [kW]
    "mass": {
        "t": 1.0, "tonne": 1.0, "tonnes": 1.0, "kg": 1e-3, "lb": POUND_KG * 1e-3, "lbs": POUND_KG * 1e-3,
        "ton": SHORT_TON_T, "tons": SHORT_TON_T, "shortton": SHORT_TON_T, "shorttons": SHORT_TON_T,
    },  # [t]
    "area": {"m2": 1.0, "ft2": FOOT_M**2, "sqft": FOOT_M**2, "sqm": 1.0},
    "resistance": {"": 1000.0, "n/kn": 1.0, "lb/ton": LB_PER_TON},  # [N/kN]
    "speed_resistance": {"n/kn/(km/h)": 1.0, "lb/ton/mph": LB_PER_TON / MILE_KM},  # [N/kN/(km/h)]
    "curve_resistance": {"n/kn/deg": 1.0, "lb/ton/deg": LB_PER_TON},  # [N/kN] per degree
    "grade": {"%": 10.0, "percent": 10.0, "‰": 1.0, "permille": 1.0},  # [permille]
    "degrees": {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "°": 1.0},  # of a curve, by a chord of 100 ft
    "number": {"": 1.0},
    "count": {"": 1.0},
}  # fmt: skip
"""Factors by unit as `plain_unit` returns it. The ton is the short ton of 2000 lb, as in eq. 10; t is the metric one."""

BARE: dict[Dimension, str] = {
    "time": "s", "stiffness": "n/mm", "angle": "deg", "pressure": "psi", "share": "", "resistance": "", "number": "",
    "count": "", "grade": "%", "degrees": "deg",
}  # fmt: skip
"""What a number without a unit is taken for; a dimension that is not here needs one."""

_NUMBER = re.compile(r"(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>(?![,\d.]).*)")


@dataclass(frozen=True, slots=True)
class Told:
    """Why a text is no value: what stands there, what may, what to do."""

    found: str
    allowed: str
    remedy: str = ""


def plain_unit(text: str) -> str:
    """Return a unit without blanks, points and capitals.

    >>> plain_unit(" sq. ft"), plain_unit("N/mm")
    ('sqft', 'n/mm')
    """
    return re.sub(r"[\s.^]", "", text).lower().replace("percentage", "percent")


def allowed_units(dimension: Dimension) -> str:
    """Return the units of a dimension for a message."""
    return ", ".join(unit for unit in UNITS[dimension] if unit)


def read_quantity(text: str, dimension: Dimension, unit: str | None = None) -> float | Told:
    """Return the value of a text such as ``6000.0 n/mm`` in the unit of the declarations.

    Parameters
    ----------
    text
        A number, and its unit behind it.
    dimension
        What it is.
    unit
        Unit of a number without one, as a header says it; None: that of `BARE`.
    """
    units = UNITS[dimension]
    match = _NUMBER.fullmatch(text.strip())
    if match is None:
        remedy = "write the decimals with a point" if re.fullmatch(r"[-+]?\d+,\d+.*", text.strip()) else ""
        known = allowed_units(dimension)
        return Told(f"'{text}'", "a number" + (f" with a unit: {known}" if known else ""), remedy)
    given = plain_unit(match["unit"])
    if not given:
        given = BARE.get(dimension, "") if unit is None else unit
    if given not in units:
        allowed = f"a number with a unit: {allowed_units(dimension)}" if allowed_units(dimension) else "a number without a unit"
        return Told(f"'{text}', without a unit" if not match["unit"] else f"the unit in '{text}'", allowed)
    value = float(match["number"])
    if not math.isfinite(value):
        return Told(f"'{text}'", "a finite number")
    if dimension == "count" and value != round(value):
        return Told(f"'{text}'", "a whole number")
    return value * units[given]
