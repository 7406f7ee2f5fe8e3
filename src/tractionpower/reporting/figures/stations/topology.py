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
from tractionpower.reporting.figures.base.labels import LETTER, shortened
from tractionpower.reporting.figures.base.style import GREY, INK, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.dynamics.panels import titled
from tractionpower.reporting.figures.stations.marks import colour_of, states_legend
from tractionpower.reporting.texts import number, tr

MOST_INSTANTS = 6
"""Instants that are drawn."""

MOST_LETTERS = 16
"""Letters of the name of a train or station."""

STATIONS = 0.5
"""Part of the width that stations take."""


def topology(case: StationsCase, rows: pd.DataFrame) -> Figure:
    """Draw the tracks with the trains at the instants of the case, each train with its name and its speed at its front.

    Without instants in the case it is the one with the most trains; of a time between rows, the row before counts.
    """
    instants = instants_of(case, rows)
    layout, scale = lay_out(case), _Scale(case)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 0.9 + 1.75 * len(instants))
        grid: Any = figure.subplots(len(instants), sharex=True, squeeze=False)
        panels = list(grid[:, 0])
        shown = []
        for axes, time_s in zip(panels, instants, strict=True):
            trains = rows[rows["time_s"] == time_s]
            shown += trains["state"].astype(str).tolist()
            _draw_tracks(axes, layout, scale)
            _draw_trains(axes, layout, trains, scale)
            _name_stations(axes, case, scale)
            axes.set_title(
                tr("at {time} s: {count} trains", time=number(time_s), count=len(trains)), fontsize=8.5, loc="left", pad=14
            )
        panels[-1].set_xlabel(tr("place [km], stations drawn longer than they are"))
        states_legend(figure, shown)
        return titled(figure, tr("trains on the line, with their speeds"))


def instants_of(case: StationsCase, rows: pd.DataFrame) -> list[float]:
    """Return the times of rows that are drawn [s]."""
    times, counts = np.unique(rows["time_s"].to_numpy(), return_counts=True)
    if not case.shown_at_s:
        return [float(times[counts.argmax()])]
    before = np.searchsorted(times, np.array(case.shown_at_s) + 1e-9, side="right") - 1
    return [float(time_s) for time_s in dict.fromkeys(times[np.maximum(before, 0)].tolist())][:MOST_INSTANTS]


class _Scale:
    """A horizontal axis on which stations have room for their tracks: together `STATIONS` of it.

    Parameters
    ----------
    case
        The case.
    """

    def __init__(self, case: StationsCase) -> None:
        inside = [station.to_m - station.from_m for station in case.stations]
        self.km = np.array([0.0, *(end for each in case.stations for end in (each.from_m, each.to_m)), case.length_m]) / 1e3
        lengths = np.diff(self.km)
        shares = lengths * (1.0 - STATIONS) * 1e3 / (case.length_m - sum(inside))
        shares[1::2] = lengths[1::2] * STATIONS * 1e3 / sum(inside)
        self.at = np.concatenate(([0.0], np.cumsum(shares)))

    def __call__(self, metres: Any) -> Any:
        """Return where places [m] stand on the axis, from 0 to 1."""
        return np.interp(np.asarray(metres) / 1e3, self.km, self.at)


def _draw_tracks(axes: Axes, layout: Layout, scale: _Scale) -> None:
    for piece in layout.pieces:
        x, y = np.array(piece.points).T
        axes.plot(scale(x), y, color=GREY, linewidth=1.0, zorder=1, solid_capstyle="butt")
    high = max(abs(y) for piece in layout.pieces for _, y in piece.points)
    axes.set_ylim(-2.4 * max(high, 1.0), 2.4 * max(high, 1.0))
    axes.set_xlim(-0.04, 1.04)
    axes.set_xticks(scale.at, [number(km, 1) for km in scale.km])
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.grid(visible=False)


def _name_stations(axes: Axes, case: StationsCase, scale: _Scale) -> None:
    for station in case.stations:
        name, middle = shortened(station.name or station.id, MOST_LETTERS), float(scale(0.5 * (station.from_m + station.to_m)))
        axes.annotate(name, (middle, 1.0), (0, 2), xycoords=("data", "axes fraction"), textcoords="offset points", ha="center",
                      va="bottom", fontsize=7.5, color=INK)  # fmt: skip


def _draw_trains(axes: Axes, layout: Layout, trains: pd.DataFrame, scale: _Scale) -> None:
    """Draw trains where their fronts are; a name that has no room above or below the track is left out."""
    pieces = {piece.name: piece for piece in layout.pieces}
    states, speeds = trains["state"].astype(str).tolist(), trains["speed_kmh"].to_numpy(float)
    at = zip(trains["station_track"].astype(str), trains["position_m"].to_numpy(float), strict=True)
    # Pieces are drawn with the distance from where trains come as x, so that is where a train stands.
    places = [(float(scale(place)), float(np.interp(place, *np.array(pieces[name].points).T))) for name, place in at]
    names = [shortened(str(name), MOST_LETTERS) for name in trains["train"]]
    ends = {1: -np.inf, -1: -np.inf}
    for k in sorted(range(len(places)), key=lambda k: places[k]):
        (x, y), colour = places[k], colour_of(states[k])
        axes.plot([x], [y], marker=">", markersize=6.5, color=colour, zorder=3)
        half = 0.5 * (max(len(names[k]), 8) + 1) * LETTER / (0.9 * PAGE)
        wished = (1, -1) if y >= 0.0 else (-1, 1)
        side = next((side for side in wished if x - half >= ends[side]), 0)
        if not side:
            continue
        ends[side] = x + half
        box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": colour, "linewidth": 0.8}
        axes.annotate(
            f"{names[k]}\n{number(speeds[k], 0)} km/h", (x, y), (0, 6 * side), textcoords="offset points", ha="center",
            va="bottom" if side > 0 else "top", color=INK, fontsize=7.0, linespacing=1.0, bbox=box, zorder=4,
        )  # fmt: skip
