"""What figures of train dynamics have in common: panels over the time of the case, lines of vehicles, units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.series import peaks_kept
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, INK, ORANGE, PAGE, PURPLE, SKY, VERMILION, new_figure
from tractionpower.reporting.figures.supply.panels import head
from tractionpower.reporting.texts import mark, number, tr

Array = NDArray[Any]

MOST_POINTS = 3000
"""Points of a line; peaks are kept."""

FIRST, MIDDLE, LAST = BLUE, GREEN, VERMILION
LINES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
LOOKS: tuple[tuple[str, Any], ...] = ((FIRST, "-"), (MIDDLE, (0, (5, 1.5))), (LAST, (0, (2, 1.2))))
"""Colours and dashes of the first, the middle and the last vehicle."""

MOST_LETTERS = 30
"""Letters of the name of a vehicle or coupling in a legend."""

LITTLE = 0.02
"""A part of an axis that is too little for room of its own."""

NOTHING = 1e-9
"""An axis of less than this has no height."""

TIME = mark("time [s]")


def titled(figure: Figure, words: str, told: str = "") -> Figure:
    """Write the title of a figure, with a line of what it tells below, and return the figure; its foot names the case."""
    head(figure, f"{words[:1].upper()}{words[1:]}")
    if told:
        figure.suptitle(f"{figure.get_suptitle()}\n{told}", x=0.01, ha="left")
    return figure


def time_figure(count: int, height: float, ratios: Sequence[float] | None = None) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels below each other that share their time, and the panels."""
    figure = new_figure(PAGE, height)
    grid: Any = figure.subplots(count, sharex=True, squeeze=False, height_ratios=ratios)
    panels = list(grid[:, 0])
    panels[-1].set_xlabel(tr(TIME))
    return figure, panels


def looks(count: int) -> tuple[tuple[str, Any], ...]:
    """Return colours and dashes of the lines of one, two or three vehicles from the front."""
    return {1: LOOKS[:1], 2: (LOOKS[0], LOOKS[2])}.get(count, LOOKS)


def time_axis(axes: Axes, times: Array) -> None:
    """Let a horizontal axis go over the times of a run [s]."""
    if len(times):
        axes.set_xlim(float(times[0]), max(float(times[-1]), float(times[0]) + 1e-6))


def line(axes: Axes, times: Array, values: Array, **look: Any) -> None:
    """Draw a line with no more points than a figure shows, none of its peaks lost."""
    kept = peaks_kept(values, MOST_POINTS)
    axes.plot(times[kept], values[kept], **({"linewidth": 1.1} | look))


def label(data: ChainData, quantity: str, words: str) -> str:
    """Return the label of an axis: words, already translated, and the unit that the case is shown in."""
    return f"{words} [{data.units[quantity].unit}]"


def told_value(data: ChainData, quantity: str, value: float) -> str:
    """Return a value, in the unit of the tables, as a sentence tells it in the unit of the case."""
    measure = data.units[quantity]
    return f"{number(value * measure.per, measure.digits, bare=False)} {measure.unit}"


def vehicle_told(name: str) -> str:
    """Return what a vehicle is called in a legend."""
    return tr("vehicle {name}", name=shortened(name, MOST_LETTERS))


def coupling_told(name: str) -> str:
    """Return what a coupling is called in a legend."""
    return tr("coupling {name}", name=shortened(name, MOST_LETTERS))


def zero_line(axes: Axes) -> None:
    """Draw the line of nothing where an axis goes to both sides of it."""
    low, high = axes.get_ylim()
    if low < 0.0 < high:
        axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1.2)


def name_sides(axes: Axes, above: str, below: str) -> None:
    """Name both halves of an axis of forces, within it at its right edge."""
    low, high = axes.get_ylim()
    style: Any = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "right", "color": GREY, "fontsize": 7.0}
    if high > 0.0:
        axes.annotate(above, (1.0, 1.0), (-2, -2), va="top", **style)
    if low < 0.0:
        axes.annotate(below, (1.0, 0.0), (-2, 2), va="bottom", **style)


def room(axes: Axes, values: Sequence[Array], share: float = 0.08) -> None:
    """Let a vertical axis hold values, with nothing in it and a little room at both ends."""
    every = np.concatenate([np.ravel(each) for each in values])
    every = every[np.isfinite(every)]
    low, high = (min(0.0, float(every.min())), max(0.0, float(every.max()))) if len(every) else (0.0, 1.0)
    if high - low < NOTHING:
        low, high = -1.0, 1.0  # of a train that stands
    wide = high - low
    axes.set_ylim(low - (share * wide if low < -LITTLE * wide else 0.0), high + (share * wide if high > LITTLE * wide else 0.0))
