"""Voltages of a run: along the line, and how often which voltage was at the pantographs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.limits import find_limit
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.axes import (
    DEAD_V,
    draw_limits,
    limits_between,
    panels_of_lines,
    voltage_range,
    with_margin,
)
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import (
    BLUE,
    COLOURS,
    DASHES,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PAGE,
    SMALLEST,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.reporting.figures.supply.km_axis import name_devices, name_stations
from tractionpower.reporting.figures.supply.panels import head, legend_below, once
from tractionpower.reporting.texts import number, recorded, tr

INCHES = PAGE - 1.15
"""Width of a panel [inches]."""

_PLACE = re.compile(r"track (.+), km (-?[\d.]+)")

MOST_TRACKS = 8
"""With more tracks, those with the lowest voltages are shown."""

BIN_KM = 0.5
"""Length of the bins in which voltages at pantographs are gathered [km]."""

CLASSES_V = (1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0)
"""Widths of a class of the histogram to choose from [V]."""

MOST_CLASSES = 60

MOST_LETTERS = 36
"""Letters of a place."""

JUDGED, LIMIT_ROOM = ("u_min2", "u_max2"), 0.08
"""Limits that voltages are judged by, and room beside them as a share of what the axis shows."""

SAME_V = 1.0
"""A key figure this near to the lowest voltage of the profile [V] tells its place and time."""


def voltage_along_line(data: RunData) -> Figure | None:
    """Draw lowest, mean and highest voltage along the line, with limits, substations, section cabins and loads.

    Where trains ran each track has its own panel, with the voltages at fixed places and at the pantographs of trains.
    """
    profile = data.table("profile")
    if profile is None:
        return None
    if "where" in profile and (profile["where"] == "pantograph").any():
        return _with_trains(data, profile)
    lines = data.places.by_line(profile["track"].astype(str).unique())
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.4 + 2.9 * len(lines))
        panels = list(figure.subplots(len(lines), sharey=True, squeeze=False)[:, 0])
        drawn = 0
        for axes, tracks in zip(panels, lines, strict=True):
            for track in tracks:
                colour, dashes = COLOURS[drawn % len(COLOURS)], DASHES[drawn % len(DASHES)]
                words = (tr("track {track}, mean", track=track), tr("track {track}, lowest to highest", track=track))
                _draw_fixed(axes, profile[profile["track"] == track], words, colour, dashes)
                drawn += 1
            _finish(axes, data, profile, tracks)
            axes.set_ylabel(
                tr("voltage between contact\nline and rail [V]") if len(lines) == 1 else _of_tracks(tracks), fontsize=8
            )
            name_stations(axes, data.places.stations(tracks), INCHES)
        _mark_worst(panels, lines, data, profile)
        return _finished(figure, panels, data)


def _of_tracks(tracks: Sequence[str]) -> str:
    return tr("{tracks}\nvoltage [V]", tracks=told(tracks))


def _finished(figure: Figure, panels: Sequence[Axes], data: RunData) -> Figure:
    for axes in panels:
        axes.tick_params(labelsize=8)
    head(figure, tr("{study}: voltage along the line", study=data.title))
    legend_below(figure, *once(panels), 3)
    return figure


def _with_trains(data: RunData, profile: pd.DataFrame) -> Figure:
    lowest = profile.groupby("track", observed=True)["lowest_voltage_v"].min().sort_values(kind="stable")
    lines = data.places.by_line(str(track) for track in lowest.index[:MOST_TRACKS])
    tracks = [track for line in lines for track in line]
    profile = profile[profile["track"].isin(tracks)]
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.5 + 0.9 * len(lines) + 2.0 * len(tracks))
        panels = panels_of_lines(figure, lines)
        words = (tr("fixed cross-sections, mean"), tr("fixed cross-sections, lowest to highest"))
        for axes, track in zip(panels, tracks, strict=True):
            own = profile[profile["track"] == track]
            _draw_fixed(axes, own[own["where"] != "pantograph"], words, BLUE, "-")
            _draw_pantographs(axes, own[own["where"] == "pantograph"], data.places.ends(track))
            axes.set_ylabel(_of_tracks([track]), fontsize=8)
        for line in lines:
            for track in line:
                axes = panels[tracks.index(track)]
                _finish(axes, data, profile, [track], line=line, names=track == line[0])
            name_stations(panels[tracks.index(line[-1])], data.places.stations(line), INCHES)
        _mark_worst(panels, [[track] for track in tracks], data, profile)
        return _finished(figure, panels, data)


def _draw_fixed(axes: Axes, rows: pd.DataFrame, words: tuple[str, str], colour: str, dashes: Any) -> None:
    """Draw voltages at fixed places, where every step counts; `words` are of the mean and of the range."""
    rows = rows.sort_values("km", kind="stable")
    axes.plot(rows["km"], rows["mean_voltage_v"], color=colour, linestyle=dashes, label=words[0], linewidth=1.5)
    low, high = rows["lowest_voltage_v"], rows["highest_voltage_v"]
    if (high - low).max() > 1.0:
        axes.fill_between(rows["km"], low, high, color=colour, alpha=0.18, label=words[1], lw=0)


def _draw_pantographs(axes: Axes, rows: pd.DataFrame, ends: tuple[float, float]) -> None:
    """Draw voltages at pantographs of trains in bins, the last of which may reach beyond the `ends` of the track [km].

    Where no train was the lines are broken.
    """
    if rows.empty:
        return
    rows = rows.sort_values("km", kind="stable")
    gaps = np.flatnonzero(np.diff(rows["km"]) > 1.5 * BIN_KM)
    km = np.insert(np.clip(rows["km"].to_numpy(float), *ends), gaps + 1, np.nan)
    looks: tuple[tuple[str, str, Any, float], ...] = (
        ("highest", tr("pantographs, highest"), (0, (1, 1.5)), 0.9),
        ("mean", tr("pantographs, mean"), (0, (4, 2)), 0.9),
        ("lowest", tr("pantographs, lowest"), "-", 1.2),
    )
    for which, label, dashes, width in looks:
        volts = np.insert(rows[f"{which}_voltage_v"].to_numpy(float), gaps + 1, np.nan)
        style: Any = {"color": VERMILION, "linestyle": dashes, "linewidth": width}
        axes.plot(km, volts, label=label, **style)


def _finish(
    axes: Axes, data: RunData, profile: pd.DataFrame, tracks: Sequence[str], *, line: Sequence[str] = (), names: bool = True
) -> None:
    """Draw limits, and devices and loads of some tracks; the axis is that of all tracks of a line."""
    axes.set_ylim(*_with_limits(data, float(profile["lowest_voltage_v"].min()), float(profile["highest_voltage_v"].max())))
    axes.set_xlim(*with_margin(*data.places.span(profile, line or tracks)))
    draw_limits(axes, data.scenario)
    name_devices(axes, data.places.devices(tracks), INCHES, names=names)
    loads = sorted({load.km for load in data.scenario.supply.loads if load.track in tracks})
    if loads:
        bottom = axes.get_ylim()[0]
        axes.plot(loads, [bottom] * len(loads), "|", color=INK, markersize=10, clip_on=False, label=tr("loads"))


def _with_limits(data: RunData, lowest: float, highest: float) -> tuple[float, float]:
    """Return from where to where the axis shows voltages [V]: the limits that the run is judged by are always there."""
    judged = [find_limit(data.scenario.limits, data.scenario.supply.system, name) for name in JUDGED]
    values = [limit.value for limit in judged if limit is not None]
    return voltage_range(min(lowest, *values), max(highest, *values), LIMIT_ROOM) if values else voltage_range(lowest, highest)


def _mark_worst(panels: Sequence[Axes], shown: Sequence[Sequence[str]], data: RunData, profile: pd.DataFrame) -> None:
    """Mark the lowest voltage in the panel of its track, with what the key figures say of its place and time."""
    volts = float(profile["lowest_voltage_v"].min())
    where, when = next(
        (
            (figure["place"], figure["time"])
            for (name, _), figure in data.key_figures.items()
            if name == "lowest_voltage_v" and figure["value"] is not None and abs(figure["value"] - volts) < SAME_V
        ),
        ("", ""),
    )
    # Of places that are equally low it is the one that the key figures tell.
    low = profile[profile["lowest_voltage_v"] < volts + SAME_V]
    place = _PLACE.search(where)
    if place is not None and (low["track"] == place[1]).any():
        low = low[low["track"] == place[1]]
        worst = low.iloc[int((low["km"] - float(place[2])).abs().argmin())]
    else:
        worst = profile.iloc[int(profile["lowest_voltage_v"].argmin())]
    km = float(worst["km"])
    axes = next(axes for axes, tracks in zip(panels, shown, strict=True) if str(worst["track"]) in tracks)
    at = "" if "km" in where else tr("km {km}", km=number(km, 2))
    lowest = tr("lowest {volts} V", volts=number(volts, 0))
    text = ", ".join(part for part in (lowest, at, shortened(recorded(where), 64), when) if part)
    left = km < sum(axes.get_xlim()) / 2
    axes.plot(km, volts, "v", color=INK, markersize=6, zorder=4)
    axes.annotate(
        text, (km, volts), (6 if left else -6, -9), textcoords="offset points", ha="left" if left else "right",
        va="top", fontsize=SMALLEST, color=INK, zorder=5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85},
    )  # fmt: skip


def voltage_histogram(data: RunData) -> Figure | None:
    """Draw which share of their time the trains had which voltage at the pantograph, with limits and mean useful voltages."""
    trains = data.table("trains")
    if trains is None:
        return None
    rows = trains[(trains["time_s"] >= data.counts_from_s) & trains["voltage_v"].notna()]
    dead = rows["voltage_v"] < DEAD_V  # neither low nor high
    share_dead = number(100.0 * float(dead.mean()), 2)
    without = tr(" ({percent} % of the time, without voltage, left out)", percent=share_dead) if dead.any() else ""
    rows = rows[~dead]
    if rows.empty:
        return None
    volts, taking = rows["voltage_v"].to_numpy(float), (rows["current_a"] >= 0.0).to_numpy()
    width = next((w for w in CLASSES_V if np.ptp(volts) / w <= MOST_CLASSES), CLASSES_V[-1])
    edges = np.arange(np.floor(volts.min() / width), np.floor(volts.max() / width) + 2) * width
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 4.2)
        axes = figure.add_subplot()
        axes.set_axisbelow(True)
        below = np.zeros(len(edges) - 1)
        for flags, colour, hatch, label in (
            (taking, BLUE, "", tr("taking current")),
            (~taking, GREEN, "////", tr("feeding back")),
        ):
            if flags.any():
                share = 100.0 * np.histogram(volts[flags], edges)[0] / len(volts)
                style: Any = {"color": colour, "edgecolor": "white", "hatch": hatch, "linewidth": 0.4}
                axes.bar(edges[:-1], share, width, bottom=below, align="edge", label=label, **style)
                below = below + share
        axes.set_xlim(*voltage_range(float(volts.min()), float(volts.max()), 0.1))
        axes.set_ylim(0.0, 1.18 * below.max())
        _draw_lines(axes, data, volts)
        axes.tick_params(labelsize=8)
        axes.set_xlabel(tr("voltage at the pantograph [V]"), fontsize=8)
        axes.set_ylabel(tr("share of the time of all trains [%],\nclasses of {width} V", width=number(width)), fontsize=8)
        head(figure, tr("{study}: voltages at pantographs", study=data.title) + without)
        legend_below(figure, *axes.get_legend_handles_labels(), 2)
        return figure


def _draw_lines(axes: Axes, data: RunData, volts: Any) -> None:
    """Draw limits, the lowest voltage and mean useful voltages as upright lines."""
    low, high = axes.get_xlim()
    for shown, value in limits_between(data.scenario, low, high):
        axes.axvline(value, color=GREY, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.annotate(
            f"{shown} {number(value)} V", (value, 1.0), (-2, -2), xycoords=("data", "axes fraction"), textcoords="offset points",
            rotation=90, ha="right", va="top", fontsize=SMALLEST, color=INK,
        )  # fmt: skip
    lines = [*useful_voltages(data), (tr("lowest voltage"), float(volts.min()))]
    dashes: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (1, 1)), (0, (4, 1, 1, 1)), (0, (3, 3)))
    for row, (label, value) in enumerate(lines):
        colour = (VERMILION, ORANGE, INK)[row % 3]
        axes.axvline(
            value, color=colour, linewidth=1.5, linestyle=dashes[row % len(dashes)], label=f"{label}: {number(value, 0)} V"
        )


def useful_voltages(data: RunData) -> list[tuple[str, float]]:
    """Return the mean useful voltages to show: that of the run, or else the lowest of a zone or a train, by each definition."""
    found = []
    for words, ending in ((tr("weighted by current"), "current_weighted"), (tr("mean over time"), "time_mean")):
        name = f"mean_useful_voltage_{ending}_v"
        values = {place: f["value"] for (n, place), f in data.key_figures.items() if n == name and f["value"] is not None}
        groups = (("",), sorted(p for p in values if p.startswith("zone ")), sorted(p for p in values if p.startswith("train ")))
        places = next((group for group in groups if any(place in values for place in group)), ())
        if places:
            place = min(places, key=lambda each: values[each])
            of_one = tr("lowest mean useful voltage, {place}", place=shortened(recorded(place), MOST_LETTERS))
            which = of_one if place else tr("mean useful voltage of all trains")
            found.append((f"{which}, {words}", float(values[place])))
    return found
