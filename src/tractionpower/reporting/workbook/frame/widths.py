"""How wide what a table shows is, and headings as Excel wants them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.reporting.workbook.frame.cells import shorten

HEADING_LENGTH = 80
"""Characters of a heading; Excel's limit is 255."""

LONGEST_WORD = 24
"""Characters of a word in a heading that its column makes room for."""

_DIGITS = {"0": 0, "0.0": 1, "0.00": 2, "0.000": 3, "0.0000": 4, "0.00000": 5}


def told_apart(headings: Sequence[str]) -> list[str]:
    """Return headings as Excel wants them in a filtered table: short, and no two that differ by case alone."""
    shown: list[str] = []
    taken: set[str] = set()
    for each in headings:
        short = heading = shorten(each, HEADING_LENGTH)
        count = 1
        while heading.casefold() in taken:
            count += 1
            heading = f"{short} ({count})"
        taken.add(heading.casefold())
        shown.append(heading)
    return shown


def header_width(heading: str) -> float:
    """Return the width that a heading needs when it is broken at its blanks, with room for the button of the filter."""
    word = min(max(map(len, heading.split()), default=0), LONGEST_WORD)
    return max(7.0, word + 3.0, len(heading) / 3.0)


def shown_width(value: Any, style: str) -> float:
    """Return how many characters a value takes as its style shows it."""
    if value is None:
        return 0.0
    if isinstance(value, str):
        return max(map(len, value.split("\n")), default=0) * 1.05
    if style in _DIGITS:
        return len(f"{value:.{_DIGITS[style]}f}")
    return 8.0 if style == "time" else len(f"{value:.10g}")
