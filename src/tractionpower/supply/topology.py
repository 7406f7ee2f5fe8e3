"""From the declared supply to a graph: which conductors meet in which node, and what links them.

Bundles of tracks (`supply.bundles`) give spans with their conductors; devices (`supply.wiring`) join their ends, plainly
or by links that can be open. A closed link without resistance makes two nodes one.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import TrackAxis, compile_axes
from tractionpower.model.conductors import Conductor as ConductorRow
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.bundles import HIGH, LOW, SHARED_KM, Bundle, Rails, find_bundles
from tractionpower.supply.merging import Merger, Nodes

SHORT_OHM = 1e-6
"""A smaller resistance is none: its ends are one node [ohm]."""

EARTH = "earth"
"""Name of the node that is remote earth."""


@dataclass(frozen=True, slots=True)
class Conductor:
    """A contact line or a return conductor within one span."""

    ohm_per_m: float
    siemens_per_m: float  # leakage to remote earth
    left: int
    right: int


@dataclass(frozen=True, slots=True)
class Span:
    """Conductors side by side between two neighbouring cuts: contact lines, then one return conductor."""

    from_km: float
    to_km: float
    length_m: float
    conductors: tuple[Conductor, ...]
    tracks: tuple[str, ...]  # of the contact lines
    rail_tracks: tuple[str, ...]  # of the return conductor

    @property
    def rail(self) -> Conductor:
        """The return conductor."""
        return self.conductors[-1]

    def contact(self, track: str) -> int:
        """Return the number of the contact line of `track` within the span."""
        return self.tracks.index(track)


@dataclass(frozen=True, slots=True)
class Link:
    """A connection with a breaker or switch, whose current is recorded; counted from `first` to `second`.

    `kind` is feeder (of a substation), cabin (feeder of a section cabin), return (return feeder of one track) or switch.
    """

    kind: str
    id: str
    station: str
    track: str
    side: str
    km: float
    first: int
    second: int
    ohm: float
    closed: bool

    @property
    def merges(self) -> bool:
        """Whether the link makes its ends one node."""
        return self.closed and self.ohm < SHORT_OHM


@dataclass(frozen=True, slots=True)
class EarthLink:
    """A connection of a node with remote earth: an earthing or a voltage-limiting device."""

    id: str
    node: int
    ohm: float
    closed: bool


@dataclass(frozen=True, slots=True)
class Busbar:
    """The busbars of a substation that stands in the network."""

    positive: int
    negative: int


@dataclass(frozen=True, slots=True)
class Section:
    """A place of a contact line whose voltage is recorded."""

    track: str
    km: float
    contact: int
    rail: int


@dataclass
class Topology:
    """The supply as a graph; nodes are numbers, of which `find` tells those that are one."""

    axes: dict[str, TrackAxis]
    bundles: list[Bundle]
    nodes: Nodes = field(default_factory=Nodes)
    joins: list[tuple[int, int]] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    bonds: list[tuple[int, int, float]] = field(default_factory=list)  # first, second, resistance [ohm]
    earth_links: list[EarthLink] = field(default_factory=list)
    busbars: dict[str, Busbar] = field(default_factory=dict)
    returns: list[tuple[int, int, float]] = field(default_factory=list)  # common return feeders
    sections: list[Section] = field(default_factory=list)

    @cached_property
    def plain(self) -> Merger:
        """Nodes that are one whatever is switched."""
        return Merger(len(self.nodes), self.joins)

    @cached_property
    def merged(self) -> Merger:
        """Nodes that are one with all closed links of no resistance."""
        return Merger(len(self.nodes), [*self.joins, *((link.first, link.second) for link in self.links if link.merges)])

    def find(self, node: int) -> int:
        """Return the node that stands for `node`."""
        return self.merged.find(node)

    @property
    def earth(self) -> int | None:
        """Remote earth, or None where nothing is joined with it."""
        return self.nodes.get(EARTH)

    def edges(self) -> Iterator[tuple[int, int, float]]:
        """Yield the fixed resistances between nodes [ohm]: links first, in their order, of which each has one or none."""
        for link in self.links:
            if link.closed and not link.merges:
                yield link.first, link.second, link.ohm
        yield from self.returns
        yield from self.bonds
        earth = self.earth
        for item in self.earth_links:
            if item.closed:
                assert earth is not None
                yield item.node, earth, item.ohm

    def distance_m(self, track: str, from_km: float, to_km: float) -> float:
        """Return the way along `track` from one kilometre to another [m]; its ends may be missed by a shared node."""
        first, last = self.metres(track, [from_km, to_km])
        return float(last - first)

    def metres(self, track: str, kms: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distances of kilometres from the start of `track` [m]; those beyond its ends count as its ends."""
        axis = self.axes[track]
        places: NDArray[np.float64] = np.clip(np.asarray(kms, float), axis.from_km, axis.to_km)
        return axis.metre(places)

    @cached_property
    def _spans_of(self) -> dict[str, tuple[list[float], list[int]]]:
        found: dict[str, tuple[list[float], list[int]]] = {}
        for number, span in enumerate(self.spans):
            for track in span.tracks:
                starts, numbers = found.setdefault(track, ([], []))
                starts.append(span.from_km)
                numbers.append(number)
        return found

    def locate(self, track: str, km: float) -> tuple[int, float]:
        """Return the span that carries `track` at `km`, and the distance from its left end [m].

        Raises
        ------
        LookupError
            If no contact line is there; `supply.checks` reports that before.
        """
        starts, numbers = self._spans_of.get(track, ([], []))
        at = bisect_right(starts, km) - 1
        for beyond in (0.0, SHARED_KM):  # at a cut the low side counts, if there is a contact line
            for k in (at - 1, at, at + 1):
                if 0 <= k < len(numbers):
                    span = self.spans[numbers[k]]
                    if span.from_km - beyond <= km <= span.to_km + beyond:
                        return numbers[k], min(max(self.distance_m(track, span.from_km, km), 0.0), span.length_m)
        raise LookupError(f"no contact line on track {track} at km {km}")


def lay_spans(supply: Supply, line: Line, conductors: Sequence[ConductorRow], cuts: Sequence[tuple[str, float]]) -> Topology:
    """Return the conductors of a supply as spans, with rails joined along each track but contact lines not yet.

    Parameters
    ----------
    supply, line, conductors
        What is declared.
    cuts
        Places (track, kilometre) of devices.
    """
    axes = compile_axes(line)
    topology = Topology(axes, find_bundles(supply, line, axes, conductors))
    for bundle in topology.bundles:
        bundle.cut_at(km for track, km in cuts if track in bundle.tracks)
        length = _piece_lengths(topology, bundle)
        for piece in range(len(bundle.contacts)):
            for rails in bundle.rails[piece]:
                _add_span(topology, bundle, piece, rails, length[rails.tracks[0]][piece])
        for cut in range(len(bundle.cuts)):
            for track in bundle.tracks:
                nodes = [topology.nodes("rail", rails.number, bundle.tracks, cut) for rails in bundle.rails_at(track, cut)]
                topology.joins += [(nodes[0], node) for node in nodes[1:] if node != nodes[0]]
    return topology


def _piece_lengths(topology: Topology, bundle: Bundle) -> dict[str, list[float]]:
    """Return the lengths of the pieces between the cuts along each track of a bundle [m]."""
    return {track: np.diff(topology.metres(track, bundle.cuts)).tolist() for track in bundle.tracks}


def _add_span(topology: Topology, bundle: Bundle, piece: int, rails: Rails, length: float) -> None:
    nodes, contacts = topology.nodes, bundle.contacts[piece]
    tracks = tuple(track for track in rails.tracks if track in contacts)
    conductors = [Conductor(contacts[track], 0.0, nodes(HIGH, track, piece), nodes(LOW, track, piece + 1)) for track in tracks]
    left, right = (nodes("rail", rails.number, bundle.tracks, cut) for cut in (piece, piece + 1))
    short = rails.ohm_per_m * length < SHORT_OHM
    if short:
        topology.joins.append((left, right))
    if rails.siemens_per_m > 0.0:
        nodes(EARTH)
    conductors.append(Conductor(0.0 if short else rails.ohm_per_m, rails.siemens_per_m, left, right))
    topology.spans.append(Span(*bundle.pieces[piece], length, tuple(conductors), tracks, rails.tracks))
