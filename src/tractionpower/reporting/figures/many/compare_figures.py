"""Figures of a comparison: lowest voltages along the line laid over each other, loads of substations side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.figures.base.axes import draw_limits, mark_devices, panels_of_lines, voltage_range, with_margin
from tractionpower.reporting.figures.base.style import COLOURS, DASHES, STYLE, new_figure, save_all
from tractionpower.results.results import Results

WIDTH = 10.5
MOST_TRACKS = 8
"""With more tracks, those with the lowest voltages are shown."""

GAP_KM = 0.75
"""Bins of pantographs further apart than this are not joined by a line [km]."""

LOADS = (
    ("highest_clock_15_min_power_kw", "highest quarter of an hour\nby the clock [kW]"),
    ("highest_power_kw", "highest power of a step [kW]"),
    ("rms_current_a", "RMS current\nover the run [A]"),
    ("highest_current_a", "highest current\nof a step [A]"),
)
"""Figures of substations that are drawn, as far as the folders have them; the second only without the first."""

MOST_BARS = 60
"""Bars in one panel; with more, the substations with the greatest loads are shown."""


NAMES = ("compare_voltage", "compare_substations")


def write_compare_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write the figures of a comparison as PNG into `folder` and return their paths."""
    return save_all(compare_figures(results, scenario), folder, NAMES)


def compare_figures(results: Results, scenario: Scenario) -> dict[str, Figure]:
    """Return the figures of a comparison by name; `scenario` is that of the base folder."""
    folders = [entry["name"] for entry in results.run["compare"]["folders"]]
    title = str(results.run.get("name") or results.run.get("study", ""))
    drawn = {
        "compare_voltage": voltage_along_line(results, scenario, folders, title),
        "compare_substations": substation_loads(results, scenario, folders, title),
    }
    return {name: figure for name, figure in drawn.items() if figure is not None}


def voltage_along_line(results: Results, scenario: Scenario, folders: Sequence[str], title: str) -> Figure | None:
    """Draw the lowest voltage along each track, one line for each folder."""
    if "compare_profile" not in results.tables:
        return None
    profile = results.table("compare_profile").dropna(subset=["lowest_voltage_v"])
    profile = profile.astype({"track": str, "folder": str, "where": str})
    lowest = profile.groupby("track")["lowest_voltage_v"].min().sort_values(kind="stable")
    places = LinePlaces(scenario)
    known = {track.id for track in scenario.line.tracks}
    shown = [track for track in lowest.index if track in known][:MOST_TRACKS]
    if not shown:
        return None
    lines = places.by_line(shown)
    tracks = [track for line in lines for track in line]
    profile = profile[profile["track"].isin(tracks)]
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 1.5 + 0.5 * len(lines) + 2.5 * len(tracks))
        for axes, track in zip(panels_of_lines(figure, lines), tracks, strict=True):
            line = next(line for line in lines if track in line)
            own = profile[profile["track"] == track]
            for number, folder in enumerate(folders):
                _draw_lowest(axes, own[own["folder"] == folder], folder, number)
            axes.set_ylabel(f"track {track}\nlowest voltage [V]")
            axes.set_ylim(*voltage_range(float(profile["lowest_voltage_v"].min()), float(profile["lowest_voltage_v"].max())))
            axes.set_xlim(*with_margin(*places.span(profile, line)))
            draw_limits(axes, scenario)
            mark_devices(axes, places.devices([track]), WIDTH - 1.0, names=track == line[0])
            if track == line[-1]:
                axes.set_xlabel("kilometre of the line [km]")
        figure.suptitle(f"{title}: lowest voltage along the line", x=0.01, ha="left", fontsize=11)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
        return figure


def _draw_lowest(axes: Axes, rows: pd.DataFrame, folder: str, number: int) -> None:
    """Draw one folder: what trains had where trains ran, else what fixed places had."""
    if (rows["where"] == "pantograph").any():
        rows = rows[rows["where"] == "pantograph"]
        gap = GAP_KM
    else:
        gap = np.inf
    rows = rows.sort_values("km", kind="stable")
    km, volts = rows["km"].to_numpy(float), rows["lowest_voltage_v"].to_numpy(float)
    breaks = np.flatnonzero(np.diff(km) > gap) + 1
    axes.plot(
        np.insert(km, breaks, np.nan), np.insert(volts, breaks, np.nan), color=COLOURS[number % len(COLOURS)],
        linestyle=DASHES[number % len(DASHES)], linewidth=1.5 if number else 1.9, label=folder,
    )  # fmt: skip


def substation_loads(results: Results, scenario: Scenario, folders: Sequence[str], title: str) -> Figure | None:
    """Draw the loads of substations as bars side by side, in their order along the line."""
    if "compare" not in results.tables:
        return None
    rows = results.table("compare").astype({"figure": str, "place": str, "folder": str})
    has = [name for name, _ in LOADS if ((rows["figure"] == name) & rows["place"].str.startswith("substation ")).any()]
    names = [name for name in has if not (name == "highest_power_kw" and "highest_clock_15_min_power_kw" in has)]
    if not names:
        return None
    wide = {name: _wide(rows[rows["figure"] == name], folders) for name in names}
    stations = _along_line(wide[names[0]], scenario, MOST_BARS // max(len(folders), 1))
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 1.6 + 2.1 * len(names))
        panels = list(np.atleast_1d(figure.subplots(len(names), 1, sharex=True)))
        width = 0.8 / len(folders)
        for axes, name in zip(panels, names, strict=True):
            loads = wide[name].reindex(stations)
            for number, folder in enumerate(folders):
                at = np.arange(len(stations)) + (number - (len(folders) - 1) / 2) * width
                axes.bar(at, loads[folder].fillna(0.0), 0.92 * width, color=COLOURS[number % len(COLOURS)], label=folder)
            axes.set_ylabel(dict(LOADS)[name])
            axes.grid(visible=False, axis="x")
            axes.set_axisbelow(True)
        crowded = sum(len(station) + 2 for station in stations) > 120
        turned: Any = {"rotation": 35, "ha": "right", "rotation_mode": "anchor"} if crowded else {}
        panels[-1].set_xticks(np.arange(len(stations)), stations, **turned)
        left = len(wide[names[0]]) - len(stations)
        more = f"; {left} with smaller loads are not drawn" if left else ""
        figure.suptitle(f"{title}: loads of the substations{more}", x=0.01, ha="left", fontsize=11)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
        return figure


def _wide(rows: pd.DataFrame, folders: Sequence[str]) -> pd.DataFrame:
    """Return values by substation, a column for each folder."""
    own = rows[rows["place"].str.startswith("substation ")]
    values = own.assign(station=own["place"].str.removeprefix("substation ")).pivot_table(
        index="station", columns="folder", values="value", aggfunc="first"
    )
    return values.reindex(columns=list(folders))


def _along_line(loads: pd.DataFrame, scenario: Scenario, most: int) -> list[str]:
    """Return the substations in their order along the line, those with the greatest loads where there are too many."""
    declared = [station.id for station in sorted(scenario.supply.substations, key=lambda station: (station.km, station.id))]
    kept = set(loads.max(axis=1).sort_values(ascending=False, kind="stable").index[: max(most, 1)])
    ordered = [station for station in declared if station in loads.index]
    return [station for station in [*ordered, *sorted(set(loads.index) - set(ordered))] if station in kept]
