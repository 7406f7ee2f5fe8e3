"""A train's route as a horizontal axis: kilometres, stations, devices of the supply, permitted speed, height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.alignment.profile import PathLeg
from tractionpower.alignment.routes import stop_distance
from tractionpower.model.line import Line
from tractionpower.model.supply import Substation
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.labels import LETTER, MOST_STATION_LETTERS, fitting, shortened
from tractionpower.reporting.figures.base.style import GREY, INK, ORANGE, PALE, PURPLE
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.supply.site import Site

Array = NDArray[Any]

MOST_LABEL_LETTERS = 40
"""Letters of tracks in the label of an axis."""

MOST_JOINTS = 2
"""With more changes to other kilometres the axis does not tell them."""

BESIDE_M = 100.0
"""Places where one device meets two tracks of a route count as one if they are this near to each other [m]."""

CEILING = mark("ceiling: limits under the\nwhole train, braking curves")


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
    joints_m
        Distances at which the kilometres jump from one leg to the next [m].
    """

    begin: float
    sign: int
    length_m: float
    label: str
    joints_m: tuple[float, ...] = ()

    def at(self, place: Any) -> Any:
        """Return the value of the axis [km] at distances `place` from the start of the route [m]."""
        return self.begin + self.sign * np.asarray(place, float) / 1000.0

    def set_limits(self, axes: Axes, begin_m: float = 0.0, end_m: float | None = None) -> None:
        """Let an axis show the route, or the part from `begin_m` to `end_m` [m], from left to right."""
        ends = self.at([begin_m, self.length_m if end_m is None else end_m])
        margin = 0.01 * (ends[1] - ends[0])
        axes.set_xlim(ends[0] - margin, ends[1] + margin)


def course_of(path: RoutePath) -> Course:
    """Return how a route is drawn from left to right."""
    probe = np.linspace(0.0, path.length_m, 501)
    _, km = path.places(probe)
    sign = 1 if km[-1] >= km[0] else -1
    if np.abs(km - km[0] - sign * probe / 1000.0).max() > 0.001:  # the kilometrage jumps somewhere
        joints = [(before, leg) for before, leg in pairwise(path.legs) if abs(_ends(before)[1] - _ends(leg)[0]) > 0.001]
        label = tr("distance from the start of the route [km]")
        if 0 < len(joints) <= MOST_JOINTS:
            starts = [path.legs[0], *(leg for _, leg in joints)]
            ends = [*(before for before, _ in joints), path.legs[-1]]
            ways = [
                tr(
                    "track {track} km {begin} to {end}",
                    track=leg.axis.track,
                    begin=number(_ends(leg)[0], 3),
                    end=_end_in_words(leg, end),
                )
                for leg, end in zip(starts, ends, strict=True)
            ]
            label += f":\n{tr(', then ').join(ways)}"
        return Course(0.0, 1, path.length_m, label, tuple(leg.start_m for _, leg in joints))
    names = list(dict.fromkeys(leg.axis.track for leg in path.legs))
    return Course(
        float(km[0]),
        sign,
        path.length_m,
        tr("kilometre of the line [km], {tracks}", tracks=shortened(told(names), MOST_LABEL_LETTERS)),
    )


def _ends(leg: PathLeg) -> tuple[float, float]:
    """Return the kilometres at which a leg begins and ends [km]."""
    begin, end = leg.axis.km(leg.track_m(np.array([leg.start_m, leg.end_m])))
    return round(float(begin), 6), round(float(end), 6)


def _end_in_words(leg: PathLeg, end: PathLeg) -> str:
    km = number(_ends(end)[1], 3)
    return km if end.axis.track == leg.axis.track else tr("track {track} km {km}", track=end.axis.track, km=km)


def draw_joints(panels: Sequence[Axes], course: Course) -> None:
    """Draw upright lines where the kilometres of the route jump, as from a main line to a branch."""
    for axes in panels:
        for joint in course.joints_m:
            style: Any = {"color": PURPLE, "linewidth": 1.0, "linestyle": (0, (6, 2, 1, 2)), "zorder": 0.6}
            axes.axvline(course.at(joint), label=tr("change to other kilometres"), **style)


def stations_along(path: RoutePath, line: Line) -> list[tuple[float, str]]:
    """Return distance [m] and name of every station that a route passes, in its order."""
    places = [(stop_distance(path, station), station.name or station.id) for station in line.stations]
    return sorted((place, name) for place, name in places if place is not None)


def route_in_words(path: RoutePath, end_m: float, line: Line) -> str:
    """Return a route up to `end_m` [m]: the stations at its ends, or else track and kilometre."""
    named = {round(place): name for place, name in stations_along(path, line)}
    ends = []
    for place in (0.0, end_m):
        track, km = path.place(place)
        ends.append(named.get(round(place), tr("track {track}, km {km}", track=track, km=number(km, 1, bare=False))))
    return " – ".join(ends)


def devices_along(path: RoutePath, site: Site) -> list[tuple[float, str, bool]]:
    """Return distance [m] and name of the substations and section cabins that a route passes, and whether it is a substation.

    One that feeds several lines on the route stands wherever it meets one of them.
    """
    found = []
    for device in site.stations:
        places: list[float] = []
        for track in dict.fromkeys(leg.axis.track for leg in path.legs):
            if track in site.fed[device.id]:
                place = path.distance(track, site.axes[track].km(site.fed[device.id][track][1]))
                if place is not None and all(abs(place - other) > BESIDE_M for other in places):
                    places.append(place)
        found += [(place, device.id, isinstance(device, Substation)) for place in places]
    return sorted(found)


def name_stations(
    panels: Sequence[Axes], course: Course, stations: Sequence[tuple[float, str]], stops_m: Sequence[float], inches: float
) -> None:
    """Name the stations above the first panel, which is `inches` wide; where names would overlap, stops stay and others go."""
    stations = [(place, shortened(name, MOST_STATION_LETTERS)) for place, name in stations]
    per_inch = course.length_m / inches  # metres of route in an inch of paper
    places = [place for place, _ in stations]
    called = [any(abs(place - stop) < 1.0 for stop in stops_m) for place in places]
    level = fitting(places, called, [(len(name) + 2) * LETTER * per_inch for _, name in stations])
    upright = len(level) < len(stations)
    shown = fitting(places, called, 0.17 * per_inch) if upright else level
    for axes in panels:
        for k in shown:
            axes.axvline(course.at(places[k]), color=GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    top = panels[0].secondary_xaxis("top")
    top.set_xticks([float(course.at(places[k])) for k in shown], [stations[k][1] for k in shown], rotation=90 if upright else 0)
    top.tick_params(length=3, labelsize=8, colors=INK)
    top.spines["top"].set_visible(False)


def draw_permitted_speed(axes: Axes, path: RoutePath, pieces: NDArray[np.void], course: Course) -> None:
    """Draw the speed limit of the line and the ceiling of the train, records of `PIECE`."""
    at, ceiling = _ceiling(pieces)
    axes.fill_between(course.at(at), ceiling, color=PALE, alpha=0.7, lw=0, label=tr(CEILING))
    at = course.at(np.append(path.limit_from_m, path.length_m))
    stairs(axes, at, 3.6 * path.limit_mps, color=GREY, linewidth=1.0, label=tr("permitted speed of the line"))


def _ceiling(pieces: NDArray[np.void]) -> tuple[Array, Array]:
    """Return places [m] and the speed ceiling there [km/h]; it is no straight line between places, so there are many."""
    share = np.linspace(0.0, 1.0, 13)
    run = np.diff(pieces["from_m"])[:, None] * share
    square = pieces["w"][:-1, None] + pieces["dw"][:-1, None] * run
    return (pieces["from_m"][:-1, None] + run).ravel(), 3.6 * np.sqrt(np.maximum(square, 0.0)).ravel()


def draw_height(axes: Axes, path: RoutePath, course: Course) -> None:
    """Draw the height along a route."""
    inside = (path.at_m > 0.0) & (path.at_m < path.length_m)
    at = np.concatenate(([0.0], path.at_m[inside], [path.length_m]))
    height = np.interp(at, path.at_m, path.height_m)
    low, high = float(height.min()), float(height.max())
    axes.fill_between(course.at(at), low, height, color=ORANGE, alpha=0.35, lw=0)
    axes.plot(course.at(at), height, color=INK, linewidth=0.9)
    axes.set_ylabel(tr("height\n[m]"), fontsize=7.5)
    axes.set_ylim(low, max(high, low + 5.0) + 0.1 * (high - low))
    if high == low:
        axes.annotate(tr("level"), (0.5, 0.5), xycoords="axes fraction", ha="center", va="center", fontsize=8, color=INK)


def draw_gradient(axes: Axes, path: RoutePath, course: Course) -> None:
    """Draw the gradient along a route; rising in the direction of travel is above zero."""
    inside = np.flatnonzero((path.at_m[1:] > 0.0) & (path.at_m[:-1] < path.length_m))
    permille = 1000.0 * np.diff(path.height_m) / np.diff(path.at_m)
    at = course.at(np.clip(np.append(path.at_m[inside], path.at_m[inside[-1] + 1]), 0.0, path.length_m))
    values = last_twice(permille[inside])
    axes.fill_between(at, 0.0, values, step="post", color=ORANGE, alpha=0.35, lw=0)
    axes.plot(at, values, drawstyle="steps-post", color=INK, linewidth=0.7)
    axes.axhline(0.0, color=INK, linewidth=0.5)
    most = max(1.0, float(np.abs(values).max()))
    axes.set_ylim(-1.15 * most, 1.15 * most)
    axes.set_ylabel(tr("gradient\n[‰]"), fontsize=7.5)


def draw_current_limit(axes: Axes, path: RoutePath, course: Course) -> None:
    """Draw the train current limits of the line where it has some."""
    if not np.isfinite(path.max_current_a).any():
        return
    at = course.at(np.append(path.current_from_m, path.length_m))
    limit = np.where(np.isfinite(path.max_current_a), path.max_current_a, np.nan)
    dashes: Any = (0, (4, 2))
    stairs(axes, at, limit, color=GREY, linewidth=1.0, linestyle=dashes, label=tr("train current limit of the line"))


def last_twice(values: Array) -> Array:
    """Return means of steps with the last one twice, for lines and areas drawn as steps."""
    return np.append(values, values[-1])


def stairs(axes: Axes, at: Array, values: Array, **style: Any) -> None:
    """Draw means of steps, whose edges are `at`."""
    axes.plot(at, last_twice(values), drawstyle="steps-post", **style)
