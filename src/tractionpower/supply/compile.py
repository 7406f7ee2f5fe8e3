"""From the declared supply to the solver's tables. Here kilometres, kilowatts and ohms per kilometre become SI."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import SECTION
from tractionpower.kernels.tables import (
    BLOCKED_CONDUCTANCE_S,
    CONDUCTOR,
    EDGE,
    NO_SLOT,
    PORT,
    SEGMENT,
    SHARED_NODE_M,
    SPAN,
    Network,
)
from tractionpower.model.limits import Limit, SystemVoltages, system_voltages
from tractionpower.model.line import Line
from tractionpower.model.supply import Load, Substation, Supply
from tractionpower.supply.characteristics import (
    NO_FLOOR_V,
    Segments,
    floor_voltage,
    load_segments,
    source_segments,
)
from tractionpower.supply.numbering import number_nodes
from tractionpower.supply.topology import Feeder, Node, Span, Topology, build_topology

CEILING_FACTOR = 5.0
"""Multiple of the no-load voltage above which feeding back without limits counts as not served."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of a track within one span, with its contact line and rails.

    Attributes
    ----------
    track
        Identifier of the track.
    from_m, to_m
        Ends by the distance from the start of the track [m].
    span, positive, negative
        Numbers of the span and of the conductors.
    length_m
        Length of the span [m].
    no_load_v
        Highest no-load voltage that sources put on the contact line; 0 without one [V].
    """

    track: str
    from_m: float
    to_m: float
    span: int
    positive: int
    negative: int
    length_m: float
    no_load_v: float


@dataclass(frozen=True, slots=True)
class SupplyTables:
    """A supply system compiled for the solver, with the names that its numbers stand for.

    Attributes
    ----------
    network
        Tables of the solver; the ports are the sources, then the loads, each by identifier, then probes, then trains.
    edges
        Fixed resistances between skeleton nodes, record array of `EDGE`.
    substations
        All substations by identifier.
    source_port
        Port of each substation, -1 when its rectifiers are out of service.
    busbar
        Positive and negative node of each substation, -1 where its busbars are not in the network; shape (n, 2).
    loads, load_port
        All loads by identifier and their ports.
    feeders, feeder_end
        Feeders, and for each the conductor (of `network.conductors`) and its end (0 left, 1 right); shape (n, 2).
    sections, section_table
        Track and kilometre of the places whose voltage is recorded, so that the voltage runs straight between them; and
        where the solver finds it, record array of `SECTION`.
    stretches
        Where contact lines are, by track and place.
    train_port
        Ports of trains, which stand nowhere yet.
    voltages
        Voltage limits of the system.
    """

    network: Network
    edges: NDArray[np.void]
    substations: tuple[Substation, ...]
    source_port: NDArray[np.int64]
    busbar: NDArray[np.int64]
    loads: tuple[Load, ...]
    load_port: NDArray[np.int64]
    feeders: tuple[Feeder, ...]
    feeder_end: NDArray[np.int64]
    sections: tuple[tuple[str, float], ...]
    section_table: NDArray[np.void]
    stretches: tuple[Stretch, ...]
    train_port: NDArray[np.int64]
    voltages: SystemVoltages


def compile_network(supply: Supply, line: Line, limits: tuple[Limit, ...], train_segments: Sequence[int] = ()) -> SupplyTables:
    """Compile a supply system that has passed `supply.checks.check_supply`.

    Parameters
    ----------
    supply, line, limits
        What is declared.
    train_segments
        For each train, how many segments its port may have.
    """
    return _Compiler(supply, line, limits).compile(train_segments)


class _Compiler:
    def __init__(self, supply: Supply, line: Line, limits: tuple[Limit, ...]) -> None:
        self.voltages = system_voltages(limits, supply.system)
        self.topology: Topology = build_topology(supply, line)
        self.substations = tuple(sorted(supply.substations, key=lambda substation: substation.id))
        self.loads = tuple(sorted(supply.loads, key=lambda load: load.id))
        in_service = [substation for substation in self.substations if substation.state == "in_service"]
        self.sources = [substation for substation in in_service if substation.id in self.topology.busbars]
        self.find = self.topology.nodes.find
        self.probes = self._probes()
        self.nodes = number_nodes(self.topology, self.sources)
        self.structure = self.nodes.structure

    def compile(self, train_segments: Sequence[int]) -> SupplyTables:
        spans, conductors, terminals, scatter = self._span_tables()
        ports, segments = _with_trains(*self._port_tables(), train_segments)
        network = Network(
            spans, conductors, ports, segments, terminals, scatter,
            self.structure.column_start, self.structure.row, self.structure.target, self._base(),
        )  # fmt: skip
        source_ids = [substation.id for substation in self.sources]
        source_port = [source_ids.index(s.id) if s.id in source_ids else -1 for s in self.substations]
        busbars = [self.topology.busbars.get(s.id) for s in self.substations]
        return SupplyTables(
            network=network,
            edges=self._edges(),
            substations=self.substations,
            source_port=np.array(source_port, np.int64),
            busbar=_pairs([(self.node(b.positive), self.node(b.negative)) if b else (-1, -1) for b in busbars]),
            loads=self.loads,
            load_port=len(self.sources) + np.arange(len(self.loads), dtype=np.int64),
            feeders=tuple(self.topology.feeders),
            feeder_end=_pairs([self._feeder_end(feeder) for feeder in self.topology.feeders]),
            sections=tuple(place[:2] for place in self.topology.sections) + tuple(self.probes),
            section_table=self._section_table(),
            stretches=tuple(self._stretches()),
            train_port=np.arange(len(ports) - len(train_segments), len(ports), dtype=np.int64),
            voltages=self.voltages,
        )

    def _probes(self) -> list[tuple[str, float]]:
        """Return the places beside each load on the tracks that share its return conductor: the voltage bends there too.

        Where a load stands on that track as close as to share a node, its own voltage is recorded anyway.
        """
        topology = self.topology
        beside = {
            (track, load.km) for load in self.loads for track in topology.spans[topology.locate(load.track, load.km)[0]].returns
        }
        kms = {track: [load.km for load in self.loads if load.track == track] for track, _ in beside}
        return sorted(
            (track, place) for track, place in beside if all(abs(km - place) >= SHARED_NODE_M / 1000.0 for km in kms[track])
        )

    # -- nodes ---------------------------------------------------------------------------------------------------

    def node(self, node: Node) -> int:
        """Return the number of a node: its rank in the elimination, or ground."""
        return self.nodes.number[self.find(node)]

    def _no_load_v(self, node: Node) -> float:
        return self.nodes.no_load_v.get(self.find(node), 0.0)

    def _base(self) -> NDArray[np.float64]:
        n, place = len(self.structure.order), self.structure.place
        base = np.zeros(n + 1 + len(self.structure.row))
        for edge in self._edges():
            i, j, g = int(edge["first"]), int(edge["second"]), edge["conductance_s"]
            base[i] += g
            base[j] += g
            base[place(i, j)] -= g
        base[list(self.nodes.floating)] += BLOCKED_CONDUCTANCE_S
        return base

    def _edges(self) -> NDArray[np.void]:
        rows = [(self.node(a), self.node(b), 1.0 / ohm) for a, b, ohm in self.topology.edges]
        return np.array([row for row in rows if row[0] != row[1]], EDGE)

    # -- spans ---------------------------------------------------------------------------------------------------

    def _span_tables(self) -> tuple[NDArray[np.void], NDArray[np.void], NDArray[np.int64], NDArray[np.int64]]:
        spans: list[tuple[float | int, ...]] = []
        conductors: list[tuple[float | int, ...]] = []
        terminals: list[int] = []
        scatter: list[int] = []
        self.first_conductor: list[int] = []
        for span in self.topology.spans:
            left, right = self._terminals(span)
            ends = right + left
            slots = {node: k for k, node in enumerate(ends)}
            self.first_conductor.append(len(conductors))
            front = len(ends)  # fronts come behind the ends, ground behind the fronts
            ground_slot = front + sum(conductor.ohm_per_m > 0.0 for conductor in span.conductors)
            for conductor in span.conductors:
                i, j = self.node(conductor.left), self.node(conductor.right)
                ohm = conductor.ohm_per_m
                left_slot, right_slot = slots.get(i, ground_slot), slots.get(j, ground_slot)
                place = self.structure.place(i, j)
                conductors.append((ohm, i, j, place, left_slot, front if ohm > 0.0 else NO_SLOT, right_slot))
                front += ohm > 0.0
            sizes = (len(span.conductors), front - len(ends), len(terminals), len(right), len(left), len(scatter))
            spans.append((span.length_m, self.first_conductor[-1], *sizes))
            terminals += ends
            scatter += [self.structure.place(ends[i], ends[j]) for i in range(len(ends)) for j in range(i + 1)]
        return (
            np.array(spans, SPAN), np.array(conductors, CONDUCTOR),
            np.array(terminals, np.int64), np.array(scatter, np.int64),
        )  # fmt: skip

    def _terminals(self, span: Span) -> tuple[list[int], list[int]]:
        ground = len(self.structure.order)
        left = sorted({self.node(c.left) for c in span.conductors} - {ground})
        right = sorted({self.node(c.right) for c in span.conductors} - {ground} - set(left))
        return left, right

    def _feeder_end(self, feeder: Feeder) -> tuple[int, int]:
        for number, span in enumerate(self.topology.spans):
            if feeder.track in span.returns:
                conductor = self.first_conductor[number] + span.contact(feeder.track)
                if feeder.side == "high_km" and span.from_km == feeder.km:
                    return conductor, 0
                if feeder.side == "low_km" and span.to_km == feeder.km:
                    return conductor, 1
        raise LookupError(f"no contact line beside the feeder {feeder}")

    def _section_table(self) -> NDArray[np.void]:
        rows = [(self.node(contact), self.node(rail), -1) for _, _, contact, rail in self.topology.sections]
        first = len(self.sources) + len(self.loads)
        return np.array(rows + [(-1, -1, first + k) for k in range(len(self.probes))], SECTION)

    def _stretches(self) -> Iterator[Stretch]:
        for number, span in enumerate(self.topology.spans):
            first = self.first_conductor[number]
            for track, rail in span.returns.items():
                axis, contact = self.topology.axes[track], span.contact(track)
                ends = axis.stretch_m(span.from_km, span.to_km)
                if ends is not None:
                    volts = self._no_load_v(span.conductors[contact].left)
                    yield Stretch(track, *ends, number, first + contact, first + rail, span.length_m, volts)

    # -- ports ---------------------------------------------------------------------------------------------------

    def _port_tables(self) -> tuple[NDArray[np.void], NDArray[np.void]]:
        rows: list[Segments] = [source_segments(s) for s in self.sources]
        rows += [load_segments(load, self.voltages) for load in self.loads]
        rows += [[(float("-inf"), 0.0, 0.0, 0.0)] for _ in self.probes]
        ports = np.zeros(len(rows), PORT)
        ports["segments"] = [len(row) for row in rows]
        ports["first_segment"] = np.cumsum(ports["segments"]) - ports["segments"]
        ports["scale"] = 1.0
        for port, substation in zip(ports, self.sources, strict=False):
            bus = self.topology.busbars[substation.id]
            i, j = self.node(bus.positive), self.node(bus.negative)
            port["span"], port["positive"], port["negative"] = -1, i, j
            port["coupling"] = self.structure.place(i, j)
            port["start_v"] = self._no_load_v(bus.positive)
        first = len(self.sources)
        for port, load in zip(ports[first:], self.loads, strict=False):
            self._place_load(port, load)
        for port, (track, km) in zip(ports[first + len(self.loads) :], self.probes, strict=True):
            self._place_port(port, track, km)
        return ports, np.array([segment for row in rows for segment in row], SEGMENT)

    def _place_load(self, port: np.void, load: Load) -> None:
        self._place_port(port, load.track, load.km)
        port["demand"] = True
        port["floor_v"] = floor_voltage(load, self.voltages)
        if port["floor_v"] > NO_FLOOR_V:
            port["ceiling_v"] = CEILING_FACTOR * max(port["start_v"], self.voltages.u_max2)

    def _place_port(self, port: np.void, track: str, km: float) -> None:
        number, x = self.topology.locate(track, km)
        span = self.topology.spans[number]
        first, contact = self.first_conductor[number], span.contact(track)
        port["span"], port["x_m"] = number, x
        port["positive"], port["negative"] = first + contact, first + span.returns[track]
        port["start_v"] = self._no_load_v(span.conductors[contact].left)


def _with_trains(
    ports: NDArray[np.void], segments: NDArray[np.void], train_segments: Sequence[int]
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return ports and segments with room for trains behind them."""
    room = np.array(train_segments, np.int64)
    trains = np.zeros(len(room), PORT)
    trains["demand"], trains["scale"] = True, 1.0
    trains["first_segment"] = len(segments) + np.cumsum(room) - room
    return np.concatenate((ports, trains)), np.concatenate((segments, np.zeros(int(room.sum()), SEGMENT)))


def _pairs(rows: list[tuple[int, int]]) -> NDArray[np.int64]:
    return np.array(rows, np.int64).reshape(-1, 2)
