"""The workbook as a whole: which sheets it has, in which order, and how it gets into its file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from openpyxl import Workbook

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.workbook.common import cover, definitions, inputs, limits
from tractionpower.reporting.workbook.feasibility import delays, feasibility, lost_time, remedies, sections
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Book
from tractionpower.reporting.workbook.run import (
    calls,
    charts,
    energy,
    events,
    extracts,
    feeders,
    key_figures,
    return_circuit,
    substations,
    trains,
)
from tractionpower.reporting.workbook.sizing import device_loads, peaks, ratings, useful_voltage
from tractionpower.results.disk import BESIDE
from tractionpower.results.results import Results

TITLE_LENGTH = 200
"""Characters of the title in the properties of the document."""


def build(results: Results, scenario: Scenario) -> Any:
    """Return the workbook of a run; a sheet that would be empty is left out."""
    workbook = Workbook()
    blank = workbook.active  # styles are made on it
    book = Book(workbook, Facts(results, scenario))
    front = book.page("Cover", shorten(book.facts.study, cover.TITLE_LENGTH))
    for add in (feasibility.add, remedies.add, delays.add, sections.add, lost_time.add):
        add(book)
    for add in (ratings.add, peaks.add, device_loads.add, useful_voltage.add):
        add(book)
    for add in (limits.add, trains.add, calls.add, substations.add, feeders.add, return_circuit.add, energy.add, key_figures.add):
        add(book)
    charted = book.page("Charts", "Charts")
    drawn = extracts.add(book)
    charts.draw_all(charted, drawn)
    for add in (events.add, inputs.add, definitions.add):
        add(book)
    cover.fill_in(book, front)
    for page in book.pages:
        page.finish()
    workbook.remove(blank)
    describe(workbook, book.facts)
    return workbook


def save_as(workbook: Any, path: Path) -> Path:
    """Save a workbook under a name that it gets when it is complete; return the name."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    try:
        workbook.save(temporary)
        try:
            temporary.replace(path)
        except PermissionError:  # Windows: another program holds the file that would be replaced
            path = path.with_name(f"{path.stem}{BESIDE}{path.suffix}")
            temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def describe(workbook: Any, facts: Facts) -> None:
    """Give the document its properties."""
    properties = workbook.properties
    properties.title, properties.creator = shorten(facts.study, TITLE_LENGTH), "tractionpower"
    properties.subject = "Co-simulation of traction power supply and train movement"
    properties.description = f"input hash {facts.run.get('input_hash', facts.scenario.input_hash)}"
