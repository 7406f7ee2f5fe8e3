"""The sheets of windows: ratings that name several, and what every device carries over every window."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from tractionpower.reporting.facts.device_words import KINDS, device_told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    colour_use,
    colour_word,
    limit_line,
    window_in_words,
)
from tractionpower.reporting.workbook.sizing.rated_cells import (
    LOADS,
    USE,
    Judge,
    keyed,
    several_windows,
    window_span,
)

RULES = mark("rules")
MOST_PRINTED = 150
"""Devices whose loads by window are printed whole; of more the first, as the foot of the page says."""

_COLUMNS = (
    Column("device", widest=34, key="device"),
    Column("kind", widest=28, key="kind"),
    Column("duty class", "beside", 12, key="duty"),
    Column("window", "beside", key="window"),
    *LOADS,
    Column(RULES, "beside", key="rules"),
)


def add(book: Book, rows: pd.DataFrame) -> None:
    """Add the sheets."""
    _rated(book, rows)
    _loads(book, rows)


def _rated(book: Book, rows: pd.DataFrame) -> None:
    """Add a row for each window of the ratings that name more than one."""
    several = several_windows(rows)
    if several.empty:
        return
    page = book.page("Ratings by window", "Ratings by window: devices that are rated for several windows")
    judge = Judge.of(book)
    limit = limit_line(page, tr("Permitted utilisation"), "utilisation_percent", judge.permitted, "%")
    page.note("The window with the highest utilisation rules. A window longer than the run is held against the whole of it.")
    block = page.table(_COLUMNS, _window_rows(several, judge, limit), frozen=True)
    for key in ("window", "load", "multiple", "permitted", "use", "from"):
        book.define(f"windows_{key}", page, block.cells(key))
    colour_use(block, USE, limit)
    colour_word(block, HOLDS)


def _window_rows(several: pd.DataFrame, judge: Judge, limit: str) -> Iterator[list[Any]]:
    first = 1
    for _, own in several.groupby(several["device"].astype(str), sort=False):
        cells = [judge.cells(row, limit) for row in own.to_dict("records")]
        uses = [each["use"].value for each in cells]
        area = window_span("use", first, first + len(own) - 1)
        for number, (row, each) in enumerate(zip(own.to_dict("records"), cells, strict=True), 1):
            word = tr(RULES) if uses.index(max(uses)) == number - 1 else ""
            text = f'IF(ISNUMBER({{use}}),IF(MATCH(MAX({area}),{area},0)={number},"{tr(RULES)}",""),"")'
            yield keyed(_COLUMNS, _device(row) | each | {"rules": Formula(text, word)})
        first += len(own)


def _device(row: dict[Any, Any]) -> dict[str, Any]:
    kind = str(row["kind"])
    return {
        "device": device_told(row["device"]), "kind": tr(KINDS.get(kind, kind)), "duty": row["duty_class"],
        "window": window_in_words(row["window_s"]),
    }  # fmt: skip


def _loads(book: Book, rows: pd.DataFrame) -> None:
    """Add a row for each device and a column for each window."""
    page = book.page("Loads by window", "Loads by window: the highest root mean square of the current over every window")
    page.note("Highest sliding root mean square of the current of every device [A]; none where the run is too short.")
    windows = sorted(rows["window_s"].unique(), key=lambda window: (window == 0.0, window))
    columns = (
        Column("device", widest=34),
        Column("kind", widest=28),
        *(Column(tr("{window} [A]", window=window_in_words(window)), "0") for window in windows),
    )
    page.table(columns, _matrix(rows, windows), frozen=True, printed=MOST_PRINTED)


def _matrix(rows: pd.DataFrame, windows: list[float]) -> Iterator[tuple[Any, ...]]:
    for device, own in rows.groupby(rows["device"].astype(str), sort=False):
        kind = str(own["kind"].iloc[0])
        loads = dict(zip(own["window_s"], own["load_a"], strict=True))
        yield device_told(device), tr(KINDS.get(kind, kind)), *(loads.get(window) for window in windows)
