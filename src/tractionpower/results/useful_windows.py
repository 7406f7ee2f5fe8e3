"""Mean useful voltages over parts of the day: each window is summed up while it lasts, and only its means are kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tractionpower.results.useful_voltage import Array, Means, Numbers, UsefulVoltage

HOUR_S = 3600.0


@dataclass(frozen=True, slots=True)
class Window:
    """A part of the run: the whole of it, an hour by the clock, or a part that the user gave; from and to [s]."""

    kind: Literal["run", "hour", "given"]
    from_s: float
    to_s: float


@dataclass(frozen=True, slots=True)
class WindowMeans:
    """The means of a window, of its zones and of all trains."""

    window: Window
    zones: Means
    trains: Means


def windows_of(from_s: float, to_s: float, given: Sequence[tuple[float, float]] = ()) -> tuple[Window, ...]:
    """Return the whole run, the full hours by the clock within it, and the `given` windows as far as they lie in it [s]."""
    first, last = int(np.ceil(from_s / HOUR_S - 1e-9)), int(np.floor(to_s / HOUR_S + 1e-9))
    hours = [Window("hour", n * HOUR_S, (n + 1) * HOUR_S) for n in range(first, last)]
    clipped = [(max(begin, from_s), min(end, to_s)) for begin, end in given]
    return (Window("run", from_s, to_s), *hours, *(Window("given", begin, end) for begin, end in clipped if begin < end))


class WindowedUsefulVoltage:
    """Mean useful voltages of trains and zones in several windows, which may overlap.

    Parameters
    ----------
    trains, parts
        How many trains there are, and how many parts of the line.
    zones
        Of each zone the numbers of its parts; zones may overlap.
    windows
        The windows. A step that crosses the end of one counts there by its share; in one of kind run every step counts in full.
    shortest_stay_s
        A train that was in a zone for less time than this within a window does not count there [s].
    """

    def __init__(
        self,
        trains: int,
        parts: int,
        zones: Sequence[NDArray[np.integer[Any]]],
        windows: Sequence[Window],
        shortest_stay_s: float = 0.0,
    ) -> None:
        self._size, self._zones = (trains, parts), tuple(zones)
        self._windows, self._shortest_s = tuple(windows), shortest_stay_s
        self._open: dict[int, UsefulVoltage] = {}
        self._means: dict[int, WindowMeans] = {}

    def add(
        self,
        time_s: Array,
        train: Numbers,
        part: Numbers,
        voltage_v: Array,
        current_a: Array,
        tractive: NDArray[np.bool_],
        step_s: float,
    ) -> None:
        """Add rows ordered by time, with the starts of their steps [s]; the others as in `UsefulVoltage.add`."""
        if not len(time_s):
            return
        for number, window in enumerate(self._windows):
            if window.kind == "run":
                self._sums(number).add(train, part, voltage_v, current_a, tractive, step_s)
            elif time_s[-1] + step_s > window.from_s and time_s[0] < window.to_s:
                first = int(np.searchsorted(time_s, window.from_s - step_s, side="right"))
                here = slice(first, int(np.searchsorted(time_s, window.to_s)))
                weight = _shares(time_s[here], step_s, window)
                self._sums(number).add(train[here], part[here], voltage_v[here], current_a[here], tractive[here], weight)
            elif time_s[0] >= window.to_s and number in self._open:
                self._means[number] = self._mean(number)
                del self._open[number]

    def means(self) -> tuple[WindowMeans, ...]:
        """Return the means of all windows in their order, those without a row too."""
        return tuple(self._means.get(number) or self._mean(number) for number in range(len(self._windows)))

    def _sums(self, number: int) -> UsefulVoltage:
        if number not in self._open:
            self._open[number] = UsefulVoltage(*self._size)
        return self._open[number]

    def _mean(self, number: int) -> WindowMeans:
        sums = self._open.get(number) or UsefulVoltage(*self._size)
        zones, trains = sums.of_zones(self._zones, self._shortest_s), sums.of_trains(self._shortest_s)
        return WindowMeans(self._windows[number], zones, trains)


def _shares(time_s: Array, step_s: float, window: Window) -> Array:
    """Return how much of each step lies in a window [s]; a step that lies in it as a whole has its exact length."""
    begin, end = time_s, time_s + step_s
    slack = 1e-9 * step_s
    inside = (begin >= window.from_s - slack) & (end <= window.to_s + slack)
    part = np.minimum(end, window.to_s) - np.maximum(begin, window.from_s)
    return np.where(inside, step_s, np.where(part > slack, part, 0.0))
