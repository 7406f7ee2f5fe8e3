"""Random networks against the dense reference: the same voltages, rail potentials and currents, and every node balances.

TRACTIONPOWER_RANDOM_NETWORKS sets the number of draws, 2000 if left out; the long profile of the benchmarks is 100000.

Left out of the comparison of voltages, for a reason each:

* loads that no source reaches: their stretch floats, only the differences within it mean something;
* stretches of contact line in which no port carries more than 1 mA: only the tiny conductance of blocked rectifiers
  holds their voltage, and 1e-9 S beside 1e5 S is lost in rounding (volts); their currents are checked.

Draws where the reference finds two solutions from its two starts are counted as ambiguous and must stay rare. Draws
that cannot be served (a share of those with ``limits: none``) must be so for both.
"""

import os
from collections import Counter

import numpy as np
import pytest
from dense_reference import ROUNDING, DenseSolver, Ports, balance
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from random_networks import Draw, draw_network
from solved import LIMITS, Solved

from tractionpower.alignment.checks import check_line
from tractionpower.kernels.network import CONVERGED, FLAG_A, NOT_SERVABLE, TOLERANCE_A
from tractionpower.kernels.tables import BLOCKED_CONDUCTANCE_S
from tractionpower.supply.checks import check_supply

DRAWS = int(os.environ.get("TRACTIONPOWER_RANDOM_NETWORKS", "2000"))
CHUNKS = 4
VOLTAGE_V = 1e-4
CURRENT_A = 1e-2
IDLE_A = 1e-3


def busy_parts(network, solver, u):
    """Return for both sides of every live port the part of the wires they hang on, and the parts in which something flows."""
    currents = np.abs(solver.currents(u, 1.0)[0])
    ends = [*network.source, *network.load[network.live]]
    part = np.array([[network.wire_part[i], network.wire_part[j]] for i, j in ends], int).reshape(-1, 2)
    return part, {int(p) for p in part.ravel() if currents[(part == p).any(axis=1)].max() > IDLE_A}


def compare(seed, tally):
    """Solve one draw both ways."""
    supply, line, network = draw_network(*seed)
    dense, ours = DenseSolver(network), Solved(supply, line, expect=None)
    live = np.concatenate([np.ones(len(network.sources), bool), network.live])
    tally["all"] += 1
    direct, continued = dense.solve()
    if direct is None or continued is None:
        tally["one start"] += continued is not None or direct is not None
        direct = continued = continued if direct is None else direct
    if direct is None and ours.status == CONVERGED:
        tally["no reference"] += 1
        check_kirchhoff(network, ours)
        return
    if direct is None or not dense.servable(dense.voltages(direct)):
        assert ours.status == NOT_SERVABLE
        assert ours.factor < 1.0
        tally["not servable"] += 1
        return
    expected, other = dense.voltages(direct), dense.voltages(continued)
    part, busy = busy_parts(network, dense, expected)
    held = np.isin(part, list(busy)).all(axis=1)
    if not np.allclose(expected[held], other[held], rtol=0.0, atol=VOLTAGE_V):
        tally["ambiguous"] += 1
        return
    assert ours.status == CONVERGED
    assert ours.worst <= (FLAG_A if has_hard_ceiling(network) else TOLERANCE_A)
    u = np.array([ours.u[name] for name in ours.names])[live]
    np.testing.assert_allclose(u[held], expected[held], rtol=0.0, atol=VOLTAGE_V)
    check_kirchhoff(network, ours)
    compare_rails(network, ours, direct, tally)
    compare_links(network, ours, direct, busy, tally)
    tally["compared"] += int(held.sum())
    tally["idle or dead"] += len(live) - int(held.sum())


def compare_rails(network, ours, v, tally):
    """Potentials against earth, where a source feeds the part of the network."""
    for (tracks, km), volts in ours.rails.items():
        at = network.node(network.rail(tracks.split()[0], km))
        assert at < 0 or network.earthed[at], (tracks, km)
        if at >= 0 and network.fed[at]:
            assert volts == pytest.approx(v[at], rel=0.0, abs=VOLTAGE_V), (tracks, km)
            tally["rails"] += 1


def compare_links(network, ours, v, busy, tally):
    """Currents of feeders and switches, where something flows."""
    pairs = network.load
    load_a = network.live * Ports(network).demands(v[pairs[:, 0]] - v[pairs[:, 1]])[0]
    for name, ampere in ours.links.items():
        if name not in network.links:
            assert abs(ampere) < IDLE_A, name
            continue
        expected, at = network.link_a(name, v, load_a), network.node(network.links[name][0])
        if expected is not None and at >= 0 and network.fed[at] and (name.endswith("return") or network.wire_part[at] in busy):
            assert ampere == pytest.approx(expected, rel=1e-6, abs=CURRENT_A), name
            tally["links"] += 1


def has_hard_ceiling(network):
    """Tell whether a ramp one millivolt wide is so steep that rounding of a voltage costs more than the tolerance."""
    return any(load.fold_back_from_v and load.fold_back_from_v >= network.voltages.u_max2 for load in network.loads)


def check_kirchhoff(network, ours):
    """Every node balances, by the solver's own account of its flows and by the reference's matrix.

    Within 1e-6 A, but for rounding: a potential of 3600 V is known to 1e-11 V or so, and a metre of rail conducts 1e5 S.
    """
    v = our_potentials(network, ours)
    noise = ROUNDING * np.abs(v).max(initial=0.0) * np.abs(network.g).sum(axis=1)
    accepted = FLAG_A if has_hard_ceiling(network) else TOLERANCE_A
    floating = len(set(network.wire_part)) * BLOCKED_CONDUCTANCE_S * network.voltages.u_max2  # of pins and blocked rectifiers
    ends = np.concatenate([network.source, network.load])
    shared = np.bincount(ends.ravel(), minlength=len(v))  # ports of a node, each of which balances by itself
    if network.earth >= 0:
        shared[network.earth] = len(v) + len(ends)  # what all other nodes leave over
    _, inside, worst, _ = ours.flows()
    assert max(inside, worst) <= accepted * shared.max(initial=1) + noise.max(initial=0.0) + floating
    u = np.array([ours.u[name] for name in ours.names])
    np.testing.assert_allclose(u, v[ends[:, 0]] - v[ends[:, 1]], rtol=0.0, atol=1e-5 if has_hard_ceiling(network) else 1e-6)
    assert np.all(np.abs(balance(network, v, u)) <= accepted * np.maximum(shared, 1) + noise + floating)


def our_potentials(network, ours):
    """Return the potentials that the solver found, in the reference's order of nodes; remote earth has none."""
    tables, work = ours.tables, ours.work
    known = {network.earth: 0.0}
    probes = len(ours.network.ports) - len(tables.substations) - len(tables.loads)
    places = tables.sections[: len(tables.sections) - probes]
    seen, count = Counter(), Counter(places)
    for place, (contact, rail, _) in zip(places, tables.section_table.tolist(), strict=False):
        sides = network.places.sides(*place)
        if count[place] == 2:  # the low side comes first
            sides = [sides[seen[place]]]
            seen[place] += 1
        if contact < 0:  # nothing feeds it
            continue
        known |= {network.node(side): work.node_v[contact] for side in sides}
        known[network.node(network.rail(*place))] = work.node_v[rail]
    for station, (positive, negative) in zip(tables.substations, tables.busbar, strict=True):
        if positive >= 0:
            known[network.node(("positive", station.id))] = work.node_v[positive]
            known[network.node(("negative", station.id))] = work.node_v[negative]
    for load, port in zip(network.loads, tables.load_port, strict=True):
        for name, side in zip(network.load_node(load), work.sides[port], strict=True):
            known[network.node(name)] = side["node_v"]
    known.pop(-1, None)
    v = np.zeros(len(network.index))
    here = np.array(sorted(known), int)
    v[here] = [known[k] for k in here]
    rest = np.setdiff1d(np.arange(len(v)), here)
    if len(rest):  # rails without contact line and busbars of cabins, which the tables do not list
        v[rest] = np.linalg.lstsq(network.g[np.ix_(rest, rest)], -network.g[np.ix_(rest, here)] @ v[here], rcond=None)[0]
    return v


@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_random_networks_agree_with_the_reference(chunk):
    tally = Counter()

    @settings(
        max_examples=DRAWS // CHUNKS, derandomize=True, deadline=None, database=None,
        phases=[Phase.generate], suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(seed=st.integers(0, 2**63 - 1))
    def check(seed):
        compare((chunk, seed), tally)

    check()
    assert tally["all"] >= 0.99 * (DRAWS // CHUNKS)
    assert tally["ambiguous"] < 0.02 * tally["all"], tally
    assert tally["one start"] <= 0.01 * tally["all"], tally
    assert tally["no reference"] <= 0.002 * tally["all"], tally
    assert tally["not servable"] < 0.1 * tally["all"], tally
    assert tally["compared"] > 4 * tally["all"], tally


@pytest.mark.parametrize("seed", range(40))
def test_the_draws_are_valid(seed):
    supply, line, _ = draw_network(seed)
    assert [
        str(problem) for problem in (*check_line(line), *check_supply(supply, line, LIMITS)) if problem.severity == "error"
    ] == []


def test_the_draws_meet_everything_that_can_be():
    seen = Counter()
    for seed in range(300):
        supply, line, network = draw_network(seed)
        seen.update(("substation", s.state, s.conducts) for s in supply.substations)
        seen.update(("cabin", c.state) for c in supply.section_cabins)
        seen.update(("point", p.state) for p in supply.section_points)
        seen.update(("load", load.limits, load.power_kw is None) for load in supply.loads)
        seen["hard ceiling"] += any(load.fold_back_from_v == 1.3 * Draw(seed).u_n for load in supply.loads)
        seen["zero feeder"] += any(s.feeder_resistance_ohm == 0.0 for s in supply.substations)
        seen["zero rails"] += any(row.resistance_ohm_per_km == 0.0 for row in supply.return_circuit)
        seen.update(("feeder", row.side, row.state) for row in supply.feeders)
        seen.update(("switch", row.state, row.resistance_ohm == 0.0) for row in supply.switches)
        seen.update(("device to earth", row.state) for row in supply.voltage_limiting_devices)
        seen.update(("earthing", row.substation is None) for row in supply.earthing)
        seen.update(("bonds", row.resistance_ohm == 0.0) for row in supply.bonds)
        seen["distant feeder"] += any(row.km is not None for row in supply.feeders)
        seen["busbar switched"] += any(None in (row.from_.track, row.to.track) for row in supply.switches)
        seen["leaky"] += any(row.leakage_s_per_km > 0.0 for row in supply.return_circuit)
        seen["earthed and not"] += 0 < network.earthed.sum() < len(network.earthed)
        seen["fewer units"] += any(s.units_in_service not in (None, 0, s.units) for s in supply.substations)
        seen["no unit"] += any(s.units_in_service == 0 for s in supply.substations)
        seen["cabin with feeders"] += any(c.feeder_resistance_ohm > 0.0 for c in supply.section_cabins)
        loops = len(line.connections) - len({connection.from_.track for connection in line.connections})
        seen["ring"] += loops > 0
        seen["tree"] += bool(line.connections) and loops == 0
        seen["island"] += len({track.id[0] for track in line.tracks if track.id[0] in "abc"}) > len(line.connections)
        seen.update("jump back" if b.continues_as_km < b.at_km else "jump" for b in line.chainage_breaks)
        seen["per track"] += len(supply.return_circuit) > 1
        seen["four tracks"] += len(line.tracks) == 4
        seen["dead loads"] += not network.live.all()
        kms = sorted(load.km for load in supply.loads)
        gaps = np.diff(kms)
        seen["same place"] += bool(np.any(gaps == 0.0))
        seen["below a metre"] += bool(np.any((gaps > 0.0) & (gaps < 0.001)))
        seen["much power"] += sum(abs(load.power_kw or 0.0) for load in supply.loads) > 40e3
    assert len([key for key in seen if key[0] == "substation"]) == 8
    assert len([key for key in seen if key[0] == "cabin"]) == 3
    assert len([key for key in seen if key[0] == "point"]) == 2
    assert len([key for key in seen if key[0] == "load"]) == 4
    assert len([key for key in seen if key[0] == "feeder"]) == 6
    assert len([key for key in seen if key[0] == "switch"]) == 4
    assert len([key for key in seen if key[0] in ("device to earth", "earthing", "bonds")]) == 6
    assert min(seen.values()) >= 5, seen


@pytest.mark.parametrize("seed", [(593,), (673,), (1378,), (1385,), (0, 2362), (1, 15014), (2, 32457)])
def test_draws_that_once_disagreed(seed):
    """Substations that float, switches between busbars, many hard ceilings, loads beside jumps of the kilometres."""
    tally = Counter()
    compare(seed, tally)
    assert tally["all"] == 1
