"""Figures of a comparison: lowest voltages along the line laid over each other, loads of substations side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.places import LinePlaces, told
from tractionpower.reporting.figures.base.axes import draw_limits, panels_of_lines, voltage_range, with_margin
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import COLOURS, DASHES, PAGE, SMALLEST, STYLE, new_figure, save_all
from tractionpower.reporting.figures.supply.km_axis import name_devices, name_stations
from tractionpower.reporting.figures.supply.panels import LETTER_7, head, legend_below
from tractionpower.reporting.texts import mark, tr
from tractionpower.results.results import Results

INCHES = PAGE - 1.15
"""Width of a panel [inches]."""

MOST_TRACKS = 8
"""With more tracks, those with the lowest voltages are shown."""

MOST_LETTERS = 20
"""Letters of a name below an axis."""

GAP_KM = 0.75
"""Bins of pantographs further apart than this are not joined by a line [km]."""

LOADS = (
    ("highest_clock_15_min_power_kw", mark("highest quarter of an hour\nby the clock [kW]")),
    ("highest_power_kw", mark("highest power\nof a step [kW]")),
    ("rms_current_a", mark("RMS current\nover the run [A]")),
    ("highest_current_a", mark("highest current\nof a step [A]")),
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
    profile = results.table("compare_profile").astype({"track": str, "folder": str, "where": str})
    return lowest_along_line(profile, scenario, {folder: folder for folder in folders}, title)


def lowest_along_line(profile: pd.DataFrame, scenario: Scenario, names: Mapping[str, str], title: str) -> Figure | None:
    """Draw the lowest voltage along each track, one line for each of `names`, which gives the words of the legend.

    Parameters
    ----------
    profile
        Columns ``folder`` (a key of `names`), ``track``, ``km``, ``where`` and ``lowest_voltage_v`` [V].
    scenario
        Whose line and limits it is.
    names
        What is drawn, in its order.
    title
        Name of the study.
    """
    profile = profile.dropna(subset=["lowest_voltage_v"])
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
        figure = new_figure(PAGE, 1.5 + 0.9 * len(lines) + 2.0 * len(tracks))
        for axes, track in zip(panels_of_lines(figure, lines), tracks, strict=True):
            line = next(line for line in lines if track in line)
            own = profile[profile["track"] == track]
            for row, (folder, name) in enumerate(names.items()):
                _draw_lowest(axes, own[own["folder"] == folder], name, row)
            axes.tick_params(labelsize=8)
            axes.set_ylabel(tr("{tracks}\nlowest voltage [V]", tracks=told([track])), fontsize=8)
            axes.set_ylim(*voltage_range(float(profile["lowest_voltage_v"].min()), float(profile["lowest_voltage_v"].max())))
            axes.set_xlim(*with_margin(*places.span(profile, line)))
            draw_limits(axes, scenario)
            name_devices(axes, places.devices([track]), INCHES, names=track == line[0])
            if track == line[-1]:
                name_stations(axes, places.stations(line), INCHES)
        head(figure, tr("{study}: lowest voltage along the line", study=title))
        handles, labels = figure.axes[0].get_legend_handles_labels()
        legend_below(figure, handles, labels)
        return figure


def _draw_lowest(axes: Axes, rows: pd.DataFrame, folder: str, row: int) -> None:
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
        np.insert(km, breaks, np.nan), np.insert(volts, breaks, np.nan), color=COLOURS[row % len(COLOURS)],
        linestyle=DASHES[row % len(DASHES)], linewidth=1.3 if row else 1.7, label=folder,
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
        figure = new_figure(PAGE, 1.9 + 1.6 * len(names))
        panels = list(np.atleast_1d(figure.subplots(len(names), 1, sharex=True)))
        width = 0.8 / len(folders)
        for axes, name in zip(panels, names, strict=True):
            loads = wide[name].reindex(stations)
            for row, folder in enumerate(folders):
                at = np.arange(len(stations)) + (row - (len(folders) - 1) / 2) * width
                axes.bar(at, loads[folder].fillna(0.0), 0.92 * width, color=COLOURS[row % len(COLOURS)], label=folder)
            axes.tick_params(labelsize=8)
            axes.set_ylabel(tr(dict(LOADS)[name]), fontsize=8)
            axes.grid(visible=False, axis="x")
            axes.set_axisbelow(True)
        names_shown = [shortened(station, MOST_LETTERS) for station in stations]
        crowded = LETTER_7 * sum(len(name) + 2 for name in names_shown) > INCHES
        turned: Any = {"rotation": 45, "ha": "right", "rotation_mode": "anchor"} if crowded else {}
        panels[-1].set_xticks(np.arange(len(stations)), names_shown, fontsize=SMALLEST, **turned)
        left = len(wide[names[0]]) - len(stations)
        more = tr("; {count} with smaller loads are not drawn", count=left) if left else ""
        head(figure, tr("{study}: loads of the substations", study=title) + more)
        handles, labels = panels[0].get_legend_handles_labels()
        legend_below(figure, handles, labels)
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
