"""Stretches on tracks: which rows lie where, where two rows overlap, and what they leave open.

All lengths are metres along a track, so that chainage breaks need no care; messages get kilometres back.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

from tractionpower.alignment.axis import TrackAxis

Interval = tuple[float, float]
"""Start and end [m]."""

TOLERANCE_M = 1e-3
"""Gaps and overlaps up to this length [m] are rounding."""


class Row(Protocol):
    """A row of a list that holds on a stretch of some tracks."""

    @property
    def from_km(self) -> float:
        """Start of the stretch [km]."""

    @property
    def to_km(self) -> float:
        """End of the stretch [km]."""

    @property
    def tracks(self) -> tuple[str, ...] | None:
        """Tracks it holds for; None: all that exist there."""


class Placed(NamedTuple):
    """The part of a row that lies on one track [m]."""

    row: int
    start_m: float
    end_m: float


class Patch(NamedTuple):
    """A stretch [km] that is the same on one or more tracks, and the rows that it is about."""

    tracks: tuple[str, ...]
    from_km: float
    to_km: float
    rows: tuple[int, ...] = ()

    def __str__(self) -> str:
        return f"{name_tracks(self.tracks)} from km {name_km(self.from_km)} to km {name_km(self.to_km)}"


Coverage = Mapping[str, Sequence[Placed]]
"""What lies on each track, by its start."""


def name_km(km: float) -> str:
    """Return a kilometre as text, to the millimetre.

    >>> name_km(12.340000000001)
    '12.34'
    """
    return f"{round(km, 6):.10g}"


def name_tracks(tracks: Sequence[str]) -> str:
    """Return tracks as text.

    >>> name_tracks(("1", "2"))
    'tracks 1, 2'
    """
    return f"track{'s' * (len(tracks) > 1)} {', '.join(tracks)}"


def place_rows(rows: Iterable[tuple[int, Row]], axes: Mapping[str, TrackAxis]) -> dict[str, list[Placed]]:
    """Return for every track the parts of the numbered `rows` that lie on it, by start; unknown tracks are passed over."""
    placed: dict[str, list[Placed]] = {track: [] for track in axes}
    for index, row in rows:
        for track in axes if row.tracks is None else dict.fromkeys(row.tracks):
            stretch = axes[track].stretch_m(row.from_km, row.to_km) if track in axes else None
            if stretch:
                placed[track].append(Placed(index, *stretch))
    for parts in placed.values():
        parts.sort(key=lambda part: (part.start_m, part.end_m))
    return placed


def merge(intervals: Iterable[Interval]) -> list[Interval]:
    """Return the union of `intervals` as intervals that are apart.

    >>> merge([(5.0, 7.0), (0.0, 2.0), (2.0, 3.0)])
    [(0.0, 3.0), (5.0, 7.0)]
    """
    union: list[Interval] = []
    for start, end in sorted(intervals):
        if union and start <= union[-1][1] + TOLERANCE_M:
            union[-1] = (union[-1][0], max(union[-1][1], end))
        else:
            union.append((start, end))
    return union


def subtract(within: Iterable[Interval], taken: Iterable[Interval]) -> list[Interval]:
    """Return what is left of `within` when `taken` is taken away.

    >>> subtract([(0.0, 10.0)], [(2.0, 3.0), (8.0, 12.0)])
    [(0.0, 2.0), (3.0, 8.0)]
    """
    union = [(float("-inf"), float("-inf")), *merge(taken), (float("inf"), float("inf"))]
    holes = [(before[1], after[0]) for before, after in pairwise(union)]
    left = [(max(start, low), min(end, high)) for start, end in merge(within) for low, high in holes]
    return [(start, end) for start, end in left if end - start > TOLERANCE_M]


def cut(within: Iterable[Interval], places: Iterable[float]) -> list[Interval]:
    """Return `within` cut at `places` [m].

    >>> cut([(0.0, 10.0)], [4.0])
    [(0.0, 4.0), (4.0, 10.0)]
    """
    marks = sorted(set(places))
    pieces: list[Interval] = []
    for start, end in within:
        ends = [start, *(mark for mark in marks if start + TOLERANCE_M < mark < end - TOLERANCE_M), end]
        pieces.extend(pairwise(ends))
    return pieces


def find_overlaps(coverage: Coverage, axes: Mapping[str, TrackAxis]) -> list[Patch]:
    """Return where two rows lie on the same track; `rows` of a patch are the two, lower index first."""
    found = []
    for track, parts in coverage.items():
        farthest: Placed | None = None
        for part in parts:
            if farthest and farthest.end_m - part.start_m > TOLERANCE_M:
                end = min(farthest.end_m, part.end_m)
                rows = (min(farthest.row, part.row), max(farthest.row, part.row))
                found.append(patch(axes[track], (part.start_m, end), rows))
            if farthest is None or part.end_m > farthest.end_m:
                farthest = part
    return group(found)


def find_gaps(coverage: Coverage, axes: Mapping[str, TrackAxis]) -> list[Patch]:
    """Return what the rows leave open of the tracks in `coverage`, between the ends of each track."""
    found = []
    for track, parts in coverage.items():
        axis = axes[track]
        for gap in subtract([(0.0, axis.length_m)], [(part.start_m, part.end_m) for part in parts]):
            found.append(patch(axis, gap))
    return group(found)


def patch(axis: TrackAxis, interval: Interval, rows: tuple[int, ...] = ()) -> Patch:
    """Return an interval [m] of one track as a patch."""
    # Rounded to the millimetre, so that tracks which start at different kilometres give the same stretch.
    return Patch((axis.track,), round(axis.km(interval[0]), 6), round(axis.km(interval[1]), 6), rows)


def group(patches: Iterable[Patch]) -> list[Patch]:
    """Return `patches` with those that differ in their track only as one, by place."""
    tracks: dict[tuple[float, float, tuple[int, ...]], list[str]] = {}
    for item in patches:
        tracks.setdefault((item.from_km, item.to_km, item.rows), []).extend(item.tracks)
    return [Patch(tuple(names), key[0], key[1], key[2]) for key, names in sorted(tracks.items())]
