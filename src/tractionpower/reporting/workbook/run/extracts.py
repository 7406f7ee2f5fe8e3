"""Extracts of long series, as sheets that the charts draw from: never more than some thousand rows, the rest stays in files."""

from __future__ import annotations

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.run import load_extracts, train_extracts, voltage_extracts
from tractionpower.reporting.workbook.run.drawn import Drawn


def add(book: Book) -> Drawn:
    """Add the sheets of extracts and return where they stand."""
    drawn = Drawn(lines=book.facts.lines.lines)
    for each in (train_extracts, voltage_extracts, load_extracts):
        each.add(book, drawn)
    return drawn
