"""Where the work of the tractive effort goes in a run of train dynamics, over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData

Array = NDArray[Any]

COLUMNS = {
    "traction": "traction_kwh",
    "resistance": "resistance_kwh",
    "brake": "brake_kwh",
    "electric": "electric_kwh",
    "grade": "grade_kwh",
    "coupling": "coupling_kwh",
}
"""Columns of the table of controls by the part of the balance."""

JOULES = 3.6e6
"""Joules of a kilowatt-hour."""


@dataclass(frozen=True, slots=True)
class Energies:
    """Energies since the start [kWh] at times [s], by the part of the balance; work of the traction first."""

    times: Array
    parts: dict[str, Array]


def energies_of(data: ChainData) -> Energies | None:
    """Return the energies of a run, None where its tables do not have them."""
    if not data.has("controls"):
        return None
    present = set(data.table("controls").columns)
    parts = {name: data.control(column) for name, column in COLUMNS.items() if column in present}
    if "traction" not in parts:
        return None
    times = data.control("time_s")
    if data.has("vehicles"):
        kinetic = kinetic_kwh(data)
        parts["kinetic"] = np.interp(times, data.times, kinetic - kinetic[0])
    return Energies(times, parts)


def kinetic_kwh(data: ChainData) -> Array:
    """Return the kinetic energy of the train at the recorded times, with its rotating parts [kWh]."""
    speed = data.of_vehicles("speed_kmh") / 3.6
    inertia = np.array(inertias_t(data)[: speed.shape[1]]) * 1000.0
    return np.asarray(0.5 * (speed**2) @ inertia / JOULES)


def inertias_t(data: ChainData) -> list[float]:
    """Return mass with load and rotating parts of each vehicle from the front [t]; the factor is that of the empty vehicle."""
    found = []
    for part in data.parts:
        vehicle = data.scenario.vehicle(part.id)
        found.append(vehicle.mass_t * vehicle.rotating_mass_factor + vehicle.load_t * part.load_percent / 100.0)
    return found
