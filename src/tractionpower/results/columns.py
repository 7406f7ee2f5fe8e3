"""The tables of a run, each column declared once: name with unit, meaning, type on disk."""

from __future__ import annotations

from dataclasses import dataclass

from tractionpower.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Column:
    """A column: its quantity and how it is stored (``f8``, ``f4``, ``text``, ``bool``, ``i4``)."""

    quantity: Quantity
    kind: str = "f4"

    @property
    def name(self) -> str:
        """Name of the column."""
        return self.quantity.name


def _column(name: str, meaning: str, kind: str = "f4") -> Column:
    return Column(Quantity(name, meaning), kind)


TIME = _column("time_s", "Start of the step, seconds after midnight of the study's day.", "f8")
VOLTAGE = _column("voltage_v", "Mean voltage of the step between contact line and rail.")

TABLES: dict[str, tuple[Column, ...]] = {
    "substations": (
        TIME,
        _column("substation", "Identifier of the substation.", "text"),
        _column("voltage_v", "Voltage of the busbars; empty where they are not in the network."),
        _column("current_a", "Current that the rectifiers feed."),
        _column("power_kw", "Power at the busbars, U I."),
        _column("regulation_kw", "Internal drop times current, (E - U) I; mostly commutation drop and no loss."),
        _column("loss_kw", "Heat in copper and diodes; empty where dissipative_resistance_ohm is not given."),
        _column("blocked", "Whether the rectifiers block.", "bool"),
    ),
    "feeders": (
        TIME,
        _column("substation", "Identifier of the substation.", "text"),
        _column("track", "Track that the feeder supplies.", "text"),
        _column("side", "Side that it supplies: low_km or high_km.", "text"),
        _column("current_a", "Current from the busbar into the contact line."),
    ),
    "loads": (
        TIME,
        _column("load", "Identifier of the load.", "text"),
        VOLTAGE,
        _column("current_a", "Current taken from the line; negative feeds back."),
        _column("power_kw", "Power taken from the line; negative feeds back."),
    ),
    "profile": (
        _column("km", "Place along the line.", "f8"),
        _column("track", "Track.", "text"),
        _column("lowest_voltage_v", "Lowest voltage between contact line and rail."),
        _column("mean_voltage_v", "Mean voltage over the run."),
        _column("highest_voltage_v", "Highest voltage."),
        _column("count", "Number of steps.", "i4"),
    ),
    "events": (
        TIME,
        _column("kind", "Kind of event.", "text"),
        _column("subject", "Device or train that it concerns.", "text"),
        _column("track", "Track.", "text"),
        _column("position_km", "Place.", "f8"),
        _column("value", "What was found.", "f8"),
        _column("limit", "What is allowed.", "f8"),
        _column("message", "The event in words.", "text"),
    ),
}
