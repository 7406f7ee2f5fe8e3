"""The workbook of a run of train dynamics: which sheets it has, in which order."""

from __future__ import annotations

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.report import Report
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common import acceptance, cover, definitions
from tractionpower.reporting.workbook.dynamics import (
    assumed,
    chain_charts,
    chain_energy,
    chain_figures,
    course,
    cover_words,
    cycles,
    evidence,
    forces,
    inputs,
    not_covered,
    spread,
    stops,
)
from tractionpower.reporting.workbook.dynamics.chain_facts import ChainFacts
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.results.results import Results


def build(results: Results, scenario: DynamicsScenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book = Book(ChainFacts(results, scenario), report)
    front = book.page("Cover", shorten(tr("{study}: train dynamics", study=book.subject.study), cover.TITLE_LENGTH))
    drawn = chain_charts.Drawn()
    for add in (forces.add, stops.add, chain_energy.add):
        add(book, drawn)
    chain_figures.add(book)
    charted = book.page("Charts", "Charts")
    for add in (course.add, spread.add, cycles.add):
        add(book, drawn)
    chain_charts.draw_all(charted, drawn)
    if not charted.sheet._charts:
        book.pages.remove(charted)
        book.workbook.remove(charted.sheet)
    for write in (assumed.add, inputs.add, definitions.add, not_covered.add, evidence.add, acceptance.add):
        write(book)
    cover.fill_in(book, front, (cover_words.head, cover_words.found, cover_words.trust))
    book.finish()
    return book
