"""Delays drawn over the lines of a train graph: stretches in the colour and dashes of their cause, and how late trains are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from numpy.typing import NDArray

from tractionpower.reporting.figures.base.labels import LETTER, LINE
from tractionpower.reporting.figures.base.style import INK
from tractionpower.reporting.figures.delays.delay_styles import CAUSES
from tractionpower.reporting.texts import tr

WIDTHS = {False: (2.8, 1.3), True: (1.7, 0.8)}
"""Widths of lines where seconds are lost, and where they are only carried on [pt]; narrower ones for many trains."""

MOST_LABELS = {False: 14, True: 8}
"""Trains whose delay is written beside their line, the latest first; less of them where there are many."""

Box = tuple[float, float, float]
"""Middle of a text on both axes, and its width."""


@dataclass(frozen=True, slots=True, eq=False)
class DelayedStretch:
    """A part of a train's line on which it is late.

    Attributes
    ----------
    time_s, km
        Times [s] and kilometres [km].
    cause
        Where most of the delay at its end first arose.
    carried
        Whether most of it was there before the stretch.
    """

    time_s: NDArray[Any]
    km: NDArray[Any]
    cause: str
    carried: bool


@dataclass(frozen=True, slots=True)
class DelayLabel:
    """How late a train is where it is latest: time [s], kilometre [km], text, and the delay by which labels are chosen [s]."""

    time_s: float
    km: float
    text: str
    delay_s: float


@dataclass(frozen=True, slots=True)
class DelayLayer:
    """What is drawn of delays in a panel; `many` trains are drawn finer."""

    stretches: Sequence[DelayedStretch] = ()
    labels: Sequence[DelayLabel] = ()
    many: bool = False


def draw_delays(axes: Axes, layer: DelayLayer, width_inches: float, height_inches: float) -> list[Box]:
    """Draw stretches and labels into axes of that size, and return where labels stand."""
    new, carried = WIDTHS[layer.many]
    present = {stretch.cause for stretch in layer.stretches}
    for name, style in CAUSES.items():
        if name not in present:
            continue
        for stretch in layer.stretches:
            if stretch.cause == name:
                width = carried if stretch.carried else new
                cause = tr(style.words)
                label = tr("late by {cause}, carried on", cause=cause) if stretch.carried else tr("late by {cause}", cause=cause)
                axes.plot(stretch.time_s, stretch.km, color=style.colour, linestyle=style.dashes, linewidth=width, label=label,
                          zorder=2.5, dash_capstyle="butt")  # fmt: skip
    shown = sorted(layer.labels, key=lambda each: -each.delay_s)[: MOST_LABELS[layer.many]]
    return _label(axes, shown, width_inches, height_inches)


def _label(axes: Axes, labels: Sequence[DelayLabel], width_inches: float, height_inches: float) -> list[Box]:
    """Write how late trains are, each where no other label stands."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    second, km = (right - left) / width_inches, (high - low) / height_inches  # in an inch of paper
    taken: list[Box] = []
    for label in labels:
        wide, tall = (LETTER * len(label.text) + 0.08) * second, LINE * km
        for x, y in _spots(label, wide, tall):
            inside = left <= x - wide / 2 and x + wide / 2 <= right and low <= y - tall / 2 and y + tall / 2 <= high
            if inside and not any(abs(x - a) < (wide + w) / 2 and abs(y - b) < tall for a, b, w in taken):
                taken.append((x, y, wide))
                box = {"facecolor": "white", "edgecolor": INK, "linewidth": 0.5, "pad": 1.2, "alpha": 0.9}
                axes.annotate(
                    label.text, (label.time_s, label.km), (x, y), fontsize=7.5, color=INK, ha="center", va="center", bbox=box,
                    zorder=5, arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.5},
                )  # fmt: skip
                break
    return taken


def _spots(label: DelayLabel, wide: float, tall: float) -> list[tuple[float, float]]:
    """Return where a label may stand, the nearest first."""
    steps = ((0, 1.1), (1, 1), (-1, 1), (1, -1), (-1, -1), (2, 1), (-2, 1), (2, -1), (-2, -1), (0, -1.1))
    return [(label.time_s + 0.62 * across * wide, label.km + 1.3 * up * tall) for up, across in steps]
