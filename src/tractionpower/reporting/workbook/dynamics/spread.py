"""The sheet of distributions: controls and speed together, force of the first coupling, acceleration of the first vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tractionpower.reporting.facts.spread import counted_told, histogram_of, joint_of
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page

JOINT = {
    "drive_speed": mark("Drive control and speed of the first vehicle: share of the time [%], classes of speed [{unit}]"),
    "brake_speed": mark("Brake control and speed of the first vehicle: share of the time [%], classes of speed [{unit}]"),
}
SINGLE = {
    "coupler_force": ("force", mark("Force of the first coupling")),
    "acceleration": ("acceleration", mark("Acceleration of the first vehicle")),
}
"""Key of the block, which is the quantity as well, and title."""

MOST_CLASSES = 40
"""Classes of speed that a table shows; of more the first."""


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if the run has distributions."""
    data = facts_of(book).data
    if not data.has("distributions"):
        return
    page = book.page("Distributions", "How often what came about")
    page.note(
        "Shares of the whole time. Levels and classes without any time are left out, classes at"
        " the ends alone; an end"
        " without a number is open. Sums are formulas and come to 100 %."
    )
    for which, title in JOINT.items():
        _joint(page, data, which, title)
    for which in SINGLE:
        block = _single(page, data, which)
        drawn.force_unit = data.units["force"].unit
        if block is not None:
            drawn.blocks[SINGLE[which][0]] = block


def _joint(page: Page, data: Any, which: str, title: str) -> None:
    joint = joint_of(data, which)
    if joint is None:
        return
    page.section(tr(title, unit=data.units["speed"].unit))
    page.note(counted_told(of_rows=joint.of_rows))
    shown = joint.share[:, :MOST_CLASSES]
    classes = [f"{number(low)}–{number(high)}" for low, high in zip(joint.edges[:-1], joint.edges[1:], strict=True)]
    keys = [f"class{k}" for k in range(shown.shape[1])]
    columns = [Column("control level", "any")]
    columns += [Column(words, "0.00", key=key) for words, key in zip(classes, keys, strict=False)]
    columns.append(Column("sum [%]", "0.00", key="sum"))
    rows = []
    for level, shares in zip(joint.levels, 100.0 * np.nan_to_num(shown), strict=True):
        cells = [share or None for share in shares.tolist()]
        told = tr("emergency") if which == "brake_speed" and level > data.scenario.case.air_brake.levels else level
        rows.append((told, *cells, Formula(f"SUM({{{keys[0]}}}:{{{keys[-1]}}})", float(shares.sum()))))
    block = page.table(columns, rows)
    _sum(page, block, ["sum"], [100.0 * float(np.nansum(shown))])


def _single(page: Page, data: Any, which: str) -> Block | None:
    key, title = SINGLE[which]
    found = histogram_of(data, which)
    if found is None:
        return None
    page.section(title)
    page.note(counted_told(of_rows=found.of_rows))
    unit = data.units[key].unit
    columns = (
        Column(tr("from [{unit}]", unit=unit), "general", key="from"),
        Column(tr("to [{unit}]", unit=unit), "general", key="to"),
        Column("share [%]", "0.000", key="share"),
        Column("share up to here [%]", "0.000", key="upto"),
    )
    first = page.next + 1
    ends = [round(float(edge), 6) for edge in found.edges]
    told, upto = [], 0.0
    for k, share in enumerate((100.0 * found.share).tolist()):
        upto += share
        low = None if found.open_low and k == 0 else ends[k]
        high = None if found.open_high and k == len(found.share) - 1 else ends[k + 1]
        told.append((low, high, share, Formula(f"SUM(C{first}:{{share}})", upto)))
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
