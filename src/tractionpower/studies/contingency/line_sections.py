"""Contact lines between the places where they can be switched off, and what switches them off."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tractionpower.model.scenario import Scenario
from tractionpower.supply.bundles import SHARED_KM
from tractionpower.supply.merging import Merger
from tractionpower.supply.topology import Topology
from tractionpower.supply.wiring import build_topology

Piece = tuple[str, float, float]
"""Track, from and to [km]."""


@dataclass(frozen=True, slots=True)
class LineSection:
    """Contact line that is dead when what is switched at its ends is open.

    Attributes
    ----------
    name
        ``track 1 km 0-10.8``; several pieces by commas, where a connection joins tracks.
    ends
        Feeders and switches that are joined with it, and section points at its ends, by identifier.
    closed
        Those of them that are closed in the normal state.
    """

    name: str
    ends: tuple[str, ...]
    closed: frozenset[str]


def find_line_sections(scenario: Scenario) -> tuple[LineSection, ...]:
    """Return the sections of contact lines by track and kilometre; a station that is bypassed ends none.

    They are what hangs together when all section points are open and no feeder or switch joins anything, so junctions and
    connections between lines need no rule of their own.
    """
    supply = scenario.supply
    closed_points = {point.id for point in supply.section_points if point.state == "closed"}
    cut = supply.model_copy(
        update={"section_points": tuple(point.model_copy(update={"state": "open"}) for point in supply.section_points)}
    )
    topology = build_topology(cut, scenario.line, scenario.conductors)
    wires = [(wire.left, wire.right) for span in topology.spans for wire in span.conductors[:-1]]
    merged = Merger(len(topology.nodes), [*topology.joins, *wires])
    pieces = _pieces(topology, merged)
    links: dict[int, dict[str, bool]] = {}
    for link in topology.links:
        for root in {merged.find(link.first), merged.find(link.second)} & pieces.keys():
            links.setdefault(root, {})[link.id] = link.closed
    found = []
    for root, mine in sorted(pieces.items(), key=lambda item: item[1]):
        joined = links.get(root, {})
        points = {point.id for point in supply.section_points if any(_ends_at(piece, point.track, point.km) for piece in mine)}
        closed = frozenset({name for name, is_closed in joined.items() if is_closed} | (points & closed_points))
        name = ", ".join(f"track {track} km {from_km:g}-{to_km:g}" for track, from_km, to_km in mine)
        found.append(LineSection(name, (*sorted(joined), *sorted(points)), closed))
    return tuple(found)


def _pieces(topology: Topology, merged: Merger) -> dict[int, list[Piece]]:
    """Return the contact lines that hang together, by the node that stands for them, each by track and kilometre."""
    spans: dict[int, list[Piece]] = {}
    for span in topology.spans:
        for track, wire in zip(span.tracks, span.conductors, strict=False):  # the last one is the rails
            spans.setdefault(merged.find(wire.left), []).append((track, span.from_km, span.to_km))
    return {root: list(_joined(sorted(mine))) for root, mine in spans.items()}


def _joined(pieces: list[Piece]) -> Iterator[Piece]:
    last = pieces[0]
    for piece in pieces[1:]:
        if piece[0] == last[0] and piece[1] - last[2] < SHARED_KM:
            last = (last[0], last[1], piece[2])
            continue
        yield last
        last = piece
    yield last


def _ends_at(piece: Piece, track: str, km: float) -> bool:
    return piece[0] == track and min(abs(piece[1] - km), abs(piece[2] - km)) < SHARED_KM
