"""What hangs together over the rails: pieces of return conductors, and what joins them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tractionpower.alignment.intervals import TOLERANCE_M
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.earthing import Bonds
from tractionpower.supply.site import Place, Site


@dataclass(frozen=True, slots=True)
class RailPiece:
    """The part of a row of the return circuit that lies on one track [m]; equal `number`: one conductor."""

    number: int
    row: int
    track: str
    start_m: float
    end_m: float


class ReturnGraph:
    """The rails of a supply with bonds, return feeders and connections of the line.

    Attributes
    ----------
    pieces
        The rails of every track, by start.
    part
        Number of the connected part of each conductor (`RailPiece.number`).
    """

    def __init__(self, site: Site) -> None:
        self.site = site
        self.pieces = _pieces(site)
        count = 1 + max((piece.number for pieces in self.pieces.values() for piece in pieces), default=-1)
        self._parent = list(range(count))
        self._stations: dict[str, int] = {}
        self._join_along_tracks()
        for station in site.supply.substations:
            rows = [row for row in site.supply.feeders if row.at == station.id and row.side == "return" and row.km is not None]
            moved = {row.track: place for row in rows if row.km is not None and (place := site.place(row.track, row.km))}
            self._join_station(station.id, [*{**site.fed[station.id], **moved}.values()])
        for item in site.line.connections:
            self._join([self.at(site.place(end.track, end.km)) for end in (item.from_, item.to)])
        for bonds in site.supply.bonds:
            for group in self.bonded(bonds):
                self._join([*group])
        self.part = [self._find(number) for number in range(count)]

    def at(self, place: Place | None) -> int | None:
        """Return the conductor that the rails of a track belong to at a place; None where there are no rails."""
        pieces = self.pieces[place[0]] if place is not None else []
        return next((p.number for p in pieces if place and p.start_m - TOLERANCE_M <= place[1] <= p.end_m + TOLERANCE_M), None)

    def part_at(self, place: Place | None) -> int | None:
        """Return the connected part that the rails of a track belong to at a place."""
        number = self.at(place)
        return None if number is None else self.part[number]

    def part_of_station(self, station: str) -> int | None:
        """Return the connected part that the negative busbar of a substation belongs to."""
        number = self._stations.get(station)
        return None if number is None else self.part[number]

    def bonded(self, bonds: Bonds) -> set[tuple[int, ...]]:
        """Return the conductors that bonds of one row join, at each place those of all tracks that exist there."""
        count = int((bonds.to_km - bonds.from_km + 1e-9) / bonds.every_km) + 1
        kms = (bonds.from_km + bonds.every_km * np.arange(count)).astype(np.float64)
        columns = []
        for track in self.pieces if bonds.tracks is None else dict.fromkeys(bonds.tracks):
            if track in self.pieces:
                axis, numbers = self.site.axes[track], np.full(count, -1)
                exists = np.flatnonzero(axis.contains(kms))
                metres = axis.metre(kms[exists])
                for piece in self.pieces[track]:
                    numbers[exists[(metres >= piece.start_m - TOLERANCE_M) & (metres <= piece.end_m + TOLERANCE_M)]] = (
                        piece.number
                    )
                columns.append(numbers)
        rows = np.unique(np.array(columns).T, axis=0).tolist() if columns else []
        return {tuple(number for number in row if number >= 0) for row in rows}

    # -- joining --------------------------------------------------------------------------------------------------

    def _find(self, number: int) -> int:
        while number != self._parent[number]:
            number = self._parent[number]
        return number

    def _join(self, numbers: list[int | None]) -> None:
        roots = sorted({self._find(number) for number in numbers if number is not None})
        for root in roots[1:]:
            self._parent[root] = roots[0]

    def _join_along_tracks(self) -> None:
        for pieces in self.pieces.values():
            for before, piece in pairwise(pieces):
                if piece.start_m - before.end_m < SHARED_NODE_M:
                    self._join([before.number, piece.number])

    def _join_station(self, station: str, places: list[Place]) -> None:
        """Join the rails at a substation, in whatever state it is, but for open return feeders."""
        rows = self.site.supply.feeders
        is_open = {row.track for row in rows if row.at == station and row.side == "return" and row.state == "open"}
        found = [number for place in places if place[0] not in is_open and (number := self.at(place)) is not None]
        if found:
            self._join([*found])
            self._stations[station] = found[0]


def _pieces(site: Site) -> dict[str, list[RailPiece]]:
    """Return the rails of each track; parts of one row that lie side by side are one conductor."""
    found: dict[str, list[RailPiece]] = {track: [] for track in site.axes}
    number = -1
    for row, parts in sorted(_by_row(site).items()):
        reach = float("-inf")
        for from_km, to_km, track, start_m, end_m in sorted(parts):
            if from_km > reach + SHARED_NODE_M / 1000.0:  # the tracks of a row may lie far from each other
                number += 1
                reach = to_km
            reach = max(reach, to_km)
            found[track].append(RailPiece(number, row, track, start_m, end_m))
    return {track: sorted(pieces, key=lambda piece: piece.start_m) for track, pieces in found.items()}


def _by_row(site: Site) -> dict[int, list[tuple[float, float, str, float, float]]]:
    rows: dict[int, list[tuple[float, float, str, float, float]]] = {}
    for track, part in _parts(site):
        axis = site.axes[track]
        rows.setdefault(part[0], []).append((axis.km(part[1]), axis.km(part[2]), track, part[1], part[2]))
    return rows


def _parts(site: Site) -> Iterator[tuple[str, tuple[int, float, float]]]:
    for track, parts in site.returns.items():
        for part in parts:
            yield track, (part.row, part.start_m, part.end_m)
