"""Rolling stock and timetable among the inputs as used."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel

from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.quantity import REQUIRED
from tractionpower.model.timetable import Timetable, TrainRun
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.compile import train_of
from tractionpower.movement.formation import form
from tractionpower.reporting.texts import number, recorded, tr
from tractionpower.reporting.workbook.common.declared import Declared, declared, flat, in_words, words_of
from tractionpower.reporting.workbook.common.input_tables import MOST_ROWS, listed, lists_of, title_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of
from tractionpower.reporting.workbook.run.trains import formation_in_words, route_in_words

_TRAINS = (
    Column("train", widest=30),
    Column("name", widest=36),
    Column("formation", widest=44),
    Column("category"),
    Column("vehicles", "0"),
    Column("mass with load [t]", "0.0"),
    Column("inertia [t]", "0.0"),
    Column("length [m]", "0.0"),
    Column("greatest speed [km/h]", "0"),
    Column("service deceleration [m/s²]", "0.00"),
    Column("auxiliaries and heating [kW]", "0.0"),
    Column("gradients act", "beside", widest=20),
    Column("source", "beside", widest=60),
)
MOST_BESIDE = 8
"""Vehicles that stand side by side in a table."""

_DWELLS = (Column("train run", widest=24), Column("station", widest=40), Column("shortest dwell [s]", "general"))


def add(book: Book) -> None:
    """Add the sheets of trains, of vehicles, and of the timetable."""
    _stock(book)
    _timetable(book)


def _stock(book: Book) -> None:
    """Add trains with their formation, every figure of their vehicles, and the points of their curves."""
    scenario = book.facts.scenario
    page = book.page("Inputs trains", "Inputs as used: trains")
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    used = {train.id: train for train in (train_of(run, scenario.trains) for run in scenario.runs)}
    page.note(
        "Mass, inertia, length and power are sums over the vehicles; speed and deceleration the lowest of them or the train's."
    )
    page.table(_TRAINS, [_train_row(train, vehicles) for _, train in sorted(used.items())], frozen=True)
    needed = [vehicles[name] for name in sorted({part.id for train in used.values() for part in train.vehicles})]
    page = book.page("Inputs vehicles", "Inputs as used: vehicles")
    page.note("Default: what the program takes where a file leaves a quantity out. Sources are on sheet Inputs study.")
    add_side_by_side(page, needed)
    add_curves(page, needed)


def add_side_by_side(page: Page, things: Sequence[Vehicle | Coupling]) -> None:
    """Write all figures of vehicles or couplings, some beside each other."""
    tables = -(-len(things) // MOST_BESIDE)
    for k in range(tables):  # as many beside each other in every table
        _side_by_side(page, things[k * len(things) // tables : (k + 1) * len(things) // tables], alone=tables == 1)


def add_curves(page: Page, vehicles: Sequence[Vehicle]) -> None:
    """Write the points of the curves of vehicles."""
    curves: dict[tuple[str, type], list[tuple[str, BaseModel]]] = {}
    for vehicle in vehicles:
        for name, points in _curves(vehicle):
            curves.setdefault((name, type(points[0])), []).extend((vehicle.id, point) for point in points)
    for (name, _), rows in curves.items():
        listed(page, title_of(name), [point for _, point in rows], (tr("vehicle"), [owner for owner, _ in rows]))


def _train_row(train: Train, vehicles: dict[str, Vehicle]) -> list[Any]:
    mass = form(train, vehicles)
    uniform = train.mass_distribution == "uniform"
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
        tr("under the whole train") if uniform else tr("under its front"),
        train.source,
    ]


def _side_by_side(page: Page, vehicles: Sequence[Vehicle | Coupling], *, alone: bool) -> None:
    """Write the figures of some vehicles, a column for each, with the default of the program beside them."""
    rows: dict[str, list[Any]] = {}
    defaults: dict[str, Any] = {}
    for k, vehicle in enumerate(vehicles):
        for heading, field in flat(vehicle):
            if field.name in ("id", "source"):
                continue
            points = _is_curve(field)
            cells = rows.setdefault(heading, [None] * len(vehicles))
            cells[k] = tr("{count} points, see below", count=len(field.value)) if points else field.shown
            defaults.setdefault(heading, _default_of(field))
    told = [
        (heading, *cells, defaults[heading]) for heading, cells in rows.items() if any(cell not in (None, "") for cell in cells)
    ]
    if not alone:
        page.section(tr("{first} to {last}", first=vehicles[0].id, last=vehicles[-1].id))
    columns = [Column("quantity", widest=44), *(Column(vehicle.id, "any", widest=20) for vehicle in vehicles)]
    page.table([*columns, Column("default", "any", widest=16)], told, frozen=alone)


def _default_of(field: Declared) -> Any:
    """Return what stands in the column of defaults: a dash where a file has to give the quantity."""
    if field.default is REQUIRED:
        return tr("none, to be given")
    return field.default if isinstance(field.default, float | int) else in_words(field.default or None, field.words)


def _curves(part: BaseModel) -> Iterator[tuple[str, tuple[BaseModel, ...]]]:
    for field in declared(part):
        if isinstance(field.value, BaseModel):
            yield from _curves(field.value)
        elif _is_curve(field):
            yield field.name, field.value


def _is_curve(field: Declared) -> bool:
    return isinstance(field.value, tuple) and len(field.value) > 0 and isinstance(field.value[0], BaseModel)


def _timetable(book: Book) -> None:
    scenario = book.facts.scenario
    page = book.page("Inputs timetable", "Inputs as used: timetable")
    runs = sorted(scenario.runs, key=lambda run: run.id)
    columns = [Column("train run", widest=24), Column("formation", widest=40), Column("from", widest=30)]
    columns += [
        Column("to", widest=30),
        Column("start", "time"),
        Column("start speed [km/h]", "general"),
        Column("end", "beside"),
    ]
    columns += [Column("calls", "0"), Column("route", "beside", widest=50), Column("driving", "beside", widest=40)]
    more = [
        name
        for name in ("category", "max_current_a", "max_power_kw", "days")
        if any(getattr(run, name) is not None for run in runs)
    ]
    columns += [Column(heading_of(name), "beside" if name in ("category", "days") else "general") for name in more]
    if any(run.calls for run in runs):
        page.note(
            "Planned times of the calls stand beside the computed ones on sheet Timetable. Calls without a shortest dwell have"
            " none."
        )
    if len(runs) > MOST_ROWS:
        page.note(tr("The first {most} of {count} rows; file scenario.json has all of them.", most=MOST_ROWS, count=len(runs)))
    whole = _driving(scenario.timetable)
    page.table(columns, ([*_run_row(book, run, whole), *_more(run, more)] for run in runs[:MOST_ROWS]), frozen=True)
    _dwells(page, book, runs)
    lists_of(page, scenario.timetable, leave_out=("trains", "driving"))
    if scenario.timetable.carry_over:
        page.note("Trains of the day before that are under way past 24:00 run at the start of this one as well.")


def _run_row(book: Book, run: TrainRun, driving: str) -> list[Any]:
    begin = run.start.time if run.start is not None else run.calls[0].departure
    legs = [
        tr("track {track}, km {a} to {b}", track=leg.track, a=number(leg.from_km, 3), b=number(leg.to_km, 3)) for leg in run.route
    ]
    ends = run.end or ("stop" if run.calls and run.calls[-1].stops else "leave")
    return [
        run.id,
        run.train or formation_in_words(run.vehicles),
        *route_in_words(run, book.facts.scenario.line),
        begin,
        0.0 if run.start is None else run.start.speed_kmh,
        recorded(ends),
        len(run.calls),
        "; ".join(legs),
        driving if run.driving is None else in_words(run.driving),
    ]


def _driving(timetable: Timetable) -> str:
    """Return how trains are driven that do not say it."""
    return tr("flat out") if timetable.driving is None else str(in_words(timetable.driving))


def _more(run: TrainRun, names: list[str]) -> Iterator[Any]:
    for name in names:
        value = getattr(run, name)
        yield ", ".join(words_of(day) for day in value) if isinstance(value, tuple) else value


def _dwells(page: Page, book: Book, runs: Sequence[TrainRun]) -> None:
    """Add the calls that have a shortest dwell."""
    rows = [(run.id, call) for run in runs for call in run.calls if call.min_dwell_s > 0.0]
    if not rows:
        return
    names = book.facts.station_names
    page.section("Shortest dwells")
    if len(rows) > MOST_ROWS:
        page.note(tr("The first {most} of {count} rows; file scenario.json has all of them.", most=MOST_ROWS, count=len(rows)))
    told = [(run, names.get(call.station) or call.station, call.min_dwell_s) for run, call in rows[:MOST_ROWS]]
    page.table(_DWELLS, told)
