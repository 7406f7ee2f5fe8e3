"""Sheets of a workbook made alone, without the rest of it and without a file."""

import pytest

from tractionpower.model.report import Report
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts


@pytest.fixture
def sheets():
    """Return a function that lets a module add its sheets to an empty book and returns the workbook."""

    def made(module, results, scenario, report=None):
        book = Book(Facts(results, scenario), report or Report())
        module.add(book)
        book.finish()
        return book.workbook

    return made
