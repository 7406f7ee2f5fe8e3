"""Kilometres of a line as a horizontal axis: substations and section cabins named above it, stations below it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes

from tractionpower.reporting.facts.places import Device
from tractionpower.reporting.figures.base.labels import fitting, shortened
from tractionpower.reporting.figures.base.style import GREY, INK, SMALLEST
from tractionpower.reporting.figures.supply.panels import LETTER_7
from tractionpower.reporting.texts import tr

LEVELS = 2
"""Rows of names above an axis."""

MOST_LETTERS = 22
"""Letters of a name of a device or station."""

SIGN, ROW = 0.11, 0.125
"""Width of the sign of a device, and height of a row of names [inches]."""


def levels(places: Sequence[float], widths: Sequence[float], important: Sequence[bool]) -> dict[int, int]:
    """Return the row of each name that fits, by its number: important ones first, those of no room are left out.

    Names of unimportant ones are shown only if all of them fit.

    >>> levels([0.0, 1.0, 2.0], [1.5, 1.5, 1.5], [True, True, True])
    {0: 0, 1: 1, 2: 0}
    """
    order = sorted(range(len(places)), key=lambda k: (not important[k], places[k]))
    found: dict[int, int] = {}
    for k in order:
        for level in range(LEVELS):
            others = (other for other, row in found.items() if row == level)
            if all(abs(places[k] - places[other]) >= (widths[k] + widths[other]) / 2 for other in others):
                found[k] = level
                break
    every = len(found) == len(places)
    return {k: level for k, level in sorted(found.items()) if every or important[k]}


def name_devices(axes: Axes, devices: Sequence[Device], inches: float, *, names: bool = True) -> None:
    """Draw a line at substations and section cabins and name them above the axes, which are `inches` wide."""
    low, high = axes.get_xlim()
    per_inch = abs(high - low) / inches
    inside = [device for device in devices if low <= device[0] <= high]
    places, substations = [place for place, _, _ in inside], [substation for _, _, substation in inside]
    texts = [shortened(name, MOST_LETTERS) for _, name, _ in inside]
    rows = levels(places, [(len(text) + 1.5) * LETTER_7 * per_inch for text in texts], substations)
    signed = set(fitting(places, substations, SIGN * per_inch))
    for k, (place, text) in enumerate(zip(places, texts, strict=True)):
        axes.axvline(place, color=GREY, linewidth=0.7 if substations[k] else 0.5, alpha=0.6, zorder=0.5)
        if names and k in signed:
            style: Any = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points", "ha": "center", "color": INK}
            axes.annotate("▲" if substations[k] else "■", (place, 1.0), (0, 1), va="bottom", fontsize=6.0, **style)
            if k in rows:
                axes.annotate(text, (place, 1.0), (0, 8 + 72 * ROW * rows[k]), va="bottom", fontsize=SMALLEST, **style)


def name_stations(axes: Axes, stations: Sequence[tuple[float, str]], inches: float) -> None:
    """Name stations (kilometre, name) below the axes, which are `inches` wide, and label the axis below the names.

    Names that would overlap stand upright, and some go where there are too many.
    """
    low, high = axes.get_xlim()
    inside = [(km, shortened(name, MOST_LETTERS)) for km, name in stations if low <= km <= high]
    bottom: Any = axes
    if inside:
        per_inch, places = (high - low) / inches, [km for km, _ in inside]
        level = fitting(places, [False] * len(places), [(len(name) + 2) * LETTER_7 * per_inch for _, name in inside])
        upright = len(level) < len(inside)
        shown = fitting(places, [False] * len(places), ROW * per_inch) if upright else level
        bottom = axes.secondary_xaxis(0.0)
        bottom.set_xticks([places[k] for k in shown], [inside[k][1] for k in shown], rotation=90 if upright else 0)
        bottom.tick_params(direction="in", length=4, pad=15, labelsize=SMALLEST, colors=INK, color=INK)
        bottom.spines["bottom"].set_visible(False)
    bottom.set_xlabel(tr("kilometre of the line [km]"), fontsize=8)
