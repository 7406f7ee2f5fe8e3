"""From the declared supply to the solver's tables. Here kilometres, kilowatts and ohms per kilometre become SI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import SECTION
from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S, EDGE, PORT, SEGMENT, Network
from tractionpower.model.conductors import Conductor
from tractionpower.model.limits import Limit, SystemVoltages, system_voltages
from tractionpower.model.line import Line
from tractionpower.model.loads import Load
from tractionpower.model.supply import Substation, Supply
from tractionpower.supply.characteristics import (
    NO_FLOOR_V,
    Segments,
    floor_voltage,
    load_segments,
    source_segments,
)
from tractionpower.supply.gauges import Section, find_sections, gauge_table
from tractionpower.supply.links import link_tables
from tractionpower.supply.numbering import find_returning, number_nodes
from tractionpower.supply.probes import find_probes
from tractionpower.supply.protection import Trigger, find_triggers, trigger_table
from tractionpower.supply.rail_places import RailPlace, find_rail_places, rail_table
from tractionpower.supply.span_tables import span_tables
from tractionpower.supply.stretches import Stretch, find_stretches
from tractionpower.supply.topology import Link, Topology
from tractionpower.supply.wiring import build_topology

_DEAD = (-1, -1, -1)
"""A place whose contact line nothing feeds: it has no voltage."""

CEILING_FACTOR = 5.0
"""Multiple of the no-load voltage above which feeding back without limits counts as not served."""


@dataclass(frozen=True, slots=True)
class SupplyTables:
    """A supply system compiled for the solver, with the names that its numbers stand for.

    Attributes
    ----------
    supply
        What was compiled.
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
    links, link_table, terms
        Breakers and switches, and what the solver knows of them: record arrays of `LINK` and `TERM`.
    sections, section_table
        Track and kilometre of the places whose voltage is recorded, so that the voltage runs straight between them; and
        where the solver finds it, record array of `SECTION`.
    conductor_sections, gauge_table
        Sections of contact lines and rails, and their ends whose currents are recorded, record array of `GAUGE`.
    rail_places, rail_table
        Places of the rails whose potential is recorded, none where nothing is joined with earth; and where the solver
        finds it, record array of `RAIL`.
    earth_devices, earth_edge
        Earthings and voltage-limiting devices by identifier, each in this order, and their edges, -1 where open.
    watched, triggers
        What the triggers stand for, and record array of `TRIGGER`.
    stretches
        Where contact lines are, by track and place.
    train_port
        Ports of trains, which stand nowhere yet.
    voltages
        Voltage limits of the system.

    The order of all lists depends on what is declared, not on the states of devices.
    """

    supply: Supply
    network: Network
    edges: NDArray[np.void]
    substations: tuple[Substation, ...]
    source_port: NDArray[np.int64]
    busbar: NDArray[np.int64]
    loads: tuple[Load, ...]
    load_port: NDArray[np.int64]
    links: tuple[Link, ...]
    link_table: NDArray[np.void]
    terms: NDArray[np.void]
    sections: tuple[tuple[str, float], ...]
    section_table: NDArray[np.void]
    conductor_sections: tuple[Section, ...]
    gauge_table: NDArray[np.void]
    rail_places: tuple[RailPlace, ...]
    rail_table: NDArray[np.void]
    earth_devices: tuple[str, ...]
    earth_edge: NDArray[np.int64]
    watched: tuple[Trigger, ...]
    triggers: NDArray[np.void]
    stretches: tuple[Stretch, ...]
    train_port: NDArray[np.int64]
    voltages: SystemVoltages


def compile_network(
    supply: Supply,
    line: Line,
    limits: tuple[Limit, ...],
    train_segments: Sequence[int] = (),
    conductors: Sequence[Conductor] = (),
) -> SupplyTables:
    """Compile a supply system that has passed `supply.checks.check_supply`.

    Parameters
    ----------
    supply, line, limits
        What is declared.
    train_segments
        For each train, how many segments its port may have.
    conductors
        Table of conductors that the supply names.
    """
    return _Compiler(supply, line, limits, conductors).compile(train_segments)


class _Compiler:
    def __init__(self, supply: Supply, line: Line, limits: tuple[Limit, ...], conductors: Sequence[Conductor]) -> None:
        self.supply = supply
        self.voltages = system_voltages(limits, supply.system)
        self.topology: Topology = build_topology(supply, line, conductors)
        self.substations = tuple(sorted(supply.substations, key=lambda substation: substation.id))
        self.loads = tuple(sorted(supply.loads, key=lambda load: load.id))
        self.find = self.topology.find
        self.returning = find_returning(self.topology)
        self.sources = [s for s in self.substations if s.feeds and s.id in self.returning]
        self.probes = find_probes(self.topology, self.loads)
        self.rail_places = find_rail_places(self.topology, self.loads)
        self.nodes = number_nodes(self.topology, self.sources)
        self.structure = self.nodes.structure
        self.edge_rows = [(self.node(a), self.node(b), 1.0 / ohm) for a, b, ohm in self.topology.edges()]

    def compile(self, train_segments: Sequence[int]) -> SupplyTables:
        topology = self.topology
        spans = span_tables(topology.spans, self.node, self.structure)
        self.first_conductor = spans.first_conductor
        ports, segments = _with_trains(*self._port_tables(), train_segments)
        network = Network(
            spans.spans, spans.conductors, ports, segments, spans.terminals, spans.scatter,
            self.structure.column_start, self.structure.row, self.structure.target,
            self._base(spans.conductors),
        )  # fmt: skip
        feeding = {source.id for source in self.sources}
        port_of = {substation.id: k for k, substation in enumerate(self.substations) if substation.id in feeding}
        busbars = [topology.busbars[s.id] if s.id in self.returning else None for s in self.substations]
        links, terms = link_tables(topology, self._edge_numbers(), port_of)
        sections = find_sections(topology, self.supply)
        watched = find_triggers(self.supply, topology.links)
        return SupplyTables(
            supply=self.supply,
            network=network,
            edges=np.array([row for row in self.edge_rows if row[0] != row[1]], EDGE),
            substations=self.substations,
            source_port=np.array([port_of.get(s.id, -1) for s in self.substations], np.int64),
            busbar=_pairs([(self.node(b.positive), self.node(b.negative)) if b else (-1, -1) for b in busbars]),
            loads=self.loads,
            load_port=len(self.substations) + np.arange(len(self.loads), dtype=np.int64),
            links=tuple(topology.links),
            link_table=links,
            terms=terms,
            sections=tuple((place.track, place.km) for place in topology.sections) + tuple(self.probes),
            section_table=self._section_table(),
            conductor_sections=sections,
            gauge_table=gauge_table(sections, self.first_conductor),
            rail_places=self.rail_places,
            rail_table=rail_table(topology, self.rail_places, self.nodes, self.first_conductor),
            earth_devices=tuple(item.id for item in topology.earth_links),
            earth_edge=self._earth_edges(),
            watched=watched,
            triggers=trigger_table(topology, self.rail_places, watched),
            stretches=tuple(find_stretches(topology, self.first_conductor, self._no_load_v, self._is_earthed)),
            train_port=np.arange(len(ports) - len(train_segments), len(ports), dtype=np.int64),
            voltages=self.voltages,
        )

    # -- nodes ---------------------------------------------------------------------------------------------------

    def node(self, node: int) -> int:
        """Return the number of a node: its rank in the elimination, or ground."""
        return self.nodes.number[self.find(node)]

    def _no_load_v(self, node: int) -> float:
        return self.nodes.no_load_v.get(self.find(node), 0.0)

    def _is_earthed(self, node: int) -> bool:
        return self.find(node) in self.nodes.earthed

    def _base(self, conductors: NDArray[np.void]) -> NDArray[np.float64]:
        n, place = len(self.structure.order), self.structure.place
        base = np.zeros(n + 1 + len(self.structure.row))
        for i, j, g in self.edge_rows:
            if i != j:
                base[i] += g
                base[j] += g
                base[place(i, j)] -= g
        for name in ("left_node", "right_node"):
            np.add.at(base, conductors[name], conductors["whole_shunt_s"])
            own = conductors[conductors["left_node"] != conductors["right_node"]]
            np.add.at(base, own[name], own["whole_s"])
        np.subtract.at(base, own["coupling"], own["whole_s"])
        base[list(self.nodes.floating)] += BLOCKED_CONDUCTANCE_S
        return base

    def _edge_numbers(self) -> list[int]:
        """Return for each edge of the graph its row in the table, -1 where both ends are one node."""
        kept = [i != j for i, j, _ in self.edge_rows]
        return np.where(kept, np.cumsum(kept) - 1, -1).astype(int).tolist() if kept else []

    def _earth_edges(self) -> NDArray[np.int64]:
        items = self.topology.earth_links
        numbers = iter(self._edge_numbers()[len(self.edge_rows) - sum(item.closed for item in items) :])
        return np.array([next(numbers) if item.closed else -1 for item in items], np.int64)

    def _section_table(self) -> NDArray[np.void]:
        places = self.topology.sections
        live = [self._no_load_v(place.contact) > 0.0 for place in places]
        rows = [(self.node(p.contact), self.node(p.rail), -1) if fed else _DEAD for p, fed in zip(places, live, strict=True)]
        first = len(self.substations) + len(self.loads)
        for k, (track, km) in enumerate(self.probes):
            number, _ = self.topology.locate(track, km)
            span = self.topology.spans[number]
            fed = self._no_load_v(span.conductors[span.contact(track)].left) > 0.0
            rows.append((-1, -1, first + k) if fed else _DEAD)
        return np.array(rows, SECTION)

    # -- ports ---------------------------------------------------------------------------------------------------

    def _port_tables(self) -> tuple[NDArray[np.void], NDArray[np.void]]:
        rows: list[Segments] = [source_segments(s) for s in self.substations]
        rows += [load_segments(load, self.voltages) for load in self.loads]
        rows += [[(float("-inf"), 0.0, 0.0, 0.0)] for _ in self.probes]
        ports = np.zeros(len(rows), PORT)
        ports["segments"] = [len(row) for row in rows]
        ports["first_segment"] = np.cumsum(ports["segments"]) - ports["segments"]
        ports["scale"] = 1.0
        feeding = {source.id for source in self.sources}
        for port, substation in zip(ports, self.substations, strict=False):
            port["span"] = -1
            if substation.id in feeding:
                bus = self.topology.busbars[substation.id]
                i, j = self.node(bus.positive), self.node(bus.negative)
                port["positive"], port["negative"] = i, j
                port["coupling"] = self.structure.place(i, j)
                port["start_v"] = self._no_load_v(bus.positive)
            else:  # between ground and ground, without current: it keeps the numbers of the others
                ground = len(self.structure.order)
                port["positive"], port["negative"], port["coupling"], port["scale"] = ground, ground, ground, 0.0
        first = len(self.substations)
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
        port["positive"], port["negative"] = first + contact, first + len(span.tracks)
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
