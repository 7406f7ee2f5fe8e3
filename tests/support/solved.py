"""A supply, compiled and solved, with its numbers under the names of its devices."""

import numpy as np

from tractionpower.io.limits_files import shipped_limits
from tractionpower.kernels.flows import conductor_flows, link_current, skeleton_balance
from tractionpower.kernels.network import CONVERGED, solve
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.rail_potential import rail_potential
from tractionpower.kernels.spans import place_ports
from tractionpower.kernels.tables import new_work
from tractionpower.model.line import Line, Track
from tractionpower.model.loads import Load
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, Substation, Supply
from tractionpower.supply.compile import compile_network

LIMITS = shipped_limits()


class Solved:
    """A solved network; `u` and `i` are voltages and currents taken from the line, by identifier."""

    def __init__(self, supply, line, expect=CONVERGED):
        self.tables = compile_network(supply, line, LIMITS)
        self.network = self.tables.network
        self.work = new_work(self.network)
        place_ports(self.network, self.work)
        ports = zip(self.tables.substations, self.tables.source_port.tolist(), strict=True)
        self.ports = {station.id: port for station, port in ports if port >= 0}
        self.sources = list(self.ports)
        self.ports |= {load.id: port for load, port in zip(self.tables.loads, self.tables.load_port.tolist(), strict=True)}
        self.names = list(self.ports)
        self.solve(expect=expect)

    def solve(self, *, warm=False, expect=CONVERGED):
        """Solve; ports behind the named ones only mark places."""
        self.status, self.iterations, self.worst, self.factor, self.port = solve(self.network, self.work, warm)
        if expect is not None:
            assert self.status == expect, (self.status, self.worst, self.factor)
        self.u = {name: float(self.work.ports[port]["u"]) for name, port in self.ports.items()}
        return self

    @property
    def i(self):
        network, work = self.network, self.work
        return {
            name: port_current(network.segments, network.ports[port], work.ports[port]["u"]) for name, port in self.ports.items()
        }

    def flows(self):
        """Return the heat in all resistances [W], the largest imbalance inside the spans and of skeleton nodes [A]."""
        balance = np.zeros(self.network.nodes + 1)
        span_heat, inside, _ = conductor_flows(self.network, self.work, balance)
        edge_heat, worst = skeleton_balance(self.network, self.work, self.tables.edges, balance)
        return span_heat + edge_heat, inside, worst, balance

    @property
    def links(self):
        """Currents of feeders and switches by identifier, from the busbar or the first side [A]."""
        self.flows()
        tables, network = self.tables, self.network
        return {
            link.id: link_current(tables.link_table, tables.terms, k, self.work, tables.edges, network.ports, network.segments)
            for k, link in enumerate(tables.links)
        }

    @property
    def rails(self):
        """Rail potentials at cross-sections by tracks and kilometre [V]."""
        tables = self.tables
        return {
            (place.tracks, place.km): float(potential)
            for place, row in zip(tables.rail_places, tables.rail_table, strict=True)
            if place.span < 0 and not np.isnan(potential := rail_potential(self.network, self.work, row))
        }

    @property
    def rails_everywhere(self):
        """The same at all places that are recorded."""
        tables = self.tables
        return {
            (place.tracks, place.km): float(rail_potential(self.network, self.work, row))
            for place, row in zip(tables.rail_places, tables.rail_table, strict=True)
        }


def seed_network(loads=(), cabin="closed", **changes):
    """Return the published two-track network of Krzysztozek 2019: supply and line."""
    station = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12} | changes
    line = Line(tracks=tuple(Track(id=t, from_km=0.0, to_km=20.0) for t in "12"))
    supply = Supply(
        substations=(Substation(id="A", km=0.0, **station), Substation(id="B", km=20.0, **station)),
        section_cabins=(SectionCabin(id="C", km=10.0, state=cabin),),
        contact_lines=(ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05),),
        return_circuit=(ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.01),),
        loads=tuple(loads),
    )
    return supply, line


def single_line(loads=(), **changes):
    """Return the single line with diode rectifiers: supply and line."""
    station = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12} | changes
    line = Line(tracks=(Track(id="1", from_km=0.0, to_km=20.0),))
    supply = Supply(
        substations=(Substation(id="A", km=0.0, **station), Substation(id="B", km=20.0, **station)),
        contact_lines=(ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.06),),
        return_circuit=(ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.0),),
        loads=tuple(loads),
    )
    return supply, line


def tap(name, km, *, track="1", kw=None, ampere=None, **more):
    """Return a load of constant power [kW] or current [A]."""
    return Load(id=name, track=track, km=km, power_kw=kw, current_a=ampere, **more)
