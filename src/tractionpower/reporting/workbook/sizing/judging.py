"""How the sheets of ratings and of outages judge: limits in cells, verdicts as formulas, and colours that follow them."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.figures.supply.ratings_figures import TIGHT_PERCENT
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.accepted import LEAST_TOLERANCE, OPEN, tolerance_name
from tractionpower.reporting.workbook.common.verdicts import Comparison, Words, beyond, same_as
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, PLAIN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Block, Page
from tractionpower.results.verdicts import AT_MOST
from tractionpower.studies.ratings.words import window_words

HOLDS, UNRATED = mark("holds"), mark("not rated")
YES, NO = mark("yes"), mark("no")

BY_RATING = Words(YES, NO, OPEN)
"""The words of verdicts on what devices carry and voltages do."""

_PLACE = re.compile(r"\{(\w+)\}")
_WIDE = 8
"""Columns of a banner."""


def limit_line(page: Page, label: str, limit: str, value: float, unit: str) -> str:
    """Write a line with a limit, and return the address of its value for formulas and formats of the same sheet.

    The value follows the sheet of acceptance, where all limits are edited; in a workbook without it, it is edited here.

    Parameters
    ----------
    page
        The sheet.
    label
        What is limited, in the language of the report.
    limit
        Name of the limit, as verdicts have it.
    value, unit
        Its value, and the unit of that.
    """
    row = page.next
    page.put(row, 1, label, "label")
    page.put(row, 2, Formula(same_as(f"{{limit_{limit}}}"), value), "editable general")
    page.put(row, 3, unit, "plain")
    page.next += 1
    return f"$B${row}"


@dataclass(frozen=True, slots=True)
class Bound:
    """The addresses of a limit and of its tolerance on a sheet; a number where the tolerance is one of rounding or none."""

    limit: str
    tolerance: str = ""

    def beyond(self, *, is_floor: bool) -> str:
        """Return the test that a number is beyond it, such as ``<$B$3-$E$3`` with room for rounding."""
        return beyond(self.limit, self.tolerance, is_floor=is_floor)


def bound_line(page: Page, label: str, limit: tuple[str, float, str], tolerance: float) -> Bound:
    """Write a line with a limit and its tolerance, which follow the sheet of acceptance.

    Parameters
    ----------
    page
        The sheet.
    label
        What is limited, in the language of the report.
    limit
        Name of the limit, as verdicts have it, its value and unit.
    tolerance
        By how much it may be missed; one of rounding is not shown.
    """
    name, value, unit = limit
    row, address = page.next, limit_line(page, label, name, value, unit)
    if tolerance < LEAST_TOLERANCE:
        return Bound(address, f"{tolerance:g}".upper() if tolerance else "")
    page.put(row, 4, tr("tolerance"), "plain")
    page.put(row, 5, Formula(same_as(f"{{{tolerance_name(f'limit_{name}')}}}"), tolerance), "editable general")
    page.widen(0.0, 0.0, 0.0, 10.0)
    return Bound(address, f"$E${row}")


def window_in_words(seconds: float) -> str:
    """Return the length of a window in words; 0 is the whole run."""
    return window_words(seconds) if seconds > 0.0 else tr("whole run")


def judged(text: str, word: str, recorded_word: str) -> Formula | str:
    """Return a verdict as a formula, or the recorded word where rounded numbers would say other than the program did.

    Parameters
    ----------
    text
        The formula.
    word, recorded_word
        What it comes to, and what the program has recorded; English.
    """
    return Formula(text, tr(word)) if word == recorded_word else tr(recorded_word)


def at_most(key: str, limit: str) -> str:
    """Return a formula that says whether the value in a column is not above a limit; not judged where one is no number."""
    return Comparison(f"{{{key}}}", limit, AT_MOST).verdict(BY_RATING)


def sentence(text: str, **parts: tuple[str, object]) -> Formula:
    """Return a sentence as a formula.

    Parameters
    ----------
    text
        The sentence in the language of the report, with its places open.
    **parts
        For each place the formula that fills it, and what that comes to.
    """
    pieces = _PLACE.split(text)
    quoted = ['"' + piece.replace('"', '""') + '"' if k % 2 == 0 else parts[piece][0] for k, piece in enumerate(pieces)]
    value = "".join(piece if k % 2 == 0 else str(parts[piece][1]) for k, piece in enumerate(pieces))
    return Formula("&".join(piece for piece in quoted if piece != '""'), value)


def rounded(value: float) -> int:
    """Return a number as ROUND(...,0) of a workbook gives it.

    >>> rounded(2.5), rounded(-0.4)
    (3, 0)
    """
    return int(math.copysign(math.floor(abs(value) + 0.5), value))


def banner(page: Page, text: Formula | str, style: str, bad: str = "", name: str = "", doubt: str = "") -> None:
    """Write a verdict in large letters across the page.

    Parameters
    ----------
    page
        The sheet.
    text
        The verdict.
    style
        good, bad, doubt or neutral.
    bad
        A formula that is true where the verdict is bad: the colour follows it.
    name
        Name of the cell, for other sheets.
    doubt
        A formula that is true where nothing was judged, for amber; it takes part with `bad` only.
    """
    row = page.next
    shown = page.put(row, 1, text, "big neutral" if bad else f"big {style}")
    page.sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=_WIDE)
    page.sheet.row_dimensions[row].height = LINE_POINTS * 1.5 * (1 + len(str(shown)) // 85) + 8.0
    if bad:
        area = f"A{row}:{chr(ord('A') + _WIDE - 1)}{row}"
        other = {"good": GREEN_FILL, "neutral": PLAIN_FILL}.get(style if style != "bad" else "good", AMBER_FILL)
        tests = ((bad, RED_FILL), *(((doubt, AMBER_FILL),) if doubt else ()), (f"NOT({bad})", other))
        for test, colour in tests:
            page.sheet.conditional_formatting.add(area, FormulaRule(formula=[test], stopIfTrue=True, fill=fill(colour)))
    if name:
        page.book.define(name, page, f"A{row}")
    page.next += 1


def colour_use(block: Block, heading: str, permitted: str) -> None:
    """Let a utilisation show green, amber when little is left, red when it is beyond what is permitted, in the cell given."""
    area = block.cells(heading)
    first = area.split(":")[0]
    held = Comparison(first, permitted, AT_MOST)
    tests = (
        (held.is_passed, RED_FILL), (f"AND({held.is_judged},{first}>{TIGHT_PERCENT / 100.0:g}*N({permitted}))", AMBER_FILL),
        (f"AND({held.is_judged},{first}>=0)", GREEN_FILL),
    )  # fmt: skip
    for test, colour in tests:
        rule = FormulaRule(formula=[test], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)


def colour_red(block: Block, area: str, test: str) -> None:
    """Let numbers that pass a test, such as ``<$B$4-0.1``, show red."""
    first = area.split(":", maxsplit=1)[0]
    rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}{test})"], fill=fill(RED_FILL))
    block.sheet.conditional_formatting.add(area, rule)


def colour_word(block: Block, heading: str) -> None:
    """Let yes and no show green and red, what is not judged grey."""
    for word, colour in ((YES, GREEN_FILL), (NO, RED_FILL), (UNRATED, PLAIN_FILL), (OPEN, AMBER_FILL)):
        rule = CellIsRule(operator="equal", formula=[f'"{tr(word)}"'], fill=fill(colour))
        block.sheet.conditional_formatting.add(block.cells(heading), rule)


def known(value: Any) -> bool:
    """Return whether a value is a number that is known."""
    return value is not None and not isinstance(value, str) and bool(math.isfinite(value))
