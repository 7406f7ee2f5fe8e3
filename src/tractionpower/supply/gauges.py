"""Where the currents of contact lines and rails are recorded: at both ends of every section between two fixed places.

A section of contact line reaches from one feeder, section point or end of its row to the next, one of rails from substation to
substation. What trains take in between flows in from its ends, so the greatest current of a section that feeds trains is at
one of them; only between a train that brakes and one beside it may more flow, for as long as they pass.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import GAUGE
from tractionpower.model.supply import Supply
from tractionpower.supply.bundles import SHARED_KM
from tractionpower.supply.topology import Topology

Piece = tuple[float, float, int, int]
"""A conductor of a span: from and to [km], number of the span, number of the conductor in it."""


@dataclass(frozen=True, slots=True)
class Section:
    """A section of contact line of one track, or of rails, between two fixed places.

    Attributes
    ----------
    kind
        contact_line or rails.
    tracks
        The track, or all tracks of the rails, by blanks.
    from_km, to_km
        Its ends.
    first, last
        Its first and its last conductor: number of the span, number in the span.
    """

    kind: str
    tracks: str
    from_km: float
    to_km: float
    first: tuple[int, int]
    last: tuple[int, int]


def find_sections(topology: Topology, supply: Supply) -> tuple[Section, ...]:
    """Return the sections of contact lines, then those of rails, each by track and kilometre."""
    pieces: dict[tuple[str, str], list[Piece]] = {}
    for number, span in enumerate(topology.spans):
        for which, track in enumerate(span.tracks):
            pieces.setdefault(("contact_line", track), []).append((span.from_km, span.to_km, number, which))
        rails = "rails", " ".join(span.rail_tracks)
        pieces.setdefault(rails, []).append((span.from_km, span.to_km, number, len(span.tracks)))
    ends = {"contact_line": _contact_ends, "rails": _rail_ends}
    return tuple(
        section
        for kind, tracks in sorted(pieces)
        for section in _cut(kind, tracks, pieces[kind, tracks], ends[kind](topology, supply, tracks))
    )


def gauge_table(sections: Sequence[Section], first_conductor: Sequence[int]) -> NDArray[np.void]:
    """Return the ends of sections as the solver knows them, two for each: its low and its high end; record array of `GAUGE`."""
    rows = []
    for section in sections:
        ends = ((section.first, False), (section.last, True))
        rows += [(first_conductor[span] + which, right) for (span, which), right in ends]
    return np.array(rows, GAUGE)


def _contact_ends(topology: Topology, supply: Supply, track: str) -> Iterator[float]:
    yield from (link.km for link in topology.links if link.kind in ("feeder", "cabin") and link.track == track)
    yield from (point.km for point in supply.section_points if point.track == track)
    for row in supply.contact_lines:
        if row.tracks is None or track in row.tracks:
            yield from (row.from_km, row.to_km)


def _rail_ends(topology: Topology, supply: Supply, tracks: str) -> Iterator[float]:
    own = set(tracks.split(" "))
    yield from (station.km for station in supply.substations if station.tracks is None or own.intersection(station.tracks))
    yield from (link.km for link in topology.links if link.kind == "return" and link.track in own)
    for row in supply.return_circuit:
        if row.tracks is None or own.intersection(row.tracks):
            yield from (row.from_km, row.to_km)


def _cut(kind: str, tracks: str, pieces: Iterable[Piece], ends: Iterable[float]) -> Iterator[Section]:
    """Yield the runs of pieces that follow each other without one of the `ends` [km] between them."""
    cuts = np.array(sorted(ends))
    run: list[Piece] = []
    for piece in sorted(pieces):
        is_cut = len(cuts) and np.abs(cuts - piece[0]).min() < 1.5 * SHARED_KM
        if run and (is_cut or piece[0] - run[-1][1] > 1.5 * SHARED_KM):
            yield Section(kind, tracks, run[0][0], run[-1][1], run[0][2:], run[-1][2:])
            run = []
        run.append(piece)
    if run:
        yield Section(kind, tracks, run[0][0], run[-1][1], run[0][2:], run[-1][2:])
