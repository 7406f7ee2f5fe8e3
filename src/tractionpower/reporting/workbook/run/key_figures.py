"""The sheet of key figures: all of them, each with its definition; those of the whole run have names for formulas."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.reporting.workbook.run.judged import judge

_COLUMNS = (
    Column("figure", widest=44),
    Column("place", widest=34),
    Column("value", "0.000", key="value"),
    Column("unit"),
    Column("time of day", "time"),
    Column("definition", widest=70),
    Column("status of its limit", widest=24),
    Column("name in key_figures.json", widest=44),
)

EXTREMES = re.compile(
    r"(lowest|highest)_voltage_v|longest_spell_.*_s|(lowest|highest)(_mean)?_rail_potential_v|highest_mean_stray_current_ma_per_m"
)
"""Figures of the whole run whose place is that of the worst."""

_JUDGED = {
    "lowest voltage": "lowest_voltage_v",
    "highest voltage": "highest_voltage_v",
    "longest spell above U_max1": "longest_spell_above_u_max1_s",
    "mean stray current": "highest_mean_stray_current_ma_per_m",
}
"""Verdicts by their name and the figures that they judge."""

_SHIFT, _MEAN = "stray_shift_", "highest_mean_rail_potential_v"
"""Limits of the mean rail potential, each for some leakage, and the figure: it is that of one of them."""


def add(book: Book) -> None:
    """Add the sheet of key figures."""
    page = book.page("Key figures", "Key figures")
    page.note("A figure without a place is that of the whole run. Values of the file key_figures.json, which has all digits.")
    figures = book.facts.results.key_figures
    block = page.table(_COLUMNS, map(_row, figures), frozen=True)
    values = {}
    for number, name in whole_run(figures):
        book.define(f"kf_{name}", page, block.cell("value", block.first + number))
        values[name] = figures[number]["value"]
    told = {row.name for row in book.acceptance}
    for verdict in book.facts.verdicts:
        name, limit = str(verdict["name"]), str(verdict["limit"])
        usual = _MEAN if limit.startswith(_SHIFT) else _JUDGED.get(name, "")
        figure = f"longest_spell_above_{limit}_s" if limit.startswith("touch_") else usual
        if figure in values and name not in told:
            judge(book, name, f"{{kf_{figure}}}", values[figure])


def whole_run(figures: Sequence[dict[str, Any]]) -> Iterator[tuple[int, str]]:
    """Yield number and name of the figures of the whole run; they are called ``kf_`` and their name in formulas."""
    known: set[str] = set()
    for number, figure in enumerate(figures):
        name = str(figure["name"])
        if (
            name not in known
            and (not figure.get("place") or EXTREMES.fullmatch(name))
            and re.fullmatch(r"[a-z_][a-z0-9_]+", name)
        ):
            known.add(name)
            yield number, name


def _row(figure: dict[str, Any]) -> tuple[Any, ...]:
    name, status = figure["name"], figure.get("status", "")
    return (
        heading_of(name).split(" [")[0],
        device_told(figure.get("place") or "") or tr("whole run"),
        figure["value"],
        figure.get("unit", ""),
        parse_time(figure.get("time") or ""),
        recorded(figure.get("definition", "")),
        tr(KNOWN_AS.get(status, status)),
        name,
    )
