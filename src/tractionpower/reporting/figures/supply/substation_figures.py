"""Loads of the substations of a run: currents over time, highest and mean powers, how long which power lasts."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import envelope, interval, sliding_mean
from tractionpower.reporting.figures.base.axes import clock_label, set_clock
from tractionpower.reporting.figures.base.style import BLUE, COLOURS, DASHES, INK, ORANGE, SKY, STYLE, VERMILION, new_figure

Array = NDArray[Any]

WIDTH = 11.7
"""Width of the figures [inches]."""

PIXELS = 1400
"""Spells into which a long series is divided over the whole width of a figure; of each the lowest and the highest is drawn."""

MEAN_S = 900.0
"""Window of the sliding mean [s]."""


def substation_currents(data: RunData) -> Figure | None:
    """Draw the current of each substation over time, a panel for each: the band of all steps and the 15-minute mean."""
    series = [(name, rows["time_s"].to_numpy(), rows["current_a"].to_numpy(float)) for name, rows in _rows(data)]
    if not series:
        return None
    columns = 1 if len(series) <= 3 else 2 if len(series) <= 16 else 3
    lines = -(-len(series) // columns)
    begin, end = float(series[0][1][0]), float(series[0][1][-1]) + interval(series[0][1])
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, max(5.0, 1.3 + (1.9 if columns == 1 else 1.15) * lines), 0.05)
        grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
        panels = grid.T.ravel()
        for axes, (name, time_s, current) in zip(panels, series, strict=False):
            _draw_current(axes, time_s, current, PIXELS // columns)
            axes.set_title(_current_title(data, name, current), loc="left", fontsize=8, pad=3)
        for axes in panels[len(series) :]:  # nothing but their clocks, so that all columns end alike
            axes.set_frame_on(False)
            axes.grid(visible=False)
            axes.tick_params(left=False, labelleft=False)
        set_clock(panels[0], begin, end, 10 if columns == 1 else 7)
        panels[0].set_xlim(begin, end)
        for axes in grid[-1]:
            axes.set_xlabel(clock_label(panels[0]))
        figure.supylabel("current of the substation [A]", fontsize=9)
        figure.suptitle(f"{data.title}: currents of the substations", x=0.01, ha="left", fontsize=11)
        figure.legend(*_once(panels), loc="outside lower center", ncols=3, fontsize=8)
        return figure


def _draw_current(axes: Axes, time_s: Array, current: Array, pixels: int) -> None:
    axes.axhline(0.0, color=INK, linewidth=0.6)
    if len(time_s) > 2 * pixels:
        starts, low, high = envelope(time_s, current, pixels)
        axes.fill_between(starts, low, high, step="post", color=SKY, lw=0.3, label="lowest to highest mean of a step")
    else:
        axes.plot(time_s, current, drawstyle="steps-post", color=SKY, linewidth=1.0, label="mean of a step")
    mean = sliding_mean(current, round(MEAN_S / interval(time_s)))
    if np.isfinite(mean).sum() > 1:
        starts, _, high = envelope(time_s, mean, min(pixels, len(mean)))
        axes.plot(starts, high, color=VERMILION, linewidth=1.0, label="mean of the last 15 min")


def _current_title(data: RunData, name: str, current: Array) -> str:
    figure = data.key_figures.get(("highest_current_a", f"substation {name}"))
    if figure is None or figure["value"] is None:
        return f"▲ {name}: highest {np.nanmax(current):.0f} A"
    return f"▲ {name}: highest {figure['value']:.0f} A" + (f" at {figure['time']}" if figure["time"] else "")


def substation_loads(data: RunData) -> Figure | None:
    """Draw bars of highest, highest 15-minute and mean power, and of highest and RMS currents of the substations."""
    names = _names(data)
    hours = data.counted_hours
    powers = {
        "highest mean of a step": [_kilo(data, "highest_power_kw", name) for name in names],
        "highest 15-min mean (current: RMS)": [_kilo(data, "highest_mean_power_15_min_kw", name) for name in names],
        "whole run: mean (current: RMS)": [_kilo(data, "energy_kwh", name) / hours if hours else np.nan for name in names],
    }
    figures = ("highest_current_a", "highest_rms_current_15_min_a", "rms_current_a")
    currents = {bar: [_kilo(data, figure, name) for name in names] for bar, figure in zip(powers, figures, strict=True)}
    if not names or not np.isfinite([*powers.values(), *currents.values()]).any():
        return None
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, max(4.2, 1.9 + 0.48 * len(names)))
        left, right = figure.subplots(1, 2, sharey=True)
        for axes, bars, label in ((left, powers, "power at the busbars [MW]"), (right, currents, "current [kA]")):
            _draw_bars(axes, bars, names)
            axes.set_xlabel(label)
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8)
        figure.suptitle(f"{data.title}: loads of the substations", x=0.01, ha="left", fontsize=11)
        return figure


def _draw_bars(axes: Axes, bars: dict[str, list[float]], names: list[str]) -> None:
    """Draw three bars a substation, their values beside them."""
    place = np.arange(len(names), dtype=float)
    for number, ((label, values), colour) in enumerate(zip(bars.items(), (BLUE, ORANGE, SKY), strict=True)):
        if not np.isfinite(values).any():  # a window longer than the run has no figure
            continue
        drawn = axes.barh(place + 0.27 * (number - 1), np.nan_to_num(values), 0.25, color=colour, label=label)
        texts = [f"{value:.2f}" if np.isfinite(value) else "" for value in values]
        axes.bar_label(drawn, texts, padding=2, fontsize=7, color=INK)
    axes.set_yticks(place, names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.margins(x=0.12)
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
    series.sort(key=lambda each: -each[1][0])
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 6.4)
        axes = figure.add_subplot()
        for number, (name, power) in enumerate(series):
            share, shown = duration_curve(power)
            colour, dashes = COLOURS[number % len(COLOURS)], DASHES[number // len(COLOURS) % len(DASHES)]
            axes.plot(share, shown, color=colour, linestyle=dashes, linewidth=1.4, label=f"{name}: highest {power[0]:.2f} MW")
        axes.set_xlim(0.0, 100.0)
        axes.set_ylim(min(0.0, *(power[-1] for _, power in series)), None)
        axes.set(xlabel=f"share of the time [%] (100 % = {_duration(data)})", ylabel="power at the busbars at least [MW]")
        axes.set_title(f"{data.title}: load duration of the substations", loc="left")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8, handlelength=3.0)
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
    return [(name, found[name]) for name in _names(data) if name in found]


def _names(data: RunData) -> list[str]:
    """Return the substations in their order along the line."""
    return [each.id for each in sorted(data.scenario.supply.substations, key=lambda each: (each.km, each.id))]


def _kilo(data: RunData, name: str, substation: str) -> float:
    """Return a thousandth of a key figure of a substation, not a number without one."""
    value = data.figure(name, f"substation {substation}")
    return np.nan if value is None else value / 1000.0


def _duration(data: RunData) -> str:
    minutes = round(60.0 * data.counted_hours)
    return f"{minutes // 60} h {minutes % 60:02d} min"


def _once(panels: Array) -> tuple[list[Any], list[str]]:
    """Return handles and labels of all panels, each once."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    return list(found.values()), list(found)
