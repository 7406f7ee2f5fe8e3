"""The tracks of a line with stations and the trains on them at chosen instants (Diviš and Kavička, figure 1)."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.dynamics.traindyn.layout import Layout, lay_out
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.reporting.figures.base.labels import LETTER, fitting, shortened
from tractionpower.reporting.figures.base.style import GREY, INK, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.stations.marks import PLACE, colour_of, name_stations, states_legend, titled
from tractionpower.reporting.texts import number, tr

MOST_INSTANTS = 6
"""Instants that are drawn."""

MOST_LETTERS = 16
"""Letters of the name of a train."""


def topology(case: StationsCase, rows: pd.DataFrame) -> Figure:
    """Draw the tracks with the trains at the instants of the case, each train with its name and its speed at its front.

    Without instants in the case it is the one with the most trains; of a time between rows, the row before counts.
    """
    instants = instants_of(case, rows)
    layout = lay_out(case)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 0.9 + 1.75 * len(instants))
        grid: Any = figure.subplots(len(instants), sharex=True, squeeze=False)
        panels = list(grid[:, 0])
        shown = []
        for axes, time_s in zip(panels, instants, strict=True):
            trains = rows[rows["time_s"] == time_s]
            shown += trains["state"].astype(str).tolist()
            _draw_tracks(axes, layout)
            _draw_trains(axes, case, layout, trains)
            axes.set_title(
                tr("at {time} s: {count} trains", time=number(time_s), count=len(trains)), fontsize=8.5, loc="left", pad=14
            )
        for axes in panels:
            name_stations(axes, case)
        panels[-1].set_xlabel(tr(PLACE))
        states_legend(figure, shown)
        return titled(figure, case, tr("trains on the line, with their speeds"))


def instants_of(case: StationsCase, rows: pd.DataFrame) -> list[float]:
    """Return the times of rows that are drawn [s]."""
    times, counts = np.unique(rows["time_s"].to_numpy(), return_counts=True)
    if not case.shown_at_s:
        return [float(times[counts.argmax()])]
    before = np.searchsorted(times, np.array(case.shown_at_s) + 1e-9, side="right") - 1
    return [float(time_s) for time_s in dict.fromkeys(times[np.maximum(before, 0)].tolist())][:MOST_INSTANTS]


def _draw_tracks(axes: Axes, layout: Layout) -> None:
    for piece in layout.pieces:
        x, y = np.array(piece.points).T
        axes.plot(x / 1e3, y, color=GREY, linewidth=1.0, zorder=1, solid_capstyle="butt")
    high = max(abs(y) for piece in layout.pieces for _, y in piece.points)
    axes.set_ylim(-2.2 * max(high, 1.0), 2.2 * max(high, 1.0))
    axes.set_xlim(-0.01 * layout.lines[-1].points[-1][0] / 1e3, 1.03 * layout.lines[-1].points[-1][0] / 1e3)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.grid(visible=False)


def _draw_trains(axes: Axes, case: StationsCase, layout: Layout, trains: pd.DataFrame) -> None:
    """Draw trains where their fronts are; names that would overlap are left out, the train farthest ahead first."""
    pieces = {piece.name: piece for piece in layout.pieces}
    at = zip(trains["station_track"].astype(str), trains["position_m"].to_numpy(float), strict=True)
    places = [pieces[name].point(place - layout.starts_m[name]) for name, place in at]
    states, speeds = trains["state"].astype(str).tolist(), trains["speed_kmh"].to_numpy(float)
    names = [shortened(str(name), MOST_LETTERS) for name in trains["train"]]
    per_inch = case.length_m / (0.9 * PAGE)
    for side in (1, -1):  # by turns above and below the tracks
        mine = [
            k for k in range(len(places)) if (1 if places[k][1] > 0.0 or (places[k][1] == 0.0 and k % 2 == 0) else -1) == side
        ]
        widths = [(max(len(names[k]), 8) + 1) * LETTER * per_inch for k in mine]
        kept = {mine[k] for k in fitting([places[k][0] for k in mine], [False] * len(mine), widths)}
        for k in mine:
            x, y = places[k]
            axes.plot([x / 1e3], [y], marker=">", markersize=6.5, color=colour_of(states[k]), zorder=3)
            if k in kept:
                box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": colour_of(states[k]), "linewidth": 0.8}
                axes.annotate(
                    f"{names[k]}\n{number(speeds[k], 0)} km/h", (x / 1e3, y), (0, 6 * side), textcoords="offset points",
                    ha="center", va="bottom" if side > 0 else "top", color=INK, fontsize=7.0, linespacing=1.0, bbox=box, zorder=4,
                )  # fmt: skip
