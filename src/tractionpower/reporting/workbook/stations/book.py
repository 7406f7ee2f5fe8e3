"""The workbook of a case of stations: which sheets it has, in which order."""

from __future__ import annotations

from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.report import Report
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common import cover, definitions
from tractionpower.reporting.workbook.dynamics import chain_figures
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.stations import cover_words, inputs, station_events, station_trains
from tractionpower.reporting.workbook.stations.station_facts import StationFacts
from tractionpower.results.results import Results


def build(results: Results, scenario: StationsCase, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book = Book(StationFacts(results, scenario), report)
    front = book.page("Cover", shorten(tr("{study}: trains on a line", study=book.subject.study), cover.TITLE_LENGTH))
    for add in (station_trains.add, chain_figures.add, station_events.add, inputs.add, definitions.add, cover_words.add_evidence):
        add(book)
    cover.fill_in(book, front, (cover_words.head, cover_words.found, cover_words.trust))
    book.finish()
    return book
