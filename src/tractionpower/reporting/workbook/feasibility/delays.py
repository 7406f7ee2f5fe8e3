"""The sheet of delays: every timed call with the parts of its delay."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.figures.delays.delay_styles import cause_in_words
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.results.columns import DELAY_PARTS

DELAY = "delay [s]"
MOST_ROWS = 20_000
"""Rows of the sheet; with more calls those without delay are left out."""


def add(book: Book) -> None:
    """Add the sheet, if the run has delays."""
    frame = book.facts.table("delays")
    if frame.empty:
        return
    tolerance = float((book.facts.feasibility or {}).get("tolerance_s", 1.0))
    total = len(frame)
    if total > MOST_ROWS:
        frame = frame[(frame["delay_s"] > 0.0) | frame["delay_s"].isna()].head(MOST_ROWS)
    page = book.page("Delays", "Delays at timed calls, by cause")
    page.note(
        "The parts add up to the delay. Delay from before: brought along from the timed call before, or from the start. The last"
        " columns follow it back to where its seconds first arose; they add up to the delay, too."
    )
    if len(frame) < total:
        page.note(f"{len(frame)} of {total} calls: those with a delay. Table delays has all of them.")
    columns = [
        Column("train", widest=24),
        Column("station", widest=28),
        Column("kind"),
        Column("planned", "time"),
        Column("computed", "time"),
        Column(DELAY, "0.0"),
        Column("main cause", "beside", 20),
        *(Column(f"{cause_in_words(part)} [s]", "0.0") for part in DELAY_PARTS),
        *(Column(f"first arose: {cause_in_words(part)} [s]", "0.0") for part in DELAY_PARTS if part != "knock_on"),
    ]
    block = page.table(columns, _rows(book, frame), frozen=True)
    _colour(block, tolerance)


def _rows(book: Book, frame: Any) -> Iterator[tuple[Any, ...]]:
    names = book.facts.station_names
    parts = [f"{part}_s" for part in DELAY_PARTS] + [f"origin_{part}_s" for part in DELAY_PARTS if part != "knock_on"]
    for row in frame.to_dict("records"):
        station = str(row["station"])
        yield (
            row["train"], names.get(station) or station, row["kind"], row["planned_s"], row["actual_s"], row["delay_s"],
            cause_in_words(str(row["cause"])), *(_shown(row[part]) for part in parts),
        )  # fmt: skip


def _shown(seconds: float) -> float | None:
    return None if not abs(seconds) >= 0.05 else seconds  # zeros would drown what matters


def _colour(block: Block, tolerance_s: float) -> None:
    """Let delays show: green within the tolerance, amber beyond it, red from a minute on or where a train did not come."""
    area = block.cells(DELAY)
    first = area.split(":")[0]
    rules = (
        FormulaRule(formula=[f"ISBLANK({first})"], stopIfTrue=True, fill=fill(RED_FILL)),
        CellIsRule(operator="greaterThanOrEqual", formula=["59.5"], stopIfTrue=True, fill=fill(RED_FILL)),
        CellIsRule(operator="greaterThan", formula=[f"{tolerance_s:g}"], stopIfTrue=True, fill=fill(AMBER_FILL)),
        CellIsRule(operator="greaterThan", formula=["0.05"], stopIfTrue=True, fill=fill(GREEN_FILL)),
    )
    for rule in rules:
        block.sheet.conditional_formatting.add(area, rule)
