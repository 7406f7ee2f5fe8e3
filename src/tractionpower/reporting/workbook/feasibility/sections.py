"""The sheet of sections: running times between timed calls, what reserve is left, where seconds are lost."""

from __future__ import annotations

import math
from typing import Any

from openpyxl.formatting.rule import DataBarRule

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.feasibility.feasibility import colour_reserve
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page

LEFT, LOST = "reserve left [s]", "lost to low voltage [s]"

_COLUMNS = (
    Column("train", widest=18),
    Column("from", widest=20),
    Column("to", widest=20),
    Column("from [km]", "0.000"),
    Column("to [km]", "0.000"),
    Column("planned [s]", "0.0", key="planned"),
    Column("shortest, at nominal voltage [s]", "0.0", key="shortest"),
    Column("with train current limits [s]", "0.0", key="limited"),
    Column("on the voltages of the run [s]", "0.0", key="recorded"),
    Column("computed [s]", "0.0"),
    Column("reserve [s]", "0.0", key="reserve"),
    Column(LEFT, "0.0", key="left"),
    Column(LOST, "0.0", key="lost"),
    Column("lost to current limits [s]", "0.0", key="current"),
    Column("most lost at [km]", "0.0"),
    Column("track", "beside", 8),
    Column("area of", "beside", 16),
    Column("lowest voltage [V]", "0"),
)

_DIFFERENCES = {
    "reserve_s": ("planned", "shortest"),
    "reserve_left_s": ("planned", "recorded"),
    "lost_voltage_s": ("recorded", "limited"),
    "lost_current_s": ("limited", "shortest"),
}
"""Columns that are the difference of two others, by their keys."""


def add(book: Book) -> None:
    """Add the sheet, if the run has sections."""
    frame = book.facts.table("sections")
    if frame.empty:
        return
    page = book.page("Sections", "Sections between timed calls: reserve left and seconds lost")
    page.note(
        "Running times of the train alone, driven flat out: at nominal voltage without current limits, then with them, then on"
        " the voltages that the run recorded. Reserve left is planned less the last of these: red where it is missing, amber"
        " below 10 s. Computed is the run itself, with its driving plan. Reserves and losses are formulas on the running times."
    )
    names = book.facts.station_names
    rows = [_row(row, names) for row in frame.to_dict("records")]
    top = page.next
    page.next += 4
    block = page.table(_COLUMNS, rows, frozen=True)
    for key in ("left", "lost", "current"):
        book.define(f"sections_{key}_s", page, block.cells(key))
    _sums(page, top, rows)
    colour_reserve(book, block, LEFT)
    bar = DataBarRule(start_type="num", start_value=0, end_type="max", color=AMBER_FILL)
    block.sheet.conditional_formatting.add(block.cells(LOST), bar)


def _row(row: dict[Any, Any], names: dict[str, str]) -> tuple[Any, ...]:
    begin, end = str(row["from_station"]), str(row["to_station"])
    stations = (names.get(begin) or begin or tr("start of the run"), names.get(end) or end)
    times = {"planned": "planned_s", "shortest": "shortest_s", "limited": "limited_s", "recorded": "recorded_s"}
    known = {key: float(row[name]) for key, name in times.items()}
    differences = [_difference(row[name], known, *keys) for name, keys in _DIFFERENCES.items()]
    return (
        row["train"], *stations, row["from_km"], row["to_km"], *known.values(), row["actual_s"], *differences,
        row["worst_km"], row["worst_track"], row["area"], row["lowest_voltage_v"],
    )  # fmt: skip


def _difference(recorded: float, known: dict[str, float], larger: str, smaller: str) -> Formula | float | None:
    """Return a difference as a formula on its row; as a number where it is not that of the shown times."""
    value = known[larger] - known[smaller]
    if math.isnan(value) or math.isnan(recorded) or abs(value - recorded) > 0.01:
        return None if math.isnan(recorded) else float(recorded)
    return Formula(f"{{{larger}}}-{{{smaller}}}", value)


def _sums(page: Page, row: int, rows: list[tuple[Any, ...]]) -> None:
    """Write the sums over all sections, and the least reserve."""
    first = len(_COLUMNS) - 7  # reserve left, then what is lost
    columns = [[_number(line[k]) for line in rows] for k in (first, first + 1, first + 2)]
    left, lost, current = ([value for value in column if value is not None] for column in columns)
    lines: list[tuple[str, Formula | None]] = [
        (tr("least reserve left [s]"), Formula("MIN({sections_left_s})", min(left)) if left else None),
        (tr("lost to low voltage, all sections [s]"), Formula("SUM({sections_lost_s})", math.fsum(lost))),
        (tr("lost to current limits, all sections [s]"), Formula("SUM({sections_current_s})", math.fsum(current))),
    ]
    for at, (label, value) in enumerate(lines, row):
        page.put(at, 1, label, "plain")
        page.put(at, 4, value, "0.0")


def _number(cell: Any) -> float | None:
    value = cell.value if isinstance(cell, Formula) else cell
    return None if value is None or math.isnan(value) else float(value)
