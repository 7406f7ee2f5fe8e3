"""One figure for each theoretical journey: speed, efforts and current over the route."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.movement.journey import Journey
from tractionpower.reporting.figures.base.route_axis import (
    Course,
    course_of,
    draw_current_limit,
    draw_gradient,
    draw_height,
    draw_permitted_speed,
    last_twice,
    name_stations,
    stairs,
)
from tractionpower.reporting.figures.base.style import BLUE, GREEN, INK, PAGE, STYLE, VERMILION, new_figure
from tractionpower.reporting.texts import tr
from tractionpower.studies.journeys import end_of

Array = NDArray[Any]

WIDTH, PANEL, STRIP, NAMES = PAGE, 1.6, 0.6, 2.0
"""Width of a figure, heights of its panels and of what stands above and below them [inches]."""

SAME_S = 1e-6
"""Times that differ by less are the same [s]."""


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
    heights = [PANEL, *([STRIP, STRIP] if hilly else []), PANEL, PANEL]
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, sum(heights) + NAMES)
        panels = figure.subplots(len(heights), sharex=True, height_ratios=heights)
        course, place = course_of(path), np.append(rows["s_m"], end_of(journey))
        _draw_speed(panels[0], journey, course, place)
        if hilly:
            draw_height(panels[1], path, course)
            draw_gradient(panels[2], path, course)
        whole = whole_rows(journey)
        _draw_efforts(panels[-2], rows[:whole], course, place[: whole + 1])
        _draw_current(panels[-1], rows[:whole], course, place[: whole + 1], path)
        course.set_limits(panels[-1])
        panels[-1].set_xlabel(course.label)
        stops = [call.at_m for call in journey.calls if call.kind == "stop"]
        name_stations(panels, course, stations, stops, WIDTH - 0.9)
        figure.align_ylabels(panels)
        _legend(figure, panels)
        figure.suptitle(title, x=0.01, ha="left")
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
    draw_permitted_speed(axes, path, journey.ceiling, course)
    last = rows[-1]
    end = max(0.0, last["v_mps"] + last["acceleration_mps2"] * journey.seconds[-1])  # a mean over the whole row
    speed = 3.6 * np.append(rows["v_mps"], end)
    axes.plot(course.at(place), speed, color=BLUE, linewidth=1.5, label=tr("speed"))
    if journey.status != "complete":
        axes.plot(course.at(place[-1]), speed[-1], "X", color=VERMILION, markersize=9, label=tr("here it stays"), clip_on=False)
    axes.set(ylabel=tr("speed [km/h]"))
    axes.set_ylim(0.0, 1.08 * max(np.nanmax(speed), 3.6 * np.nanmax(path.limit_mps, initial=0.0), 1.0))


def _draw_efforts(axes: Axes, rows: Array, course: Course, place: Array) -> None:
    at = course.at(place)
    axes.axhline(0.0, color=INK, linewidth=0.6)
    electric, friction = (-last_twice(rows[name]) / 1000.0 for name in ("electric_brake_n", "friction_brake_n"))
    for low, high, colour, hatch, label in (
        (electric, 0.0 * electric, GREEN, "", tr("electric brake")),
        (electric + friction, electric, VERMILION, "////", tr("friction brake")),
    ):
        if np.any(low < high):
            paint: Any = {"facecolor": colour, "edgecolor": colour, "alpha": 0.55, "hatch": hatch, "linewidth": 0.4}
            axes.fill_between(at, low, high, step="post", label=label, **paint)
    stairs(axes, at, rows["traction_n"] / 1000.0, color=BLUE, linewidth=1.3, label=tr("tractive effort"))
    stairs(axes, at, rows["resistance_n"] / 1000.0, color=INK, linewidth=1.0, linestyle=(0, (4, 2)), label=tr("resistance"))
    axes.set(ylabel=tr("effort at the\nwheel [kN]"))


def _draw_current(axes: Axes, rows: Array, course: Course, place: Array, path: RoutePath) -> None:
    axes.axhline(0.0, color=INK, linewidth=0.6)
    stairs(axes, course.at(place), rows["current_a"], color=BLUE, linewidth=1.3, label=tr("current"))
    draw_current_limit(axes, path, course)
    axes.set(ylabel=tr("current at the\npantograph [A]"))


def _legend(figure: Figure, panels: Sequence[Axes]) -> None:
    """Draw one legend for all panels below them."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label.replace("\n", " "), handle)
    figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=3, fontsize=7.5, handlelength=1.6)
