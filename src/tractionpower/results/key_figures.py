"""Key figures: what sums a run up. Here watts and joules of the sums become kilowatts and kilowatt hours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from tractionpower.model.base import format_time
from tractionpower.model.quantity import unit_of
from tractionpower.results.extremes import Extremes
from tractionpower.results.ledgers import ElectricLedger

LEDGER_FIGURES = {
    "source": ("source_energy_kwh", "sum of E I over the whole run"),
    "regulation": ("regulation_energy_kwh", "sum of (E - U) I over the whole run"),
    "conductor": ("line_loss_kwh", "heat in contact lines, return circuit and feeders over the whole run"),
}


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """One number that sums up a run.

    Attributes
    ----------
    name
        Name with the unit as suffix.
    value
        The number in that unit.
    place, time
        Where and when (HH:MM:SS); empty where that means nothing.
    definition
        How it is computed.
    status
        Status of the limit that it is held against; empty without one.
    """

    name: str
    value: float
    place: str = ""
    time: str = ""
    definition: str = ""
    status: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the figure as it is written, with its unit."""
        figure = asdict(self)
        return {"name": self.name, "value": self.value, "unit": unit_of(self.name)} | {
            key: figure[key] for key in ("place", "time", "definition", "status")
        }


def voltage_figure(which: str, value: float, place: str, when_s: float) -> KeyFigure:
    """Return the ``lowest`` or ``highest`` voltage [V] of a run, with its place and time [s]."""
    definition = f"{which} voltage between contact line and rail at cross-sections and loads"
    return KeyFigure(f"{which}_voltage_v", float(value), place, format_time(when_s), definition)


def substation_figures(names: Sequence[str], current: Extremes, power: Extremes, step_s: float) -> Iterator[KeyFigure]:
    """Yield the figures of all substations from their currents [A] and powers [W] in steps of `step_s`."""
    energy_j = power.total * step_s
    for k, name in enumerate(names):
        place = f"substation {name}"
        when = format_time(current.highest_s[k])
        yield KeyFigure("highest_current_a", float(current.highest[k]), place, when, "highest mean of a step")
        yield KeyFigure("mean_current_a", float(current.mean[k]), place, "", "mean over the run")
        yield KeyFigure("rms_current_a", float(current.rms[k]), place, "", "root of the mean square over the run")
        when = format_time(power.highest_s[k])
        yield KeyFigure("highest_power_kw", float(power.highest[k]) / 1000.0, place, when, "highest mean of a step, U I")
        yield KeyFigure("energy_kwh", float(energy_j[k]) / 3.6e6, place, "", "sum of U I over the steps")


def load_figures(names: Sequence[str], power: Extremes, step_s: float) -> Iterator[KeyFigure]:
    """Yield the energy of all loads from their powers [W] in steps of `step_s`."""
    for name, energy_j in zip(names, power.total * step_s, strict=True):
        yield KeyFigure("load_energy_kwh", float(energy_j) / 3.6e6, f"load {name}", "", "sum of U I over the steps")


def ledger_figures(ledger: ElectricLedger) -> Iterator[KeyFigure]:
    """Yield the energies of the electric ledger that no device's figure tells."""
    for name, (title, definition) in LEDGER_FIGURES.items():
        yield KeyFigure(title, ledger.energy_j[name] / 3.6e6, definition=definition)
