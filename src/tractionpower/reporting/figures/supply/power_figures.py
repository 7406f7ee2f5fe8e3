"""Substations of a run over time: powers with sliding means, rated powers and contracts; currents with rated currents."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.facts.device_words import window_told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import envelope, interval, sliding_mean
from tractionpower.reporting.facts.substation_loads import Load, substation_loads
from tractionpower.reporting.figures.base.style import BLUE, INK, PAGE, PURPLE, SKY, SMALLEST, STYLE, VERMILION
from tractionpower.reporting.figures.supply.panels import (
    LETTER_7,
    MOST_PANELS,
    columns_for,
    fitted,
    head,
    legend_below,
    most_loaded,
    once,
    time_panels,
)
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

PIXELS = 1400
"""Spells into which a long series is divided over the whole width of a figure; of each the lowest and the highest is drawn."""

WINDOWS: tuple[tuple[float, str, Any, float], ...] = ((900.0, VERMILION, "-", 1.0), (3600.0, BLUE, (0, (4, 1.5)), 1.3))
"""Windows of the sliding means [s], with colour, dashes and width of their lines."""

RATED: dict[str, Any] = {"color": INK, "linewidth": 1.0, "linestyle": (0, (6, 2, 1, 2)), "zorder": 2.5}
CONTRACT: dict[str, Any] = {"color": PURPLE, "linewidth": 1.4, "linestyle": (0, (2, 1.2)), "zorder": 2.6}
OVERLOAD: dict[str, Any] = {"color": INK, "linewidth": 0.9, "linestyle": (0, (1, 1.5)), "zorder": 2.5}

NEAR = 1.35
"""A line of what is permitted is drawn when it is within so many highest values; a rated one always."""


def substation_power(data: RunData) -> Figure | None:
    """Draw the power of each substation over time: all steps, means of 15 and 60 min, rated power and contract.

    The rated power is that of the units in service from the start: rated current times rated voltage of their type.
    """

    def lines(load: Load, top: float) -> Sequence[tuple[float, str, dict[str, Any]]]:
        marks = [(load.contract_kw / 1000.0, tr("contracted, quarter of an hour by the clock"), CONTRACT)]
        rated = (load.rated_kw / 1000.0, tr("rated power of the units in service (rated current times rated voltage)"), RATED)
        return [rated, *(mark for mark in marks if mark[0] <= NEAR * top)]

    return _draw(
        data,
        lambda load: load.power_kw / 1000.0,
        lines,
        (tr("power at the busbars [MW]"), tr("power of the substations")),
        lambda load, name: _told(data, load, name, "highest_power_kw", tr("{value} MW"), 1000.0, 2),
    )


def substation_currents(data: RunData) -> Figure | None:
    """Draw the current of each substation over time: all steps, means of 15 and 60 min, and what the units permit.

    That is the rated current of the units in service from the start, and its multiples by their duty class as far as the
    currents come near them.
    """

    def lines(load: Load, top: float) -> Sequence[tuple[float, str, dict[str, Any]]]:
        found = [(load.rating.rated_a, tr("rated current of the units in service"), RATED)]
        for window_s, multiple in load.rating.windows:
            permitted = multiple * load.rating.rated_a
            if multiple > 1.0 and permitted <= NEAR * top:
                words = tr(
                    "{multiple} times rated: RMS over {window} at most", multiple=number(multiple, 2), window=_window(window_s)
                )
                found.append((permitted, words, OVERLOAD))
        return found

    return _draw(
        data,
        lambda load: load.current_a,
        lines,
        (tr("current of the substation [A]"), tr("currents of the substations")),
        lambda load, name: _told(data, load, name, "highest_current_a", tr("{value} A"), 1.0, 0),
    )


def _draw(
    data: RunData,
    values: Callable[[Load], Array],
    lines: Callable[[Load, float], Sequence[tuple[float, str, dict[str, Any]]]],
    words: tuple[str, str],
    title: Callable[[Load, str], str],
) -> Figure | None:
    """Draw a panel for each substation, of too many those with the highest means of a quarter of an hour."""
    every = substation_loads(data)
    if not every:
        return None
    shown = [every[k] for k in most_loaded([_highest_mean(load, values(load)) for load in every])]
    begin = float(shown[0].time_s[0])
    end = float(shown[0].time_s[-1]) + interval(shown[0].time_s)
    top = max(float(values(load).max()) for load in shown)
    columns = columns_for(len(shown))
    room = (PAGE - 0.6) / columns - 0.1
    with mpl.rc_context(STYLE):
        figure, panels = time_panels(len(shown), begin, end)
        for axes, load in zip(panels, shown, strict=False):
            _draw_series(axes, load.time_s, values(load), PIXELS // columns)
            for value, label, style in lines(load, top):
                if np.isfinite(value):
                    axes.axhline(value, label=label, **style)
            name = fitted(load.station.id, room - LETTER_7 * len(title(load, "")))
            axes.set_title(title(load, name), loc="left", fontsize=SMALLEST, pad=3)
        figure.supylabel(words[0], fontsize=9)
        more = tr(", the {shown} most loaded of {every}", shown=MOST_PANELS, every=len(every)) if len(shown) < len(every) else ""
        head(figure, f"{data.title}: {words[1]}{more}")
        legend_below(figure, *once(panels), 2)
        return figure


def _highest_mean(load: Load, values: Array) -> float:
    mean = sliding_mean(values, max(1, round(900.0 / interval(load.time_s))))
    return float(np.nanmax(mean)) if np.isfinite(mean).any() else float(values.mean())


def _draw_series(axes: Axes, time_s: Array, values: Array, pixels: int) -> None:
    axes.axhline(0.0, color=INK, linewidth=0.6)
    if len(time_s) > 2 * pixels:
        starts, low, high = envelope(time_s, values, pixels)
        axes.fill_between(starts, low, high, step="post", color=SKY, lw=0.3, label=tr("lowest to highest mean of a step"))
    else:
        axes.plot(time_s, values, drawstyle="steps-post", color=SKY, linewidth=1.0, label=tr("mean of a step"))
    for window_s, colour, dashes, width in WINDOWS:
        mean = sliding_mean(values, max(1, round(window_s / interval(time_s))))
        if np.isfinite(mean).sum() > 1:
            starts, _, high = envelope(time_s, mean, min(pixels, len(mean)))
            label = tr("mean of the last {window}", window=_window(window_s))
            axes.plot(starts, high, color=colour, linewidth=width, linestyle=dashes, label=label)


def _window(seconds: float) -> str:
    return "60 min" if seconds == 3600.0 else window_told(seconds)  # beside one of 15 min


def _told(data: RunData, load: Load, name: str, figure: str, unit: str, size: float, digits: int) -> str:
    """Return the title of a panel: the substation, its highest value with its time."""
    told = data.key_figures.get((figure, f"substation {load.station.id}"))
    known = told is not None and told["value"] is not None
    rows = load.current_a if size == 1.0 else load.power_kw
    value = number((float(told["value"]) if told is not None and known else float(rows.max())) / size, digits)
    when = str(told["time"]) if told is not None and known else ""
    highest = unit.format(value=value)
    if when:
        return tr("▲ {name}: highest {highest} at {time}", name=name, highest=highest, time=when)
    return tr("▲ {name}: highest {highest}", name=name, highest=highest)
