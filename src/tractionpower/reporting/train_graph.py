"""The train graph: place over time of trains, with the timetable beside it. It does not know where the trains come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.axes import clock_label, set_clock
from tractionpower.reporting.labels import LETTER, LINE, fitting
from tractionpower.reporting.style import BLUE, GREEN, GREY, INK, STYLE, VERMILION, new_figure

Array = NDArray[Any]

WIDTH, HEIGHT = 10.5, 6.8

MOST_NAMES = 40
"""With more trains their names are left out."""

MOST_CIRCLES = 160
"""With more planned times they are left out."""

_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9)  # of a train's run, where its name may stand

JUMP_KM = 0.05
"""Where the kilometre moves by this much more than the train, its line is broken [km]."""


@dataclass(frozen=True, slots=True, eq=False)
class TrainLine:
    """A train in the graph.

    Attributes
    ----------
    name
        Its identifier.
    time_s, km
        Times [s] and kilometres [km], not a number where the line is broken.
    arrives
        Whether it comes to its end; one that does not is marked where it stays.
    """

    name: str
    time_s: Array
    km: Array
    arrives: bool = True

    def between(self, begin_s: float, end_s: float) -> TrainLine | None:
        """Return the part of the line within a window of time [s], or None if there is none."""
        inside = (self.time_s >= begin_s) & (self.time_s <= end_s)
        if np.isfinite(self.km[inside]).sum() < 2:
            return None
        return TrainLine(self.name, self.time_s[inside], self.km[inside], self.arrives or not inside[-1])


@dataclass(frozen=True, slots=True)
class GraphPlaces:
    """What stands beside a train graph.

    Attributes
    ----------
    stations
        Kilometre [km] and name of the stations, and whether a train stops there.
    devices
        Kilometre [km] and name of substations and section cabins, and whether it is a substation.
    """

    stations: Sequence[tuple[float, str, bool]] = ()
    devices: Sequence[tuple[float, str, bool]] = ()


def broken_where_it_jumps(km: Array, place_m: Array, track: Array) -> Array:
    """Return kilometres, not a number where a train comes onto another track whose kilometrage jumps.

    Parameters
    ----------
    km, place_m, track
        Kilometre [km], distance from the start of the route [m], and a number of the track.
    """
    jumps = np.abs(np.abs(np.diff(km)) - np.diff(place_m) / 1000.0) > JUMP_KM
    return np.where(np.append(False, jumps & (np.diff(track) != 0)), np.nan, km)


def train_graph(lines: Sequence[TrainLine], planned: Sequence[tuple[float, float]], places: GraphPlaces, title: str) -> Figure:
    """Draw s = f(t) of trains, times that the timetable plans as circles.

    Parameters
    ----------
    lines
        What is drawn; trains with rising and falling kilometres differ in colour and dashes.
    planned
        Planned times [s] and places [km].
    places
        Stations and devices of the supply.
    title
        What stands above.
    """
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, HEIGHT)
        axes = figure.add_subplot()
        many = len(lines) > MOST_NAMES
        for line in lines:
            _draw(axes, line, 0.6 if many else 1.2)
        planned = planned if len(planned) <= MOST_CIRCLES else ()
        if planned:
            axes.plot(*zip(*planned, strict=True), "o", markerfacecolor="white", markeredgecolor=VERMILION, markersize=4.5,
                      markeredgewidth=1.0, linestyle="", label="planned (timetable)", zorder=3)  # fmt: skip
        set_clock(axes, min(float(line.time_s[0]) for line in lines), max(float(line.time_s[-1]) for line in lines))
        axes.set(xlabel=clock_label(axes), ylabel="kilometre of the line [km]")
        axes.margins(y=0.03)
        _name_stations(axes, places.stations)
        _mark_devices(axes, places.devices)
        if not many:
            _name_trains(axes, lines, planned)
        axes.set_title(title, loc="left")
        handles, labels = axes.get_legend_handles_labels()
        unique = dict(zip(labels, handles, strict=True))
        axes.legend(unique.values(), unique.keys(), loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=6)
        return figure


def _draw(axes: Axes, line: TrainLine, width: float) -> None:
    known = line.km[np.isfinite(line.km)]
    rising = known[-1] >= known[0]
    colour, dashes, label = (BLUE, "-", "rising kilometres") if rising else (INK, (0, (5, 2)), "falling kilometres")
    axes.plot(line.time_s, line.km, color=colour, linestyle=dashes, linewidth=width, label=f"computed, {label}")
    if not line.arrives:
        axes.plot(line.time_s[-1], line.km[-1], "X", color=VERMILION, markersize=8, label="not at the end of its route", zorder=4)


def _name_stations(axes: Axes, stations: Sequence[tuple[float, str, bool]]) -> None:
    """Name the stations on the right; leave out names that would overlap."""
    low, high = axes.get_ylim()
    gap = LINE * (high - low) / (HEIGHT - 1.3)
    shown = fitting([km for km, _, _ in stations], [stops for _, _, stops in stations], gap)
    for k in shown:
        axes.axhline(stations[k][0], color=GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    right = axes.secondary_yaxis("right")
    right.set_yticks([stations[k][0] for k in shown], [stations[k][1] for k in shown])
    right.tick_params(length=3, labelsize=8, colors=INK)
    right.spines["right"].set_visible(False)


def _mark_devices(axes: Axes, devices: Sequence[tuple[float, str, bool]]) -> None:
    """Mark substations and section cabins on the left."""
    for substation, sign, size, label in ((True, ">", 7, "substation"), (False, "s", 4, "section cabin")):
        km = [place for place, _, kind in devices if kind == substation]
        if km:
            axes.plot([0.0] * len(km), km, sign, color=GREEN, markersize=size, clip_on=False, zorder=4, label=label,
                      transform=axes.get_yaxis_transform())  # fmt: skip


def _name_trains(axes: Axes, lines: Sequence[TrainLine], planned: Sequence[tuple[float, float]]) -> None:
    """Write each train's name on its line where it moves and nothing else stands; leave it out where there is no room."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    tall = LINE * (high - low) / (HEIGHT - 1.3)
    second = (right - left) / (WIDTH - 2.0)  # time in an inch of paper
    taken = [(x, y, 0.1 * second) for x, y in planned]
    for number, line in enumerate(lines):
        time_s, km = line.time_s, line.km
        wide = (LETTER * len(line.name) + 0.1) * second
        moving = np.flatnonzero(np.abs(np.diff(km)) > 0.0)  # not where it stands or its line is broken
        moving = moving[(time_s[moving] > left + wide / 2) & (time_s[moving] < right - wide / 2)]
        spots = [moving[int(share * (len(moving) - 1))] for share in _SHARES] if moving.size else []
        free = [k for k in spots if not any(
            abs(time_s[k] - x) < (wide + w) / 2 and abs(km[k] - y) < tall for x, y, w in taken
        )]  # fmt: skip
        others = [other for position, other in enumerate(lines) if position != number]
        alone = [k for k in free if not any(_passes(other, float(time_s[k]), float(km[k]), wide, tall) for other in others)]
        for k in (alone or free)[:1]:
            taken.append((float(time_s[k]), float(km[k]), wide))
            box = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85}
            axes.text(time_s[k], km[k], line.name, fontsize=8, color=INK, ha="center", va="center", bbox=box)


def _passes(line: TrainLine, x: float, y: float, wide: float, tall: float) -> bool:
    """Return whether the line of a train passes a name of that width and height around a time and a place."""
    span = np.array([x - wide / 2, x, x + wide / 2])
    span = span[(span >= line.time_s[0]) & (span <= line.time_s[-1])]
    km = np.interp(span, line.time_s, line.km)
    return bool(km.size) and bool(km.min() - tall / 2 < y < km.max() + tall / 2)
