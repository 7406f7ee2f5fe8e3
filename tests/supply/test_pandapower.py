"""Snapshots of loop circuits against the DC elements of pandapower, an independent program.

pandapower knows no diodes and no fold-back, so sources conduct both ways, have one no-load voltage and stand behind
their resistance (a line), and loads are constant powers inside their range. Its currents return through ideal ground:
the rails have no resistance.
"""

from itertools import pairwise

import numpy as np
import pandapower
import pytest
from solved import Solved, single_line, tap

from tractionpower.model.line import Line, Track
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, Substation, Supply

E_V = 3600.0
KV = 1e-3


class Peer:
    """The same network in pandapower."""

    def __init__(self):
        self.net = pandapower.create_empty_network()
        # A power flow wants an AC side, and iterates only if there is something to solve; it is not coupled to the DC side.
        slack, other = pandapower.create_buses(self.net, 2, vn_kv=15.0)
        pandapower.create_ext_grid(self.net, slack)
        pandapower.create_line_from_parameters(
            self.net, slack, other, length_km=1.0, r_ohm_per_km=0.1, x_ohm_per_km=0.1, c_nf_per_km=0.0, max_i_ka=1.0
        )

        self.ideal = self.bus()
        pandapower.create_source_dc(self.net, self.ideal, vm_pu=1.0)

    def bus(self):
        return pandapower.create_bus_dc(self.net, vn_kv=E_V * KV)

    def resistance(self, first, second, ohm):
        pandapower.create_line_dc_from_parameters(self.net, first, second, length_km=1.0, r_ohm_per_km=ohm, max_i_ka=100.0)

    def source(self, busbar, ohm):
        """Feed a busbar from the one ideal source: with two of them its power flow does not converge."""
        self.resistance(self.ideal, busbar, ohm)

    def load(self, bus, kw):
        pandapower.create_load_dc(self.net, bus, p_dc_mw=kw / 1000.0)

    def solve(self):
        pandapower.runpp(self.net, init="flat", tolerance_mva=1e-10, max_iteration=50)
        return self.net.res_bus_dc.vm_pu.to_numpy() * E_V


def assert_agreement(solved, peer, buses):
    volts = peer.solve()
    assert [solved.u[name] for name in buses] == pytest.approx([volts[bus] for bus in buses.values()], rel=1e-6)


def lay(peer, places, ohm_per_km):
    """Lay one contact line through places {name: km}; return the bus of each."""
    buses = {name: peer.bus() for name in places}
    names = sorted(places, key=places.get)
    for a, b in pairwise(names):
        peer.resistance(buses[a], buses[b], ohm_per_km * (places[b] - places[a]))
    return buses


@pytest.mark.parametrize(
    "loads",
    [
        {"x": (10.0, 4000.0)},
        {"x": (10.0, 8000.0)},
        {"x": (3.0, 2500.0), "y": (8.0, 1500.0), "z": (17.0, 3000.0)},
        {"x": (5.0, 3000.0), "y": (12.0, -2500.0)},
        {"x": (5.0, -900.0)},
    ],
)
def test_single_line(loads):
    solved = Solved(*single_line([tap(n, km, kw=kw, fold_back_from_v=3900.0) for n, (km, kw) in loads.items()], conducts="both"))
    peer = Peer()
    buses = lay(peer, {"A": 0.0, "B": 20.0} | {name: km for name, (km, _) in loads.items()}, 0.06)
    for name in "AB":
        peer.source(buses[name], 0.12)
    for name, (_, kw) in loads.items():
        peer.load(buses[name], kw)
    assert_agreement(solved, peer, buses)


@pytest.mark.parametrize("seed", range(4))
def test_two_tracks_with_cabins_and_a_ring_of_feeders(seed):
    rng = np.random.default_rng(seed)
    kms = {"A": 0.0, "B": 14.0, "D": 30.0}
    ohms = {name: float(rng.uniform(0.05, 0.2)) for name in kms}
    feeder = 0.02
    cabins = {"C": 7.0, "F": 21.0}
    loads = {
        f"L{k}": (str(rng.integers(1, 3)), float(rng.uniform(0.5, 29.5)), float(rng.uniform(-800.0, 2500.0))) for k in range(8)
    }
    supply = Supply(
        substations=tuple(
            Substation(id=n, km=km, no_load_voltage_v=E_V, internal_resistance_ohm=ohms[n], conducts="both",
                       feeder_resistance_ohm=feeder)
            for n, km in kms.items()
        ),
        section_cabins=tuple(SectionCabin(id=name, km=km) for name, km in cabins.items()),
        contact_lines=(ContactLine(from_km=0.0, to_km=30.0, resistance_ohm_per_km=0.055),),
        return_circuit=(ReturnCircuit(from_km=0.0, to_km=30.0, resistance_ohm_per_km=0.0),),
        loads=tuple(tap(n, km, track=t, kw=kw, fold_back_from_v=3900.0) for n, (t, km, kw) in loads.items()),
    )  # fmt: skip
    solved = Solved(supply, Line(tracks=tuple(Track(id=t, from_km=0.0, to_km=30.0) for t in "12")))

    peer = Peer()
    buses = {name: peer.bus() for name in (*kms, *cabins)}
    for name in kms:
        peer.source(buses[name], ohms[name])
    cuts = sorted([*kms.items(), *cabins.items()], key=lambda item: item[1])
    for track in "12":
        for (first, low), (second, high) in pairwise(cuts):
            ends = []
            for name in (first, second):
                if name in cabins:
                    ends.append(buses[name])
                else:
                    ends.append(peer.bus())
                    peer.resistance(buses[name], ends[-1], feeder)
            last, last_km = ends[0], low
            for name, (_, km, kw) in sorted(loads.items(), key=lambda item: item[1][1]):
                if loads[name][0] == track and low < km < high:
                    buses[name] = peer.bus()
                    peer.load(buses[name], kw)
                    peer.resistance(last, buses[name], 0.055 * (km - last_km))
                    last, last_km = buses[name], km
            peer.resistance(last, ends[1], 0.055 * (high - last_km))
    assert_agreement(solved, peer, {name: bus for name, bus in buses.items() if name not in cabins})
