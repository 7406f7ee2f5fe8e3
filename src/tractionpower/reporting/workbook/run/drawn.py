"""What the charts of a run are drawn from: where the extracts stand in the workbook, and how far the axes go."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.page import Block

TIME, KM, SPEED, VOLTAGE = mark("time of day"), mark("place [km]"), mark("speed [km/h]"), mark("voltage [V]")
SHARE = mark("share of the time [%]")

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Stretch:
    """Consecutive rows of a sheet that belong together: a train on a line, or a track; `line` is the number of the line."""

    name: str
    first: int
    last: int
    rising: bool = True
    where: str = ""
    line: int = 0


@dataclass
class Drawn:
    """What there is to draw.

    Attributes
    ----------
    blocks
        Tables of extracts by kind.
    stretches
        Their parts by kind.
    spans
        From where to where the axes go, by what they show.
    lines
        The tracks of each line.
    trains
        Trains of the run.
    period_s, windows
        Length of the means of the load curves, and the sliding windows of the most loaded substation [s].
    substations
        Names of substations, the most loaded first; `blocks` have a column for each, by its number in the order of the line.
    numbers
        That number by name.
    train, substation
        The train with the lowest voltage; the substation that is loaded most.
    """

    lines: tuple[tuple[str, ...], ...] = ()
    blocks: dict[str, Block] = field(default_factory=dict)
    stretches: dict[str, list[Stretch]] = field(default_factory=dict)
    spans: dict[str, tuple[float, float]] = field(default_factory=dict)
    trains: int = 0
    period_s: int = 0
    windows: tuple[int, ...] = ()
    substations: tuple[str, ...] = ()
    numbers: dict[str, int] = field(default_factory=dict)
    train: str = ""
    substation: str = ""


def chosen(count: int, most: int) -> Array:
    """Return at most `most` of `count` indices, evenly spread, with the first and the last."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def period_in_words(seconds: int) -> str:
    """Return the length of a period as one says it."""
    if seconds < 60:
        return tr("{seconds} s", seconds=seconds)
    return tr("{minutes} min", minutes=seconds // 60)
