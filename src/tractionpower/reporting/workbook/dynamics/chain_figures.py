"""The sheet of key figures of train dynamics, each with its definition."""

from __future__ import annotations

from typing import Any

from tractionpower.reporting.texts import decimal, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, heading_of

_COLUMNS = (
    Column("figure", widest=44),
    Column("value", "0.0000", key="value"),
    Column("unit", "beside"),
    Column("place", "beside", widest=34),
    Column("time since the start", "beside", widest=20),
    Column("definition", "beside", widest=80),
    Column("name in key_figures.json", "beside", widest=40),
)


def add(book: Book) -> None:
    """Add the sheet, if the run has key figures."""
    figures = book.computed.results.key_figures
    if not figures:
        return
    page = book.page("Key figures", "Key figures")
    page.note("A figure without a place is that of the whole run. Values of the file key_figures.json, which has all digits.")
    page.table(_COLUMNS, map(_row, figures), frozen=True)


def _row(figure: dict[str, Any]) -> tuple[Any, ...]:
    name = str(figure["name"])
    return (
        heading_of(name).split(" [")[0],
        figure["value"],
        figure.get("unit", ""),
        recorded(str(figure.get("place") or "")) or tr("whole run"),
        decimal(str(figure.get("time") or "")),
        recorded(figure.get("definition", "")),
        name,
    )
