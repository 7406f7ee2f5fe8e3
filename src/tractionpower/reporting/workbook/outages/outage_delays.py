"""The sheet of delays in outages: the trains that are later than without them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column

ADDED = mark("added [s]")
MOST_ROWS = 5000
"""Rows of the table of single trains; with more, those that are delayed most are shown."""


def add(book: Book, outages: Outages) -> None:
    """Add the sheet, if trains have timed calls."""
    rows = outages.table("case_trains")
    if rows.empty:
        return
    least = outages.tolerance_s
    rows = rows[(rows["added_late_s"] > least) | (rows["status"] == "stuck")]
    page = book.page("Delays in outages", "Delays in outages: trains that are later than without the outage")
    page.note(
        tr(
            "Lateness at the timed call where a train is latest, and how much more that is than with nothing out at the same grid"
            " voltage; trains that lose more than {least} s, or stand for good. A call that a train has not come to counts with"
            " the time until the end of the clock: a stuck train is late by at least that, and by nothing told where none was"
            " due. Trains do not see each other.",
            least=number(least),
        )
    )
    if rows.empty:
        page.line("No outage makes a train later.")
        return
    page.section("Outages by the delay that they add")
    page.table(_SUMS, _sums(outages, rows, live=len(rows) <= MOST_ROWS))
    page.section("Trains")
    if len(rows) > MOST_ROWS:
        page.note(tr("The {most} of {all} rows with most added; table case_trains has all.", most=MOST_ROWS, all=len(rows)))
    worst = rows.sort_values("added_late_s", ascending=False, kind="stable", na_position="first").head(MOST_ROWS)
    order = {case: at for at, case in enumerate(outages.cases["case"])}
    worst = worst.assign(_at=[order.get(str(case), len(order)) for case in worst["case"]]).sort_values("_at", kind="stable")
    cells = (
        (outages.told(row["case"]), row["train"], row["late_s"], row["added_late_s"], _status(row))
        for row in worst.to_dict("records")
    )
    block = page.table(_TRAINS, cells)
    book.define("delays_what", page, block.cells("what is out"))
    book.define("delays_added", page, block.cells(ADDED))
    for limit, colour in ((60.0, RED_FILL), (least, AMBER_FILL)):
        rule = CellIsRule(operator="greaterThan", formula=[f"{limit:g}"], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(block.cells(ADDED), rule)


_SUMS = (
    Column("what is out", widest=60, key="what"),
    Column("trains delayed", "0"),
    Column("added, at most [s]", "0.0"),
    Column("train", "beside", 24),
    Column("added, all trains [s]", "0"),
    Column("trains stuck", "0"),
)
_TRAINS = (
    Column("what is out", widest=60),
    Column("train", widest=24),
    Column("latest at a call [s]", "0.0"),
    Column(ADDED, "0.0"),
    Column("status", "beside"),
)


def _status(row: Mapping[Any, Any]) -> str:
    is_least = row["status"] == "stuck" and row["late_s"] > 0.0
    return tr("stuck, late by at least that") if is_least else recorded(str(row["status"]))


def _sums(outages: Outages, rows: pd.DataFrame, *, live: bool) -> list[tuple[Any, ...]]:
    """Return the sums of each outage; where all trains stand in the table below, by formulas on it."""
    found = []
    for case, own in rows.groupby(rows["case"].astype(str), sort=False):
        added = own["added_late_s"]
        most = own["train"].iloc[int(added.fillna(-1.0).argmax())]
        stuck = int((own["status"].astype(str) == "stuck").sum())
        count: Any = len(own)
        total: Any = float(added.astype(float).sum())
        if live:
            count = Formula("SUMPRODUCT(({delays_what}={what})*1)", count)
            total = Formula("SUMPRODUCT(({delays_what}={what})*{delays_added})", total)
        found.append((outages.told(str(case)), count, added.max(), most, total, stuck))
    return sorted(found, key=lambda row: -row[2] if row[2] == row[2] else -len(rows))
