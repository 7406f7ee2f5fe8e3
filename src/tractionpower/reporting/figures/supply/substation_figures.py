"""Loads of the substations of a run: highest and mean powers and currents, how long which power lasts."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.substation_loads import along_line
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import BLUE, COLOURS, DASHES, INK, ORANGE, PAGE, SKY, SMALLEST, STYLE, new_figure
from tractionpower.reporting.figures.supply.panels import head, legend_below, most_loaded, once
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

MOST_STATIONS = 24
"""Substations of a figure with bars; with more, those with the highest powers are shown."""

MOST_CURVES = 16

MOST_LETTERS = 24
"""Letters of a name."""


def substation_loads(data: RunData) -> Figure | None:
    """Draw bars of highest, highest 15-minute and mean power, and of highest and RMS currents of the substations."""
    every = [station.id for station in along_line(data.scenario)]
    hours = data.counted_hours
    order = most_loaded([_kilo(data, "highest_power_kw", name) for name in every], MOST_STATIONS)
    names = [every[k] for k in order]
    powers = {
        tr("highest mean of a step"): [_kilo(data, "highest_power_kw", name) for name in names],
        tr("highest 15-min mean (current: RMS)"): [_kilo(data, "highest_mean_power_15_min_kw", name) for name in names],
        tr("whole run: mean (current: RMS)"): [_kilo(data, "energy_kwh", name) / hours if hours else np.nan for name in names],
    }
    figures = ("highest_current_a", "highest_rms_current_15_min_a", "rms_current_a")
    currents = {bar: [_kilo(data, figure, name) for name in names] for bar, figure in zip(powers, figures, strict=True)}
    if not names or not np.isfinite([*powers.values(), *currents.values()]).any():
        return None
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, max(2.6, 1.3 + 0.4 * len(names)))
        left, right = figure.subplots(1, 2, sharey=True)
        for axes, bars, label in ((left, powers, tr("power at the busbars [MW]")), (right, currents, tr("current [kA]"))):
            _draw_bars(axes, bars, names)
            axes.set_xlabel(label, fontsize=8)
        legend_below(figure, *once([left]), 3)
        more = tr(", the {shown} most loaded of {every}", shown=len(names), every=len(every)) if len(names) < len(every) else ""
        head(figure, tr("{study}: loads of the substations", study=data.title) + more)
        return figure


def _draw_bars(axes: Axes, bars: dict[str, list[float]], names: list[str]) -> None:
    """Draw three bars a substation, their values beside them."""
    place = np.arange(len(names), dtype=float)
    for row, ((label, values), colour) in enumerate(zip(bars.items(), (BLUE, ORANGE, SKY), strict=True)):
        if not np.isfinite(values).any():  # a window longer than the run has no figure
            continue
        drawn = axes.barh(place + 0.29 * (row - 1), np.nan_to_num(values), 0.27, color=colour, label=label)
        texts = [number(value, 2, bare=False) if np.isfinite(value) else "" for value in values]
        axes.bar_label(drawn, texts, padding=2, fontsize=SMALLEST, color=INK)
    axes.set_yticks(place, [shortened(name, MOST_LETTERS) for name in names], fontsize=SMALLEST)
    axes.tick_params(labelsize=SMALLEST)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.margins(x=0.17)
    axes.set_axisbelow(True)
    axes.grid(visible=False, axis="y")


def load_duration(data: RunData) -> Figure | None:
    """Draw for each substation how long its power is at least so high."""
    series = []
    for name, rows in _rows(data):
        counted = rows[rows["time_s"] >= data.counts_from_s]
        power = np.sort(np.nan_to_num(counted["power_kw"].to_numpy(float)))[::-1] / 1000.0
        if len(power):
            series.append((name, power))
    if not series:
        return None
    every = len(series)
    series = sorted(series, key=lambda each: -each[1][0])[:MOST_CURVES]
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.6 + 0.16 * (-(-len(series) // 2)))
        axes = figure.add_subplot()
        for row, (name, power) in enumerate(series):
            share, shown = duration_curve(power)
            colour, dashes = COLOURS[row % len(COLOURS)], DASHES[row // len(COLOURS) % len(DASHES)]
            highest = number(power[0], 2, bare=False)
            label = tr("{name}: highest {power} MW", name=shortened(name, MOST_LETTERS), power=highest)
            axes.plot(share, shown, color=colour, linestyle=dashes, linewidth=1.3, label=label)
        axes.set_xlim(0.0, 100.0)
        axes.set_ylim(min(0.0, *(power[-1] for _, power in series)), None)
        axes.tick_params(labelsize=8)
        axes.set_xlabel(tr("share of the time [%] (100 % = {time})", time=_duration(data)), fontsize=8)
        axes.set_ylabel(tr("power at the busbars at least [MW]"), fontsize=8)
        more = tr(", the {shown} most loaded of {every}", shown=len(series), every=every) if len(series) < every else ""
        head(figure, tr("{study}: load duration of the substations", study=data.title) + more)
        legend_below(figure, *axes.get_legend_handles_labels(), 2)
        return figure


def duration_curve(falling: Array, most: int = 1500) -> tuple[Array, Array]:
    """Return shares of the time [%] and the values that last at least so long, of values sorted from the highest down.

    The highest value stands at 0, the lowest at 100 %.
    """
    picks = np.unique(np.linspace(0, len(falling) - 1, min(most, len(falling))).astype(int))
    return np.append(0.0, 100.0 * (picks + 1) / len(falling)), np.append(falling[0], falling[picks])


def _rows(data: RunData) -> list[tuple[str, Any]]:
    """Return the rows of substations in their order along the line."""
    found = dict(data.rows_of("substations", "substation"))
    return [(station.id, found[station.id]) for station in along_line(data.scenario) if station.id in found]


def _kilo(data: RunData, name: str, substation: str) -> float:
    """Return a thousandth of a key figure of a substation, not a number without one."""
    value = data.figure(name, f"substation {substation}")
    return np.nan if value is None else value / 1000.0


def _duration(data: RunData) -> str:
    minutes = round(60.0 * data.counted_hours)
    return f"{minutes // 60} h {minutes % 60:02d} min"
