"""The train graph: place over time of all journeys, with the timetable beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.movement.journey import Journey
from tractionpower.reporting.labels import clock, clock_ticks, fitting
from tractionpower.reporting.style import BLUE, GREY, INK, STYLE, VERMILION, new_figure
from tractionpower.studies.journeys import end_of

Array = NDArray[Any]

WIDTH, HEIGHT = 10.0, 6.0
LINE = 0.17
"""Height of a line of small text [inches]."""

_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9)  # of a train's run, where its name may stand

JUMP_KM = 0.05
"""Where the kilometre moves by this much more than the train, its line is broken [km]."""


def train_graph(journeys: Sequence[Journey], stations: Sequence[tuple[float, str, bool]], title: str) -> Figure:
    """Draw s = f(t) of all journeys, times that the timetable plans as circles.

    Parameters
    ----------
    journeys
        What is drawn; trains with rising and falling kilometres differ in colour and dashes.
    stations
        Kilometre [km] and name of the stations, and whether a train stops there.
    title
        What stands above.
    """
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, HEIGHT)
        axes = figure.add_subplot()
        drawn = [_draw(axes, journey) for journey in journeys]
        planned = _planned(journeys)
        if planned:
            axes.plot(*zip(*planned, strict=True), "o", markerfacecolor="white", markeredgecolor=VERMILION, markersize=4.5,
                      markeredgewidth=1.0, linestyle="", label="planned (timetable)", zorder=3)  # fmt: skip
        begin, end = min(float(t[0]) for t, _ in drawn), max(float(t[-1]) for t, _ in drawn)
        axes.set_xlim(begin - 0.01 * (end - begin), end + 0.02 * (end - begin))
        ticks = clock_ticks(begin, end)
        axes.set_xticks(ticks, [clock(tick, ticks) for tick in ticks])
        axes.set(xlabel="time of day [h:min]" if not any(tick % 60 for tick in ticks) else "time of day [h:min:s]")
        axes.set_ylabel("kilometre of the line [km]")
        axes.margins(y=0.03)
        _name_stations(axes, stations)
        _name_trains(axes, journeys, drawn, planned)
        axes.set_title(title, loc="left")
        handles, labels = axes.get_legend_handles_labels()
        unique = dict(zip(labels, handles, strict=True))
        axes.legend(unique.values(), unique.keys(), loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=4)
        return figure


def _draw(axes: Axes, journey: Journey) -> tuple[Array, Array]:
    rows = journey.rows
    place = np.append(rows["s_m"], end_of(journey))
    leg, km = journey.path.places(place)
    moved = np.abs(np.abs(np.diff(km)) - np.diff(place) / 1000.0) > JUMP_KM
    km = np.where(np.append(False, moved & (np.diff(leg) != 0)), np.nan, km)
    time_s = np.append(rows["time_s"], journey.finished_s)
    rising = km[np.isfinite(km)][-1] >= km[0]
    colour, dashes, label = (BLUE, "-", "rising kilometres") if rising else (INK, (0, (5, 2)), "falling kilometres")
    axes.plot(time_s, km, color=colour, linestyle=dashes, linewidth=1.2, label=f"computed, {label}")
    if journey.status != "complete":
        axes.plot(time_s[-1], km[-1], "X", color=VERMILION, markersize=8, label="not at the end of its route", zorder=4)
    return time_s, km


def _planned(journeys: Sequence[Journey]) -> list[tuple[float, float]]:
    """Return planned times [s] and places [km] of all calls."""
    return [
        (float(planned), journey.path.place(call.at_m)[1])
        for journey in journeys
        for call in journey.calls
        for planned in (call.planned_arrival_s, call.planned_departure_s)
        if planned is not None
    ]


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


def _name_trains(
    axes: Axes, journeys: Sequence[Journey], drawn: Sequence[tuple[Array, Array]], planned: Sequence[tuple[float, float]]
) -> None:
    """Write each train's name on its line where it moves and nothing else stands; leave it out where there is no room."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    tall = LINE * (high - low) / (HEIGHT - 1.3)
    second = (right - left) / (WIDTH - 2.0)  # time in an inch of paper
    taken = [(x, y, 0.1 * second) for x, y in planned]
    for number, (journey, (time_s, km)) in enumerate(zip(journeys, drawn, strict=True)):
        wide = (0.075 * len(journey.run.id) + 0.1) * second
        moving = np.flatnonzero(np.abs(np.diff(km)) > 0.0)  # not where it stands or its line is broken
        spots = [moving[int(share * (len(moving) - 1))] for share in _SHARES] if moving.size else []
        free = [k for k in spots if not any(
            abs(time_s[k] - x) < (wide + w) / 2 and abs(km[k] - y) < tall for x, y, w in taken
        )]  # fmt: skip
        others = [line for other, line in enumerate(drawn) if other != number]
        alone = [k for k in free if not any(_passes(line, float(time_s[k]), float(km[k]), wide, tall) for line in others)]
        for k in (alone or free)[:1]:
            taken.append((float(time_s[k]), float(km[k]), wide))
            box = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85}
            axes.text(time_s[k], km[k], journey.run.id, fontsize=8, color=INK, ha="center", va="center", bbox=box)


def _passes(line: tuple[Array, Array], x: float, y: float, wide: float, tall: float) -> bool:
    """Return whether the line of a train passes a name of that width and height around a time and a place."""
    span = np.array([x - wide / 2, x, x + wide / 2])
    span = span[(span >= line[0][0]) & (span <= line[0][-1])]
    km = np.interp(span, *line)
    return bool(km.size) and bool(km.min() - tall / 2 < y < km.max() + tall / 2)
