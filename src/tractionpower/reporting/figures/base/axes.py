"""What axes of several figures have in common: the clock, limits of the voltage, devices of the supply along the line."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.limits import find_limit
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.figures.base.labels import LETTER, LINE, MOST_STATION_LETTERS, clock, clock_ticks, fitting, shortened
from tractionpower.reporting.figures.base.style import GREY, INK
from tractionpower.reporting.texts import number, tr

LIMITS = {"u_min2": "U_min2", "u_n": "U_n", "u_max1": "U_max1", "u_max2": "U_max2"}
"""Limits of the voltage that are drawn, and how they are written."""


LAYOUT = 0.7
"""Share of the height of axes that titles, labels and legends may leave of them when the figure gets its layout."""

DEAD_V = 1.0
"""A line with no more than this is dead [V]."""


def panels_of_lines(figure: Figure, lines: Sequence[Sequence[str]]) -> list[Axes]:
    """Return a panel for each track, one below the other; those of a line share its kilometres, all share their values."""
    count = sum(len(tracks) for tracks in lines)
    panels: list[Axes] = []
    for tracks in lines:
        first = None
        for track in tracks:
            axes = figure.add_subplot(count, 1, len(panels) + 1, sharex=first, sharey=panels[0] if panels else None)
            axes.tick_params(labelbottom=track == tracks[-1])
            first = first or axes
            panels.append(axes)
    return panels


def with_margin(low: float, high: float) -> tuple[float, float]:
    """Return the ends of an axis for places between two kilometres [km]."""
    margin = 0.01 * max(high - low, 0.1)
    return low - margin, high + margin


def set_clock(axes: Axes, begin_s: float, end_s: float, most: int = 10) -> None:
    """Let the horizontal axis be a clock from `begin_s` to `end_s` [s], with at most some `most` ticks."""
    axes.set_xlim(begin_s - 0.01 * (end_s - begin_s), end_s + 0.02 * (end_s - begin_s))
    ticks = clock_ticks(begin_s, end_s, most)
    axes.set_xticks(ticks, [clock(tick, ticks) for tick in ticks])


def clock_label(axes: Axes) -> str:
    """Return the label of an axis that is a clock."""
    return tr("time of day [h:min:s]") if any(tick % 60 for tick in axes.get_xticks()) else tr("time of day [h:min]")


def voltage_range(lowest: float, highest: float, room: float = 0.3) -> tuple[float, float]:
    """Return from where to where an axis shows voltages between `lowest` and `highest` [V], with a share of `room` at both.

    Below zero there is little of it, so that a dead line shows.
    """
    margin = room * max(highest - lowest, 400.0)
    return (lowest - margin if lowest > margin else min(lowest, 0.0) - 0.2 * margin), highest + margin


def limits_between(scenario: Scenario, low: float, high: float) -> list[tuple[str, float]]:
    """Return the limits of the voltage that lie between two voltages [V], as name and value; equal ones together."""
    found: dict[float, list[str]] = {}
    for name, shown in LIMITS.items():
        limit = find_limit(scenario.limits, scenario.supply.system, name)
        if limit is not None and low < limit.value < high:
            found.setdefault(limit.value, []).append(shown)
    return [(", ".join(names), value) for value, names in found.items()]


def draw_limits(axes: Axes, scenario: Scenario, *, names: bool = True) -> None:
    """Draw the limits of the voltage within the vertical axis, with their names right of the axes."""
    low, high = axes.get_ylim()
    limits = sorted(limits_between(scenario, low, high), key=lambda limit: limit[1])
    inches = (high - low) / max(axes.get_window_extent().height / axes.figure.dpi, 0.1)
    inches /= LAYOUT
    gaps = [(after - value) / inches for (_, value), (_, after) in pairwise(limits)]
    for k, (shown, value) in enumerate(limits):
        axes.axhline(value, color=GREY, linewidth=0.9, linestyle=(0, (5, 3)), zorder=1.5)
        if not names:
            continue
        # Names of near limits stand in one line each, that of the upper one above it.
        close = [bool(gap < 1.4 * LINE) for gap in (*gaps[k - 1 : k], *gaps[k : k + 1])]
        apart = "\n" if not any(close) else " "
        above = k > 0 and gaps[k - 1] < 1.2 * LINE
        below = k < len(gaps) and gaps[k] < 1.2 * LINE
        axes.annotate(
            f"{shown}{apart}{number(value, 1)} V", (1.0, value), (3, 0), xycoords=("axes fraction", "data"),
            textcoords="offset points", ha="left", va="bottom" if above else "top" if below else "center", color=INK,
            fontsize=7.5, linespacing=1.0,
        )  # fmt: skip


def mark_devices(axes: Axes, devices: Sequence[tuple[float, str, bool]], inches: float, *, names: bool = True) -> None:
    """Draw a line at substations and section cabins and name them above the axes, which are `inches` wide.

    `devices` are place on the horizontal axis, name, and whether it is a substation. Where names would overlap,
    substations keep theirs first; the others keep their sign where there is room for it.
    """
    devices = [(place, shortened(name, MOST_STATION_LETTERS), substation) for place, name, substation in devices]
    low, high = axes.get_xlim()
    per_inch = abs(high - low) / inches
    places, important = [place for place, _, _ in devices], [substation for _, _, substation in devices]
    named = set(fitting(places, important, [(len(name) + 2) * LETTER * per_inch for _, name, _ in devices]))
    signed = set(fitting(places, [k in named for k in range(len(places))], 0.12 * per_inch))
    for k, (place, name, substation) in enumerate(devices):
        axes.axvline(place, color=GREY, linewidth=0.6 if substation else 0.5, alpha=0.4, zorder=0.5)
        if names and k in signed:
            style: Any = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points", "ha": "center", "color": INK}
            axes.annotate("▲" if substation else "■", (place, 1.0), (0, 1), va="bottom", fontsize=6.5, **style)
            if k in named:
                axes.annotate(name, (place, 1.0), (0, 9), va="bottom", fontsize=7.5, **style)
