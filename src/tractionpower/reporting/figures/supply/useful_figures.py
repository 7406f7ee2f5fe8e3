"""Mean useful voltage of the zones by the hour, as a map of colours with its numbers, by both definitions."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import INK, PAGE, SMALLEST, STYLE, VERMILION, new_figure
from tractionpower.reporting.figures.supply.panels import head
from tractionpower.reporting.texts import mark, number, tr

DEFINITIONS = {
    "current_weighted_v": mark("Weighted by the currents of the trains"),
    "time_mean_v": mark("Mean over time of all trains in the zone"),
}
"""The two definitions by column, and how they are told."""

CLASSES_V = (2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0)
"""Widths of a class of colours to choose from [V]."""

MOST_CLASSES = 10
MOST_ZONES = 26
"""Zones of a figure; with more, those with the lowest voltages are shown."""

NUMBERS_UP_TO = 13
"""Columns up to which numbers stand level in the cells; in more columns they stand upright."""

UPRIGHT_UP_TO = 27

MOST_LETTERS = 30
"""Letters of a name."""


def useful_voltage_zones(data: RunData) -> Figure | None:
    """Draw the mean useful voltage of each zone in each hour and over the run, one panel for each definition."""
    rows = data.table("useful_voltage")
    if rows is None:
        return None
    rows = rows[(rows["kind"] == "zone") & rows["window"].isin(["hour", "run"])]
    if rows[list(DEFINITIONS)].isna().to_numpy().all():
        return None
    zones, every = _zones(rows)
    rows = rows[rows["subject"].isin(zones)]
    hours = sorted(set(rows.loc[rows["window"] == "hour", "from_s"]))
    limit = float(rows["limit_v"].max())
    classes = colour_classes(rows[list(DEFINITIONS)].to_numpy(float))
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        row = 0.17 if len(hours) < NUMBERS_UP_TO else 0.29
        figure = new_figure(PAGE, 1.5 + 2 * (0.3 + row * len(zones)))
        panels = list(figure.subplots(2, 1, sharex=True))
        for axes, (name, words) in zip(panels, DEFINITIONS.items(), strict=True):
            mesh = _draw(axes, _grid(rows, name, zones, hours), zones, classes, limit)
            axes.set_title(tr(words), loc="left", fontsize=8)
        _label_hours(panels[-1], hours)
        bar = figure.colorbar(mesh, ax=panels, location="bottom", shrink=0.8, aspect=45, pad=0.02)
        bar.set_label(tr("mean useful voltage [V]"), fontsize=8)
        bar.ax.tick_params(labelsize=SMALLEST)
        more = tr(", the {shown} lowest of {every} zones", shown=len(zones), every=every) if len(zones) < every else ""
        held = tr("; marked red: below {volts} V", volts=number(limit)) if np.isfinite(limit) else ""
        head(figure, tr("{study}: mean useful voltage of the zones", study=data.title) + more + held)
        return figure


def _zones(rows: pd.DataFrame) -> tuple[list[str], int]:
    """Return the zones to show in the order of the table, and how many there are."""
    valued = rows[rows[list(DEFINITIONS)].notna().any(axis=1)]  # where no train was there is nothing to show
    names = list(dict.fromkeys(valued["subject"].astype(str)))
    lowest = valued.groupby(valued["subject"].astype(str))["current_weighted_v"].min()
    kept = set(lowest.sort_values(kind="stable").head(MOST_ZONES).index)
    return [name for name in names if name in kept], len(names)


def _grid(rows: pd.DataFrame, name: str, zones: list[str], hours: list[float]) -> Any:
    """Return the voltages of a definition [V], a row for each zone, a column for each hour, the last for the run."""
    hourly = rows[rows["window"] == "hour"].pivot_table(index="subject", columns="from_s", values=name, observed=True)
    run = rows[rows["window"] == "run"].set_index(rows.loc[rows["window"] == "run", "subject"].astype(str))[name]
    whole = [float(run.get(zone, np.nan)) for zone in zones]
    return np.column_stack([hourly.reindex(index=zones, columns=hours).to_numpy(float), whole])


def colour_classes(volts: Any) -> Any:
    """Return the bounds of classes of colours that voltages fall into [V], round and at most some ten."""
    low, high = float(np.nanmin(volts)), float(np.nanmax(volts))
    width = next((width for width in CLASSES_V if (high - low) / width <= MOST_CLASSES), 500.0)
    first, last = np.floor(low / width) * width, np.ceil(high / width) * width
    return np.arange(first, max(last, first + 2 * width) + width / 2, width)


def _draw(axes: Axes, volts: Any, zones: list[str], classes: Any, limit: float) -> Any:
    colours = mpl.colormaps["cividis"]
    norm = BoundaryNorm(classes, colours.N)
    mesh = axes.pcolormesh(np.arange(volts.shape[1] + 1), np.arange(len(zones) + 1), volts, cmap=colours, norm=norm)
    axes.set_facecolor("#eeeeee")
    axes.axvline(volts.shape[1] - 1, color="white", linewidth=3.0)
    for row, column in np.argwhere(np.isfinite(volts)) if volts.shape[1] <= UPRIGHT_UP_TO else ():
        value = volts[row, column]
        style: Any = {"color": text_colour(colours(norm(value))), "fontsize": SMALLEST, "ha": "center", "va": "center"}
        style["rotation"] = 0 if volts.shape[1] <= NUMBERS_UP_TO else 90
        if value < limit:
            style["color"], style["bbox"] = "white", {"facecolor": VERMILION, "edgecolor": "none", "pad": 1.0}
        axes.text(column + 0.5, row + 0.5, number(value, 0), **style)
    axes.set_yticks(np.arange(len(zones)) + 0.5, [shortened(zone, MOST_LETTERS) for zone in zones], fontsize=SMALLEST)
    axes.set_ylim(len(zones), 0)
    axes.tick_params(length=0)
    return mesh


def text_colour(behind: Any) -> str:
    """Return the colour of a text that can be read on a colour (relative luminance of sRGB, WCAG 2)."""
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in behind[:3])
    return "black" if 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.18 else "white"


def _label_hours(axes: Axes, hours: list[float]) -> None:
    step = max(1, -(-len(hours) // 26))
    ticks = [k + 0.5 for k in range(0, len(hours), step)]
    names = [f"{int(hours[k] // 3600):02d}" for k in range(0, len(hours), step)]
    axes.set_xticks([*ticks, len(hours) + 0.5], [*names, tr("run")], fontsize=SMALLEST)
    axes.set_xlabel(tr("hour of the day that begins at [h]; the last column is the whole run"), color=INK, fontsize=8)
