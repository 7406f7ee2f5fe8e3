"""Key figures: what sums a run up. Here watts and joules of the sums become kilowatts and kilowatt hours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tractionpower.model.base import format_time
from tractionpower.model.quantity import unit_of
from tractionpower.results.extremes import Array, Extremes
from tractionpower.results.ledgers import ElectricLedger
from tractionpower.results.windows import ClockDemand, SlidingWindows, window_label

LEDGER_FIGURES = {
    "source": ("source_energy_kwh", "sum of E I over the run, warm-up left out"),
    "regulation": ("regulation_energy_kwh", "sum of (E - U) I over the run, warm-up left out"),
    "conductor": ("line_loss_kwh", "heat in contact lines, return circuit and feeders over the run, warm-up left out"),
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
        return {"name": self.name, "value": self.value + 0.0, "unit": unit_of(self.name)} | {  # -0.0 becomes 0.0
            key: figure[key] for key in ("place", "time", "definition", "status")
        }


def voltage_figure(which: str, value: float, place: str, when_s: float) -> KeyFigure:
    """Return the ``lowest`` or ``highest`` voltage [V] of a run, with its place and time [s]."""
    definition = f"{which} mean of a step between contact line and rail, at trains, loads and cross-sections"
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


@dataclass(frozen=True, slots=True)
class PlantSums:
    """What the plant of all substations gives and keeps, besides current and power at the busbars.

    Attributes
    ----------
    voltage
        Busbar voltages [V].
    regulation, heat, fed_back
        (E - U) I; R I2 of the resistances that are heat, where they are given; U I where it is negative [W].
    """

    voltage: Extremes
    regulation: Extremes
    heat: Extremes
    fed_back: Extremes

    @classmethod
    def of(cls, substations: int) -> PlantSums:
        """Return sums of which nothing is known yet."""
        return cls(*(Extremes(substations) for _ in range(4)))

    def add(self, time_s: Array, source: tuple[Array, Array], voltage_v: Array, current_a: Array) -> None:
        """Add rows: start of the steps [s]; voltages [V] and currents [A] of shape (rows, substations).

        `source` are no-load voltages [V] and dissipative resistances [ohm] in these steps, NaN where there is none.
        """
        no_load_v, dissipative_ohm = source
        self.voltage.add(time_s, voltage_v)
        self.heat.add(time_s, dissipative_ohm * current_a**2)
        self.regulation.add(time_s, np.nan_to_num((no_load_v - voltage_v) * current_a))
        self.fed_back.add(time_s, np.minimum(np.nan_to_num(voltage_v) * current_a, 0.0))


def plant_figures(names: Sequence[str], sums: PlantSums, two_way: Sequence[bool], step_s: float) -> Iterator[KeyFigure]:
    """Yield energies and busbar voltages of all substations; those `two_way` can feed back."""
    to_kwh = step_s / 3.6e6
    for k, name in enumerate(names):
        place = f"substation {name}"
        if np.isfinite(sums.voltage.lowest[k]):
            when = format_time(sums.voltage.lowest_s[k])
            yield KeyFigure("lowest_busbar_voltage_v", float(sums.voltage.lowest[k]), place, when, "lowest mean of a step")
            yield KeyFigure("mean_busbar_voltage_v", float(sums.voltage.mean[k]), place, "", "mean of the steps with a voltage")
        regulation_kwh = float(sums.regulation.total[k]) * to_kwh
        yield KeyFigure("plant_regulation_kwh", regulation_kwh, place, "", "sum of (E - U) I over the steps")
        if sums.heat.counts[k]:
            definition = "dissipative resistance times the square of the current, sum over the steps; a part of the regulation"
            yield KeyFigure("plant_heat_kwh", float(sums.heat.total[k]) * to_kwh, place, "", definition)
        if two_way[k]:
            definition = "sum of -U I over the steps in which the busbar feeds back"
            yield KeyFigure("energy_fed_back_kwh", -float(sums.fed_back.total[k]) * to_kwh, place, "", definition)


@dataclass(frozen=True, slots=True)
class SubstationWindows:
    """Sliding windows of all substations.

    Attributes
    ----------
    power, current
        Highest sliding means of the power at the busbars [W] and root mean squares of the current [A].
    demand
        Means of the power over quarters of an hour by the clock [W].
    """

    power: SlidingWindows
    current: SlidingWindows
    demand: ClockDemand

    @classmethod
    def of(cls, substations: int, step_s: float) -> SubstationWindows:
        """Return windows of which nothing is known yet."""
        power, current = SlidingWindows(substations, step_s), SlidingWindows(substations, step_s, squares=True)
        return cls(power, current, ClockDemand(substations, step_s))

    def add(self, time_s: Array, current_a: Array, power_w: Array) -> None:
        """Add rows: start of the steps [s], currents [A] and powers [W] of shape (rows, substations)."""
        self.power.add(time_s, power_w)
        self.current.add(time_s, current_a)
        self.demand.add(time_s, power_w)


def window_figures(names: Sequence[str], windows: SubstationWindows) -> Iterator[KeyFigure]:
    """Yield the highest sliding means and the demand of all substations; windows longer than the run are left out."""
    power, current, demand = windows.power, windows.current, windows.demand
    for k, name in enumerate(names):
        place = f"substation {name}"
        for n, seconds in enumerate(power.windows_s):
            label, words = window_label(seconds), window_label(seconds).replace("_", " ")
            if np.isfinite(power.best[n, k]):
                when = format_time(power.best_from_s[n, k])
                definition = f"highest sliding mean over {words}, U I; time is the start of the window"
                yield KeyFigure(f"highest_mean_power_{label}_kw", float(power.best[n, k]) / 1000.0, place, when, definition)
                when = format_time(current.best_from_s[n, k])
                definition = f"highest sliding root mean square over {words}; time is the start of the window"
                yield KeyFigure(f"highest_rms_current_{label}_a", float(current.best[n, k]), place, when, definition)
        if np.isfinite(demand.best[k]):
            when, definition = format_time(demand.best_from_s[k]), "highest mean over a quarter of an hour by the clock, U I"
            yield KeyFigure("highest_clock_15_min_power_kw", float(demand.best[k]) / 1000.0, place, when, definition)


def link_heat(place: str, squares: float, ohm: float, step_s: float) -> Iterator[KeyFigure]:
    """Yield the heat in a feeder from the sum of the squares of its current [A2]; nothing without a resistance [ohm]."""
    if ohm > 0.0:
        definition = "resistance times the square of the current, sum over the steps"
        yield KeyFigure("feeder_heat_kwh", ohm * squares * step_s / 3.6e6, place, "", definition)


def link_figures(place: str, magnitude: Extremes, k: int, closed_steps: int, trips: int | None) -> Iterator[KeyFigure]:
    """Yield the figures of feeder or switch `k` from the magnitudes of its current [A]; nothing without steps.

    Parameters
    ----------
    place
        Which it is.
    magnitude, k
        Sums and extremes of all of them, and its number.
    closed_steps
        Steps in which it is closed.
    trips
        How often its breaker has tripped; None where it has none.
    """
    if not magnitude.counts[k]:
        return
    when = format_time(magnitude.highest_s[k])
    yield KeyFigure("highest_current_a", float(magnitude.highest[k]), place, when, "highest mean of a step, in either direction")
    yield KeyFigure("rms_current_a", float(magnitude.rms[k]), place, "", "root of the mean square over the run")
    share = 100.0 * closed_steps / magnitude.count
    yield KeyFigure("time_closed_percent", share, place, "", "share of the steps in which it is closed")
    if trips is not None:
        yield KeyFigure("trips", float(trips), place, "", "how often its breaker trips")


def load_figures(names: Sequence[str], power: Extremes, step_s: float) -> Iterator[KeyFigure]:
    """Yield the energy of all loads from their powers [W] in steps of `step_s`."""
    for name, energy_j in zip(names, power.total * step_s, strict=True):
        yield KeyFigure("load_energy_kwh", float(energy_j) / 3.6e6, f"load {name}", "", "sum of U I over the steps")


def ledger_figures(ledger: ElectricLedger) -> Iterator[KeyFigure]:
    """Yield the energies of the electric ledger that no device's figure tells."""
    for name, (title, definition) in LEDGER_FIGURES.items():
        yield KeyFigure(title, ledger.energy_j[name] / 3.6e6, definition=definition)
