"""The sheet of heat: the utilisation of every device in every outage, with a colour scale."""

from __future__ import annotations

from copy import copy
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.formatting.rule import ColorScaleRule, FormulaRule
from openpyxl.styles import Font
from openpyxl.utils import get_column_letter

from tractionpower.reporting.facts.device_words import KINDS, device_told, kind_order
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.figures.supply.ratings_figures import TIGHT_PERCENT
from tractionpower.reporting.texts import number, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.sizing.judging import limit_line

MOST_DEVICES, MOST_OUTAGES = 70, 60
"""Rows and columns; with more, those with the highest utilisation are shown."""

WIDTH = 5.0
"""Width of the column of an outage [characters]."""

LEAST_A = 1.0
"""Highest current with nothing out from which on devices are shown [A]."""

_LOW, _MID, _HIGH = "FFFFFF", "FFE08A", "D55E00"
_POINTS = 6.0
"""Height of a rotated character [pt]."""


def add(book: Book, outages: Outages) -> None:
    """Add the sheet: utilisations, or where no device has a rating the highest currents of those with nothing out."""
    rows = outages.table("case_devices")
    rated = rows[rows["utilisation_percent"].notna()] if len(rows) else rows
    if len(rated):
        _rated(book, outages, rated)
    elif len(rows):
        _bare(book, outages, rows)


def _rated(book: Book, outages: Outages, rows: pd.DataFrame) -> None:
    """Add the sheet of utilisations."""
    wide, kinds = _wide(outages, rows, "utilisation_percent")
    page = book.page("Outage heat map", "Outage heat map: utilisation of the devices in every outage [%]")
    limit = limit_line(page, tr("Permitted utilisation"), "utilisation_percent", outages.scenario.sizing.utilisation_percent, "%")
    page.note(
        tr(
            "Highest utilisation of all grid voltages. Amber around {tight} % of what is permitted, red and bold beyond it. The"
            " {devices} devices and {outages} outages with the highest utilisation at most; table case_devices has all.",
            tight=f"{TIGHT_PERCENT:g}", devices=MOST_DEVICES, outages=MOST_OUTAGES,
        )
    )  # fmt: skip
    block, area = _fill(page, wide, kinds)
    rule = FormulaRule(formula=[f"AND(ISNUMBER({area[0]}),{area[0]}>{limit})"], font=Font(bold=True))
    block.sheet.conditional_formatting.add(area[1], rule)
    _scale(block, area[1], ("num", 0), (f"{TIGHT_PERCENT / 100.0:g}*{limit}", f"1.2*{limit}"))


def _bare(book: Book, outages: Outages, rows: pd.DataFrame) -> None:
    """Add the sheet of the highest currents, of those with nothing out at the same grid voltage [%]."""
    grids = {case: row["grid"] for case, row in outages.by_id.items()}
    base = {case for case, row in outages.by_id.items() if row["kind"] == "base"}
    rows = rows.assign(case=rows["case"].astype(str), device=rows["device"].astype(str))
    rows = rows.assign(grid=rows["case"].map(grids))
    known = rows[rows["case"].isin(base) & (rows["peak_a"] > LEAST_A)].drop_duplicates(["device", "grid"])
    least = known.set_index(["device", "grid"])["peak_a"].rename("base_a")
    rows = rows[~rows["case"].isin(base)].join(least, on=["device", "grid"], how="inner")
    rows = rows.assign(of_base=100.0 * rows["peak_a"] / rows["base_a"])
    rows = rows[rows["of_base"].notna()]
    if not len(rows):
        return
    wide, kinds = _wide(outages, rows, "of_base")
    page = book.page(
        "Outage heat map", "Outage heat map: highest current of the devices in every outage, of that with nothing out [%]"
    )
    page.note(
        tr(
            "No device has a rating, so there is no utilisation to show: highest currents are held against those with nothing"
            " out at the same grid voltage. 100: as with nothing out; the highest of all grid voltages. Devices that carry less"
            " than {least} A with nothing out are left out, and of many the {devices} devices and {outages} outages with the"
            " highest values are shown.",
            least=number(LEAST_A), devices=MOST_DEVICES, outages=MOST_OUTAGES,
        )
    )  # fmt: skip
    block, area = _fill(page, wide, kinds)
    _scale(block, area[1], ("num", 100), ("150", "200"))


def _fill(page: Page, wide: pd.DataFrame, kinds: dict[str, str]) -> tuple[Block, tuple[str, str]]:
    """Write the table; return it, and the first cell and the area of its numbers."""
    last = f"case_{len(wide.columns) - 1}"
    columns = (
        Column("device", widest=30, key="device"),
        Column("kind", widest=24, key="kind"),
        Column("highest [%]", "0", key="most"),
        *(Column(str(words), "0", key=f"case_{k}") for k, words in enumerate(wide.columns)),
    )
    cells = []
    for at, (device, values) in enumerate(zip(wide.index, wide.to_numpy(float), strict=True), page.next + 1):
        known = [float(value) for value in values if np.isfinite(value)]
        most = Formula(f"MAX(D{at}:{get_column_letter(3 + len(values))}{at})", max(known)) if known else None
        cells.append((device_told(device), tr(KINDS.get(kinds[device], kinds[device])), most, *values))
    block = page.table(columns, cells, frozen=True)
    page.sheet.freeze_panes = f"D{block.first}"
    _turn(page, block)
    page.narrow(4, 3 + len(wide.columns), WIDTH)
    first = block.cell("most", block.first)
    return block, (first, f"{first}:{block.cell(last, block.last)}")


def _wide(outages: Outages, rows: pd.DataFrame, figure: str) -> tuple[pd.DataFrame, dict[str, str]]:
    """Return a figure by device and by what is out, the worst of all grid voltages; and the kinds of the devices."""
    words = {case: row["words"] for case, row in outages.by_id.items()}
    rows = rows.assign(device=rows["device"].astype(str), kind=rows["kind"].astype(str), what=rows["case"].astype(str).map(words))
    kinds = dict(zip(rows["device"], rows["kind"], strict=True))
    wide = rows.pivot_table(index="device", columns="what", values=figure, aggfunc="max", sort=False)
    order = [name for name in dict.fromkeys(words.values()) if name in wide.columns]
    worst = set(wide.max().sort_values(ascending=False, kind="stable").index[:MOST_OUTAGES])
    devices = wide.max(axis=1).sort_values(ascending=False, kind="stable").index[:MOST_DEVICES]
    shown = sorted(devices, key=lambda device: kind_order(kinds[device]))
    return wide.loc[shown, [name for name in order if name in worst]], kinds


def _turn(page: Page, block: Block) -> None:
    """Let the headings of outages stand upright."""
    row, longest = block.first - 1, 0
    for column in range(4, len(block.headings) + 1):
        cell = page.sheet.cell(row, column)
        cell._style = copy(cell._style)  # that of all headings
        alignment: Any = copy(cell.alignment)
        alignment.textRotation, alignment.vertical, alignment.wrap_text = 90, "bottom", False
        cell.alignment = alignment
        longest = max(longest, len(str(cell.value)))
    page.sheet.row_dimensions[row].height = min(max(60.0, longest * _POINTS + 14.0), 400.0)


def _scale(block: Block, area: str, low: tuple[str, float], others: tuple[str, str]) -> None:
    """Shade numbers from white over amber to red; `others` are the formulas of where amber and red are."""
    scale = ColorScaleRule(
        start_type=low[0], start_value=low[1], start_color=_LOW, mid_type="formula", mid_value=others[0],
        mid_color=_MID, end_type="formula", end_value=others[1], end_color=_HIGH,
    )  # fmt: skip
    block.sheet.conditional_formatting.add(area, scale)
