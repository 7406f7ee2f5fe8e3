"""Wires, contact lines, cables and rails: the shipped table and a user's rows over it."""

from __future__ import annotations

from tractionpower.io.overlaid_tables import OverlaidTable
from tractionpower.model.conductors import Conductor, overlay_conductors

CONDUCTORS = OverlaidTable(Conductor, "conductors", "conductor", ("kind", "name"), overlay_conductors)


def shipped_conductors() -> tuple[Conductor, ...]:
    """Return the conductors that ship with the program, sorted by kind and name."""
    return CONDUCTORS.shipped
