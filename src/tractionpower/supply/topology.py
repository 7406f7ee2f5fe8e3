"""From the declared supply to a graph: which conductors meet in which node.

Tracks that share a return conductor form a *bundle*. A bundle is cut wherever something happens on one of its tracks:
a substation, a section cabin, a section point, an end or a change of a conductor. Between two neighbouring cuts lie
spans; at a cut every contact line has a low and a high side, which are one node unless something separates them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass, field

from tractionpower.alignment.axis import TrackAxis, compile_axes
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.line import Line
from tractionpower.model.supply import ReturnCircuit, SectionCabin, SectionPoint, Substation, Supply

Node = Hashable
SHORT_OHM = 1e-6
"""A smaller resistance is none: its ends are one node [ohm]."""

_SHARED_KM = SHARED_NODE_M / 1000.0


class Merger:
    """Nodes that may turn out to be one (union-find)."""

    def __init__(self) -> None:
        self._parent: dict[Node, Node] = {}

    def find(self, node: Node) -> Node:
        """Return the node that stands for `node`."""
        parent = self._parent.setdefault(node, node)
        while parent != self._parent[parent]:
            self._parent[parent] = self._parent[self._parent[parent]]
            parent = self._parent[parent]
        self._parent[node] = parent
        return parent

    def join(self, first: Node, second: Node) -> None:
        """Make two nodes one."""
        a, b = self.find(first), self.find(second)
        if a != b:
            self._parent[max(a, b, key=repr)] = min(a, b, key=repr)


@dataclass(frozen=True, slots=True)
class Conductor:
    """A contact line or a return conductor within one span."""

    name: tuple[str, str]  # ("contact", track) or ("rail", number of the row)
    ohm_per_m: float
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Span:
    """Conductors side by side between two neighbouring cuts."""

    from_km: float
    to_km: float
    length_m: float
    conductors: tuple[Conductor, ...]
    returns: dict[str, int]  # track -> number of its return conductor within the span

    def contact(self, track: str) -> int:
        """Return the number of the contact line of `track` within the span."""
        return next(k for k, conductor in enumerate(self.conductors) if conductor.name == ("contact", track))


@dataclass(frozen=True, slots=True)
class Feeder:
    """A feeder of a substation: to one track, to the side of lower or higher kilometres."""

    substation: str
    track: str
    side: str  # "low_km" or "high_km"
    km: float


@dataclass(frozen=True, slots=True)
class Busbar:
    """The busbars of a substation that stands in the network."""

    positive: Node
    negative: Node


@dataclass
class Topology:
    """The supply as a graph. `nodes` knows which of them are one."""

    axes: dict[str, TrackAxis]
    nodes: Merger = field(default_factory=Merger)
    spans: list[Span] = field(default_factory=list)
    edges: list[tuple[Node, Node, float]] = field(default_factory=list)  # first, second, resistance [ohm]
    busbars: dict[str, Busbar] = field(default_factory=dict)
    feeders: list[Feeder] = field(default_factory=list)
    sections: list[tuple[str, float, Node, Node]] = field(default_factory=list)  # track, km, contact line, rail

    def distance_m(self, track: str, from_km: float, to_km: float) -> float:
        """Return the way along `track` from one kilometre to another [m]; its ends may be missed by a shared node."""
        axis = self.axes[track]
        first, last = (min(max(km, axis.from_km), axis.to_km) for km in (from_km, to_km))
        return float(axis.metre(last) - axis.metre(first))

    def locate(self, track: str, km: float) -> tuple[int, float]:
        """Return the span that carries `track` at `km`, and the distance from its left end [m].

        Raises
        ------
        LookupError
            If no contact line is there; `supply.checks` reports that before.
        """
        for beyond in (0.0, _SHARED_KM):  # the right side of a cut counts, if there is a contact line
            for number, span in enumerate(self.spans):
                if track in span.returns and span.from_km - beyond <= km <= span.to_km + beyond:
                    return number, min(max(self.distance_m(track, span.from_km, km), 0.0), span.length_m)
        raise LookupError(f"no contact line on track {track} at km {km}")


def build_topology(supply: Supply, line: Line) -> Topology:
    """Return the graph of a supply that has passed `supply.checks`."""
    topology = Topology(axes=compile_axes(line))
    for tracks in _bundles(supply, line):
        _Bundle(topology, supply, line, tracks).build()
    topology.feeders.sort(key=lambda feeder: (feeder.substation, feeder.track, feeder.side))
    return topology


def tracks_at(line: Line, km: float) -> Iterator[str]:
    """Yield the tracks that exist at `km`."""
    for track in line.tracks:
        if track.from_km - _SHARED_KM <= km <= track.to_km + _SHARED_KM:
            yield track.id


def _return_tracks(row: ReturnCircuit, line: Line) -> set[str]:
    known = {track.id for track in line.tracks}
    return known if row.tracks is None else known & set(row.tracks)


def _bundles(supply: Supply, line: Line) -> list[list[str]]:
    merger = Merger()
    for row in supply.return_circuit:
        tracks = sorted(_return_tracks(row, line))
        for track in tracks:
            merger.join(tracks[0], track)
    groups: dict[Node, list[str]] = defaultdict(list)
    for track in sorted(track.id for track in line.tracks):
        groups[merger.find(track)].append(track)
    return list(groups.values())


class _Bundle:
    """Builds the part of the graph that belongs to one bundle of tracks."""

    def __init__(self, topology: Topology, supply: Supply, line: Line, tracks: list[str]) -> None:
        self.topology, self.join = topology, topology.nodes.join
        self.tracks = tracks
        self.ends = {track.id: (track.from_km, track.to_km) for track in line.tracks}
        self.contact = [
            (track, row.from_km, row.to_km, (row.resistance_ohm_per_km or 0.0) / 1000.0)
            for row in supply.contact_lines
            for track in tracks
            if row.tracks is None or track in row.tracks
        ]
        self.rails = [
            (number, _return_tracks(row, line) & set(tracks), row.from_km, row.to_km, (row.resistance_ohm_per_km or 0.0) / 1000.0)
            for number, row in enumerate(supply.return_circuit)
            if _return_tracks(row, line) & set(tracks)
        ]
        self.devices: list[tuple[Substation | SectionCabin | SectionPoint, list[str]]] = []
        across: list[Substation | SectionCabin] = [*supply.substations, *supply.section_cabins]
        for device in across:
            own = tracks_at(line, device.km) if device.tracks is None else device.tracks
            self._add_device(device, own)
        for point in supply.section_points:
            self._add_device(point, [point.track])
        self.cuts = self._cuts()

    def _add_device(self, device: Substation | SectionCabin | SectionPoint, tracks: Iterable[str]) -> None:
        own = sorted(set(tracks) & set(self.tracks))
        if own:
            self.devices.append((device, own))

    def _cuts(self) -> list[float]:
        kms = [device.km for device, _ in self.devices]
        for track, from_km, to_km, _ in self.contact:
            low, high = self.ends[track]
            kms += [max(from_km, low), min(to_km, high)]
        for _, tracks, from_km, to_km, _ in self.rails:
            low, high = min(self.ends[track][0] for track in tracks), max(self.ends[track][1] for track in tracks)
            kms += [max(from_km, low), min(to_km, high)]
        cuts: list[float] = []
        for km in sorted(kms):
            if not cuts or km - cuts[-1] >= _SHARED_KM:
                cuts.append(km)
        return cuts

    def _cut(self, km: float) -> float:
        return min(self.cuts, key=lambda cut: abs(cut - km))

    def build(self) -> None:
        for low, high in zip(self.cuts, self.cuts[1:], strict=False):
            self._add_spans(low, high)
        for cut in self.cuts:
            self._join_rails(cut)
            self._join_contact_lines(cut)
        for device, tracks in self.devices:
            if isinstance(device, Substation):
                self._add_substation(device, tracks)
            elif isinstance(device, SectionCabin) and device.state == "closed":
                for track in tracks:
                    for side in self._sides(track, self._cut(device.km)):
                        self.join(("cabin", device.id), side)

    # -- spans ---------------------------------------------------------------------------------------------------

    def _contacts_over(self, km: float) -> dict[str, float]:
        return {
            track: ohm
            for track, from_km, to_km, ohm in self.contact
            if from_km <= km <= to_km and self.ends[track][0] <= km <= self.ends[track][1]
        }

    def _rails_over(self, km: float) -> dict[int, tuple[set[str], float]]:
        return {
            number: ({track for track in tracks if self.ends[track][0] <= km <= self.ends[track][1]}, ohm)
            for number, tracks, from_km, to_km, ohm in self.rails
            if from_km <= km <= to_km
        }

    def _add_spans(self, low: float, high: float) -> None:
        middle = 0.5 * (low + high)
        contacts = self._contacts_over(middle)
        for number, (tracks, rail_ohm) in sorted(self._rails_over(middle).items()):
            if not tracks:
                continue
            length = self.topology.distance_m(min(tracks), low, high)
            conductors = [
                Conductor(("contact", track), contacts[track], ("high", track, low), ("low", track, high))
                for track in sorted(tracks & set(contacts))
            ]
            left, right = ("rail", number, low), ("rail", number, high)
            short = rail_ohm * length < SHORT_OHM
            if short:
                self.join(left, right)
            returns = {conductor.name[1]: len(conductors) for conductor in conductors}
            conductors.append(Conductor(("rail", str(number)), 0.0 if short else rail_ohm, left, right))
            self.topology.spans.append(Span(low, high, length, tuple(conductors), returns))
            self.topology.sections += [
                (conductor.name[1], km, node, rail)
                for conductor in conductors[:-1]
                for km, node, rail in ((low, conductor.left, left), (high, conductor.right, right))
            ]

    # -- cross-sections ------------------------------------------------------------------------------------------

    def _beside(self, cut: float) -> tuple[float, float]:
        position = self.cuts.index(cut)
        before = self.cuts[position - 1] if position else cut - 1.0
        after = self.cuts[position + 1] if position + 1 < len(self.cuts) else cut + 1.0
        return 0.5 * (before + cut), 0.5 * (cut + after)

    def _sides(self, track: str, cut: float) -> list[Node]:
        """Return the ends of the contact line of `track` at `cut`: its low side, its high side, where they exist."""
        before, after = self._beside(cut)
        sides: list[Node] = []
        if track in self._contacts_over(before):
            sides.append(("low", track, cut))
        if track in self._contacts_over(after):
            sides.append(("high", track, cut))
        return sides

    def _rail_nodes(self, tracks: Iterable[str], cut: float) -> list[Node]:
        wanted = set(tracks)
        rows = [
            number
            for km in self._beside(cut)
            for number, (members, _) in sorted(self._rails_over(km).items())
            if members & wanted
        ]
        return [("rail", number, cut) for number in rows]

    def _join_rails(self, cut: float) -> None:
        for track in self.tracks:
            nodes = self._rail_nodes([track], cut)
            for node in nodes:
                self.join(nodes[0], node)

    def _join_contact_lines(self, cut: float) -> None:
        separated = set()
        for device, tracks in self.devices:
            ties = isinstance(device, Substation) and device.state in ("in_service", "rectifiers_out")
            if self._cut(device.km) == cut and (ties or device.state == "open"):
                separated.update(tracks)
        for track in set(self.tracks) - separated:
            sides = self._sides(track, cut)
            if len(sides) == 2:
                self.join(*sides)

    def _add_substation(self, device: Substation, tracks: list[str]) -> None:
        cut = self._cut(device.km)
        rails = self._rail_nodes(tracks, cut)
        for rail in rails:  # rails stay joined there whatever the state of the contact lines
            self.join(("return", device.id), rail)
        if device.state not in ("in_service", "rectifiers_out"):
            return
        positive, negative = ("positive", device.id), ("negative", device.id)
        first = device.id not in self.topology.busbars
        self.topology.busbars[device.id] = Busbar(positive, negative)
        if first:
            self._connect(("return", device.id), negative, device.return_resistance_ohm)
        for track in tracks:
            for side in self._sides(track, cut):
                self._connect(positive, side, device.feeder_resistance_ohm)
                name = "low_km" if side[0] == "low" else "high_km"  # type: ignore[index]
                self.topology.feeders.append(Feeder(device.id, track, name, cut))

    def _connect(self, first: Node, second: Node, ohm: float) -> None:
        if ohm < SHORT_OHM:
            self.join(first, second)
        else:
            self.topology.edges.append((first, second, ohm))
