"""The verdicts on the cover: formulas on the sheet of acceptance, so that they follow when a limit is edited there."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from copy import copy
from typing import Any

from openpyxl.formatting.rule import FormulaRule
from openpyxl.styles import Alignment

from tractionpower.reporting.texts import mark, recorded, tr, trn
from tractionpower.reporting.workbook.common.acceptance import colour_words
from tractionpower.reporting.workbook.common.accepted import (
    MET,
    OPEN,
    VIOLATED,
    Accepted,
    digits_of,
    number_in,
    place_in_words,
    word_of,
)
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Page
from tractionpower.results.verdicts import AT_LEAST

MOST_LINES = 24
"""Limits that the cover lists; violated ones come first where there are more."""

NAME_CHARACTERS = 66
"""Characters of the name of a limit, or of a place, that fit into one line."""

MOST_NAMED = 40
"""Rows whose names the headline can tell; a formula has at most 8192 characters."""

KNOWN = {
    "verified": mark("verified"),
    "secondary": mark("secondary source"),
    "recalled": mark("recalled"),
    "user": mark("given by the user"),
    "derived": mark("derived"),
    "assumed": mark("assumed"),
}
"""How the value of a limit is known, in few words."""

_ALIGNED = {3: "right", 4: "right", 5: "center"}
"""Columns of numbers, and of the verdict."""

_STYLES = {MET: "good", VIOLATED: "bad", OPEN: "doubt"}


def write_headline(page: Page, rows: Sequence[Accepted]) -> None:
    """Write the verdict in words, large, and the names of what is violated."""
    words = [word_of(row) for row in rows]
    row, counts = page.next, {word: words.count(word) for word in (MET, VIOLATED, OPEN)}
    judged = sum(counts.values())
    state = VIOLATED if counts[VIOLATED] else OPEN if counts[OPEN] or not judged else MET
    page.put(row, 1, "", "label")
    if rows:
        page.put(row, 2, _headline(counts), f"big {_STYLES[state]}")
        page.put(row, 7, Formula("{acceptance_violated}", counts[VIOLATED]), f"big {_STYLES[state]}")
        page.put(row, 8, Formula("{acceptance_met}", counts[MET]), f"big {_STYLES[state]}")
        for column, word in ((7, VIOLATED), (8, MET)):
            _show_as(page, row, column, f'0" {_quoted(tr(word))}"')
        at, rules = (
            f"B{row}:H{row}",
            ((f"$G${row}>0", RED_FILL), (f"$H${row}>={max(judged, 1)}", GREEN_FILL), ("TRUE", AMBER_FILL)),
        )
        for condition, colour in rules:
            page.sheet.conditional_formatting.add(at, FormulaRule(formula=[condition], fill=fill(colour), stopIfTrue=True))
    else:
        page.put(row, 2, tr("No limits were judged"), "big doubt")
    page.sheet.merge_cells(start_row=row, start_column=2, end_row=row, end_column=6 if rows else 8)
    page.sheet.row_dimensions[row].height = LINE_POINTS * 1.35 + 8.0
    page.next += 1
    if rows:
        _named(page, rows, words)
        _known(page, [row for row, word in zip(rows, words, strict=True) if word in counts])


def _headline(counts: dict[str, int]) -> Formula:
    """Return the verdict in words, as a formula on the counts of the sheet of acceptance."""
    violated, told, met = (
        tr("{violated} of {all} limits violated"), tr("{met} of {all} limits met, {open} not judged"), tr("All {all} limits met"),
    )  # fmt: skip
    values = {"met": counts[MET], "violated": counts[VIOLATED], "open": counts[OPEN], "all": sum(counts.values())}
    none = tr("No limits were judged")
    shown = violated if counts[VIOLATED] else told if counts[OPEN] else met if counts[MET] else none
    else_met = f'IF({{acceptance_met}}>0,{_spoken(met)},"{_quoted(none, chr(34) * 2)}")'
    text = f"IF({{acceptance_violated}}>0,{_spoken(violated)},IF({{acceptance_open}}>0,{_spoken(told)},{else_met}))"
    return Formula(text, shown.format(**values))


def _spoken(text: str) -> str:
    """Return a text with places for counts as a formula that joins its parts.

    >>> _spoken("{met} of {all} met")
    '{acceptance_met}&" of "&{acceptance_all}&" met"'
    """
    parts = re.split(r"\{(\w+)\}", text)
    joined = [f"{{acceptance_{part}}}" if k % 2 else f'"{_quoted(part, chr(34) * 2)}"' for k, part in enumerate(parts) if part]
    return "&".join(joined)


def _named(page: Page, rows: Sequence[Accepted], words: Sequence[str]) -> None:
    """Tell what is violated by its names."""
    names = [recorded(row.name) for row in rows]
    shown = "; ".join(name for name, word in zip(names, words, strict=True) if word == VIOLATED)
    if len(rows) <= MOST_NAMED:
        each = (
            f'IF(INDEX({{acceptance_verdicts}},{k})="{tr(VIOLATED)}","; "&INDEX({{acceptance_names}},{k}),"")'
            for k in range(1, len(rows) + 1)
        )
        listed = f'IF({{acceptance_violated}}=0,"{tr("none")}",MID({"&".join(each)},3,2000))'
        text: Formula | str = Formula(listed, shown or tr("none"))
    else:
        text = shown or tr("none")
    _line(page, tr("Violated"), text, max(1, math.ceil(len(shown) / 165)))


def _known(page: Page, rows: Sequence[Accepted]) -> None:
    """Tell how many limits are editable values, not verified."""
    editable = sum(row.status != "verified" for row in rows)
    if editable:
        text = trn(
            "{count} of these limits is an editable value, not verified against the text of a standard; the verdict is on it.",
            "{count} of these limits are editable values, not verified against the text of a standard; the verdicts are on them.",
            editable,
        )
        _line(page, tr("Limits"), text, 1)


def _line(page: Page, label: str, text: str | Formula, lines: int) -> None:
    page.put(page.next, 1, label, "label")
    page.put(page.next, 2, text, "wrapped")
    page.sheet.merge_cells(start_row=page.next, start_column=2, end_row=page.next, end_column=8)
    page.sheet.row_dimensions[page.next].height = LINE_POINTS * lines + 1.0
    page.next += 1


def write_verdicts(page: Page, rows: Sequence[Accepted]) -> None:
    """Write a line for each limit: what was found, the limit, the verdict, where and when, how the limit is known."""
    if not rows:
        return
    top = page.next
    heads = (tr("Limit"), "", tr("found"), tr("limit"), tr("verdict"), tr("where and when"), "", tr("status of the limit"))
    for column, text in enumerate(heads, 1):
        page.put(top, column, text, "small head")
        if column in _ALIGNED:
            _align(page, top, column)
    for first, last in ((1, 2), (6, 7)):
        page.sheet.merge_cells(start_row=top, start_column=first, end_row=top, end_column=last)
    page.next += 1
    digits = digits_of(rows)
    for number in _listed(rows):
        _verdict(page, rows[number], number + 1, digits[number])
    colour_words(page.sheet, f"E{top + 1}:E{page.next - 1}")
    if len(rows) > MOST_LINES:
        more = len(rows) - MOST_LINES
        _line(page, "", trn("{count} more is on sheet Acceptance.", "{count} more are on sheet Acceptance.", more), 1)


def _listed(rows: Sequence[Accepted]) -> list[int]:
    """Return the numbers of the rows that the cover has room for, from 0: all, or those that are not met first."""
    order = sorted(range(len(rows)), key=lambda k: (word_of(rows[k]) not in (VIOLATED, OPEN), k))
    return sorted(order[:MOST_LINES])


def _verdict(page: Page, row: Accepted, number: int, digits: str) -> None:
    at, word = page.next, word_of(row)
    name, where = recorded(row.name), ", ".join(part for part in (place_in_words(row), row.time) if part)
    found, limit = number_in(row.found), number_in(row.limit_value)
    cells: tuple[tuple[Any, str], ...] = (
        (name[:1].upper() + name[1:], "any"), ("", "any"),
        (None if found is None else Formula(f"INDEX({{acceptance_found}},{number})", found), "0.0"),
        (None if limit is None else Formula(f"INDEX({{acceptance_limits}},{number})", limit), "0.0"),
        (Formula(f"INDEX({{acceptance_verdicts}},{number})", tr(word)), _STYLES.get(word, "neutral")),
        (where, "any"), ("", "any"), (tr(KNOWN.get(row.status, row.status)), "any"),
    )  # fmt: skip
    for column, (value, style) in enumerate(cells, 1):
        page.put(at, column, value, style)
    unit = f'" {_quoted(row.unit)}"' if row.unit else ""
    sign = "≥" if row.sense == AT_LEAST else "≤"
    _align(page, at, 5)
    _show_as(page, at, 3, f"{digits}{unit}")
    _show_as(page, at, 4, f'"{sign} "{digits}{unit}')
    for first, last in ((1, 2), (6, 7)):
        page.sheet.merge_cells(start_row=at, start_column=first, end_row=at, end_column=last)
    lines = max(math.ceil(len(name) / NAME_CHARACTERS), math.ceil(len(where) / NAME_CHARACTERS), 1)
    page.sheet.row_dimensions[at].height = LINE_POINTS * lines + 1.0
    page.next += 1


def _align(page: Page, row: int, column: int) -> None:
    """Let a heading or a word stand over or beside its numbers."""
    cell = page.sheet.cell(row, column)
    cell._style = copy(cell._style)
    cell.alignment = Alignment(horizontal=_ALIGNED[column], vertical="top")


def _show_as(page: Page, row: int, column: int, number_format: str) -> None:
    """Give a number a format of its own."""
    cell = page.sheet.cell(row, column)
    cell._style = copy(cell._style)  # those of a style share it
    cell.number_format = number_format


def _quoted(text: str, quote: str = "'") -> str:
    """Return a text as it may stand between quotes."""
    return text.replace('"', quote)
