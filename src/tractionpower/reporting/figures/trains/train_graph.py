"""The train graph: place over time of trains, with the timetable beside it. It does not know where the trains come from.

Lines with kilometres of their own, a main line and its branches, have a panel each.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.reporting.figures.base.axes import clock_label, set_clock
from tractionpower.reporting.figures.base.labels import LETTER, LINE, MOST_STATION_LETTERS, fitting, shortened
from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, INK, PAGE, STYLE, VERMILION, new_figure
from tractionpower.reporting.figures.delays.delay_layer import Box, DelayLayer, draw_delays
from tractionpower.reporting.texts import tr

Array = NDArray[Any]

WIDTH, HEIGHT = PAGE, 5.6
TALL, LOW, BESIDE = 4.2, 1.5, 1.3
"""Size of a graph with one panel; heights of the panels of the longest and the lowest line and of all beside [inches]."""

NAMES = 1.75
"""Width of what stands left and right of the panels [inches]."""

BESIDE_LABEL = 0.7
"""Width of what stands beside the words of a legend [inches]."""

ROUND_S = (1.0, 10.0, 60.0, 300.0, 900.0, 3600.0)
"""A graph begins and ends at multiples of one of these, so that ticks stand at its ends [s]."""

MOST_NAMES = 40
"""With more trains their names are left out."""

MOST_CIRCLES = 160
"""With more planned times they are dots."""

DARK_GREEN = "#00684b"
"""Colour of the names of substations, darker than that of their signs."""

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
    comes_over, goes_over
        Whether it comes from another line where it begins, and goes to another one where it ends.
    """

    name: str
    time_s: Array
    km: Array
    arrives: bool = True
    comes_over: bool = False
    goes_over: bool = False

    def between(self, begin_s: float, end_s: float) -> TrainLine | None:
        """Return the part of the line within a window of time [s], or None if there is none."""
        inside = (self.time_s >= begin_s) & (self.time_s <= end_s)
        if np.isfinite(self.km[inside]).sum() < 2:
            return None
        return replace(
            self, time_s=self.time_s[inside], km=self.km[inside], arrives=self.arrives or not bool(inside[-1]),
            comes_over=self.comes_over and bool(inside[0]), goes_over=self.goes_over and bool(inside[-1]),
        )  # fmt: skip


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


@dataclass(frozen=True, slots=True)
class GraphPanel:
    """What is drawn over the kilometres of one line.

    Attributes
    ----------
    words
        Its tracks in words.
    lines, planned, places
        Trains, planned times [s] and places [km], what stands beside them.
    delays
        Where trains are late; then what is on time is pale.
    """

    words: str
    lines: Sequence[TrainLine]
    planned: Sequence[tuple[float, float]] = ()
    places: GraphPlaces = GraphPlaces()
    delays: DelayLayer | None = None

    @property
    def length_km(self) -> float:
        """Length of line that it shows [km]."""
        beside = [place for place, *_ in (*self.places.stations, *self.places.devices)]
        return float(np.ptp(np.concatenate([*(line.km[np.isfinite(line.km)] for line in self.lines), beside])))


def broken_where_it_jumps(km: Array, place_m: Array, track: Array) -> Array:
    """Return kilometres, not a number where a train comes onto another track whose kilometrage jumps.

    Parameters
    ----------
    km, place_m, track
        Kilometre [km], distance from the start of the route [m], and a number of the track.
    """
    jumps = np.abs(np.abs(np.diff(km)) - np.diff(place_m) / 1000.0) > JUMP_KM
    return np.where(np.append(False, jumps & (np.diff(track) != 0)), np.nan, km)


def split_by_line(train: TrainLine, path: RoutePath, place_m: Array, number: Mapping[str, int]) -> list[tuple[int, TrainLine]]:
    """Return the parts of a train's line, each on one line of tracks and in one direction, with the number of that line.

    Parameters
    ----------
    train
        The whole line; its kilometres are not looked at, those of the route count.
    path, place_m
        The route, and the distances from its start at the times of the line [m].
    number
        Number of the line of tracks by track.
    """
    leg, km = path.places(place_m)
    kinds = [(number[each.axis.track], each.sign) for each in path.legs]
    cuts = [0, *(k for k in range(1, len(leg)) if kinds[leg[k]] != kinds[leg[k - 1]]), len(leg)]
    parts = []
    for first, last in pairwise(cuts):
        (line, _), own = kinds[leg[first]], slice(first, last)
        time_s, shown = train.time_s[own], broken_where_it_jumps(km[own], place_m[own], leg[own])
        if first > 0:  # from the very place where it came over, which lies between two points
            start = path.legs[leg[first]]
            when = np.interp(start.start_m, place_m[first - 1 : first + 1], train.time_s[first - 1 : first + 1])
            time_s, shown = np.append(when, time_s), np.append(start.axis.km(start.from_track_m), shown)
        if last < len(leg):
            end = path.legs[leg[last - 1]]
            when = np.interp(end.end_m, place_m[last - 1 : last + 1], train.time_s[last - 1 : last + 1])
            time_s, shown = np.append(time_s, when), np.append(shown, end.axis.km(end.track_m(np.array([end.end_m]))))
        before, behind = (kinds[leg[k]][0] if 0 <= k < len(leg) else line for k in (first - 1, last))
        arrives = train.arrives or last < len(leg)
        parts.append((line, TrainLine(train.name, time_s, shown, arrives, before != line, behind != line)))
    return parts


def train_graph(panels: Sequence[GraphPanel], title: str) -> Figure:
    """Draw s = f(t) of trains, times that the timetable plans as circles, a panel for each line.

    Trains with rising and falling kilometres differ in colour and dashes. A kilometre has the same height in all panels,
    but for lines that are too short.
    """
    single = len(panels) == 1
    longest = max(panel.length_km for panel in panels) or 1.0
    inches = [HEIGHT - BESIDE] if single else [max(LOW, TALL * panel.length_km / longest) for panel in panels]
    many = len({line.name for panel in panels for line in panel.lines}) > MOST_NAMES
    circles = sum(len(panel.planned) for panel in panels) <= MOST_CIRCLES
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, sum(inches) + BESIDE)
        grid = list(figure.subplots(len(panels), sharex=True, squeeze=False, height_ratios=inches)[:, 0])
        every = [line for panel in panels for line in panel.lines]
        first, last = min(float(line.time_s[0]) for line in every), max(float(line.time_s[-1]) for line in every)
        whole = max(step for step in ROUND_S if step <= max((last - first) / 20.0, ROUND_S[0]))
        set_clock(grid[0], whole * (first // whole), -whole * (-last // whole), 12)
        for axes, panel, tall in zip(grid, panels, inches, strict=True):
            _draw_panel(axes, panel, tall, names=not many, circles=circles)
            axes.set_ylabel(
                tr("kilometre of the line [km]")
                if single
                else f"{shortened(panel.words, MOST_STATION_LETTERS)}\n{tr('kilometre [km]')}"
            )
        grid[-1].set_xlabel(clock_label(grid[-1]))
        found: dict[str, Any] = {}
        for axes in grid:
            found |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
        figure.suptitle(title, x=0.01, ha="left")
        figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=columns_of(found, 4))
        return figure


def columns_of(labels: Collection[str], most: int) -> int:
    """Return in how many columns a legend fits the width of the figure; `most` at most.

    >>> columns_of(["short"] * 6, 6), columns_of(["timetable too tight, carried on"] * 6, 6)
    (5, 2)
    """
    widest = LETTER * max(map(len, labels), default=1) + BESIDE_LABEL
    return max(1, min(most, int((WIDTH - 0.2) / widest)))


def _draw_panel(axes: Axes, panel: GraphPanel, inches: float, *, names: bool, circles: bool) -> None:
    """Draw the trains of a line into axes that are `inches` high."""
    for line in panel.lines:
        _draw(axes, line, 1.1 if names else 0.5, pale=panel.delays is not None)
    if panel.planned:
        colour = VERMILION if panel.delays is None else INK
        style: dict[str, Any] = {"markerfacecolor": "white", "markersize": 3.5, "markeredgewidth": 0.8, "zorder": 3}
        if not circles:  # they would hide the trains
            style = {"markerfacecolor": colour, "markersize": 1.5, "markeredgewidth": 0.0, "zorder": 2.5}
        axes.plot(
            *zip(*panel.planned, strict=True), "o", markeredgecolor=colour, linestyle="", label=tr("planned (timetable)"), **style
        )
    axes.margins(y=0.03)
    _name_stations(axes, panel.places.stations, inches)
    written = _mark_devices(axes, panel.places, inches)
    if panel.delays is not None:
        written += draw_delays(axes, panel.delays, WIDTH - NAMES, inches)
    if names:
        _name_trains(axes, panel.lines, panel.planned if circles else (), written, inches)


def _draw(axes: Axes, line: TrainLine, width: float, *, pale: bool = False) -> None:
    known = line.km[np.isfinite(line.km)]
    style: Any = {"color": INK, "linestyle": (0, (5, 2)), "label": tr("computed, falling kilometres")}
    if pale:
        style = {"color": GREY, "linestyle": "-", "label": tr("on time")}
    elif known[-1] >= known[0]:
        style = {"color": BLUE, "linestyle": "-", "label": tr("computed, rising kilometres")}
    axes.plot(line.time_s, line.km, linewidth=width, **style)
    if not line.arrives:
        axes.plot(
            line.time_s[-1], line.km[-1], "X", color=VERMILION, markersize=8, label=tr("not at the end of its route"), zorder=4
        )
    for over, end in ((line.comes_over, 0), (line.goes_over, -1)):
        if over:
            axes.plot(
                line.time_s[end], line.km[end], "D", color=INK, markersize=4, linestyle="", label=tr("from or to another line")
            )


def _name_stations(axes: Axes, stations: Sequence[tuple[float, str, bool]], inches: float) -> None:
    """Name the stations on the right; leave out names that would overlap."""
    low, high = axes.get_ylim()
    gap = LINE * (high - low) / inches
    shown = fitting([km for km, _, _ in stations], [stops for _, _, stops in stations], gap)
    for k in shown:
        axes.axhline(stations[k][0], color=GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    right = axes.secondary_yaxis("right")
    right.set_yticks([stations[k][0] for k in shown], [shortened(stations[k][1], MOST_STATION_LETTERS) for k in shown])
    right.tick_params(length=3, labelsize=7.5, colors=INK)
    right.spines["right"].set_visible(False)


def _mark_devices(axes: Axes, places: GraphPlaces, inches: float) -> list[Box]:
    """Mark substations and section cabins on the left; name the substations that have room, and return where."""
    for substation, sign, size, label in ((True, ">", 6, tr("substation")), (False, "s", 3.5, tr("section cabin"))):
        km = [place for place, _, kind in places.devices if kind == substation]
        if km:
            axes.plot([0.0] * len(km), km, sign, color=GREEN, markersize=size, clip_on=False, zorder=4, label=label,
                      transform=axes.get_yaxis_transform())  # fmt: skip
    low, high = axes.get_ylim()
    named = [(km, name) for km, name, substation in places.devices if substation]
    style: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points", "fontsize": 6.5}
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0.4, "alpha": 0.8}
    (left, right), written = axes.get_xlim(), list[Box]()
    for k in fitting([place for place, _ in named], [False] * len(named), 0.8 * LINE * (high - low) / inches):
        place, name = named[k][0], shortened(named[k][1], MOST_STATION_LETTERS)
        axes.annotate(name, (0.0, place), (6, 0), va="center", color=DARK_GREEN, zorder=3.5, bbox=box, gid="substation", **style)
        wide = (LETTER * len(name) + 0.1) * (right - left) / (WIDTH - NAMES)
        written.append((left + wide / 2, place, wide))
    return written


def _name_trains(
    axes: Axes, lines: Sequence[TrainLine], planned: Sequence[tuple[float, float]], written: Sequence[Box], inches: float
) -> None:
    """Write each train's name on its longest line where it moves and nothing else stands, if there is room."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    tall = LINE * (high - low) / inches
    second = (right - left) / (WIDTH - NAMES)  # time in an inch of paper
    taken = [*((x, y, 0.1 * second) for x, y in planned), *written]
    lasts = {line.name: max(np.ptp(each.time_s) for each in lines if each.name == line.name) for line in lines}
    for number, line in enumerate(lines):
        time_s, km = line.time_s, line.km
        if np.ptp(time_s) < lasts[line.name]:
            continue
        name = shortened(line.name, MOST_STATION_LETTERS)
        wide = (LETTER * len(name) + 0.1) * second
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
            axes.text(time_s[k], km[k], name, fontsize=7.5, color=INK, ha="center", va="center", bbox=box)


def _passes(line: TrainLine, x: float, y: float, wide: float, tall: float) -> bool:
    """Return whether the line of a train passes a name of that width and height around a time and a place."""
    span = np.array([x - wide / 2, x, x + wide / 2])
    span = span[(span >= line.time_s[0]) & (span <= line.time_s[-1])]
    km = np.interp(span, line.time_s, line.km)
    return bool(km.size) and bool(km.min() - tall / 2 < y < km.max() + tall / 2)
