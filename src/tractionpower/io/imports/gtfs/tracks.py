"""Tracks of the axes: single, or double where trains keep one direction on each; routes of trains over them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.network import Leg, Network, Place
from tractionpower.io.wording import did_you_mean, shown


@dataclass(frozen=True, slots=True)
class Second:
    """The second track of a double stretch of an axis; trains with falling kilometres run on it."""

    track: str
    axis: int
    from_km: float
    to_km: float


@dataclass(slots=True)
class Tracks:
    """Tracks of a network, and the connections that trains use between them.

    Attributes
    ----------
    main
        The track of each axis that runs through.
    seconds
        Second tracks of double stretches.
    connections
        Pairs of (track, km) where trains change track.
    """

    network: Network
    main: list[str] = field(default_factory=list)
    seconds: list[Second] = field(default_factory=list)
    connections: set[tuple[tuple[str, float], tuple[str, float]]] = field(default_factory=set)

    def rows(self) -> list[dict[str, Any]]:
        """Return the tracks as rows of a line."""
        whole = [
            {"id": track, "from_km": axis.from_km, "to_km": axis.to_km}
            for track, axis in zip(self.main, self.network.axes, strict=True)
        ]
        rows = whole + [{"id": each.track, "from_km": each.from_km, "to_km": each.to_km} for each in self.seconds]
        return sorted(rows, key=lambda row: int(row["id"]))

    def at(self, place: Place) -> list[str]:
        """Return the tracks at a place."""
        seconds = [each.track for each in self.seconds if each.axis == place.axis and each.from_km <= place.km <= each.to_km]
        return [self.main[place.axis], *seconds]

    def stretches(self, axis: int) -> Iterator[tuple[float, float, list[str]]]:
        """Yield the stretches of an axis that have the same tracks: from [km], to [km], tracks."""
        whole = self.network.axes[axis]
        own = [each for each in self.seconds if each.axis == axis]
        cuts = sorted({whole.from_km, whole.to_km, *(each.from_km for each in own), *(each.to_km for each in own)})
        for low, high in pairwise(cuts):
            yield low, high, self.at(Place(axis, 0.5 * (low + high)))

    def route(self, legs: Sequence[Leg]) -> list[dict[str, Any]]:
        """Return the route of a train, and keep the connections that it needs."""
        route = [piece for leg in legs for piece in self._pieces(leg)]
        for one, other in pairwise(route):
            end, start = (one["track"], one["to_km"]), (other["track"], other["from_km"])
            if end != start:
                self.connections.add((min(end, start), max(end, start)))
        return route

    def _pieces(self, leg: Leg) -> Iterator[dict[str, Any]]:
        rises = leg.to_km > leg.from_km
        cuts = {each for row in self.seconds if row.axis == leg.axis for each in (row.from_km, row.to_km)}
        low, high = min(leg.from_km, leg.to_km), max(leg.from_km, leg.to_km)
        ends = sorted({low, high, *(km for km in cuts if low < km < high)}, reverse=not rises)
        pieces: list[dict[str, Any]] = []
        for a, b in pairwise(ends):
            tracks = self.at(Place(leg.axis, 0.5 * (a + b)))
            track = tracks[0] if rises else tracks[-1]
            if pieces and pieces[-1]["track"] == track:
                pieces[-1]["to_km"] = b
            else:
                pieces.append({"track": track, "from_km": a, "to_km": b})
        yield from pieces


def lay_tracks(network: Network, double: Sequence[str], problems: list[Problem]) -> Tracks:
    """Return the tracks of a network.

    Parameters
    ----------
    network
        Axes and stations.
    double
        Stretches with two tracks as FROM..TO by stations; or `all`; or `none`.
    problems
        Takes what is wrong with `double`.
    """
    wanted = [stretch for text in double for stretch in _stretch(network, text, problems)]
    tracks = Tracks(network)
    number = 0
    for k in range(len(network.axes)):
        number += 1
        tracks.main.append(str(number))
        for low, high in _merged(sorted((a, b) for axis, a, b in wanted if axis == k)):
            number += 1
            tracks.seconds.append(Second(str(number), k, low, high))
    return tracks


def _stretch(network: Network, text: str, problems: list[Problem]) -> Iterator[tuple[int, float, float]]:
    if text == "none":
        return
    if text == "all":
        yield from ((k, axis.from_km, axis.to_km) for k, axis in enumerate(network.axes))
        return
    ends = text.split("..")
    unknown = [name for name in ends if name not in network.stations]
    if len(ends) != 2 or unknown:
        remedy = did_you_mean(unknown[0], network.stations) if len(ends) == 2 else ""
        allowed = "all, none, or two stations as FROM..TO"
        problems.append(Problem("bad_double", "", f"double track {shown(text)}", allowed, remedy))
        return
    one, other = (network.stations[name] for name in ends)
    if one.axis != other.axis or one.km == other.km:
        remedy = "name the stretches on each side of the junction by themselves"
        problems.append(Problem("bad_double", "", f"double track {shown(text)} is not on one axis", "", remedy))
        return
    yield one.axis, min(one.km, other.km), max(one.km, other.km)


def _merged(stretches: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    merged: list[tuple[float, float]] = []
    for low, high in stretches:
        if merged and low <= merged[-1][1]:
            merged[-1] = merged[-1][0], max(merged[-1][1], high)
        else:
            merged.append((low, high))
    return merged
