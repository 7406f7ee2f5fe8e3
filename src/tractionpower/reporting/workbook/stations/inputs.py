"""The inputs of a case of stations as used: settings, traffic, trains, line with its stations."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.common.declared import declared
from tractionpower.reporting.workbook.common.input_tables import SETTINGS, listed, lists_of, setting_rows, settings, shown
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Page, heading_of
from tractionpower.reporting.workbook.stations.station_facts import facts_of

_CASE = ("name", "source", "seed", "length_m", "speed_kmh")
"""Fields of the case itself that are told."""

_LISTS = ("trains", "traffic", "run", "shown_at_s")
"""What is told on other sheets than that of the line, or not as a list."""


def add(book: Book) -> None:
    """Add the sheets of inputs."""
    case = facts_of(book).scenario
    page = book.page("Inputs case", "Inputs as used: case and settings")
    page.note(
        "Given: the value differs from the default of the program; default: it is that value, given or not; left out: neither the"
        " case nor the program sets it, and its meaning says what holds instead."
    )
    page.section("Case")
    values = {field.name: field for field in declared(case)}
    page.table(SETTINGS, [_setting(name, values[name]) for name in _CASE])
    settings(page, tr("Traffic"), case.traffic)
    settings(page, tr("How it is computed"), case.run)
    page = book.page("Inputs trains", "Inputs as used: kinds of trains")
    for kind in case.trains:
        page.section(tr("Kind of trains {name}", name=kind.id))
        page.table(SETTINGS, [*setting_rows(kind)])
        _points(page, kind.characteristics)
    page = book.page("Inputs track", "Inputs as used: track")
    page.note("Places are metres from where trains come; level and straight where nothing is said.")
    lists_of(page, case, _LISTS)


def _setting(name: str, field: Any) -> tuple[Any, ...]:
    return heading_of(name), shown(field), tr(field.known), recorded(field.meaning)


def _points(page: Page, characteristics: BaseModel) -> None:
    """Write the lists of characteristics as tables."""
    for field in declared(characteristics):
        if isinstance(field.value, tuple) and field.value:
            title = heading_of(field.name)
            listed(page, f"{title[:1].upper()}{title[1:]}", field.value)
