"""What figures of a line with stations have in common: colours of states, stations along an axis, titles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.reporting.figures.base.labels import LETTER, MOST_STATION_LETTERS, fitting, shortened
from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, INK, ORANGE, PAGE, PALE
from tractionpower.reporting.figures.supply.panels import legend_below
from tractionpower.reporting.texts import mark, tr

Array = NDArray[Any]

ACCELERATING_OR_CONSTANT = mark("accelerating or constant speed")

STATES: dict[str, tuple[str, Any, str]] = {
    "accelerating": (GREEN, "-", ACCELERATING_OR_CONSTANT),
    "cruising": (GREEN, "-", ACCELERATING_OR_CONSTANT),
    "braking_to_stop": (BLUE, "-", mark("braking to a stop")),
    "decelerating": (ORANGE, "-", mark("braking to a lower speed")),
    "standing": (GREY, (0, (1, 1.2)), mark("standing")),
}
"""Colour, dashes and words of a state; blue and green as in section 3.4 of Diviš and Kavička."""

PLACE = mark("place [km]")


def colour_of(state: str) -> str:
    """Return the colour of a state."""
    return STATES[state][0]


def draw_by_state(axes: Axes, x: Array, y: Array, states: Sequence[str], **look: Any) -> None:
    """Draw a line through points, each of its pieces in the colour of the state at its beginning."""
    codes = np.asarray(states)
    for state in dict.fromkeys(states):
        inside = codes == state
        ends = np.append(False, inside[:-1])  # the point behind belongs to the piece, too
        shown = np.where(inside | ends, y, np.nan)
        gaps = ends & ~inside
        # Behind the end of a piece the line must break, also where the next one begins with the next point.
        at = np.insert(x, np.flatnonzero(gaps) + 1, np.nan)
        values = np.insert(shown, np.flatnonzero(gaps) + 1, np.nan)
        colour, dashes, _ = STATES[state]
        axes.plot(at, values, color=colour, linestyle=dashes, **({"linewidth": 1.2} | look))


def states_legend(figure: Figure, states: Sequence[str]) -> None:
    """Write below a figure what the colours of the states that it shows mean."""
    words = {STATES[state][2]: STATES[state] for state in STATES if state in set(states)}
    handles = [Line2D([], [], color=colour, linestyle=dashes, linewidth=1.6) for colour, dashes, _ in words.values()]
    legend_below(figure, handles, [tr(word) for word in words])


def shade_stations(axes: Axes, case: StationsCase, *, upright: bool = False) -> None:
    """Shade where stations lie along the horizontal axis [km]; `upright`: along the vertical one."""
    for station in case.stations:
        span = axes.axhspan if upright else axes.axvspan
        span(station.from_m / 1e3, station.to_m / 1e3, color=PALE, alpha=0.6, linewidth=0, zorder=0)


def name_stations(axes: Axes, case: StationsCase, *, upright: bool = False) -> None:
    """Name the stations above the axes, or right of them; where names would overlap, the first ones stay."""
    names = [shortened(station.name or station.id, MOST_STATION_LETTERS) for station in case.stations]
    places = [(station.from_m + station.to_m) / 2e3 for station in case.stations]
    per_inch = case.length_m / 1e3 / (0.85 * PAGE)
    gaps: float | list[float] = 0.25 * per_inch if upright else [(len(name) + 2) * LETTER * per_inch for name in names]
    for k in fitting(places, [False] * len(places), gaps):
        at = (1.0, places[k]) if upright else (places[k], 1.0)
        frame: Any = ("axes fraction", "data") if upright else ("data", "axes fraction")
        beside: Any = {"ha": "left", "va": "center"} if upright else {"ha": "center", "va": "bottom"}
        axes.annotate(names[k], at, (3, 0) if upright else (0, 2), xycoords=frame, textcoords="offset points", color=INK,
                      fontsize=7.5, **beside)  # fmt: skip


def by_train(rows: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """Return the rows of each train in the order of time, trains in the order in which they came."""
    ordered = rows.assign(train=rows["train"].astype(str), state=rows["state"].astype(str)).sort_values("time_s", kind="stable")
    return [(str(name), part) for name, part in ordered.groupby("train", sort=False)]
