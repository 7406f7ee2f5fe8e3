"""An assumption as the sheet lists it, and how names and numbers stand in it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from tractionpower.reporting.texts import number, tr
from tractionpower.reporting.workbook.common.declared import DIGITS

MOST_NAMES = 8
"""Names that a list of who is meant shows."""


class Assumption(NamedTuple):
    """What is taken as given, where it acts, and where it comes from or how it is known; in the language of the report."""

    text: str
    where: str
    known: str


def figure(value: float | None) -> str:
    """Return a number within a sentence, with as many digits as it has."""
    return tr("not known") if value is None else number(float(value), DIGITS)


def span(values: Iterable[float]) -> str:
    """Return the range of some numbers: one where they are equal."""
    low, high = min(known := list(values)), max(known)
    return figure(low) if low == high else tr("{low} to {high}", low=figure(low), high=figure(high))


def names(found: Iterable[Any]) -> str:
    """Return names in a list, of many the first, each once."""
    known = [str(each) for each in dict.fromkeys(found)]
    told = ", ".join(known[:MOST_NAMES])
    return told if len(known) <= MOST_NAMES else tr("{names} and {count} more", names=told, count=len(known) - MOST_NAMES)
