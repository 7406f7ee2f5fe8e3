"""Conductors among the inputs as used: each resistance and how it was found, and what each wire of a contact line carries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tractionpower.model.conductors import Conductor
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import ContactLine, ReturnCircuit
from tractionpower.reporting.texts import mark, number, recorded, tr, trn
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.supply.bundles import return_tracks
from tractionpower.supply.conductors import (
    REFERENCE_C,
    cable_resistance,
    contact_line_resistance,
    look_up,
    return_resistance,
    wire_shares,
    worn_wires,
)

CONTACT, RETURN = mark("contact line"), mark("return circuit")
USES = {"contact": mark("contact wire"), "messenger": mark("messenger wire"), "feeder": mark("reinforcing feeder")}

_WHERE = (
    Column("conductor"),
    Column("tracks", widest=30),
    Column("from [km]", "general"),
    Column("to [km]", "general"),
)
_KNOWN = (Column("status", "beside", 40), Column("source", widest=80))
_RESISTANCES = (
    *_WHERE,
    Column("resistance [Ω/km]", "0.00000"),
    Column("found by", "beside", 44),
    Column("wear [%]", "0.0"),
    Column("temperature [°C]", "0.0"),
    *_KNOWN,
)
_SHARES = (
    *_WHERE,
    Column("use", "beside", 14),
    Column("wire"),
    Column("count", "0"),
    Column("wear [%]", "0.0"),
    Column("resistance of each [Ω/km]", "0.00000"),
    Column("share of the current [%]", "0.0"),
)
_CABLES = (
    Column("feeder", widest=30),
    Column("cable"),
    Column("cables", "0"),
    Column("length [m]", "general"),
    Column("resistance [Ω]", "0.00000"),
    *_KNOWN,
)


def add(page: Page, scenario: Scenario) -> None:
    """Add the resistances in use, the shares of wires where wires are known, and the feeders that are given by their cable."""
    supply, table = scenario.supply, scenario.conductors
    page.section("Resistances used")
    page.note(
        tr(
            "Wear is that of contact wires and rails. At {temperature} °C where no temperature is given.",
            temperature=number(REFERENCE_C),
        )
    )
    rows = [_contact_line(row, table) for row in supply.contact_lines]
    page.table(_RESISTANCES, [*rows, *(_rails(row, scenario.line, table) for row in supply.return_circuit)])
    shares = [share for row in supply.contact_lines for share in _shares(row, table)]
    if shares:
        page.section("Share of current of each wire")
        page.note("By conductance; of a type that is given without wear, with the wear that its printed resistance means.")
        page.table(_SHARES, shares)
    cables = list(_cables(scenario))
    if cables:
        page.section("Cables of feeders")
        page.table(_CABLES, cables)


def _contact_line(row: ContactLine, table: tuple[Conductor, ...]) -> list[Any]:
    wires = worn_wires(row, table)
    used = [look_up("wire", wire.conductor, table) for wire in wires]
    kind = None if row.type is None else look_up("contact_line", row.type, table)
    printed = kind is not None and kind.resistance_ohm_per_km is not None and row.wear_percent is None
    if row.resistance_ohm_per_km is not None:
        found = tr("given")
    elif kind is None:
        found = tr("its wires")
    elif printed:
        found = tr("type {name}, as its source prints", name=kind.name)
        if row.temperature_c is not None:
            found = tr("type {name}, as its source prints for 20 °C", name=kind.name)
    else:
        found = tr("type {name}, its wires", name=kind.name)
    sources = ([kind] if kind is not None else []) + ([] if printed and row.temperature_c is None else used)
    wear = next((wire.wear_percent for wire in wires if wire.use == "contact"), None)
    ohm = contact_line_resistance(row, table)
    return [*_where(CONTACT, row), ohm, found, wear, _temperature(row, bool(sources)), *_known(sources)]


def _rails(row: ReturnCircuit, line: Line, table: tuple[Conductor, ...]) -> list[Any]:
    tracks = len(return_tracks(row, line))  # as the network counts them
    found = tr("given")
    if row.rail is not None:
        found = tr("rail {name}, {tracks}", name=row.rail, tracks=trn("{count} track", "{count} tracks", tracks))
    sources = [] if row.rail is None else [look_up("rail", row.rail, table)]
    wear = row.wear_percent if sources else None
    ohm = return_resistance(row, tracks, table)
    return [*_where(RETURN, row), ohm, found, wear, _temperature(row, bool(sources)), *_known(sources)]


def _shares(row: ContactLine, table: tuple[Conductor, ...]) -> Iterator[list[Any]]:
    for wire in wire_shares(row, table):
        what = [
            tr(USES.get(wire.use, wire.use)),
            wire.conductor,
            wire.count,
            wire.wear_percent,
            wire.resistance_ohm_per_km,
            100.0 * wire.share,
        ]
        yield [*_where(CONTACT, row), *what]


def _cables(scenario: Scenario) -> Iterator[list[Any]]:
    for feeder in scenario.supply.feeders:
        if feeder.cable is not None:
            ohm = cable_resistance(feeder, scenario.conductors, 0.0)
            known = _known([look_up("cable", feeder.cable, scenario.conductors)])
            yield [feeder.id, feeder.cable, feeder.cables, feeder.length_m, ohm, *known]


def _where(what: str, row: ContactLine | ReturnCircuit) -> list[Any]:
    return [tr(what), tr("all") if row.tracks is None else ", ".join(row.tracks), row.from_km, row.to_km]


def _temperature(row: ContactLine | ReturnCircuit, computed: bool) -> float | None:
    if not computed:
        return None
    return REFERENCE_C if row.temperature_c is None else row.temperature_c


def _known(rows: Iterable[Conductor]) -> list[str]:
    """Return how values are known and where they come from, each once; a value without a row is the user's."""
    kept = list(rows)
    statuses = dict.fromkeys(row.status for row in kept) or ["user"]
    sources = dict.fromkeys(f"{row.name}: {recorded(row.source)}" for row in kept if row.source)
    return ["; ".join(tr(KNOWN_AS.get(status, status)) for status in statuses), "; ".join(sources)]
