"""Resistances of contact lines, rails and cables from what is declared of them.

A wire of resistance R20 (new, at 20 °C), temperature coefficient alpha and worn part w of its cross-section has

    R = R20 (1 + alpha (T - 20)) / (1 - w)                                                                  (1)

and the wires of a contact line carry its current in parallel, each by its conductance. The resistances that the Polish
table prints for types of contact line (S. Yoo 2024, table 4) are those of wires at 20 °C whose contact wires are some 9 %
worn: a type that is given without wear keeps the printed value, which is read as that wear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tractionpower.model.conductors import Conductor, Kind, find_conductor, parse_wires
from tractionpower.model.supply import ContactLine, ReturnCircuit, Wire
from tractionpower.model.switchgear import Cable

REFERENCE_C = 20.0
"""Temperature of the resistances in tables [°C] (IEC 60028)."""

MOST_WEAR_PERCENT = 60.0
"""Greatest wear that inputs may give [%]; a printed resistance that means more does not belong to its wires."""


@dataclass(frozen=True, slots=True)
class WireShare:
    """Equal wires of a contact line.

    Attributes
    ----------
    use, conductor, count
        What they are for, their type, and how many there are.
    resistance_ohm_per_km
        Resistance of one of them, worn and warm [ohm/km].
    share
        Part of the contact line's current that all of them carry together.
    wear_percent
        Lost part of the cross-section [%].
    """

    use: str
    conductor: str
    count: int
    resistance_ohm_per_km: float
    share: float
    wear_percent: float


def contact_line_resistance(row: ContactLine, table: Sequence[Conductor]) -> float:
    """Return the resistance of the contact line of one track [ohm/km].

    A type with wires and a printed resistance has that resistance where no wear is given, times the wires' change with
    temperature; with a wear, even of zero, it has that of its wires.

    Raises
    ------
    KeyError
        If the table lacks a conductor; `supply.conductor_checks` reports that before.
    """
    if row.resistance_ohm_per_km is not None:
        return row.resistance_ohm_per_km
    kind = _type_of(row, table)
    wires = worn_wires(row, table)
    printed = kind.resistance_ohm_per_km if kind is not None else None
    if kind is not None and printed is not None and (row.wear_percent is None or not wires):
        return printed * _warming(kind, wires, row.temperature_c, table)
    return _parallel(wires, row.temperature_c, table)


def wire_shares(row: ContactLine, table: Sequence[Conductor]) -> list[WireShare]:
    """Return the wires of a contact line with their shares of its current; none where its wires are not known.

    Raises
    ------
    KeyError
        If the table lacks a conductor; `supply.conductor_checks` reports that before.
    """
    wires = worn_wires(row, table)
    each = [_resistance(look_up("wire", wire.conductor, table), wire.wear_percent, row.temperature_c) for wire in wires]
    whole = sum(wire.count / ohm for wire, ohm in zip(wires, each, strict=True))
    return [
        WireShare(wire.use, wire.conductor, wire.count, ohm, wire.count / ohm / whole, wire.wear_percent)
        for wire, ohm in zip(wires, each, strict=True)
    ]


def return_resistance(row: ReturnCircuit, tracks: int, table: Sequence[Conductor]) -> float:
    """Return the resistance of the rails of so many tracks in parallel [ohm/km].

    Raises
    ------
    KeyError
        If the table lacks the rail; `supply.conductor_checks` reports that before.
    """
    if row.rail is None:
        return row.resistance_ohm_per_km or 0.0
    return _resistance(look_up("rail", row.rail, table), row.wear_percent, row.temperature_c) / tracks


def cable_resistance(item: Cable, table: Sequence[Conductor], default_ohm: float) -> float:
    """Return the resistance of a feeder or return feeder [ohm], at 20 °C where it is given by its cable.

    Raises
    ------
    KeyError
        If the table lacks the cable; `supply.conductor_checks` reports that before.
    """
    if item.resistance_ohm is not None:
        return item.resistance_ohm
    if item.cable is None or item.length_m is None:
        return default_ohm
    return _resistance(look_up("cable", item.cable, table)) * item.length_m / 1000.0 / item.cables


@dataclass(frozen=True, slots=True)
class WornWires:
    """Equal wires of a contact line with their wear [%]."""

    use: str
    conductor: str
    count: int
    wear_percent: float


def worn_wires(row: ContactLine, table: Sequence[Conductor]) -> list[WornWires]:
    """Return the wires of a contact line, each with its own wear or that of the contact line; none where they are not known."""
    kind = _type_of(row, table)
    wires = (row.wires or ()) if kind is None else parse_wires(kind.wires)
    wear = row.wear_percent
    if wear is None and kind is not None and wires:
        wear = wear_as_printed(kind, table)
    return [WornWires(wire.use, wire.conductor, wire.count, _wear(wire, wear or 0.0)) for wire in wires]


def wear_as_printed(kind: Conductor, table: Sequence[Conductor]) -> float | None:
    """Return the wear of the contact wires with which a type has its printed resistance [%]; None if there is none.

    From (1) with G the conductance new: ``1/R = G_others + (1 - w) G_contact``.
    """
    if kind.resistance_ohm_per_km is None or not kind.wires:
        return None
    wires = [WornWires(wire.use, wire.conductor, wire.count, 0.0) for wire in parse_wires(kind.wires)]
    contact = [wire for wire in wires if wire.use == "contact"]
    if not contact:
        return None
    of_contact, of_all = 1.0 / _parallel(contact, None, table), 1.0 / _parallel(wires, None, table)
    percent = 100.0 * (of_all - 1.0 / kind.resistance_ohm_per_km) / of_contact
    return percent if 0.0 <= percent <= MOST_WEAR_PERCENT else None


def look_up(kind: Kind, name: str, table: Sequence[Conductor]) -> Conductor:
    """Return the row of a kind and name.

    Raises
    ------
    KeyError
        If the table lacks it.
    """
    found = find_conductor(table, kind, name)
    if found is None:
        raise KeyError(f"{kind} {name}")
    return found


def _type_of(row: ContactLine, table: Sequence[Conductor]) -> Conductor | None:
    return look_up("contact_line", row.type, table) if row.type is not None else None


def _wear(wire: Wire, of_the_line: float) -> float:
    if wire.wear_percent is not None:
        return wire.wear_percent
    return of_the_line if wire.use == "contact" else 0.0


def _resistance(conductor: Conductor, wear_percent: float = 0.0, temperature_c: float | None = None) -> float:
    """Return the resistance of a conductor by (1) [ohm/km]."""
    warm = 1.0 + conductor.per_kelvin * ((REFERENCE_C if temperature_c is None else temperature_c) - REFERENCE_C)
    return (conductor.resistance_ohm_per_km or 0.0) * warm / (1.0 - wear_percent / 100.0)


def _parallel(wires: Sequence[WornWires], temperature_c: float | None, table: Sequence[Conductor]) -> float:
    """Return the resistance of wires in parallel [ohm/km]."""
    each = [(wire.count, _resistance(look_up("wire", wire.conductor, table), wire.wear_percent, temperature_c)) for wire in wires]
    return 1.0 / sum(count / ohm for count, ohm in each)


def _warming(kind: Conductor, wires: Sequence[WornWires], temperature_c: float | None, table: Sequence[Conductor]) -> float:
    """Return the factor by which a type's resistance changes with temperature: that of its wires, else by its own row."""
    if temperature_c is None:
        return 1.0
    if wires:
        return _parallel(wires, temperature_c, table) / _parallel(wires, None, table)
    return 1.0 + kind.per_kelvin * (temperature_c - REFERENCE_C)
