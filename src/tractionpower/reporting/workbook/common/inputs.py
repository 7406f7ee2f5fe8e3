"""The inputs as used: the study, its supply, line, rolling stock and timetable, from the scenario that was run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel

from tractionpower.model.base import Declaration, format_time
from tractionpower.model.limits import ALL_SYSTEMS
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Supply
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.compile import train_of
from tractionpower.movement.formation import form
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of
from tractionpower.reporting.workbook.run import conductors
from tractionpower.reporting.workbook.run.trains import formation_in_words, route_in_words

LEFT_OUT = "A list or field that the study does not give is left out; others have their defaults."

MOST_ROWS = 12
"""Rows that a cell shows of a list within a row, such as the profile of a load."""

_NO_LISTS = ("format", "name", "source", "system")
"""Fields that are no lists of devices, or are told elsewhere."""


def add(book: Book) -> None:
    """Add the sheets of inputs."""
    scenario = book.facts.scenario
    page = book.page("Inputs study", "Inputs as used: study and supply system")
    page.note(LEFT_OUT)
    page.section("Study")
    page.table((Column("what", widest=40), Column("value", "any", widest=70)), _study(scenario))
    _lists(page, scenario.supply, Supply)
    conductors.add(page, scenario)
    page = book.page("Inputs line", "Inputs as used: line")
    if scenario.line.source:
        page.note(f"Source: {scenario.line.source}")
    page.note(LEFT_OUT)
    _lists(page, scenario.line, Line)
    if scenario.runs:
        _stock(book)
        _timetable(book)
    _limits(book)


def _study(scenario: Scenario) -> Iterator[tuple[str, Any]]:
    clock, output = scenario.clock, scenario.output
    yield "study", scenario.name
    yield "line", scenario.line.name
    yield "system", scenario.supply.system
    yield "start", format_time(clock.start)
    yield "end", format_time(clock.end)
    yield heading_of("step_s"), clock.step_s
    yield "warm up, left out of key figures", "none" if clock.warm_up is None else format_time(clock.warm_up)
    yield "coupling", scenario.coupling.replace("_", " ")
    if scenario.coupling != "full":
        yield heading_of("coupling_voltage_v"), scenario.coupling_voltage_v or "nominal voltage"
    yield "seed", scenario.seed
    yield "rows every [s]", "every step" if output.every_s is None else output.every_s
    yield "tables", "all" if output.tables is None else ", ".join(output.tables)


def _lists(page: Page, whole: Declaration, kind: type[Declaration]) -> None:
    """Write every list of `whole` that is not empty as a table with all fields; a single part as well."""
    for name in kind.model_fields:
        value = getattr(whole, name)
        if name in _NO_LISTS or value is None or value == ():
            continue
        rows = value if isinstance(value, tuple) else (value,)
        page.section(name.replace("_", " ").capitalize())
        page.table(*_table_of(rows))


def _table_of(rows: Sequence[Declaration]) -> tuple[list[Column], list[list[Any]]]:
    """Return columns and rows of declarations of one kind; a field that none of them gives is left out."""
    kind = type(rows[0])
    fields = [name for name in kind.model_fields if any(getattr(row, name) is not None for row in rows)]
    fields.sort(key=lambda name: name != "id")  # a track inherits its ends, which come first
    files = [row.model_dump(mode="json") for row in rows]
    columns, values = [], []
    for name in fields:
        given = [getattr(row, name) for row in rows]
        written = [file[name] for file in files]
        heading = heading_of(kind.model_fields[name].alias or name)
        if any(isinstance(value, float) and isinstance(text, str) for value, text in zip(given, written, strict=True)):
            columns.append(Column(heading, "time"))  # a time of day is a number here and a text in files
        elif all(value is None or (isinstance(value, float | int) and not isinstance(value, bool)) for value in given):
            columns.append(Column(heading, "general"))
        else:
            columns.append(Column(heading, widest=50))
        values.append([in_words(value) if columns[-1].style == "text" else value for value in given])
    return columns, [list(row) for row in zip(*values, strict=True)]


def in_words(value: Any) -> Any:
    """Return what stands in a cell for a value of a declaration: lists and parts in one line."""
    if isinstance(value, BaseModel):
        given = {name: getattr(value, name) for name in type(value).model_fields}
        written = value.model_dump(mode="json")  # where a time of day is a text
        given |= {name: text for name, text in written.items() if isinstance(text, str) and isinstance(given[name], float)}
        return ", ".join(f"{name.replace('_', ' ')} {in_words(part)}" for name, part in given.items() if part is not None)
    if isinstance(value, dict):
        return "; ".join(f"{key}: {in_words(part)}" for key, part in value.items())
    if isinstance(value, tuple | list) and len(value) > MOST_ROWS and isinstance(value[0], BaseModel):
        return f"{len(value)} rows, from {in_words(value[0])} to {in_words(value[-1])}"
    if isinstance(value, tuple | list):
        return ("; " if value and isinstance(value[0], BaseModel) else ", ").join(str(in_words(part)) for part in value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else value


def _stock(book: Book) -> None:
    """Add trains with their formation, and every figure of their vehicles."""
    scenario = book.facts.scenario
    page = book.page("Inputs stock", "Inputs as used: trains and vehicles")
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    used = {train.id: train for train in (train_of(run, scenario.trains) for run in scenario.runs)}
    columns = [Column("train", widest=30), Column("name", widest=30), Column("formation", widest=60), Column("category")]
    columns += [
        Column("vehicles", "0"),
        Column("mass with load [t]", "0.0"),
        Column("inertia [t]", "0.0"),
        Column("length [m]", "0.0"),
    ]
    columns += [Column("greatest speed [km/h]", "0"), Column(heading_of("service_rate_mps2"), "0.00")]
    columns += [Column("auxiliaries and heating [kW]", "0.0"), Column("source", widest=50)]
    page.section("Trains")
    page.table(columns, [_train_row(train, vehicles) for _, train in sorted(used.items())])
    page.section("Vehicles")
    needed = sorted({part.id for train in used.values() for part in train.vehicles})
    rows = [(name, *row) for name in needed for row in _fields(vehicles[name])]
    page.table((Column("vehicle", widest=30), Column("quantity", widest=44), Column("value", "any", widest=60)), rows)


def _train_row(train: Train, vehicles: dict[str, Vehicle]) -> list[Any]:
    mass = form(train, vehicles)
    return [
        train.id,
        train.name,
        formation_in_words(train.vehicles),
        train.category,
        sum(part.count for part in train.vehicles),
        mass.mass_kg / 1000.0,
        mass.inertia_kg / 1000.0,
        mass.length_m,
        mass.max_mps * 3.6,
        mass.service_rate_mps2,
        (mass.auxiliary_w + mass.heating_w) / 1000.0,
        train.source,
    ]


def _fields(part: BaseModel, before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield heading and value of every field that is given, those of inner parts with the name of the part before them."""
    for name in type(part).model_fields:
        value = getattr(part, name)
        if isinstance(value, BaseModel):
            yield from _fields(value, f"{before}{name.replace('_', ' ')}: ")
        elif value is not None and value not in ((), "") and name not in ("format", "id"):
            yield f"{before}{heading_of(name)}", value if isinstance(value, float | int) else in_words(value)


def _timetable(book: Book) -> None:
    page = book.page("Inputs timetable", "Inputs as used: timetable")
    columns = [Column("train run", widest=24), Column("formation", widest=44), Column("category"), Column("from", widest=30)]
    columns += [Column("to", widest=30), Column("start", "time"), Column("start speed [km/h]", "general"), Column("end")]
    columns += [Column("calls", "0"), Column("route", widest=60)]
    rows = []
    for run in sorted(book.facts.scenario.runs, key=lambda run: run.id):
        begin = run.start.time if run.start is not None else run.calls[0].departure
        legs = "; ".join(f"track {leg.track}, km {leg.from_km:g} to {leg.to_km:g}" for leg in run.route)
        formation = run.train or formation_in_words(run.vehicles)
        speed = 0.0 if run.start is None else run.start.speed_kmh
        ends = run.end or ("stop" if run.calls and run.calls[-1].stops else "leave")
        rows.append(
            [
                run.id,
                formation,
                run.category,
                *route_in_words(run, book.facts.scenario.line),
                begin,
                speed,
                ends,
                len(run.calls),
                legs,
            ]
        )
    if any(run.calls for run in book.facts.scenario.runs):
        page.note("Planned times of the calls are on sheet Calls.")
    page.table(columns, rows, frozen=True)


def _limits(book: Book) -> None:
    scenario = book.facts.scenario
    page = book.page("Inputs limits", f"Inputs as used: limits of system {scenario.supply.system}")
    columns = [Column("name"), Column("value", "general"), Column("unit"), Column("meaning", widest=50)]
    columns += [Column("status", widest=40), Column("source", widest=80)]
    systems = {scenario.supply.system, *([ALL_SYSTEMS] if book.facts.run.get("return_circuit") else [])}
    used = [limit for limit in scenario.limits if limit.system in systems]
    rows = [(li.name, li.value, li.unit, li.meaning, KNOWN_AS.get(li.status, li.status), li.source) for li in used]
    page.table(columns, rows, frozen=True)
