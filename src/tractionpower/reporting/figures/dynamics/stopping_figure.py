"""Stops of a train: its speed over the distance from the brake command."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.chain_stops import Stop, stops_of
from tractionpower.reporting.figures.base.style import INK, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.dynamics.panels import LINES, label, line, titled, told_value
from tractionpower.reporting.figures.supply.panels import legend_below
from tractionpower.reporting.texts import number, tr

MOST_STOPS = 6
"""Stops of one figure: the longest."""


def stopping(data: ChainData) -> Figure | None:
    """Draw speed over distance of each stop from its first brake command, with the stopping distance."""
    every = stops_of(data.results) if data.has("vehicles") else []
    if not every:
        return None
    shown = sorted(sorted(every, key=lambda stop: -stop.distance_m)[:MOST_STOPS], key=lambda stop: stop.from_s)
    speed, place = (data.of_vehicles(name)[:, 0] for name in ("speed_kmh", "position_m"))
    fast, far = data.units["speed"].per, data.units["distance"].per
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.7)
        axes = figure.add_subplot()
        for colour, stop in zip(LINES, shown, strict=False):
            rows = (data.times > stop.from_s) & (data.times <= stop.to_s)
            words = _words(data, stop)
            run = np.concatenate([[0.0], np.abs(place[rows] - stop.from_m), [stop.distance_m]]) * far
            fall = np.concatenate([[stop.speed_kmh], np.abs(speed[rows]), [0.0]]) * fast
            line(axes, run, fall, color=colour, label=words, linewidth=1.3)
            end = stop.distance_m * far
            axes.plot([end], [0.0], "o", color=colour, markersize=4.5, clip_on=False, zorder=4)
            style: Any = {"textcoords": "offset points", "ha": "right", "va": "bottom", "color": INK, "fontsize": 7.5}
            axes.annotate(told_value(data, "distance", stop.distance_m), (end, 0.0), (-2, 5), **style)
        axes.set_ylim(0.0, None)
        axes.set_xlim(0.0, 1.03 * max(stop.distance_m for stop in shown) * far)
        axes.set_xlabel(label(data, "distance", tr("distance of the first vehicle from the first brake command")))
        axes.set_ylabel(label(data, "speed", tr("speed")))
        handles, labels = axes.get_legend_handles_labels()
        legend_below(figure, handles, labels, 2)
        longest = max(shown, key=lambda stop: stop.distance_m)
        told = tr("stopping distance {distance} from {speed}", distance=told_value(data, "distance", longest.distance_m),
                  speed=told_value(data, "speed", longest.speed_kmh))  # fmt: skip
        return titled(figure, tr("stopping"), told)


def _words(data: ChainData, stop: Stop) -> str:
    """Return what the legend says of a stop."""
    far, seconds, since = told_value(data, "distance", stop.distance_m), number(stop.time_s), number(stop.from_s)
    if not np.isfinite(stop.deceleration_mps2):
        return tr("braked at {time} s: {distance} in {seconds} s", time=since, distance=far, seconds=seconds)
    rate = told_value(data, "acceleration", stop.deceleration_mps2)
    return tr(
        "braked at {time} s: {distance} in {seconds} s, mean {deceleration}",
        time=since, distance=far, seconds=seconds, deceleration=rate,
    )  # fmt: skip
