"""Rail potentials against the touch voltages that may last so long (EN 50122-1, DC; the values are rows of the limits table).

The potential of the rails against remote earth stands for the touch voltage, of which it is the upper bound. Between two
durations of the table that of the longer one holds, so a spell above a voltage may last as long as the next shorter duration.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import Problem
from tractionpower.kernels.windows import GAP_STEPS
from tractionpower.model.base import format_time
from tractionpower.model.limits import Limit, common_limits
from tractionpower.results.spells import TOLERANCE_V, TrainSpells
from tractionpower.results.verdicts import AT_MOST

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
Place = tuple[str, float]
"""Track and kilometre."""

PREFIX, WORKSHOP = "touch_", "touch_workshop"
_DURATION = re.compile(r"touch_(?:permanent|(\d+(?:\.\d+)?)s)")
_TINY_S = 1e-6


@dataclass(frozen=True, slots=True)
class TouchLimit:
    """A touch voltage [V], the duration that it belongs to [s], and how long a spell above it may last [s].

    `judged` tells whether a spell that lasts longer is a violation: the voltage of workshops holds in some places only.
    """

    limit: Limit
    voltage_v: float
    duration_s: float
    may_last_s: float
    judged: bool = True


def touch_limits(limits: Iterable[Limit], system: str, step_s: float) -> tuple[TouchLimit, ...]:
    """Return the limits that steps of `step_s` [s] can tell, from the longest duration on; shorter ones are left out."""
    named = common_limits(limits, system, PREFIX)
    timed = {duration: limit for limit in named.values() if (duration := _duration(limit.name)) is not None}
    order = [*sorted(timed, reverse=True), 0.0]
    found = [TouchLimit(timed[a], timed[a].value, a, b) for a, b in pairwise(order) if a >= step_s - _TINY_S]
    if WORKSHOP in named and np.inf in timed:
        found.append(TouchLimit(named[WORKSHOP], named[WORKSHOP].value, np.inf, order[1], judged=False))
    return tuple(found)


def check_touch(limits: Iterable[Limit], system: str) -> list[Problem]:
    """Return what is wrong with the rows of touch voltages."""
    problems = []
    for name, limit in sorted(common_limits(limits, system, PREFIX).items()):
        path = f"limits[{limit.system} {name}]"
        if name != WORKSHOP and not _duration(name):
            known = f"touch_permanent, {WORKSHOP}, or touch_ with a duration in seconds such as touch_300s"
            problems.append(Problem("unknown_limit", path, name, known, "name the duration"))
        elif limit.value <= 0.0:
            problems.append(Problem("touch_voltage", path, f"{limit.value:g} V", "above 0 V", "correct the value"))
    return problems


def _duration(name: str) -> float | None:
    match = _DURATION.fullmatch(name)
    if match is None:
        return None
    return float(match[1]) if match[1] else np.inf


class TouchCheck:
    """Longest spells above each touch voltage, at places and under trains.

    Parameters
    ----------
    limits
        What is looked at.
    places, trains
        Number of places and of trains.
    step_s
        Length of a step [s].
    """

    def __init__(self, limits: Sequence[TouchLimit], places: int, trains: int, step_s: float) -> None:
        self.limits, self.step_s = tuple(limits), step_s
        self._lowest_v = min((each.voltage_v for each in limits), default=np.inf)
        self.places = [TrainSpells(places, each.voltage_v) for each in limits]
        self.trains = [_MovingSpells(trains, each.voltage_v) for each in limits]

    def add(self, time_s: Array, potential_v: Array) -> None:
        """Add steps: their start [s], shape (rows,), and potentials [V], shape (rows, places)."""
        volts = np.abs(potential_v)
        highest = np.fmax.reduce(volts, axis=None, initial=0.0)
        for touch, spells in zip(self.limits, self.places, strict=True):
            if highest <= touch.voltage_v:
                continue
            # Only what lies above is passed on: a row that is missing ends a spell.
            row, place = np.nonzero(volts > touch.voltage_v + TOLERANCE_V)
            if len(row):
                spells.add(time_s[row], place, volts[row, place], self.step_s)

    def add_trains(self, time_s: Array, train: Numbers, potential_v: Array, place: tuple[Numbers, Array]) -> None:
        """Add rows of trains, ordered by time: potential under each [V], number of its track and kilometre [km]."""
        volts = np.abs(potential_v)
        if (volts > self._lowest_v + TOLERANCE_V).any():
            for touch, spells in zip(self.limits, self.trains, strict=True):
                over = volts > touch.voltage_v + TOLERANCE_V
                spells.add(time_s[over], train[over], volts[over], (place[0][over], place[1][over]), self.step_s)

    def rows(self, places: Sequence[str], trains: Sequence[str], tracks: Sequence[str]) -> list[dict[str, Any]]:
        """Return for each limit the longest spell, its place and time, and whether it may last so long.

        Parameters
        ----------
        places, trains, tracks
            What the numbers stand for, in words.
        """
        return [self._row(n, places, trains, tracks) for n in range(len(self.limits))]

    def _row(self, n: int, places: Sequence[str], trains: Sequence[str], tracks: Sequence[str]) -> dict[str, Any]:
        touch, fixed, train = self.limits[n], self.places[n], self.trains[n]
        moving = train.spells
        longest, place, when = 0.0, "", np.nan
        if len(fixed.longest_s):
            k = int(fixed.longest_s.argmax())
            longest, place, when = float(fixed.longest_s[k]), places[k], float(fixed.longest_from_s[k])
        if len(moving.longest_s) and moving.longest_s.max() > longest:
            k = int(moving.longest_s.argmax())
            longest, when = float(moving.longest_s[k]), float(moving.longest_from_s[k])
            place = f"train {trains[k]}, from track {tracks[int(train.track[k])]}, km {train.km[k]:.2f}"
        return {
            "limit": touch.limit.name,
            "voltage_v": touch.voltage_v,
            "may_last_s": touch.may_last_s,
            "longest_s": longest,
            "place": place if longest > 0.0 else "",
            "time": format_time(when) if longest > 0.0 else "",
            "met": bool(longest <= touch.may_last_s + _TINY_S) if touch.judged else None,
            "meaning": touch.limit.meaning,
            "source": touch.limit.source,
            "status": touch.limit.status,
        }


class _MovingSpells:
    """Spells of trains above a voltage, with the place where the longest of each began; only rows above it are added."""

    def __init__(self, trains: int, voltage_v: float) -> None:
        self.spells = TrainSpells(trains, voltage_v)
        self.track, self.km = np.zeros(trains, np.int64), np.full(trains, np.nan)
        self._last_s = np.full(trains, -np.inf)
        self._present = np.zeros((trains, 3))  # start of the present spell [s], number of the track, place [km]

    def add(self, time_s: Array, train: Numbers, volts: Array, place: tuple[Numbers, Array], step_s: float) -> None:
        """Add rows: start of the step [s], train, potential [V], number of the track and place [km]; their step [s]."""
        if not len(train):
            return
        self.spells.add(time_s, train, volts, step_s)
        for k in np.unique(train).tolist():
            mine = np.flatnonzero(train == k)
            begins = np.diff(time_s[mine], prepend=self._last_s[k]) > GAP_STEPS * step_s
            starts = np.stack([time_s[mine], place[0][mine], place[1][mine]], axis=1)[begins]
            known = np.concatenate([self._present[k : k + 1], starts])
            found = np.flatnonzero(known[:, 0] == self.spells.longest_from_s[k])
            if len(found):
                self.track[k], self.km[k] = int(known[found[-1], 1]), known[found[-1], 2]
            self._present[k], self._last_s[k] = known[-1], time_s[mine[-1]]


def touch_verdicts(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the judged rows of a check as verdicts: how long a spell lasts against how long it may."""
    return [
        {
            "name": f"longest spell of the rail potential above {row['voltage_v']:g} V", "value": row["longest_s"], "unit": "s",
            "place": row["place"], "time": row["time"], "limit": row["limit"], "limit_value": row["may_last_s"],
            "source": row["source"], "status": row["status"], "sense": AT_MOST, "met": row["met"],
            "voltage_v": row["voltage_v"],
        }
        for row in rows
        if row["met"] is not None
    ]  # fmt: skip
