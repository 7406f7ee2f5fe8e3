"""Trains that stand in each other: they do not see each other before signals exist, so this is counted and warned of."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.places import Placed
from tractionpower.model.base import format_time

Numbers = NDArray[np.int64]


@dataclass(slots=True)
class Overlap:
    """A pair of trains: steps in which they overlap, and the first of them."""

    steps: int
    time_s: float
    track: int
    km: float


class Overlaps:
    """Pairs of trains that occupy the same metre of a track in the same step.

    Parameters
    ----------
    names, lengths_km
        Trains by number, and their lengths [km].
    tracks
        Identifiers of the tracks by number.
    together
        Pairs of trains, the lower number first, that may: portions of one train.
    """

    def __init__(
        self,
        names: Sequence[str],
        lengths_km: NDArray[np.float64],
        tracks: Sequence[str],
        together: Collection[tuple[int, int]] = (),
    ) -> None:
        self._names, self._lengths_km, self._tracks, self._together = names, lengths_km, tracks, together
        self.pairs: dict[tuple[int, int], Overlap] = {}

    def add(self, time_s: NDArray[np.float64], train: Numbers, placed: Placed) -> None:
        """Look at rows of trains, those of a step together."""
        length = self._lengths_km[train]
        low = np.where(placed.sign > 0, placed.km - length, placed.km)
        order = np.lexsort((low, placed.track, time_s))
        time_s, train, low, track = time_s[order], train[order], low[order], placed.track[order]
        high = low + length[order]
        for n, m in _reaching(time_s, track, low, high):
            pair = sorted((int(train[n]), int(train[m])))
            if (pair[0], pair[1]) in self._together:
                continue
            new = Overlap(0, float(time_s[n]), int(track[n]), float(low[m]))
            self.pairs.setdefault((pair[0], pair[1]), new).steps += 1

    def summary(self) -> dict[str, Any]:
        """Return how many pairs of trains overlap, and in words which."""
        first = sorted(self.pairs.items(), key=lambda item: (item[1].time_s, item[0]))
        told = [
            f"{self._names[a]} and {self._names[b]} ({format_time(found.time_s)}, track {self._tracks[found.track]},"
            f" km {found.km:.1f}, {found.steps} steps)"
            for (a, b), found in first[:5]
        ]
        more = f" and {len(first) - 5} more pairs" if len(first) > 5 else ""
        message = f"trains do not see each other; these overlap: {'; '.join(told)}{more}" if told else ""
        return {"count": len(first), "message": message}


def _reaching(
    time_s: NDArray[np.float64], track: Numbers, low: NDArray[np.float64], high: NDArray[np.float64]
) -> list[tuple[int, int]]:
    """Return which rows reach into which others, by time; rows are sorted by time, track and lower end.

    A row that does not reach the one n places further on reaches none beyond it.
    """
    found, first, away = [], np.arange(len(low)), 1
    while len(first):
        first = first[first + away < len(low)]
        second = first + away
        same = (time_s[second] == time_s[first]) & (track[second] == track[first])
        first = first[same & (low[second] < high[first])]
        found += [(n, n + away) for n in first.tolist()]
        away += 1
    return sorted(found)
