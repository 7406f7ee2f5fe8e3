"""Tracks as axes: from the kilometre of the line to the metre along a track and back, through chainage breaks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.line import ChainageBreak, Line, Track

Metres = NDArray[np.float64]

_EDGE_KM = 1e-9  # a place this far beyond an end is rounding of who computed it, not another place


@dataclass(frozen=True, slots=True, eq=False)
class TrackAxis:
    """One track as pieces between chainage breaks, in each of which kilometre and metre run alike.

    Kilometres that a forward jump leaves out have no length: all of them lie at the metre of the jump. Kilometres that
    occur twice, after a backward jump, mean their first occurrence. So ``metre(km(y)) == y`` for every metre outside a
    second occurrence, and ``km(metre(x)) == x`` for every kilometre that exists except the first one after a jump, which
    is the same place as the last one before it.

    Attributes
    ----------
    track
        Identifier of the track.
    start_km, end_km
        First and last kilometre of each piece [km].
    start_m
        Metre at which each piece starts, from the `from_km` of the track [m].
    """

    track: str
    start_km: Metres
    end_km: Metres
    start_m: Metres

    @property
    def from_km(self) -> float:
        """Lowest kilometre of the track [km]."""
        return float(self.start_km[0])

    @property
    def to_km(self) -> float:
        """Highest kilometre of the track [km]."""
        return float(self.end_km[-1])

    @property
    def length_m(self) -> float:
        """Length of the track [m]."""
        return float(self.start_m[-1] + (self.end_km[-1] - self.start_km[-1]) * 1000.0)

    @overload
    def metre(self, km: float) -> float: ...
    @overload
    def metre(self, km: Metres) -> Metres: ...
    def metre(self, km: Any) -> Any:
        """Return the distance of kilometres from the start of the track [m]; of doubled ones that of the first occurrence.

        Raises
        ------
        ValueError
            If a kilometre lies before or behind the track.
        """
        place = _within(np.asarray(km, float), self.from_km, self.to_km, _EDGE_KM, f"km of track {self.track}")
        # A jump back keeps the highest kilometre so far in an earlier piece, so this finds the first occurrence.
        piece = np.searchsorted(np.maximum.accumulate(self.end_km), place)
        return _like(km, self.start_m[piece] + np.maximum(place - self.start_km[piece], 0.0) * 1000.0)

    @overload
    def km(self, metre: float) -> float: ...
    @overload
    def km(self, metre: Metres) -> Metres: ...
    def km(self, metre: Any) -> Any:
        """Return the kilometre of distances from the start of the track [km]; at a break the one before the jump.

        Raises
        ------
        ValueError
            If a distance is negative or beyond the length of the track.
        """
        place = _within(np.asarray(metre, float), 0.0, self.length_m, 1000.0 * _EDGE_KM, f"metre of track {self.track}")
        piece = np.maximum(np.searchsorted(self.start_m, place) - 1, 0)
        return _like(metre, np.minimum(self.start_km[piece] + (place - self.start_m[piece]) / 1000.0, self.end_km[piece]))

    @overload
    def contains(self, km: float) -> bool: ...
    @overload
    def contains(self, km: Metres) -> NDArray[np.bool_]: ...
    def contains(self, km: Any) -> Any:
        """Tell whether kilometres exist on the track; those that a chainage break leaves out do not."""
        place = np.asarray(km, float)[..., None]
        inside = ((place >= self.start_km - _EDGE_KM) & (place <= self.end_km + _EDGE_KM)).any(axis=-1)
        return inside if inside.ndim else bool(inside)

    def stretch_m(self, from_km: float, to_km: float) -> tuple[float, float] | None:
        """Return the part of a stretch that lies on the track as metres (from, to) [m], or None if it has no length there."""
        low, high = max(from_km, self.from_km), min(to_km, self.to_km)
        if low >= high:
            return None
        start, end = self.metre(low), self.metre(high)
        return (start, end) if start < end else None


def compile_axes(line: Line) -> dict[str, TrackAxis]:
    """Return the axis of every track of `line`, by identifier and in its order.

    Of two tracks with the same identifier the first is taken, and chainage breaks that cannot be are left out: so that
    all checks can run over a faulty line. `check_line` tells of both as errors, no run comes here with them.
    """
    tracks: dict[str, Track] = {}
    for track in line.tracks:
        tracks.setdefault(track.id, track)
    return {name: _axis(tracks[name], line.chainage_breaks) for name in sorted(tracks)}


def tracks_at(axes: Mapping[str, TrackAxis], km: float, tracks: Iterable[str] | None = None) -> tuple[str, ...]:
    """Return which of `tracks`, of all if left out, exist at a kilometre."""
    names = axes if tracks is None else dict.fromkeys(tracks)
    return tuple(name for name in names if name in axes and axes[name].contains(km))


def breaks_of(track: Track, breaks: Sequence[ChainageBreak]) -> list[tuple[int, ChainageBreak]]:
    """Return the breaks that concern a track with their index, in the order of `at_km`.

    A break without `tracks` concerns the tracks that it lies inside of.
    """
    mine = [
        (index, item)
        for index, item in enumerate(breaks)
        if (track.from_km < item.at_km < track.to_km if item.tracks is None else track.id in item.tracks)
    ]
    return sorted(mine, key=lambda pair: (pair[1].at_km, pair[1].continues_as_km))


def follow_breaks(
    track: Track, breaks: Sequence[ChainageBreak]
) -> tuple[list[tuple[float, float]], list[tuple[int, str, float, float]]]:
    """Return the pieces (from km, to km) of a track between its breaks, and the breaks that cannot be.

    A fault is (index of the break, its field, the kilometres between which it may lie). A break must lie behind the
    one before, inside the track; a jump back must not pass the place where the piece before it starts, or kilometres
    would no longer rise with the metres of their first occurrence.
    """
    pieces: list[tuple[float, float]] = []
    faults: list[tuple[int, str, float, float]] = []
    start = behind = track.from_km
    for index, item in breaks_of(track, breaks):
        if not behind < item.at_km < track.to_km:
            faults.append((index, "at_km", behind, track.to_km))
        elif not start <= item.continues_as_km < track.to_km:
            faults.append((index, "continues_as_km", start, track.to_km))
        else:
            pieces.append((start, item.at_km))
            start = item.continues_as_km
            behind = max(start, item.at_km)
    return [*pieces, (start, track.to_km)], faults


def _axis(track: Track, breaks: Sequence[ChainageBreak]) -> TrackAxis:
    pieces = np.array(follow_breaks(track, breaks)[0])
    start_km, end_km = pieces[:, 0].copy(), pieces[:, 1].copy()
    start_m = np.concatenate(([0.0], np.cumsum((end_km - start_km) * 1000.0)[:-1]))
    for array in (start_km, end_km, start_m):
        array.flags.writeable = False
    return TrackAxis(track.id, start_km, end_km, start_m)


def _within(values: Metres, low: float, high: float, edge: float, what: str) -> Metres:
    outside = ~((values >= low - edge) & (values <= high + edge))
    if outside.any():
        raise ValueError(f"{float(values[outside].flat[0]):g} is no {what}, which runs from {low:g} to {high:g}")
    return np.asarray(np.clip(values, low, high))


def _like(given: Any, result: Metres) -> Any:
    return result if np.ndim(given) else float(result)
