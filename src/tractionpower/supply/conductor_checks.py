"""Checks of conductors: whether the table has what the supply names, and whether wear and temperature can act."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Sequence

from tractionpower.errors import Problem
from tractionpower.io.conductor_files import shipped_conductors
from tractionpower.io.wording import shown
from tractionpower.model.conductors import Conductor, Kind, find_conductor, overlay_conductors, parse_wires
from tractionpower.model.supply import ContactLine, ReturnCircuit, Supply
from tractionpower.supply.conductors import MOST_WEAR_PERCENT, REFERENCE_C, wear_as_printed

_WORDS: dict[Kind, str] = {"wire": "wire", "contact_line": "type of contact line", "cable": "cable", "rail": "rail"}
_ADD = "or add a row of it to a CSV file that `conductors:` of the study names"


def check_conductors(supply: Supply, table: Sequence[Conductor]) -> list[Problem]:
    """Return what is wrong or doubtful with the conductors of a supply system.

    Parameters
    ----------
    supply
        The supply system.
    table
        The conductors table, or the rows of it that the supply uses.
    """
    problems: list[Problem] = []
    for number, line in enumerate(supply.contact_lines):
        problems += _check_contact_line(f"supply.contact_lines[{number}]", line, table)
    for number, row in enumerate(supply.return_circuit):
        path = f"supply.return_circuit[{number}]"
        if row.rail is not None:
            problems += _check_name(f"{path}.rail", "rail", row.rail, table)
        else:
            problems += _check_unused(path, row)
    for number, feeder in enumerate(supply.feeders):
        path = f"supply.feeders[{number}]"
        if feeder.cable is not None:
            problems += _check_name(f"{path}.cable", "cable", feeder.cable, table)
        elif feeder.cables != 1:
            remedy = "give cable and length_m as well; resistance_ohm is that of all in parallel"
            problems.append(Problem("cables_without_cable", f"{path}.cables", f"{feeder.cables} cables of no type", "", remedy))
    return problems


def _check_contact_line(path: str, row: ContactLine, table: Sequence[Conductor]) -> Iterator[Problem]:
    for number, wire in enumerate(row.wires or ()):
        yield from _check_name(f"{path}.wires[{number}].conductor", "wire", wire.conductor, table)
    if row.wires is not None:
        return
    if row.type is None:
        yield from _check_unused(path, row)
        return
    yield from _check_name(f"{path}.type", "contact_line", row.type, table)
    kind = find_conductor(table, "contact_line", row.type)
    if kind is not None and kind.wires:
        yield from _check_wires(path, kind, table)
    elif kind is not None:
        yield from _check_wireless(path, row, kind)


def _check_wires(path: str, kind: Conductor, table: Sequence[Conductor]) -> Iterator[Problem]:
    """Yield wires of a type that the table lacks, else whether its printed resistance can be that of its wires."""
    missing = False
    for wire in parse_wires(kind.wires):
        for problem in _check_name(f"{path}.type", "wire", wire.conductor, table, f" of {kind.name}"):
            missing = True
            yield problem
    if not missing and kind.resistance_ohm_per_km is not None and wear_as_printed(kind, table) is None:
        yield Problem(
            "printed_resistance",
            f"{path}.type",
            f"the {kind.resistance_ohm_per_km:g} ohm/km of {kind.name} are not those of its wires with any wear",
            f"contact wires worn by 0 to {MOST_WEAR_PERCENT:g} %",
            "correct the row's resistance or its wires; shares of wires are those of new ones",
            "warning",
        )


def _check_wireless(path: str, row: ContactLine, kind: Conductor) -> Iterator[Problem]:
    """Yield wear and temperature of a type whose wires are not known."""
    found = f"the wires of {kind.name} are not known, only its resistance"
    if row.wear_percent is not None:
        remedy = f"leave it out, choose a type with wires, or add wires to the row of {kind.name}"
        yield Problem("no_wires", f"{path}.wear_percent", found, "", remedy)
    if row.temperature_c not in (None, REFERENCE_C) and kind.per_kelvin == 0.0:
        remedy = f"leave it out, choose a type with wires, or add per_kelvin to the row of {kind.name}"
        yield Problem("no_wires", f"{path}.temperature_c", found, f"{REFERENCE_C:g} °C", remedy)


def _check_unused(path: str, row: ContactLine | ReturnCircuit) -> Iterator[Problem]:
    """Yield wear and temperature beside a given resistance, which they would not change."""
    instead = "type or wires" if isinstance(row, ContactLine) else "rail"
    for name, given in (("wear_percent", bool(row.wear_percent)), ("temperature_c", row.temperature_c is not None)):
        if given:
            found = f"{name} beside resistance_ohm_per_km, which is used as it is given"
            yield Problem(
                "unused_value", f"{path}.{name}", found, "", f"leave it out, or give {instead} instead of the resistance"
            )


def _check_name(path: str, kind: Kind, name: str, table: Sequence[Conductor], owner: str = "") -> Iterator[Problem]:
    """Yield that no row of the table has the name."""
    if find_conductor(table, kind, name) is not None:
        return
    known = overlay_conductors(shipped_conductors(), table)
    found = f"there is no {_WORDS[kind]} {shown(name)}{owner} in the conductors table"
    if find_conductor(known, kind, name) is not None:
        yield Problem("unknown_conductor", path, found, "", "it ships with the program: put its row into Scenario.conductors")
        return
    others = [_WORDS[row.kind] for row in known if row.name == name]
    by_lower = {row.name.lower(): row.name for row in known if row.kind == kind}
    near = [by_lower[match] for match in difflib.get_close_matches(name.lower(), by_lower, n=3, cutoff=0.5)]
    allowed = f"for example {', '.join(near or sorted(by_lower.values())[:3])}"
    hint = f"{name} is a {others[0]}; " if others else "did you mean one of these? " if near else ""
    yield Problem("unknown_conductor", path, found, allowed, f"{hint}choose one that docs/conductors.md lists, {_ADD}")
