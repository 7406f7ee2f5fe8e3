"""Wires, contact lines, cables and rails as data: every value with its source and how far it was verified."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Identifier, Real, Text
from tractionpower.model.limits import Status
from tractionpower.model.quantity import field
from tractionpower.model.supply import Supply, Wire

Kind = Literal["wire", "contact_line", "cable", "rail"]

_WIRE = re.compile(r"(contact|messenger|feeder)\s+([1-9]\d{0,2})\s+(\S.*)")


class Conductor(Declaration):
    """One row of the conductors table.

    A wire, a cable or a pair of rails has a resistance at 20 °C and a temperature coefficient. A contact line is given by
    its wires (`wires`, as ``messenger 1 L120 + contact 2 Cu100``), by the resistance that its source prints, or by both.
    """

    kind: Kind = Field(description="wire, contact_line, cable or rail (both rails of one track).")
    name: Identifier = Field(description="Name by which inputs call it.")
    resistance_ohm_per_km: Real | None = field(
        "resistance_ohm_per_km", "Resistance at 20 °C: new, that of a contact line as printed.", above=0, default=None
    )
    area_mm2: Real | None = field("area_mm2", "Cross-section.", above=0, default=None)
    per_kelvin: Real = Field(default=0.0, ge=0, le=0.02, description="Temperature coefficient of the resistance at 20 °C [1/K].")
    rated_current_a: Real | None = field(
        "rated_current_a", "Continuous current of one cable, one wire or the rails of a track.", above=0, default=None
    )
    diameter_mm: Real | None = Field(default=None, gt=0, description="Outer diameter of a wire [mm].")
    highest_c: Real | None = field("highest_c", "Highest permanent temperature of a wire.", above=0, default=None)
    wires: Text = Field(default="", description="Wires of a contact line, as 'messenger 1 L120 + contact 2 Cu100'.")
    source: Text = Field(default="", description="Where it comes from.")
    status: Status = Field(default="user", description="How the value is known.")

    @model_validator(mode="after")
    def _has_a_value(self) -> Conductor:
        if self.wires and self.kind != "contact_line":
            raise PydanticCustomError("conductor", "only a contact_line has wires")
        if self.resistance_ohm_per_km is None and not self.wires:
            raise PydanticCustomError("conductor", "a conductor has resistance_ohm_per_km; a contact_line that or wires")
        parse_wires(self.wires)
        return self


def parse_wires(text: str) -> tuple[Wire, ...]:
    """Return the wires that a row of kind contact_line names; none for an empty text.

    >>> [(wire.use, wire.count, wire.conductor) for wire in parse_wires("messenger 1 L120 + contact 2 Cu100")]
    [('messenger', 1, 'L120'), ('contact', 2, 'Cu100')]

    Raises
    ------
    PydanticCustomError
        If the text is none of wires; a validator of pydantic tells it as a problem of the input.
    """
    wires = []
    for part in re.split(r"\s\+(?:\s|$)", text) if text.strip() else ():
        match = _WIRE.fullmatch(part.strip())
        if match is None:
            raise PydanticCustomError("wires", "wires are 'USE COUNT NAME + ...'; a use is contact, messenger or feeder")
        wires.append(Wire.model_validate({"use": match[1], "count": int(match[2]), "conductor": match[3]}))
    return tuple(wires)


def overlay_conductors(base: Sequence[Conductor], rows: Sequence[Conductor]) -> tuple[Conductor, ...]:
    """Return `base` with each row replaced or added by `rows`, matched by kind and name."""
    merged = {(row.kind, row.name): row for row in base}
    merged.update({(row.kind, row.name): row for row in rows})
    return tuple(merged[key] for key in sorted(merged))


def find_conductor(table: Sequence[Conductor], kind: Kind, name: str) -> Conductor | None:
    """Return the row of a kind and name, or None."""
    return next((row for row in table if row.kind == kind and row.name == name), None)


def used_conductors(supply: Supply, table: Sequence[Conductor]) -> tuple[Conductor, ...]:
    """Return the rows of `table` that a supply system uses, those of the wires of its contact lines included, sorted."""
    rows = {(row.kind, row.name): row for row in table}
    named: set[tuple[Kind, str]] = {("cable", feeder.cable) for feeder in supply.feeders if feeder.cable is not None}
    named |= {("rail", row.rail) for row in supply.return_circuit if row.rail is not None}
    for row in supply.contact_lines:
        wires = row.wires or ()
        if row.type is not None:
            named.add(("contact_line", row.type))
            found = rows.get(("contact_line", row.type))
            wires = parse_wires(found.wires) if found is not None else ()
        named |= {("wire", wire.conductor) for wire in wires}
    return tuple(rows[key] for key in sorted(named & rows.keys()))
