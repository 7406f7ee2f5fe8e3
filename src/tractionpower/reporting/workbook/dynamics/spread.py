"""The sheet of distributions: controls and speed together, force of the first coupling, acceleration of the first vehicle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.reporting.facts.spread import LEAST_SHARE, joint_of, rows_of
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page

JOINT = {
    "drive_speed": mark("Drive control and speed of the first vehicle: share of the time [%], classes of speed [km/h]"),
    "brake_speed": mark("Brake control and speed of the first vehicle: share of the time [%], classes of speed [km/h]"),
}
SINGLE = {
    "coupler_force": ("force", mark("Force of the first coupling"), mark("from [kN]"), mark("to [kN]")),
    "acceleration": ("acceleration", mark("Acceleration of the first vehicle"), mark("from [m/s²]"), mark("to [m/s²]")),
}
"""Key of the block, title, and headings of the classes."""

MOST_CLASSES = 40
"""Classes of speed that a table shows; of more the first."""


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if the run has distributions."""
    data = facts_of(book).data
    if not data.has("distributions"):
        return
    page = book.page("Distributions", "How often what came about")
    page.note(
        "Shares of the whole time, summed up in every step. Levels and classes without any time are left out, classes at"
        " the ends alone; an end"
        " without a number is open. Sums are formulas and come to 100 %."
    )
    for which, title in JOINT.items():
        _joint(page, data, which, title)
    for which in SINGLE:
        block = _single(page, rows_of(data, which), which)
        if block is not None:
            drawn.blocks[SINGLE[which][0]] = block


def _joint(page: Page, data: Any, which: str, title: str) -> None:
    joint = joint_of(data, which)
    if joint is None:
        return
    page.section(title)
    shown = joint.share[:, :MOST_CLASSES]
    classes = [f"{number(low)}–{number(high)}" for low, high in zip(joint.edges[:-1], joint.edges[1:], strict=True)]
    keys = [f"class{k}" for k in range(shown.shape[1])]
    columns = [Column("control level", "0"), *(Column(words, "0.00", key=key) for words, key in zip(classes, keys, strict=False))]
    columns.append(Column("sum [%]", "0.00", key="sum"))
    rows = []
    for level, shares in enumerate(100.0 * np.nan_to_num(shown)):
        if not shares.any():
            continue
        cells = [share or None for share in shares.tolist()]
        rows.append((level, *cells, Formula(f"SUM({{{keys[0]}}}:{{{keys[-1]}}})", float(shares.sum()))))
    block = page.table(columns, rows)
    _sum(page, block, ["sum"], [100.0 * float(np.nansum(shown))])


def _single(page: Page, rows: pd.DataFrame, which: str) -> Block | None:
    _, title, low, high = SINGLE[which]
    used = rows[rows["frequency"] > LEAST_SHARE] if len(rows) else rows
    if used.empty:
        return None
    inner = rows.loc[used.index[0] : used.index[-1]]
    page.section(title)
    columns = (
        Column(low, "general", key="from"),
        Column(high, "general", key="to"),
        Column("share [%]", "0.000", key="share"),
        Column("share up to here [%]", "0.000", key="upto"),
    )
    first = page.next + 1
    told, upto = [], 0.0
    for lowest, highest, frequency in inner[["lowest", "highest", "frequency"]].to_numpy(float).tolist():
        share = 100.0 * frequency
        upto += share
        ends = [None if math.isnan(end) else round(end, 6) for end in (lowest, highest)]
        told.append((*ends, share, Formula(f"SUM(C{first}:{{share}})", upto)))
    block = page.table(columns, told)
    _sum(page, block, ["share"], [upto])
    return block


def _sum(page: Page, block: Block, keys: Sequence[str], values: Sequence[float]) -> None:
    """Write sums below a table that was just written."""
    row = block.last + 1
    for column in range(1, len(block.headings) + 1):
        page.put(row, column, tr("sum") if column == 1 else None, "sum text")
    for key, value in zip(keys, values, strict=True):
        page.put(row, block.column(key), Formula(f"SUM({block.cells(key)})", value), "sum 0.00")
    page.next = row + 2
