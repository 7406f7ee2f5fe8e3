"""Figures of single trains of a run: speed, voltage and current at the pantograph over distance and over time.

They show what figures 5 to 9 of Krzysztozek (2019) show.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import PHASES
from tractionpower.model.base import format_time
from tractionpower.movement.compile import PlannedRun, ceiling_of
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import interval, peaks_kept
from tractionpower.reporting.figures.base.axes import DEAD_V, clock_label, draw_limits, mark_devices, set_clock, voltage_range
from tractionpower.reporting.figures.base.route_axis import (
    Course,
    course_of,
    devices_along,
    draw_current_limit,
    draw_gradient,
    draw_height,
    draw_joints,
    draw_permitted_speed,
    last_twice,
    name_stations,
    route_in_words,
    stations_along,
)
from tractionpower.reporting.figures.base.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PAGE,
    PALE,
    PURPLE,
    SKY,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

MOST = 8
"""So many trains get a figure unless the template names others: half of them by the lowest voltage at the pantograph, then
those with the highest current."""

WIDTH, HEIGHT, PANEL = PAGE, 7.6, 2.4
"""Size of a figure and width of one of its panels [inches]."""

POINTS = 3000
"""Points of a line in a panel."""

PHASE_COLOURS = dict(zip(PHASES, (VERMILION, SKY, ORANGE, BLUE, GREY, PALE, PURPLE, INK), strict=True))


@dataclass(frozen=True, slots=True, eq=False)
class Ride:
    """A train of a run as it is drawn.

    Attributes
    ----------
    name, planned, rows
        Identifier, its run on its route, its rows.
    time_s, place_m
        Edges of the rows: times [s] and places [m], one more than rows.
    """

    name: str
    planned: PlannedRun
    rows: pd.DataFrame
    time_s: Array
    place_m: Array


def chosen_trains(data: RunData, most: int = MOST) -> list[str]:
    """Return the trains that get a figure: all, or half of `most` with the lowest voltages and then the highest currents."""
    trains = data.table("trains")
    if trains is None:
        return []
    by_train = trains.groupby("train", observed=True)
    names = sorted(str(name) for name in by_train.groups)
    if len(names) <= most:
        return names
    lowest = by_train["voltage_v"].min().sort_values(kind="stable").index.astype(str).tolist()
    highest = by_train["current_a"].max().sort_values(ascending=False, kind="stable").index.astype(str).tolist()
    chosen = [*lowest[: most // 2]]
    chosen += [name for name in highest if name not in chosen][: most - len(chosen)]
    return sorted(chosen)


def train_figures(data: RunData, names: list[str]) -> Iterator[tuple[str, Figure]]:
    """Yield the trains called `names` with their figures."""
    for name in names:
        rows = data.whole_rows(name)
        if rows is not None and name in data.planned:
            yield name, train_figure(ride_of(data, name, rows), data)


def ride_of(data: RunData, name: str, rows: pd.DataFrame) -> Ride:
    """Return a train and its rows as they are drawn."""
    step = interval(rows["time_s"].to_numpy())
    last, planned = rows.iloc[-1], data.planned[name]
    time_s = np.append(rows["time_s"], last["time_s"] + step)
    ahead = max(0.0, float(last["speed_kmh"] / 3.6 + 0.5 * last["acceleration_mps2"] * step)) * step
    return Ride(name, planned, rows, time_s, np.append(rows["distance_m"], min(last["distance_m"] + ahead, planned.route_m)))


def train_figure(ride: Ride, data: RunData) -> Figure:
    """Draw a train: on the left over the route, on the right over time; from above speed, height and phase, voltage, current."""
    scenario, path = data.scenario, ride.planned.path
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, HEIGHT, 0.03)
        whole = figure.subplots(5, 2, sharex="col", sharey="row", height_ratios=(4, 1.3, 1.3, 4, 4), width_ratios=(1, 1))
        whole[1, 1].remove()  # over time a band of phases stands beside the gradient alone
        draw_height(whole[1, 0], path, course_of(path))
        grid = whole[[0, 2, 3, 4]]
        over_way, over_time = grid.T
        course = course_of(path)
        draw_permitted_speed(over_way[0], path, ceiling_of(ride.planned), course)
        draw_gradient(over_way[1], path, course)
        draw_current_limit(over_way[3], path, course)
        _draw_phases(over_time[1], ride)
        for panels, edges in ((over_way, course.at(ride.place_m)), (over_time, ride.time_s)):
            _draw_rows(panels, ride.rows, edges)
        _scale(over_way, ride, path.limit_mps)
        for axes in grid[2]:
            draw_limits(axes, scenario, names=axes is over_time[2])
        _draw_axes(over_way, over_time, ride, data, course)
        whole[1, 0].set_ylabel(tr("relative\nheight [m]"), fontsize=7.5)
        figure.align_ylabels(whole[:, 0])
        figure.suptitle(title_of(ride, data), x=0.01, ha="left")
        _draw_legend(figure, grid, ride)
        return figure


def title_of(ride: Ride, data: RunData) -> str:
    """Return the title of a train's figure, with its lowest voltage and its highest current below."""
    way = route_in_words(ride.planned.path, ride.planned.route_m, data.scenario.line)
    jumps = bool(course_of(ride.planned.path).joints_m)  # then a kilometre alone would be no place
    text = tr("{study}: train {train}, {route}", study=data.title, train=ride.name, route=way)
    facts, dead = [], ride.rows["voltage_v"] < DEAD_V
    for column, pick, words, unit in (
        ("voltage_v", "idxmin", tr("lowest voltage"), "V"),
        ("current_a", "idxmax", tr("highest current"), "A"),
    ):
        known = ride.rows[column][~dead]
        if known.notna().any():
            row = ride.rows.loc[getattr(known, pick)()]
            km = number(float(row["position_km"]), 1, bare=False)
            place = tr("track {track}, km {km}", track=row["track"], km=km) if jumps else tr("km {km}", km=km)
            facts.append(f"{words} {row[column]:.0f} {unit}, {place}, {format_time(row['time_s'])}")
    if dead.any():
        seconds = float(np.diff(ride.time_s)[dead.to_numpy()].sum())
        facts.append(tr("line dead for {seconds} s", seconds=number(seconds, 0)))
    return "\n".join([text, "; ".join(facts)])


def _draw_rows(panels: Array, rows: pd.DataFrame, edges: Array) -> None:
    """Draw speed, voltage and current over places or times; speed is that where a row begins, the others are means."""
    speed = rows["speed_kmh"].to_numpy()
    kept = peaks_kept(speed, POINTS)
    panels[0].plot(edges[kept], speed[kept], color=BLUE, linewidth=1.1, label=tr("speed"))
    for axes, column, colour, label in (
        (panels[2], "voltage_v", GREEN, tr("voltage at the pantograph")),
        (panels[3], "current_a", VERMILION, tr("current at the pantograph")),
    ):
        values = last_twice(rows[column].to_numpy())
        kept = peaks_kept(values, POINTS)
        axes.plot(edges[kept], values[kept], drawstyle="steps-post", color=colour, linewidth=0.9, label=label)
    dead = (rows["voltage_v"] < DEAD_V).to_numpy()
    limited = (rows["limited_by"] == "voltage").to_numpy() & ~dead
    for flags, colour, label in (
        (limited, ORANGE, tr("effort limited by the voltage")),
        (dead, INK, tr("line dead, no voltage")),
    ):
        for first, last in spells(flags):
            for axes in panels[2:]:
                axes.axvspan(edges[first], edges[last], color=colour, alpha=0.25, lw=0, zorder=0.4, label=label)


def spells(flags: Array) -> list[tuple[int, int]]:
    """Return begin and end (behind the last) of every spell of true flags.

    >>> spells(np.array([True, False, True, True]))
    [(0, 1), (2, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(int)))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]


def _draw_phases(axes: Axes, ride: Ride) -> None:
    """Draw a band that tells what the train does."""
    phases = ride.rows["phase"].astype(str).to_numpy()
    changes = np.concatenate(([0], np.flatnonzero(phases[1:] != phases[:-1]) + 1, [len(phases)]))
    for phase in dict.fromkeys(phases):
        own = [(ride.time_s[a], ride.time_s[b] - ride.time_s[a]) for a, b in pairwise(changes) if phases[a] == phase]
        axes.broken_barh(own, (0.25, 0.5), transform=axes.get_xaxis_transform(), color=PHASE_COLOURS.get(phase, GREY), lw=0)
    axes.grid(visible=False, axis="y")
    axes.tick_params(axis="y", length=0)


def _scale(panels: Array, ride: Ride, limit_mps: Array) -> None:
    rows = ride.rows
    panels[0].set_ylim(0.0, 1.08 * max(float(rows["speed_kmh"].max()), 3.6 * float(np.nanmax(limit_mps, initial=0.0)), 1.0))
    if rows["voltage_v"].notna().any():
        panels[2].set_ylim(*voltage_range(float(rows["voltage_v"].min()), float(rows["voltage_v"].max())))
    current = rows["current_a"].fillna(0.0)
    low, high = min(0.0, float(current.min())), max(10.0, float(current.max()))
    panels[3].set_ylim(1.08 * low, 1.12 * high)


def _draw_axes(over_way: Array, over_time: Array, ride: Ride, data: RunData, course: Course) -> None:
    """Label the axes and name stations and devices."""
    path, scenario = ride.planned.path, data.scenario
    over_way[0].set_ylabel(tr("speed [km/h]"))
    over_way[2].set_ylabel(tr("voltage at the\npantograph [V]"))
    over_way[3].set(ylabel=tr("current at the\npantograph [A]"), xlabel=course.label)
    for axes in (over_way[3], over_time[3]):
        axes.axhline(0.0, color=INK, linewidth=0.6)
    begin_m, end_m = _shown(ride, data)
    course.set_limits(over_way[3], begin_m, end_m)
    set_clock(over_time[3], float(ride.time_s[0]), float(ride.time_s[-1]), 5)
    over_time[3].set_xlabel(clock_label(over_time[3]))
    stops = [placed.at_m for placed in ride.planned.calls if placed.call.stops]
    stations = [(place, name) for place, name in stations_along(path, scenario.line) if begin_m <= place <= end_m]
    name_stations(over_way[:2].tolist(), course, stations, stops, PANEL)
    along = [device for device in devices_along(path, data.places.site) if begin_m <= device[0] <= end_m]
    devices = [(float(course.at(place)), name, kind) for place, name, kind in along]
    draw_joints(over_way.tolist(), course)
    for axes in over_way[2:]:
        axes.grid(visible=False, axis="x")
        mark_devices(axes, devices, PANEL, names=axes is over_way[2])


def _shown(ride: Ride, data: RunData) -> tuple[float, float]:
    """Return what part of the route is shown [m]: all of it, or what a selection of places has left of the train."""
    whole = not data.places.is_part
    return (0.0, ride.planned.path.length_m) if whole else (float(ride.place_m[0]), float(ride.place_m[-1]))


def _draw_legend(figure: Figure, grid: Array, ride: Ride) -> None:
    """Draw one legend for all panels below them."""
    found: dict[str, Any] = {}
    for axes in grid.flat:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label.replace("\n", " "), handle)
    for phase in dict.fromkeys(ride.rows["phase"].astype(str)):
        found.setdefault(tr(phase), Patch(color=PHASE_COLOURS.get(phase, GREY), lw=0))
    figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=3, fontsize=7.5, handlelength=1.6)
