"""The way of a train over the tracks of a line from station to station, where a timetable does not tell it."""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

from tractionpower.model.line import Line, Station, Track

WRONG_TRACK = 3.0
"""A kilometre on the track of the other direction counts as many."""

CHANGE_KM = 0.5
"""What a change of the track counts [km]."""

SAME_LINE_KM = 0.5
"""Ends of a connection whose kilometres differ by no more are on parallel tracks: a train goes on in its direction."""

_SLACK_KM = 1e-9


@dataclass(frozen=True, slots=True)
class _Step:
    # Where a train is: track, direction, kilometre, and how many stations it has behind it; legs up to there.
    track: str
    sign: int
    km: float
    behind: int
    legs: tuple[tuple[str, float, float], ...]


def usual_tracks(line: Line) -> tuple[str, str] | None:
    """Return the tracks of rising and falling kilometres: the first two tracks side by side; None if there are none."""
    for index, first in enumerate(line.tracks):
        for second in line.tracks[index + 1 :]:
            if first.from_km < second.to_km and second.from_km < first.to_km and not _joined_apart(line, first, second):
                return first.id, second.id
    return None


def _joined_apart(line: Line, first: Track, second: Track) -> bool:
    ends = ((each.from_, each.to) for each in line.connections)
    return any({a.track, b.track} == {first.id, second.id} and abs(a.km - b.km) > SAME_LINE_KM for a, b in ends)


class Ways:
    """Finds the shortest way through stations, on the tracks of their directions where there are two.

    Parameters
    ----------
    line
        The line.
    usual
        Tracks of trains with rising and with falling kilometres; None: any.
    """

    def __init__(self, line: Line, usual: tuple[str, str] | None) -> None:
        self._tracks = {track.id: track for track in line.tracks}
        self._usual = usual
        ends = [(each.from_, each.to) for each in line.connections]
        self._joints = [*ends, *((b, a) for a, b in ends)]
        self._known: dict[Any, list[dict[str, Any]] | int] = {}

    def find(self, stations: Sequence[Station], tracks: Sequence[str]) -> list[dict[str, Any]] | int:
        """Return the legs of a route from the first station to the last, or the index of the first that is out of reach.

        Parameters
        ----------
        stations
            Stations in the order of the run.
        tracks
            Track that the train comes on, where the timetable says it; else an empty text.
        """
        key = (tuple(station.id for station in stations), tuple(tracks))
        if key not in self._known:
            self._known[key] = self._search(stations, tracks)
        return self._known[key]

    def _search(self, stations: Sequence[Station], tracks: Sequence[str]) -> list[dict[str, Any]] | int:
        number = count()
        heap: list[tuple[float, int, _Step]] = []
        for track in self._tracks:
            for sign in (1, -1):
                km = self._stop_km(stations[0], track, sign, tracks[0])
                if km is not None:
                    heapq.heappush(heap, (0.0, next(number), _Step(track, sign, km, 1, ((track, km, km),))))
        farthest, done = 0, set()
        while heap:
            cost, _, step = heapq.heappop(heap)
            farthest = max(farthest, step.behind)
            if step.behind == len(stations):
                return [{"track": t, "from_km": a, "to_km": b} for t, a, b in step.legs if abs(a - b) > _SLACK_KM]
            state = (step.track, step.sign, round(step.km, 6), step.behind)
            if state in done:
                continue
            done.add(state)
            for more, after in self._moves(step, stations, tracks):
                heapq.heappush(heap, (cost + more, next(number), after))
        return farthest

    def _moves(self, step: _Step, stations: Sequence[Station], tracks: Sequence[str]) -> Iterator[tuple[float, _Step]]:
        """Yield what a step leads to: the next station on its track, or another track at a connection; and its cost."""
        (track, begin, _), before = step.legs[-1], step.legs[:-1]
        km = self._stop_km(stations[step.behind], step.track, step.sign, tracks[step.behind])
        if km is not None and step.sign * (km - step.km) > _SLACK_KM:
            legs = (*before, (track, begin, km))
            yield self._cost(step, km), _Step(track, step.sign, km, step.behind + 1, legs)
        for here, there in self._joints:
            if here.track != step.track or step.sign * (here.km - step.km) < -_SLACK_KM:
                continue
            parallel = abs(here.km - there.km) <= SAME_LINE_KM
            for sign in (step.sign,) if parallel else (1, -1):
                legs = (*before, (track, begin, here.km), (there.track, there.km, there.km))
                yield self._cost(step, here.km) + CHANGE_KM, _Step(there.track, sign, there.km, step.behind, legs)

    def _cost(self, step: _Step, km: float) -> float:
        wrong = self._usual is not None and step.track == self._usual[1 if step.sign > 0 else 0] and len(set(self._usual)) > 1
        return abs(km - step.km) * (WRONG_TRACK if wrong else 1.0)

    def _stop_km(self, station: Station, track: str, sign: int, wanted: str) -> float | None:
        """Return where a train stops at a station on a track [km], or None if it is not there."""
        if (wanted and wanted != track) or (station.tracks is not None and track not in station.tracks):
            return None
        stops = station.stop_km or {}
        direction = "increasing" if sign > 0 else "decreasing"
        km = stops.get(f"{track} {direction}", stops.get(track, station.km))
        own = self._tracks[track]
        return km if own.from_km <= km <= own.to_km else None
