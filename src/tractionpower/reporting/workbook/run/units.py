"""The sheet of rectifier units of a run: currents of their substations shared out to them, against their ratings."""

from __future__ import annotations

from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.model.supply import Substation
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.run.substations import ordered

_COLUMNS = (
    Column("substation", widest=28),
    Column("type of unit", widest=24),
    Column("units", "0"),
    Column("in service", "0", key="units"),
    Column("in reserve", "0"),
    Column("rated current of a unit [A]", "0", key="rated"),
    Column("highest current of the substation [A]", "0", key="highest"),
    Column("time of highest current", "time"),
    Column("RMS current of the substation [A]", "0", key="rms"),
    Column("highest current of a unit [A]", "0", key="unit"),
    Column("of its rated current [%]", "0.0", key="share"),
    Column("RMS current of a unit [A]", "0", key="unit_rms"),
    Column("RMS of its rated current [%]", "0.0", key="rms_share"),
)


def add(book: Book) -> None:
    """Add the sheet, if units are told apart and their ratings are not judged on sheets of their own."""
    facts = book.facts
    stations = [s for s in ordered(facts) if s.unit is not None or s.units > 1 or s.rated_current_a is not None]
    if not stations or len(facts.table("ratings")):
        return
    page = book.page("Units", "Rectifier units")
    page.note(
        "Units in service of a substation carry equal currents. Left empty where switch events change how many are in service."
        " Means of a step and of the whole run: whether units bear their load by their duty class is told by a study of sizing."
    )
    page.table(_COLUMNS, [_row(facts, station) for station in stations], frozen=True)


def _rated(facts: Facts, station: Substation) -> float | None:
    if station.rated_current_a is not None or station.unit is None:
        return station.rated_current_a
    return next((unit.rated_current_a for unit in facts.scenario.rectifier_units if unit.unit == station.unit), None)


def _row(facts: Facts, station: Substation) -> list[Any]:
    place = f"substation {station.id}"
    in_service = station.units if station.units_in_service is None else station.units_in_service
    changes = any(event.device == station.id for event in facts.scenario.supply.switch_events)
    units = in_service if station.feeds and not changes else 0
    rated = _rated(facts, station)
    highest, rms = facts.value(place, "highest_current_a"), facts.value(place, "rms_current_a")
    shared: list[Formula | None] = []
    for total, key, own in ((highest, "highest", "unit"), (rms, "rms", "unit_rms")):
        each = total / units if total is not None and units else None
        shared.append(None if each is None else Formula(f"{{{key}}}/{{units}}", each))
        shared.append(None if each is None or not rated else Formula(f"100*{{{own}}}/{{rated}}", 100.0 * each / rated))
    return [
        station.id, station.unit or "", station.units, in_service, station.reserve_units or None, rated,
        highest, parse_time(facts.when(place, "highest_current_a")), rms, *shared,
    ]  # fmt: skip
