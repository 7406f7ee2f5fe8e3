"""Where the work of the tractive effort goes in a run of train dynamics, over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData

Array = NDArray[Any]

COLUMNS = {
    "traction": "traction_kwh",
    "resistance": "resistance_kwh",
    "brake": "brake_kwh",
    "electric": "electric_kwh",
    "gravity": "gravity_kwh",
    "coupling": "coupling_kwh",
    "kinetic": "kinetic_kwh",
}
"""Columns of the table of controls by the part of the balance."""


@dataclass(frozen=True, slots=True)
class Energies:
    """Energies since the start [kWh] at times [s], by the part of the balance; the kinetic one is its change."""

    times: Array
    parts: dict[str, Array]


def energies_of(data: ChainData) -> Energies | None:
    """Return the energies of a run, None where its tables do not have them."""
    if not data.has("controls"):
        return None
    present = set(data.table("controls").columns)
    parts = {name: data.control(column) for name, column in COLUMNS.items() if column in present}
    if "kinetic" in parts:
        parts["kinetic"] = parts["kinetic"] - parts["kinetic"][0]
    return Energies(data.control("time_s"), parts)
