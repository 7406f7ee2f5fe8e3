"""Outages by kilometre: the lowest voltage of every outage along a line, as a map of colours."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure

from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages, grid_told
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import INK, PAGE, SMALLEST, STYLE, VERMILION, new_figure
from tractionpower.reporting.figures.supply.km_axis import name_devices, name_stations
from tractionpower.reporting.figures.supply.panels import LETTER_7, head
from tractionpower.reporting.figures.supply.useful_figures import colour_classes
from tractionpower.reporting.texts import number, tr

MAP = "outages_by_km"
"""Beginning of the names of the maps."""

MOST_ROWS = 56
"""Outages of one map; with more there is one for each kind, of those with the lowest voltages."""

ROW = 0.125
"""Height of an outage [inches]."""

MOST_LETTERS = 40
"""Letters of a name beside a row."""

GAP_KM = 0.5
"""Length of a bin of the profiles [km]."""


def outage_maps(outages: Outages, title: str) -> Iterator[tuple[str, Figure]]:
    """Yield the maps with their names: of each line, of normal and of low grid voltage, of all outages or of each kind."""
    profile = outages.table("case_profile")
    if profile.empty or outages.cases.empty:
        return
    lines = [tracks for tracks in outages.places.lines if profile["track"].isin(list(tracks)).any()]
    volts = profile["lowest_voltage_v"].to_numpy(float)
    if not np.isfinite(volts).any():
        return
    limit = outages.limit("u_min2")
    classes = _classes(volts, None if limit is None else limit.value)
    for grid in outages.grids:
        if grid == "high" and len(outages.grids) > 1:
            continue  # it raises voltages; low ones are what matters here
        for count, tracks in enumerate(lines, 1):
            for part, rows, words in _parts(outages, grid):
                ends = ("" if grid == "normal" else f"_{grid}") + (f"_line_{count}" if len(lines) > 1 else "")
                what = tr("{study}: lowest voltage of all tracks in every outage, {grid}", study=title, grid=grid_told(grid))
                line_words = f", {told(tracks)}" if len(lines) > 1 else ""
                figure = _draw(outages, rows, tracks, classes, f"{what}{line_words}{words}")
                yield f"{MAP}{ends}{part}", figure


def _parts(outages: Outages, grid: str) -> Iterator[tuple[str, pd.DataFrame, str]]:
    """Yield the rows of each map of a grid voltage with the end of its name and of its title."""
    cases = outages.cases
    rows = cases[(cases["grid"] == grid) & cases["status"].isin(COMPUTED)]
    if len(rows) <= MOST_ROWS:
        if len(rows):
            yield "", rows, ""
        return
    base = rows[rows["kind"] == "base"]
    for kind in dict.fromkeys(rows.loc[rows["kind"] != "base", "kind"]):
        own = rows[rows["kind"] == kind]
        kept = own.sort_values("lowest_voltage_v", kind="stable").head(MOST_ROWS).index
        words = f"\n{tr(KINDS_WORDS.get(kind, kind))}"
        lowest = tr(": the {shown} with the lowest voltages of {every}", shown=len(kept), every=len(own))
        words += lowest if len(kept) < len(own) else ""
        yield f"_{kind}", pd.concat([base, own[own.index.isin(kept)]]), words


def _classes(volts: Any, limit: float | None) -> Any:
    """Return bounds of the classes of colours; below the limit there is one colour for all."""
    known = volts[np.isfinite(volts)]
    if limit is None or not (known < limit).any():
        return colour_classes(known)
    classes = colour_classes(np.maximum(known, limit))
    return np.concatenate(([limit], classes[classes > limit]))


def _draw(outages: Outages, rows: pd.DataFrame, tracks: Sequence[str], classes: Any, title: str) -> Figure:
    profile = outages.table("case_profile")
    own = profile[profile["track"].isin(list(tracks)) & profile["case"].isin(list(rows["case"]))]
    low, high = (float(own["km"].min()), float(own["km"].max())) if len(own) else (0.0, 1.0)
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        names = [shortened(words, MOST_LETTERS) for words in rows["words"]]
        inches = PAGE - 0.3 - LETTER_7 * max(map(len, names), default=0)
        figure = new_figure(PAGE, 2.9 + ROW * max(len(rows), 8))
        axes = figure.add_subplot()
        edges, volts = _grid(own, list(rows["case"]), low, high)
        colours = mpl.colormaps["viridis"].with_extremes(under=VERMILION)
        norm = BoundaryNorm(classes, colours.N)
        below = bool((volts[np.isfinite(volts)] < classes[0]).any())
        mesh = axes.pcolormesh(edges, np.arange(len(rows) + 1), volts, cmap=colours, norm=norm, rasterized=True)
        axes.set_facecolor("#e4e4e4")
        axes.set_xlim(edges[0], edges[-1])
        axes.set_ylim(len(rows), 0)
        axes.set_yticks(np.arange(len(rows)) + 0.5, names, fontsize=SMALLEST)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", labelsize=8)
        _mark_outages(axes, outages, rows, tracks)
        name_devices(axes, [d for d in outages.places.devices(tracks) if d[2]], inches)
        name_stations(axes, outages.places.stations(tracks), inches)
        _part_kinds(axes, list(rows["kind"]))
        bar = figure.colorbar(
            mesh, ax=axes, location="bottom", pad=0.015, aspect=50, shrink=0.9, extend="min" if below else "neither"
        )
        bar.ax.tick_params(labelsize=SMALLEST)
        red = tr("; red: below {volts} V", volts=number(float(classes[0]))) if below else ""
        note = tr("white ring: what is out; grey: no voltage or no train") + red
        bar.set_label(f"{tr('lowest voltage of the run [V]')}\n{note}", fontsize=8)
        head(figure, title)
        return figure


def _grid(rows: pd.DataFrame, cases: list[str], low: float, high: float) -> tuple[Any, Any]:
    """Return the edges of bins [km] and the lowest voltage in each bin of each case, of all tracks [V]."""
    first = np.floor(low / GAP_KM) * GAP_KM
    bins = max(1, int(np.floor((high - first) / GAP_KM + 1e-9)) + 1)
    volts = np.full((len(cases), bins), np.inf)
    codes = pd.Categorical(rows["case"].astype(str), categories=cases).codes
    at = np.clip(((rows["km"].to_numpy(float) - first) / GAP_KM + 1e-9).astype(int), 0, bins - 1)
    values = rows["lowest_voltage_v"].to_numpy(float)
    known = np.isfinite(values) & (codes >= 0)
    np.minimum.at(volts, (codes[known], at[known]), values[known])
    return first + GAP_KM * np.arange(bins + 1), np.where(np.isinf(volts), np.nan, volts)


def _mark_outages(axes: Axes, outages: Outages, rows: pd.DataFrame, tracks: Sequence[str]) -> None:
    """Put a ring at the kilometre of what is out."""
    here = {name: km for km, name, _ in outages.places.devices(tracks)}
    low, high = axes.get_xlim()
    for row, (subject, km) in enumerate(zip(rows["subject"], rows["at_km"], strict=True)):
        station = max((name for name in here if subject == name or subject.startswith(f"{name} ")), key=len, default="")
        at = here.get(station, km if len(outages.places.lines) == 1 else np.nan)
        if np.isfinite(at) and low <= at <= high:
            style: Any = {"markersize": 3.6, "markerfacecolor": "none", "markeredgecolor": "white", "markeredgewidth": 0.9}
            axes.plot([at], [row + 0.5], "o", **style)


def _part_kinds(axes: Axes, kinds: list[str]) -> None:
    """Draw a line between kinds of outages."""
    for row in range(1, len(kinds)):
        if kinds[row] != kinds[row - 1]:
            axes.axhline(row, color="white", linewidth=2.0)
            axes.axhline(row, color=INK, linewidth=0.6)
