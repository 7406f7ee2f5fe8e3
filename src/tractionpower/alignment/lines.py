"""Which tracks share a kilometre axis: the main line and its branches, each with kilometres of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from tractionpower.alignment.routes import SAME_PLACE_M
from tractionpower.model.line import Connection, Line, Track
from tractionpower.model.supply import Supply

_ROUNDING_KM = 1e-9


def tracks_by_line(line: Line, supply: Supply | None = None) -> tuple[tuple[str, ...], ...]:
    """Return the tracks of each line, whose kilometres mean the same places; lines and tracks in the order of identifiers.

    What is told counts in this order:

    1. Tracks that a station, a substation, a section cabin, a row of bonds or a return conductor names together are on
       one line: its kilometres are meant on all of them.
    2. Tracks that a connection joins at different kilometres are on different lines.
    3. Tracks that a contact line names together, or that a connection joins at the same kilometre, are on one line.
    4. Other tracks go with the first line with which they share kilometres.

    Two tracks of which 2 tells that they are on different lines stay apart, whatever 3 and 4 tell.
    """
    tracks = {track.id: track for track in sorted(line.tracks, key=lambda track: track.id, reverse=True)}
    groups = _Groups(sorted(tracks))
    for names in _named_at_places(line, supply):
        for first, second in pairwise(names):
            groups.join(first, second)
    for connection in line.connections:
        if not _at_one_km(connection):
            groups.hold_apart(connection.from_.track, connection.to.track)
    together = [row.tracks for row in supply.contact_lines if row.tracks] if supply else []
    together += [(each.from_.track, each.to.track) for each in line.connections if _at_one_km(each)]
    for names in together:
        for first, second in pairwise(names):
            groups.join(first, second)
    for name in [group[0] for group in groups.all() if len(group) == 1]:
        _find_line(tracks, groups, name)
    return tuple(groups.all())


def _named_at_places(line: Line, supply: Supply | None) -> Iterator[Sequence[str]]:
    rows: list[Sequence[str] | None] = [station.tracks for station in line.stations]
    if supply is not None:
        rows += [substation.tracks for substation in supply.substations]
        rows += [cabin.tracks for cabin in supply.section_cabins]
        rows += [bonds.tracks for bonds in supply.bonds]
        rows += [conductor.tracks for conductor in supply.return_circuit]
    return (names for names in rows if names)


def _at_one_km(connection: Connection) -> bool:
    return abs(connection.from_.km - connection.to.km) <= SAME_PLACE_M / 1000.0 + _ROUNDING_KM


def _find_line(tracks: dict[str, Track], groups: _Groups, name: str) -> None:
    """Put a track that nothing names with others to the first line before or behind it with which it shares kilometres."""
    own = tracks[name]
    for group in groups.all():
        shares = any(tracks[other].from_km < own.to_km and own.from_km < tracks[other].to_km for other in group)
        if name not in group and shares and groups.join(group[0], name):
            return


class _Groups:
    """Tracks that are joined step by step to groups, of which some stay apart from others; unknown tracks are passed over."""

    def __init__(self, names: Iterable[str]) -> None:
        self._group: dict[str, frozenset[str]] = {name: frozenset((name,)) for name in names}
        self._apart: set[frozenset[str]] = set()

    def all(self) -> list[tuple[str, ...]]:
        """Return the groups in the order of their first names."""
        return sorted(tuple(sorted(group)) for group in set(self._group.values()))

    def hold_apart(self, first: str, second: str) -> None:
        """Keep two tracks in different groups from now on, unless they are in one."""
        if first in self._group and second in self._group and second not in self._group[first]:
            self._apart.add(frozenset((first, second)))

    def join(self, first: str, second: str) -> bool:
        """Make one group of those of two tracks, unless some of them are to stay apart; tell whether they are in one."""
        if first not in self._group or second not in self._group:
            return False
        both = self._group[first] | self._group[second]
        if self._group[first] != self._group[second] and any(pair <= both for pair in self._apart):
            return False
        self._group.update(dict.fromkeys(both, both))
        return True
