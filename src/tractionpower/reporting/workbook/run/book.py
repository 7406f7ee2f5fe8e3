"""The workbook of a run: which sheets it has, in which order."""

from __future__ import annotations

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.workbook.common import acceptance, assumptions, cover, definitions, evidence, inputs, not_covered
from tractionpower.reporting.workbook.feasibility import causes, delays, feasibility, lost_time, remedies, sections
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.run import (
    charts,
    energy,
    events,
    extracts,
    feeders,
    key_figures,
    return_circuit,
    substations,
    timetable,
    trains,
    units,
    voltages,
)
from tractionpower.reporting.workbook.sizing import device_loads, peaks, ratings, useful_voltage
from tractionpower.results.results import Results


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook of a run; a sheet that would be empty is left out."""
    book = Book(Facts(results, scenario), report)
    front = book.page("Cover", shorten(book.facts.name, cover.TITLE_LENGTH))
    for add in (feasibility.add, remedies.add, causes.add, delays.add, sections.add, lost_time.add):
        add(book)
    for add in (ratings.add, peaks.add, device_loads.add, useful_voltage.add):
        add(book)
    for add in (timetable.add, trains.add, voltages.add, substations.add, units.add, feeders.add, return_circuit.add):
        add(book)
    for add in (energy.add, key_figures.add):
        add(book)
    charted = book.page("Charts", "Charts")
    drawn = extracts.add(book)
    charts.draw_all(charted, drawn)
    for add in (events.add, assumptions.add, inputs.add, definitions.add, not_covered.add, evidence.add):
        add(book)
    acceptance.add(book)
    cover.fill_in(book, front)
    book.finish()
    return book
