"""The sheet of delays: every timed call with the parts of its delay."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.figures.delays.delay_styles import cause_in_words
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.feasibility.feasibility import LIMIT
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, SECONDS_PER_DAY, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.results.columns import DELAY_PARTS

DELAY = "delay [s]"
MOST_ROWS = 20_000
"""Rows of the sheet; with more calls those without delay are left out."""

KINDS = {"arrival": mark("arrival"), "departure": mark("departure"), "passing": mark("passing")}


def shown_delays(book: Book) -> pd.DataFrame:
    """Return the calls that stand on the sheet."""
    frame = book.facts.table("delays")
    if len(frame) > MOST_ROWS:
        frame = frame[(frame["delay_s"] > 0.0) | frame["delay_s"].isna()].head(MOST_ROWS)
    return frame.reset_index(drop=True)


def add(book: Book) -> None:
    """Add the sheet, if the run has delays."""
    total = len(book.facts.table("delays"))
    if not total:
        return
    frame = shown_delays(book)
    page = book.page("Delays", "Delays at timed calls, by cause")
    page.note(
        "The parts add up to the delay. Delay from before: brought along from the timed call before, or from the start. The last"
        " columns follow it back to where its seconds first arose; they add up to the delay, too."
    )
    if len(frame) < total:
        page.note(tr("{n} of {all} calls: those with a delay. Table delays has all of them.", n=len(frame), all=total))
    parts = {part: tr(cause_in_words(part)) for part in DELAY_PARTS}
    columns = [
        Column("train", widest=18),
        Column("station", widest=20),
        Column("kind", widest=10),
        Column("planned", "time", key="planned"),
        Column("computed", "time", key="computed"),
        Column(DELAY, "0.0", key="delay"),
        Column("main cause", "beside", 14),
        *(Column(f"{words} [s]", "0.0") for words in parts.values()),
        *(
            Column(tr("first arose: {cause} [s]", cause=words), "0.0", key=f"origin_{part}")
            for part, words in parts.items()
            if part != "knock_on"
        ),
    ]
    block = page.table(columns, _rows(book, frame), frozen=True)
    book.define("delays_s", page, block.cells("delay"))
    for part in DELAY_PARTS:
        if part != "knock_on":
            book.define(f"delays_origin_{part}_s", page, block.cells(f"origin_{part}"))
    _colour(book, block)


def _rows(book: Book, frame: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    names = book.facts.station_names
    parts = [f"{part}_s" for part in DELAY_PARTS] + [f"origin_{part}_s" for part in DELAY_PARTS if part != "knock_on"]
    for row in frame.to_dict("records"):
        station = str(row["station"])
        yield (
            row["train"], names.get(station) or station, tr(KINDS.get(row["kind"], str(row["kind"]))), row["planned_s"],
            row["actual_s"], delay_cell(row), tr(cause_in_words(str(row["cause"]))), *(_shown(row[part]) for part in parts),
        )  # fmt: skip


def delay_cell(row: dict[Any, Any]) -> Formula | float | None:
    """Return a delay as a formula on the times of its row; as a number where it is not what they differ by."""
    planned, actual, delay = (float(row[name]) for name in ("planned_s", "actual_s", "delay_s"))
    value = round(max(0.0, (actual / SECONDS_PER_DAY - planned / SECONDS_PER_DAY) * SECONDS_PER_DAY), 3)
    if math.isnan(delay) or math.isnan(value) or min(planned, actual) < 0.0 or abs(value - delay) > 0.01:
        return None if math.isnan(delay) else delay  # times before midnight are texts
    return Formula(f"ROUND(MAX(0,({{computed}}-{{planned}})*{SECONDS_PER_DAY:.0f}),3)", value)


def _shown(seconds: float) -> float | None:
    return None if not abs(seconds) >= 0.05 else seconds  # zeros would drown what matters


def _colour(book: Book, block: Block) -> None:
    """Let delays show: green within the tolerance, amber beyond it, red from a minute on or where a train did not come."""
    area = block.cells("delay")
    first = area.split(":")[0]
    tolerance = (book.facts.feasibility or {}).get("tolerance_s", 1.0)
    beyond = LIMIT if book.facts.feasibility and "Acceptance" not in book.report.leave_out else f"{tolerance:g}"
    rules = (
        FormulaRule(formula=[f"ISBLANK({first})"], stopIfTrue=True, fill=fill(RED_FILL)),
        CellIsRule(operator="greaterThanOrEqual", formula=["59.5"], stopIfTrue=True, fill=fill(RED_FILL)),
        CellIsRule(operator="greaterThan", formula=[beyond], stopIfTrue=True, fill=fill(AMBER_FILL)),
        CellIsRule(operator="greaterThan", formula=["0.05"], stopIfTrue=True, fill=fill(GREEN_FILL)),
    )
    for rule in rules:
        block.sheet.conditional_formatting.add(area, rule)
