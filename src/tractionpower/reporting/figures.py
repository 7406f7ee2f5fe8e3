"""Figures of a run."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.limits import find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.style import COLOURS, DASHES, STYLE, new_figure, save
from tractionpower.results.results import Results


def write_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write all figures of a run as PNG into `folder` and return their paths."""
    return [save(voltage_along_line(results, scenario), folder / "voltage_along_line.png")]


def voltage_along_line(results: Results, scenario: Scenario) -> Figure:
    """Draw lowest, mean and highest voltage along the line, with limits, substations, section cabins and loads."""
    with mpl.rc_context(STYLE):
        figure = new_figure(9.0, 4.2)
        axes = figure.add_subplot()
        profile = results.table("profile")
        for number, (track, rows) in enumerate(profile.groupby("track", observed=True)):
            _draw_track(axes, rows, number, f"track {track}")
        _draw_limits(axes, scenario, float(profile["lowest_voltage_v"].min()), float(profile["highest_voltage_v"].max()))
        _mark_devices(axes, scenario)
        axes.set(xlabel="km", ylabel="voltage between contact line and rail [V]")
        axes.set_title(scenario.name, loc="left", pad=22)
        axes.margins(x=0.02)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=4)
        return figure


def _draw_track(axes: Axes, rows: pd.DataFrame, number: int, label: str) -> None:
    km, colour, dashes = rows["km"], COLOURS[number % len(COLOURS)], DASHES[number % len(DASHES)]
    axes.plot(km, rows["mean_voltage_v"], color=colour, linestyle=dashes, label=f"{label}, mean", linewidth=1.6)
    if (rows["highest_voltage_v"] - rows["lowest_voltage_v"]).max() > 1.0:
        band = f"{label}, lowest to highest"
        axes.fill_between(km, rows["lowest_voltage_v"], rows["highest_voltage_v"], color=colour, alpha=0.18, label=band, lw=0)


def _draw_limits(axes: Axes, scenario: Scenario, lowest: float, highest: float) -> None:
    """Draw the limits of the voltage that are near enough to matter."""
    margin = 0.35 * max(highest - lowest, 400.0)
    axes.set_ylim(lowest - margin, highest + margin)
    names = {"u_min2": "U_min2", "u_n": "U_n", "u_max1": "U_max1", "u_max2": "U_max2"}
    for name, shown in names.items():
        limit = find_limit(scenario.limits, scenario.supply.system, name)
        if limit is not None and lowest - margin < limit.value < highest + margin:
            axes.axhline(limit.value, color="#888888", linewidth=0.9, linestyle=(0, (5, 3)))
            axes.annotate(
                f"{shown} {limit.value:g} V", (1.0, limit.value), (-2, 2), xycoords=("axes fraction", "data"),
                textcoords="offset points", ha="right", va="bottom", color="#555555", fontsize=8,
            )  # fmt: skip


def _mark_devices(axes: Axes, scenario: Scenario) -> None:
    """Name substations and section cabins above the axes; leave out names that would overlap."""
    devices = [(s.km, s.id, "▲") for s in scenario.supply.substations]
    devices += [(c.km, c.id, "■") for c in scenario.supply.section_cabins]
    low, high = axes.get_xlim()
    last = -1e9
    for km, name, sign in sorted(devices):
        axes.axvline(km, color="#bbbbbb", linewidth=0.8, zorder=0)
        room = (high - low) * (0.012 * (len(name) + 2))
        text = sign if km - last < room else f"{sign} {name}"
        last = km if text != sign else last
        axes.annotate(text, (km, 1.0), (0, 3), xycoords=("data", "axes fraction"), textcoords="offset points",
                      ha="center", va="bottom", fontsize=8, color="#333333")  # fmt: skip
    loads = sorted({(load.km, load.id) for load in scenario.supply.loads})
    bottom = axes.get_ylim()[0]
    axes.plot([km for km, _ in loads], [bottom] * len(loads), "|", color="#333333", markersize=10, clip_on=False)
