"""Wires, contact lines, cables and rails as data: every value with its source and how far it was verified."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from pydantic import Field

from tractionpower.model.base import Declaration, Identifier, Real, Text
from tractionpower.model.limits import Status
from tractionpower.model.quantity import field

Kind = Literal["wire", "contact_line", "cable", "rail"]


class Conductor(Declaration):
    """One row of the conductors table.

    A wire, a cable or a pair of rails has a resistance at 20 °C and a temperature coefficient. A contact line is given by
    its wires (`wires`, as ``messenger 1 L120 + contact 2 Cu100``) or by the resistance that its source prints.
    """

    kind: Kind = Field(description="wire, contact_line, cable or rail (both rails of one track).")
    name: Identifier = Field(description="Name by which inputs call it.")
    resistance_ohm_per_km: Real | None = field("resistance_ohm_per_km", "Resistance at 20 °C, new.", above=0, default=None)
    area_mm2: Real | None = field("area_mm2", "Cross-section.", above=0, default=None)
    per_kelvin: Real = Field(default=0.0, ge=0, le=0.02, description="Temperature coefficient of the resistance at 20 °C [1/K].")
    wires: Text = Field(default="", description="Wires of a contact line.")
    source: Text = Field(default="", description="Where it comes from.")
    status: Status = Field(default="user", description="How the value is known.")


def overlay_conductors(base: Sequence[Conductor], rows: Sequence[Conductor]) -> tuple[Conductor, ...]:
    """Return `base` with each row replaced or added by `rows`, matched by kind and name."""
    merged = {(row.kind, row.name): row for row in base}
    merged.update({(row.kind, row.name): row for row in rows})
    return tuple(merged[key] for key in sorted(merged))


def find_conductor(table: Sequence[Conductor], kind: Kind, name: str) -> Conductor | None:
    """Return the row of a kind and name, or None."""
    return next((row for row in table if row.kind == kind and row.name == name), None)
