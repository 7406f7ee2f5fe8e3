"""One figure for each theoretical journey: speed, efforts and current over the route."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.movement.journey import Journey
from tractionpower.reporting.labels import fitting
from tractionpower.reporting.style import BLUE, GREEN, GREY, INK, ORANGE, PALE, STYLE, VERMILION, new_figure
from tractionpower.studies.journeys import end_of

Array = NDArray[Any]

WIDTH, PANEL, STRIP, NAMES = 10.0, 2.1, 0.8, 1.4
"""Width of a figure, heights of its panels and of what stands above and below them [inches]."""

CEILING = "ceiling: limits under the\nwhole train, braking curves"

SAME_S = 1e-6
"""Times that differ by less are the same [s]."""

LETTER = 0.075
"""Width of a letter of a station's name [inches]."""


@dataclass(frozen=True, slots=True)
class Course:
    """The route as a horizontal axis: the kilometre where it runs on evenly, else the distance.

    Attributes
    ----------
    begin, sign
        Value at the start of the route [km], and +1 or -1 as values grow or fall along it.
    length_m
        Length of the route [m].
    label
        Label of the axis.
    """

    begin: float
    sign: int
    length_m: float
    label: str

    def at(self, place: Any) -> Any:
        """Return the value of the axis [km] at distances `place` from the start of the route [m]."""
        return self.begin + self.sign * np.asarray(place, float) / 1000.0


def course_of(path: RoutePath) -> Course:
    """Return how a route is drawn from left to right."""
    probe = np.linspace(0.0, path.length_m, 501)
    _, km = path.places(probe)
    sign = 1 if km[-1] >= km[0] else -1
    if np.abs(km - km[0] - sign * probe / 1000.0).max() > 0.001:  # the kilometrage jumps somewhere
        return Course(0.0, 1, path.length_m, "distance from the start of the route [km]")
    names = list(dict.fromkeys(leg.axis.track for leg in path.legs))
    tracks = f"track{'s' if len(names) > 1 else ''} {', '.join(names)}"
    return Course(float(km[0]), sign, path.length_m, f"kilometre of the line [km], {tracks}")


def journey_figure(journey: Journey, stations: Sequence[tuple[float, str]], title: str) -> Figure:
    """Draw a journey over its route.

    Parameters
    ----------
    journey
        The journey.
    stations
        Distance [m] and name of the stations on the route.
    title
        What stands above.
    """
    path, rows = journey.path, journey.rows
    hilly = bool(np.ptp(path.height_m) > 0.0)
    heights = [PANEL, *([STRIP] if hilly else []), PANEL, PANEL]
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, sum(heights) + NAMES)
        panels = figure.subplots(len(heights), sharex=True, height_ratios=heights)
        course, place = course_of(path), np.append(rows["s_m"], end_of(journey))
        _draw_speed(panels[0], journey, course, place)
        if hilly:
            _draw_height(panels[1], path, course)
        whole = whole_rows(journey)
        _draw_efforts(panels[-2], rows[:whole], course, place[: whole + 1])
        _draw_current(panels[-1], rows[:whole], course, place[: whole + 1], path)
        ends = course.at([0.0, path.length_m])
        margin = 0.01 * (ends[1] - ends[0])
        panels[-1].set_xlim(ends[0] - margin, ends[1] + margin)
        panels[-1].set_xlabel(course.label)
        _name_stations(panels, course, stations, [call.at_m for call in journey.calls if call.kind == "stop"])
        figure.align_ylabels(panels)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
        return figure


def whole_rows(journey: Journey) -> int:
    """Return how many rows the train is on the line from their start to their end.

    One that leaves within a step has means over the whole step in its last row, which are no forces of a train.
    """
    rows = journey.rows
    present = journey.finished_s - rows["time_s"][-1]
    return max(1, len(rows) - int(present < journey.seconds[-1] - SAME_S))


def _draw_speed(axes: Axes, journey: Journey, course: Course, place: Array) -> None:
    path, rows = journey.path, journey.rows
    at, ceiling = _ceiling(journey)
    axes.fill_between(course.at(at), ceiling, color=PALE, alpha=0.7, lw=0, label=CEILING)
    limit = 3.6 * path.limit_mps
    at = course.at(np.append(path.limit_from_m, path.length_m))
    _stairs(axes, at, limit, color=GREY, linewidth=1.0, label="permitted speed of the line")
    last = rows[-1]
    end = max(0.0, last["v_mps"] + last["acceleration_mps2"] * journey.seconds[-1])  # a mean over the whole row
    speed = 3.6 * np.append(rows["v_mps"], end)
    axes.plot(course.at(place), speed, color=BLUE, linewidth=1.5, label="speed")
    if journey.status != "complete":
        axes.plot(course.at(place[-1]), speed[-1], "X", color=VERMILION, markersize=9, label="here it stays", clip_on=False)
    axes.set(ylabel="speed [km/h]")
    axes.set_ylim(0.0, 1.08 * max(np.nanmax(speed), np.nanmax(limit, initial=0.0), 1.0))
    _legend(axes)


def _ceiling(journey: Journey) -> tuple[Array, Array]:
    """Return places [m] and the speed ceiling there [km/h]; it is no straight line between places, so there are many."""
    pieces = journey.ceiling
    share = np.linspace(0.0, 1.0, 13)
    run = np.diff(pieces["from_m"])[:, None] * share
    square = pieces["w"][:-1, None] + pieces["dw"][:-1, None] * run
    return (pieces["from_m"][:-1, None] + run).ravel(), 3.6 * np.sqrt(np.maximum(square, 0.0)).ravel()


def _draw_height(axes: Axes, path: RoutePath, course: Course) -> None:
    inside = (path.at_m > 0.0) & (path.at_m < path.length_m)
    at = np.concatenate([[0.0], path.at_m[inside], [path.length_m]])
    height = np.interp(at, path.at_m, path.height_m)
    low = float(height.min())
    axes.fill_between(course.at(at), low, height, color=ORANGE, alpha=0.35, lw=0)
    axes.plot(course.at(at), height, color=INK, linewidth=0.9)
    axes.set(ylabel="height above\nstart [m]")
    axes.set_ylim(low, max(float(height.max()), low + 5.0) * 1.0 + 0.1 * float(np.ptp(height)))


def _draw_efforts(axes: Axes, rows: Array, course: Course, place: Array) -> None:
    at = course.at(place)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    electric, friction = (-_steps(rows[name]) / 1000.0 for name in ("electric_brake_n", "friction_brake_n"))
    for low, high, colour, hatch, label in (
        (electric, 0.0 * electric, GREEN, "", "electric brake"),
        (electric + friction, electric, VERMILION, "////", "friction brake"),
    ):
        if np.any(low < high):
            paint: Any = {"facecolor": colour, "edgecolor": colour, "alpha": 0.55, "hatch": hatch, "linewidth": 0.4}
            axes.fill_between(at, low, high, step="post", label=label, **paint)
    _stairs(axes, at, rows["traction_n"] / 1000.0, color=BLUE, linewidth=1.3, label="tractive effort")
    _stairs(axes, at, rows["resistance_n"] / 1000.0, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), label="resistance")
    axes.set(ylabel="effort at the wheel [kN]")
    _legend(axes)


def _draw_current(axes: Axes, rows: Array, course: Course, place: Array, path: RoutePath) -> None:
    axes.axhline(0.0, color=INK, linewidth=0.6)
    _stairs(axes, course.at(place), rows["current_a"], color=BLUE, linewidth=1.3, label="current")
    if np.isfinite(path.max_current_a).any():
        at = course.at(np.append(path.current_from_m, path.length_m))
        limit = np.where(np.isfinite(path.max_current_a), path.max_current_a, np.nan)
        dashes: Any = (0, (4, 2))
        _stairs(axes, at, limit, color=GREY, linewidth=1.0, linestyle=dashes, label="train current limit of the line")
    axes.set(ylabel="current at the\npantograph [A]")
    _legend(axes)


def _name_stations(panels: Any, course: Course, stations: Sequence[tuple[float, str]], stops_m: Sequence[float]) -> None:
    """Name the stations above the first panel; where names would overlap, stops stay and others go."""
    per_inch = course.length_m / (WIDTH - 1.2)  # metres of route in an inch of paper
    places = [place for place, _ in stations]
    called = [any(abs(place - stop) < 1.0 for stop in stops_m) for place in places]
    longest = max((len(name) for _, name in stations), default=0)
    level = fitting(places, called, (longest + 2) * LETTER * per_inch)
    upright = len(level) < len(stations)
    shown = fitting(places, called, 0.17 * per_inch) if upright else level
    for axes in panels:
        for k in shown:
            axes.axvline(course.at(places[k]), color=GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    top = panels[0].secondary_xaxis("top")
    top.set_xticks([float(course.at(places[k])) for k in shown], [stations[k][1] for k in shown], rotation=90 if upright else 0)
    top.tick_params(length=3, labelsize=8, colors=INK)
    top.spines["top"].set_visible(False)


def _steps(values: Array) -> Array:
    """Return means of steps with the last one twice, for lines and areas drawn as steps."""
    return np.append(values, values[-1])


def _stairs(axes: Axes, at: Array, values: Array, **style: Any) -> None:
    axes.plot(at, _steps(values), drawstyle="steps-post", **style)


def _legend(axes: Axes) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8, handlelength=1.6, borderaxespad=0.2)
