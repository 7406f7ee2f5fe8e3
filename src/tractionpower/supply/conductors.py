"""Resistances of contact lines, rails and cables from what is declared of them."""

from __future__ import annotations

from collections.abc import Sequence

from tractionpower.model.conductors import Conductor
from tractionpower.model.supply import ContactLine, ReturnCircuit
from tractionpower.model.switchgear import Cable


def contact_line_resistance(row: ContactLine, table: Sequence[Conductor]) -> float:
    """Return the resistance of the contact line of one track [ohm/km]."""
    return row.resistance_ohm_per_km or 0.0


def return_resistance(row: ReturnCircuit, tracks: int, table: Sequence[Conductor]) -> float:
    """Return the resistance of the rails of so many tracks in parallel [ohm/km]."""
    return row.resistance_ohm_per_km or 0.0


def cable_resistance(item: Cable, table: Sequence[Conductor], default_ohm: float) -> float:
    """Return the resistance of a feeder or return feeder [ohm]."""
    return default_ohm if item.resistance_ohm is None else item.resistance_ohm
