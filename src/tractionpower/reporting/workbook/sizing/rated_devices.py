"""A sheet for each kind of devices: the window that rules each, what it carries in it and what it may."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import pandas as pd

from tractionpower.reporting.facts.device_words import KINDS, device_told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.sizing.judging import HOLDS, colour_use, colour_word, limit_line, window_in_words
from tractionpower.reporting.workbook.sizing.rated_cells import LOADS, USE, Judge, keyed, sources_of

SHEETS = (
    (mark("Units"), mark("Units: load and rating of the rectifier units"), ("unit",)),
    (mark("Substation ratings"), mark("Substations: load and rating"), ("substation",)),
    (
        mark("Feeder ratings"),
        mark("Feeders, feeders of section cabins and switches: load and rating"),
        ("feeder", "cabin_feeder", "switch"),
    ),
    (mark("Contact line"), mark("Contact line: load and rating of every section"), ("contact_line",)),
    (mark("Return circuit ratings"), mark("Return feeders and rails: load and rating"), ("return_feeder", "rails")),
)
"""Sheets with their titles, and the kinds of devices on each."""

OTHERS = (mark("Other ratings"), mark("Other devices: load and rating"))

_WITH_ENDS = ("contact_line", "rails")
"""Kinds that have two ends."""


def add(book: Book, ruling: pd.DataFrame, several: pd.DataFrame) -> dict[str, str]:
    """Add a sheet for each kind of devices, or for those that belong together; return the name of the sheet of each kind.

    Parameters
    ----------
    book
        The workbook.
    ruling
        A row for each device.
    several
        The rows of sheet Ratings by window.
    """
    known = {kind for _, _, kinds in SHEETS for kind in kinds}
    left = tuple(kind for kind in dict.fromkeys(ruling["kind"].astype(str)) if kind not in known)
    teller = _Teller(Judge.of(book), sources_of(ruling)[1], _windows(several))
    found: dict[str, str] = {}
    for name, title, kinds in (*SHEETS, (*OTHERS, left)):
        rows = ruling[ruling["kind"].astype(str).isin(kinds)]
        if len(rows):
            page = book.page(name, title)
            _fill(page, rows, teller)
            found |= dict.fromkeys(rows["kind"].astype(str), page.sheet.title)
    return found


def name_of(kind: str) -> str:
    """Return how the names of the ranges of a kind of devices begin."""
    return f"rated_{re.sub(r'[^A-Za-z0-9_]', '_', kind)}"


@dataclass(frozen=True)
class _Teller:
    """What all sheets need: limits, numbers of the sources, and windows of devices with several.

    Attributes
    ----------
    judge, numbers
        What devices are held against; numbers of the sources.
    windows
        By device the number of its first row on sheet Ratings by window, and all of these rows.
    """

    judge: Judge
    numbers: dict[tuple[str, str], int]
    windows: dict[str, tuple[int, pd.DataFrame]]

    def cells(self, row: dict[Any, Any], limit: str) -> dict[str, Any]:
        """Return the cells of a device."""
        several = self.windows.get(str(row["device"]))
        own = self.judge.cells(row, limit) if several is None else self.judge.worst_cells(several[1], several[0], limit)
        return _device(row, self.numbers) | own


def _windows(several: pd.DataFrame) -> dict[str, tuple[int, pd.DataFrame]]:
    found, first = {}, 1
    for device, own in several.groupby(several["device"].astype(str), sort=False):
        found[str(device)] = first, own
        first += len(own)
    return found


def _fill(page: Page, rows: pd.DataFrame, teller: _Teller) -> None:
    limit = limit_line(page, tr("Permitted utilisation"), "utilisation_percent", teller.judge.permitted, "%")
    page.note(
        "Of every device the window that rules: that of its rows on sheet Ratings by window with the highest utilisation,"
        " found anew when a multiple is edited. Permitted: rated current times multiple; where units go and come during the run"
        " it holds what is permitted until a reserve feeds, and no multiple stands beside it. Source: the number in the list of"
        " sheet Ratings. Other windows: sheets Ratings by window and Loads by window."
    )
    several, has_ends = rows["kind"].nunique() > 1, bool(rows["kind"].astype(str).isin(_WITH_ENDS).any())
    columns = _columns(several=several, has_ends=has_ends)
    if not rows["device"].astype(str).isin(teller.windows).any():
        columns = [column for column in columns if column.key != "row"]
    cells = (teller.cells(row, limit) for row in rows.to_dict("records"))
    block = page.table(columns, (keyed(columns, each) for each in cells), frozen=True)
    colour_use(block, USE, limit)
    colour_word(block, HOLDS)
    first = block.first
    for kind, own in rows.groupby(rows["kind"].astype(str), sort=False):
        for key in ("device", "window", "use", "left", "holds"):
            area = f"{block.cell(key, first)}:{block.cell(key, first + len(own) - 1)}"
            page.book.define(f"{name_of(str(kind))}_{key}", page, area)
        first += len(own)


def _columns(*, several: bool, has_ends: bool) -> list[Column]:
    """Return the columns of a sheet: kinds only where there are several, two ends only where devices have them."""
    return [
        Column("device", widest=34, key="device"),
        *([Column("kind", widest=24, key="kind")] if several else []),
        Column("track", "beside", 10, key="track"),
        Column("from [km]" if has_ends else "at [km]", "0.000", key="low"),
        *([Column("to [km]", "0.000", key="high")] if has_ends else []),
        Column("duty class", "beside", 12, key="duty"),
        Column("window that rules", "beside", key="window"),
        Column("its row of Ratings by window", "0", key="row"),
        *LOADS,
        Column("status of the rating", "beside", 26, key="status"),
        Column("source", "0", key="source"),
    ]


def _device(row: dict[Any, Any], numbers: dict[tuple[str, str], int]) -> dict[str, Any]:
    kind, status = str(row["kind"]), str(row["status"])
    return {
        "device": device_told(row["device"]), "kind": tr(KINDS.get(kind, kind)), "track": row["track"], "low": row["from_km"],
        "high": row["to_km"], "duty": row["duty_class"], "window": window_in_words(row["window_s"]), "row": None,
        "status": tr(KNOWN_AS.get(status, status)), "source": numbers.get((status, str(row["source"]))),
    }  # fmt: skip
