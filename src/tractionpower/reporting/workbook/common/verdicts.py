"""Texts of the formulas that judge: margin, verdict and passed limit, of one making on all sheets.

A limit or a found value that is no number, since a checker has emptied its cell or put a text there, is not judged; a tolerance
that is none counts as nothing. Without these tests an empty limit would be 0 V, and kept.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from tractionpower.reporting.texts import tr
from tractionpower.results.verdicts import AT_LEAST, Sense

ROUNDING = "1E-9"
"""Share of a limit by which a value may be beyond it, as the studies have it: a sum of rounded numbers."""


@dataclass(frozen=True, slots=True)
class Words:
    """What a verdict says, English: the limit is kept, passed, or nothing is judged."""

    kept: str
    passed: str
    not_judged: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """What a value is held against, as parts of a formula.

    Attributes
    ----------
    found, limit
        The value and its limit: places in braces, names or addresses.
    sense
        ``at_least``: the value must not be below the limit; ``at_most``: not above.
    tolerance
        By how much it may be beyond the limit, in the same unit: a number, place, name or address.
    """

    found: str
    limit: str
    sense: Sense
    tolerance: str = "0"

    @property
    def is_judged(self) -> str:
        """The condition that there are two numbers to compare."""
        return f"ISNUMBER({self.found}),ISNUMBER({self.limit})"

    @property
    def margin(self) -> str:
        """How far the value is from the limit, negative beyond it; nothing where nothing is judged."""
        return f'IF(AND({self.is_judged}),{self._difference},"")'

    @property
    def is_passed(self) -> str:
        """The condition that the value is a number and beyond the limit by more than the tolerance."""
        return f"IF(AND({self.is_judged}),{self._difference}<{self._slack},FALSE)"

    def verdict(self, words: Words) -> str:
        """Return the verdict in words, in the language of the report."""
        judged = f'IF({self._difference}>={self._slack},"{tr(words.kept)}","{tr(words.passed)}")'
        return f'IF(AND({self.is_judged}),{judged},"{tr(words.not_judged)}")'

    def verdict_by(self, margin: str, words: Words) -> str:
        """Return the same where the margin stands in a cell of its own."""
        judged = f'IF({margin}>={self._slack},"{tr(words.kept)}","{tr(words.passed)}")'
        return f'IF(ISNUMBER({margin}),{judged},"{tr(words.not_judged)}")'

    def holds(self, found: float, limit: float, tolerance: float = 0.0) -> bool:
        """Return whether numbers keep the limit, as the formula has it."""
        margin = found - limit if self.sense == AT_LEAST else limit - found
        return margin >= -tolerance - float(ROUNDING) * abs(limit)

    @property
    def _difference(self) -> str:
        first, second = (self.found, self.limit) if self.sense == AT_LEAST else (self.limit, self.found)
        return f"{first}-{second}"

    @property
    def _slack(self) -> str:
        """The lowest margin that is still kept."""
        rounding = f"-{ROUNDING}*ABS({self.limit})"
        return f"{_term('-', self.tolerance)}{rounding}"


def _term(sign: str, tolerance: str) -> str:
    """Return a tolerance as a term: that of a cell, which may be empty or a text, or a number."""
    if tolerance in ("", "0"):
        return ""
    return f"{sign}{tolerance.upper()}" if re.fullmatch(r"[\d.]+(e-?\d+)?", tolerance) else f"{sign}N({tolerance})"


def beyond(limit: str, tolerance: str, *, is_floor: bool) -> str:
    """Return the end of a test that a number is beyond a limit, such as ``<$B$3-$E$3`` with room for rounding.

    No number is beyond a limit that is none.
    """
    side, sign, never = ("<", "-", "-1E+99") if is_floor else (">", "+", "1E+99")
    return f"{side}IF(ISNUMBER({limit}),{limit}{_term(sign, tolerance)}{sign}{ROUNDING}*ABS({limit}),{never})"


def same_as(cell: str) -> str:
    """Return a formula that repeats a number; nothing where there is none, which a bare reference would make 0 of."""
    return f'IF(ISNUMBER({cell}),{cell},"")'
