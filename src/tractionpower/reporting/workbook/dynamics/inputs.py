"""The inputs of a case of train dynamics as used: settings, train, vehicles, couplings, track, commands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from tractionpower.dynamics.engines import powered
from tractionpower.model.dynamics.case import Case, CasePart
from tractionpower.model.dynamics.coupling import Coupling, Gear
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.declared import declared
from tractionpower.reporting.workbook.common.input_tables import SETTINGS, listed, lists_of, setting_rows, settings, shown
from tractionpower.reporting.workbook.common.input_trains import add_curves, add_side_by_side
from tractionpower.reporting.workbook.dynamics.chain_facts import ChainFacts, facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of

_CASE = ("name", "source", "unified_resistance", "grade", "standstill_mps", "units")
"""Fields of the case itself that are told."""

_CALLED = {"units": mark("units of the figures"), "grade": mark("gradient under")}
"""Fields whose names mean something else elsewhere."""

_GEARS = (
    ("traction", mark("Traction of {vehicles}")),
    ("electric_brake", mark("Electric brake of {vehicles}")),
    ("brake", mark("Air brake of {vehicles}")),
)

_TRAIN = (
    Column("vehicle", widest=30),
    Column("kind", "beside", widest=18),
    Column("powered", "beside"),
    Column("coupling behind", "beside", widest=60),
    Column("mass with load [t]", "0.0", key="mass"),
    Column("length [m]", "0.00", key="length"),
    Column("load [%]", "general"),
    Column("air brake", "beside"),
)
_SOURCES = (
    Column("vehicle", widest=30),
    Column("name", "beside", widest=40),
    Column("how many", "0"),
    Column("source", "beside", widest=100),
)
_COUPLINGS = (
    Column("kind of coupling", widest=30),
    Column("name", "beside", widest=44),
    Column("how many", "0"),
    Column("status", "beside", widest=34),
    Column("source", "beside", widest=110),
)

MOST_NAMES = 4


def add(book: Book) -> None:
    """Add the sheets of inputs."""
    facts = facts_of(book)
    _case(book, facts)
    _train(book, facts)
    page = book.page("Inputs vehicles", "Inputs as used: vehicles")
    page.note("Default: what the program takes where a file leaves a quantity out. Sources stand below the table of the train.")
    used = [facts.scenario.vehicle(name) for name in sorted({part.id for part in facts.data.parts})]
    add_side_by_side(page, used)
    add_curves(page, used)
    if facts.kinds:
        _couplings(book, facts)
    _track(book, facts)
    if facts.scenario.case.commands:
        page = book.page("Inputs commands", "Inputs as used: commands of the driver")
        page.note("What a row leaves out stays as it is. A train driven by hand has the commands that were given on the way.")
        listed(page, tr("Commands"), facts.scenario.case.commands)


def _case(book: Book, facts: ChainFacts) -> None:
    case = facts.scenario.case
    page = book.page("Inputs case", "Inputs as used: case and settings")
    page.note(
        "Given: the value differs from the default of the program; default: it is that value, given or not; left out: neither the"
        " case nor the program sets it, and its meaning says what holds instead."
    )
    page.section("Case")
    values = {field.name: field for field in declared(case)}
    rows = [
        (tr(_CALLED[name]) if name in _CALLED else heading_of(name), shown(values[name]), tr(values[name].known),
         recorded(_meaning(name)))
        for name in _CASE
    ]  # fmt: skip
    page.table(SETTINGS, rows)
    settings(page, tr("How it is computed"), case.run)
    settings(page, tr("How the train starts"), case.start)
    settings(page, tr("Brake pipe and cylinders"), case.air_brake)


def _meaning(name: str) -> str:
    return Case.model_fields[name].description or ""


def _train(book: Book, facts: ChainFacts) -> None:
    page = book.page("Inputs trains", "Inputs as used: the train, vehicle by vehicle from the front")
    page.section("Vehicles")
    page.table(_TRAIN, list(_vehicles(facts)))
    page.section("Sources of the vehicles")
    parts, drives = facts.data.parts, powered(facts.scenario)
    used = [facts.scenario.vehicle(name) for name in dict.fromkeys(part.id for part in parts)]
    count = [part.id for part in parts]
    rows = [(vehicle.id, vehicle.name, count.count(vehicle.id), vehicle.source or tr("not told")) for vehicle in used]
    page.table(_SOURCES, rows)
    driven = tuple(part for part, is_powered in zip(parts, drives, strict=True) if is_powered)
    for field, title in _GEARS:
        for gear, names in _distinct(parts if field == "brake" else driven, field):
            more = "" if len(names) <= MOST_NAMES else " …"
            page.section(tr(title, vehicles=f"{', '.join(names[:MOST_NAMES])}{more}"))
            page.table(SETTINGS, list(setting_rows(gear)))


def _vehicles(facts: ChainFacts) -> Iterator[tuple[Any, ...]]:
    parts, drives = facts.data.parts, powered(facts.scenario)
    names = [f"{number} {part.id}" for number, part in enumerate(parts, 1)]
    for number, (part, name, drive) in enumerate(zip(parts, names, drives, strict=True), 1):
        vehicle = facts.scenario.vehicle(part.id)
        mass = vehicle.mass_t + vehicle.load_t * part.load_percent / 100.0
        braked = part.brake is not None and part.brake.in_use
        yield (
            name,
            recorded(vehicle.kind.replace("_", " ")),
            tr("yes") if drive else tr("no"),
            part.coupling if number < len(parts) else "–",
            mass,
            vehicle.length_m,
            part.load_percent,
            tr("yes") if braked else tr("no"),
        )


def _distinct(parts: tuple[CasePart, ...], field: str) -> list[tuple[BaseModel, list[str]]]:
    """Return the different gears of the vehicles, each with the vehicles that have it."""
    found: list[tuple[BaseModel, list[str]]] = []
    for part in parts:
        gear = getattr(part, field)
        if gear is None:
            continue
        own = next((names for known, names in found if known == gear), None)
        if own is None:
            found.append((gear, [part.id]))
        elif part.id not in own:
            own.append(part.id)
    return found


def _couplings(book: Book, facts: ChainFacts) -> None:
    page = book.page("Inputs couplings", "Inputs as used: couplings")
    page.section("Sources of the couplings")
    count = [kind.id for k in range(len(facts.data.couplings)) if (kind := facts.data.coupling_of(k)) is not None]
    sources = [
        (kind.id, kind.name, count.count(kind.id), recorded(KNOWN_AS.get(kind.status, kind.status)), kind.source)
        for kind in facts.kinds
    ]
    page.table(_COUPLINGS, [(*row, source or tr("not told")) for *row, source in sources])
    page.section("Figures of the couplings")
    add_side_by_side(page, facts.kinds)
    points: dict[str, list[tuple[str, BaseModel]]] = {}
    for kind in facts.kinds:
        for owner, gear in _gears(kind):
            for name in ("loading", "unloading"):
                points.setdefault(name, []).extend((owner, point) for point in getattr(gear, name))
    titles = {"loading": tr("Force over deflection on loading"), "unloading": tr("Force over deflection on unloading")}
    for name, rows in points.items():
        if rows:
            listed(page, titles[name], [point for _, point in rows], (tr("coupling, gear"), [owner for owner, _ in rows]))


def _gears(kind: Coupling) -> Iterator[tuple[str, Gear]]:
    yield tr("{coupling}, draw", coupling=kind.id), kind.draw
    if kind.buff is not None:
        yield tr("{coupling}, buff", coupling=kind.id), kind.buff


def _track(book: Book, facts: ChainFacts) -> None:
    track = facts.scenario.case.track
    page = book.page("Inputs track", "Inputs as used: track")
    page.note("By the distance from where the front of the train starts; level and straight where nothing is said.")
    lists_of(page, track)
    _roundings(page, track)


def _roundings(page: Page, track: BaseModel) -> None:
    page.section("Settings of the track")
    page.table(SETTINGS, [row for row in setting_rows(track) if row[0] == heading_of("rounding_radius_m")])
