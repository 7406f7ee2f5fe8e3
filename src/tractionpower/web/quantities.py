"""The quantities that the page shows: how they are called, in which unit, with how many decimals."""

from __future__ import annotations

from typing import NamedTuple


class Shown(NamedTuple):
    """A number of a snapshot on the panel.

    Attributes
    ----------
    name
        Its name in the snapshot.
    label, unit, decimals
        What is shown.
    """

    name: str
    label: str
    unit: str = ""
    decimals: int = 0


PANEL = (
    Shown("time_s", "Time", "s", 1),
    Shown("position_m", "Way of the front", "m", 1),
    Shown("speed_kmh", "Speed", "km/h", 1),
    Shown("acceleration_mps2", "Acceleration", "m/s²", 3),
    Shown("gradient_permille", "Gradient, first vehicle", "‰", 1),
    Shown("tractive_force_kn", "Tractive effort", "kN", 1),
    Shown("brake_force_kn", "Brakes, all", "kN", 1),
    Shown("resistance_kn", "Resistance", "kN", 1),
    Shown("first_coupling_kn", "First coupling", "kN", 1),
    Shown("greatest_tension_kn", "Greatest tension", "kN", 1),
    Shown("greatest_compression_kn", "Greatest compression", "kN", 1),
    Shown("pipe_bar", "Brake pipe", "bar", 2),
    Shown("cylinder_first_bar", "Cylinder, first", "bar", 2),
    Shown("cylinder_last_bar", "Cylinder, last", "bar", 2),
    Shown("independent_bar", "Independent brake", "bar", 2),
    Shown("electric_percent", "Electric brake", "%", 0),
    Shown("energy_kwh", "Work of traction", "kWh", 2),
    Shown("damage_index", "Cycles of 100 kN", "", 3),
)
"""Numbers of the panel (Zobory and Bekefi, figure 14, lower part), in their order."""

FIRST_AND_LAST = ("cylinder_bar",)
"""Entries of a snapshot that are pairs: of the first and of the last vehicle."""

CHARTS = (
    ("drive", "brake"),
    ("speed_kmh",),
    ("acceleration_mps2",),
    ("first_coupling_kn", "first_coupling_least_kn", "first_coupling_greatest_kn"),
    ("energy_kwh",),
    ("damage_index",),
)
"""Quantities of the rolling diagrams (Zobory and Bekefi, figure 14)."""


def panel() -> list[dict[str, str | int]]:
    """Return the panel as the page reads it."""
    return [shown._asdict() for shown in PANEL]
