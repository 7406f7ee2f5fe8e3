"""The workbook of a study of outages."""

from __future__ import annotations

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common import acceptance, assumptions, definitions, evidence, inputs, not_covered
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.outages import outage_cover, outage_delays, outage_envelopes, outage_table
from tractionpower.results.results import Results


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book, outages = Book(Facts(results, scenario), report), Outages(results, scenario)
    front = book.page("Cover", shorten(tr("{study}: outages", study=book.facts.study), TITLE_LENGTH))
    for add in (outage_table.add, outage_envelopes.add, outage_delays.add):
        add(book, outages)
    for add_inputs in (assumptions.add, inputs.add, definitions.add, not_covered.add, evidence.add, acceptance.add):
        add_inputs(book)
    outage_cover.fill(book, front, outages)
    book.finish()
    return book
