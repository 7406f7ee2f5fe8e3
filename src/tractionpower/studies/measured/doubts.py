"""Whether a measured series looks as if its unit, its decimal sign or its sign were another than the map says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tractionpower.errors import Problem
from tractionpower.io.wording import shown
from tractionpower.model.measured import MeasuredSeries
from tractionpower.model.quantity import unit_of
from tractionpower.studies.measured.errors import Compared
from tractionpower.studies.measured.numbers import name_of

OPPOSITE = -0.5
"""Correlation below which two series run against each other."""

ALIKE = 0.8
"""Correlation from which on a factor between two series is taken for one of units."""

THOUSAND = (400.0, 2500.0)
"""Ratios of two series that are taken for a thousand; a model that is wrong by so much is no model."""

SMALLER = {"V": "kV", "A": "kA", "kW": "MW", "km": "m", "m": "km", "kN": "N", "m/s²": ""}


def doubts_of(
    each: MeasuredSeries, compared: Compared, figures: Mapping[str, float], cells: Sequence[str], place: str
) -> list[Problem]:
    """Return warnings on a series.

    Parameters
    ----------
    each
        What the map says.
    compared, figures
        The series beside the computed one, and their errors.
    cells
        Some cells of the column as they are written.
    place
        File and line of the series in the map.
    """
    both = compared.both
    if not both.any():
        return []
    typical = [float(np.sqrt(np.median(values[both] ** 2))) for values in (compared.measured, compared.computed)]
    if min(typical) <= 0.0:
        typical = [figures["rms_measured"], figures["rms_computed"]]
    ratio = typical[0] / typical[1] if min(typical) > 0.0 else np.nan
    unit = unit_of(each.quantity)
    found = f"measured values are typically {_brief(typical[0])} {unit}, computed ones {_brief(typical[1])} {unit}"
    problems = []
    if THOUSAND[0] < ratio < THOUSAND[1] or THOUSAND[0] < 1.0 / ratio < THOUSAND[1]:
        problems.append(_warn("unit", found, _thousandfold(each, ratio > 1.0, cells), place))
    elif unit == "km/h" and figures["correlation"] > ALIKE:
        for factor, words in ((1.0 / 3.6, "m/s"), (3.6, "km/h, where the map says m/s")):
            if 0.85 * factor < ratio < factor / 0.85:
                problems.append(_warn("unit", found, f"it looks like {words}: mend unit in the map", place))
    if figures["correlation"] < OPPOSITE:
        words = f"measured and computed values run against each other (correlation {figures['correlation']:.2f})"
        problems.append(_warn("sign", words, f"say sign: {-each.sign} in the map if the file counts the other direction", place))
    return problems


def _thousandfold(each: MeasuredSeries, larger: bool, cells: Sequence[str]) -> str:
    written = each.unit or unit_of(each.quantity)
    example = next((cell for cell in cells if "," in cell or "." in cell), "")
    sign = "," if "," in example else "." if "." in example else ""
    whole, _, rest = example.partition(sign) if sign else ("", "", "")
    if not larger:
        words = f"it looks like {SMALLER[unit_of(each.quantity)] or 'another unit'}, where the map says {written}"
        if sign and len(rest) == 3 and whole.lstrip("+-").isdigit():
            other = "." if sign == "," else ","
            words += f"; or the sign in {shown(example)} separates thousands: say decimal: {name_of(other)} in the map"
        return f"{words}; mend the map"
    words = f"it looks like {unit_of(each.quantity)}, where the map says {written}" if each.unit else "mend unit in the map"
    return f"{words}; or a decimal sign was lost" + (f", as in {shown(example)}" if sign else "")


def _brief(value: float) -> str:
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _warn(code: str, found: str, remedy: str, place: str) -> Problem:
    return Problem(code, "", found, remedy=remedy, severity="warning", place=place)
