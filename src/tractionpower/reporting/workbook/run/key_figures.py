"""The sheet of key figures: all of them, each with its definition."""

from __future__ import annotations

from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, heading_of

_COLUMNS = (
    Column("figure", widest=44),
    Column("place", widest=34),
    Column("value", "0.000"),
    Column("unit"),
    Column("time of day", "time"),
    Column("definition", widest=70),
    Column("status of its limit", widest=24),
    Column("name in key_figures.json", widest=44),
)


def add(book: Book) -> None:
    """Add the sheet of key figures."""
    page = book.page("Key figures", "Key figures")
    page.note("A figure without a place is that of the whole run. Values of the file key_figures.json, which has all digits.")
    page.table(_COLUMNS, map(_row, book.facts.results.key_figures), frozen=True)


def _row(figure: dict[str, Any]) -> tuple[Any, ...]:
    name, status = figure["name"], figure.get("status", "")
    return (
        heading_of(name).split(" [")[0],
        figure.get("place") or "whole run",
        figure["value"],
        figure.get("unit", ""),
        parse_time(figure.get("time") or ""),
        figure.get("definition", ""),
        KNOWN_AS.get(status, status),
        name,
    )
