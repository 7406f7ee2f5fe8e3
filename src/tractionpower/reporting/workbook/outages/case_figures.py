"""Figures of the cases of a study of outages: where the workbook has them and their limits, and what a case tells of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.reporting.facts.outages import COMPUTED
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.page import Column

Case = Mapping[str, Any]

NOT_COMPUTED = mark("not computed")
GRID_WORDS = {"normal": mark("normal"), "low": mark("low"), "high": mark("high")}


def grid_in_words(grid: object) -> str:
    """Return the voltage of the feeding grid in a word."""
    return tr(GRID_WORDS.get(str(grid), str(grid)))


FIRST = (Column("what is out", widest=44), Column("grid voltage", "beside", 10))

COUNTS = frozenset({"overloaded", "late_trains", "stuck_trains", "dark_trains", "unfinished_trains", "unserved_loads", "trips"})
"""Figures that are 0 also in cases that were not computed."""


DEVICES = ("utilisation_device", "breaker_device")
"""Figures of a case that name a device."""


def limit_name(limit: str) -> str:
    """Return the name of the cell with a limit on the sheet of the cases' figures."""
    return f"case_limit_{limit}"


def tolerance_of(limit: str) -> str:
    """Return the name of the cell with the tolerance of a limit on the same sheet."""
    return f"case_tolerance_{limit}"


def range_name(figure: str) -> str:
    """Return the name of the range with a figure of all cases."""
    return f"cases_{figure}"


def figure_of(case: Case, name: str) -> Any:
    """Return a figure of a case, None where it has none."""
    value = case.get(name)
    return None if value is None or (name in COUNTS and case["status"] not in COMPUTED) else value
