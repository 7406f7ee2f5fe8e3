"""The inputs as used: every value that computed the figures, from the scenario that was run, with its source where it has one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tractionpower.io.limits_files import shipped_limits
from tractionpower.model.limits import ALL_SYSTEMS, Limit
from tractionpower.model.scenario import Scenario, StudyFile
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common import input_trains
from tractionpower.reporting.workbook.common.declared import DEFAULT, GIVEN, declared
from tractionpower.reporting.workbook.common.input_tables import (
    SETTINGS,
    listed,
    lists_of,
    setting_rows,
    settings,
    shown,
)
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.reporting.workbook.run import conductors

MANY = ("contingency", "sweep")
"""Kinds of studies of many cases."""

_STUDY = ("day", "coupling", "coupling_voltage_v", "seed", "coast_without_voltage_s")

_DEFAULTS = mark(
    "Given: the value differs from the default of the program; default: it is that value, given or not; left out: neither the"
    " study nor the program sets it, and its meaning says what holds instead."
)
_SOURCES = (Column("input", widest=24), Column("which", widest=36), Column("status", widest=40), Column("source", widest=110))
_LIMITS = (
    Column("name"),
    Column("value", "general"),
    Column("unit", "beside"),
    Column("meaning", "beside", widest=60),
    Column("given / default", widest=16),
    Column("status", widest=40),
    Column("source", widest=80),
)


def add(book: Book) -> None:
    """Add the sheets of inputs."""
    scenario = book.facts.scenario
    _study(book)
    page = book.page("Inputs supply", "Inputs as used: supply system")
    page.note(tr("System {system}. A list that the study does not give is left out.", system=scenario.supply.system))
    lists_of(page, scenario.supply)
    conductors.add(book.page("Inputs conductors", "Inputs as used: resistances of conductors"), scenario)
    page = book.page("Inputs line", "Inputs as used: line")
    if scenario.line.source:
        page.note(tr("Source: {source}", source=scenario.line.source))
    page.note("A list that the study does not give is left out: there are none.")
    lists_of(page, scenario.line)
    if scenario.runs:
        input_trains.add(book)
    _equipment(book)
    _limits(book)


def _study(book: Book) -> None:
    """Add the sheet of the study: clock, method, settings of what it asks for, sources."""
    facts, scenario = book.facts, book.facts.scenario
    page = book.page("Inputs study", "Inputs as used: study and settings")
    page.note(_DEFAULTS)
    page.section("Study")
    page.table(SETTINGS, [*_names(scenario), *setting_rows(scenario.clock), *_method(scenario)])
    for title, part in _parts(facts):
        settings(page, tr(title), part, leave_out="search: ")
    page.section("Sources of the inputs")
    page.note("As the files of the inputs tell them. Files of supply, timetable and study have no field for a source.")
    page.table(_SOURCES, _sources(scenario))


def _names(scenario: Scenario) -> Iterator[tuple[Any, ...]]:
    yield tr("study"), scenario.name, tr(GIVEN), ""
    yield tr("line"), scenario.line.name, tr(GIVEN), ""
    system = next(field for field in declared(scenario.supply) if field.name == "system")
    yield tr("system"), system.value, tr(system.known), recorded(system.meaning)


def _method(scenario: Scenario) -> Iterator[tuple[Any, ...]]:
    """Yield what the study file says of the method; its declaration has the meanings."""
    values = {field.name: field for field in declared(scenario)}
    for name in _STUDY:
        meaning = recorded(StudyFile.model_fields[name].description or "")
        yield heading_of(name), shown(values[name]), tr(values[name].known), meaning


def _parts(facts: Facts) -> Iterator[tuple[str, Any]]:
    """Yield the settings that act in such a run, with the title of their table."""
    scenario, kind = facts.scenario, str(facts.run.get("kind") or "")
    yield mark("Tables and rows that were written"), scenario.output
    if facts.feasibility is not None or kind in MANY:
        yield mark("Verdict on the timetable"), scenario.feasibility
    if (facts.feasibility or {}).get("search") is not None:
        yield mark("Search for changes that make the timetable feasible"), scenario.remedies
    sizing = scenario.sizing
    if kind in (*MANY, "size"):
        yield mark("Ratings and mean useful voltage"), sizing
    elif scenario.runs:
        yield mark("Mean useful voltage"), sizing.useful_voltage
    if (facts.run.get("size") or {}).get("search"):
        yield mark("Search for the least equipment"), sizing.search
    if kind == "contingency":
        yield mark("Outages"), scenario.contingency


def _sources(scenario: Scenario) -> Iterator[tuple[str, str, str, str]]:
    nowhere = tr("not told")
    yield tr("line"), scenario.line.name, "", scenario.line.source or nowhere
    for train in scenario.trains:
        yield tr("train"), train.id, "", train.source or nowhere
    for vehicle in scenario.vehicles:
        yield tr("vehicle"), vehicle.id, "", vehicle.source or nowhere
    for row in scenario.conductors:
        yield recorded(row.kind.replace("_", " ")), row.name, _known_as(row.status), row.source or nowhere
    for unit in scenario.rectifier_units:
        yield tr("rectifier unit"), unit.unit, _known_as(unit.status), unit.source or nowhere
    told = {(duty.duty_class, duty.status, duty.source) for duty in scenario.duty_classes}
    for name, status, source in sorted(told):
        yield tr("duty class"), name, _known_as(status), recorded(source) or nowhere


def _equipment(book: Book) -> None:
    """Add the rows of the tables of equipment that the supply uses."""
    scenario = book.facts.scenario
    tables: dict[str, tuple[Any, ...]] = {
        mark("Conductors"): scenario.conductors,
        mark("Rectifier units"): scenario.rectifier_units,
        mark("Duty classes"): scenario.duty_classes,
    }
    if not any(tables.values()):
        return
    page = book.page("Inputs equipment", "Inputs as used: conductors, rectifier units, duty classes")
    page.note("The rows of these tables that the supply uses, those of the study over those that ship with the program.")
    for title, rows in tables.items():
        if rows:
            listed(page, tr(title), rows)


def _limits(book: Book) -> None:
    scenario = book.facts.scenario
    page = book.page("Inputs limits", tr("Inputs as used: limits of system {system}", system=scenario.supply.system))
    page.note(
        "Values that were computed with, those of the study over those that ship. Verdicts, with values that can be changed, are"
        " on sheet Acceptance."
    )
    shipped = {(limit.system, limit.name): limit for limit in shipped_limits()}
    rows = [_limit(limit, shipped.get((limit.system, limit.name))) for limit in used_limits(book.facts)]
    page.table(_LIMITS, rows, frozen=True)


def used_limits(facts: Facts) -> list[Limit]:
    """Return the limits that act in such a run: those of its system, and over it of all DC systems."""
    scenario, kind = facts.scenario, str(facts.run.get("kind") or "")
    common: list[str] = []
    if facts.run.get("return_circuit"):
        common += ["touch_", "stray_"]
    if kind in (*MANY, "size"):
        common += ["window_", "wire_"]
    if kind == "contingency":
        common += ["grid_"]
    own = {limit.name for limit in scenario.limits if limit.system == scenario.supply.system}
    return [limit for limit in scenario.limits if _acts(limit, scenario.supply.system, own, common)]


def _acts(limit: Limit, system: str, own: set[str], common: Iterable[str]) -> bool:
    if limit.system == system:
        return True
    return limit.system == ALL_SYSTEMS and limit.name not in own and limit.name.startswith(tuple(common))


def _limit(limit: Limit, shipped: Limit | None) -> tuple[Any, ...]:
    known = tr(DEFAULT) if shipped is not None and shipped.value == limit.value else tr(GIVEN)
    meaning, source = recorded(limit.meaning), recorded(limit.source)
    return limit.name, limit.value, limit.unit, meaning, known, _known_as(limit.status), source


def _known_as(status: str) -> str:
    return recorded(KNOWN_AS.get(status, status))
