"""Currents of a solved network: at the ends of all conductors, losses, and the balance of every node.

This looks at the solution afresh from the node potentials, so that the balance is a check of the solver and no echo.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.tables import EDGE_CURRENT, LEFT_END, PORT_CURRENT, SHARED


@njit
def conductor_flows(network, work, balance):
    """Compute the end currents of every conductor.

    Parameters
    ----------
    network, work
        A solved network.
    balance : ndarray, shape (nodes + 1,)
        Out: sum of the currents that leave each skeleton node [A], ground last.

    Returns
    -------
    loss : float
        Heat in the conductors of the spans and in their leakage [W].
    worst : float
        Largest imbalance of a node inside a span [A].
    leaked : float
        Current that leaves the conductors for earth [A]; what comes back elsewhere is not counted.
    """
    for k in range(balance.shape[0]):
        balance[k] = 0.0
    loss = worst = leaked = 0.0
    ground = balance.shape[0] - 1
    for s in range(network.spans.shape[0]):
        span = network.spans[s]
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            w = work.conductors[c]
            w.left_a = 0.0
            w.right_a = 0.0
            w.earth_a = 0.0
            w.leaked_a = 0.0
            w.front_v = work.node_v[network.conductors[c].left_node]
            w.front_a = 0.0
            w.open = False
        for k in range(work.spans[s].first_port, work.spans[s].first_port + work.spans[s].ports):
            p = work.order[k]
            i = port_current(network.segments, network.ports[p], work.ports[p].u)
            heat, gap = _insert(network, work, work.sides[p, 0], i)
            loss += heat
            worst = max(worst, gap)
            heat, gap = _insert(network, work, work.sides[p, 1], -i)
            loss += heat
            worst = max(worst, gap)
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            heat, gap = _finish(network.conductors[c], work.conductors[c], work.node_v, balance)
            loss += heat
            worst = max(worst, gap)
            leaked += work.conductors[c].leaked_a
            balance[ground] -= work.conductors[c].earth_a
    return loss, worst, leaked


@njit
def _insert(network, work, side, i):
    """Pass one side of a port, which takes the current `i` [A]; return heat [W] and imbalance [A] of what lies behind."""
    conductor, w = network.conductors[side.conductor], work.conductors[side.conductor]
    if side.insertion == SHARED:
        if side.slot == conductor.front_slot:
            w.front_a -= i
        elif side.slot == conductor.left_slot:
            w.left_a += i
        else:
            w.right_a += i
        return 0.0, 0.0
    drop = w.front_v - side.node_v
    inflow = drop * side.conductance_s
    leaves, enters = _leak(w, side.conductance_s, side.shunt_s, w.front_v, side.node_v)
    gap = abs(w.front_a - inflow - leaves) if w.open else 0.0
    heat = drop * inflow + leaves * w.front_v + enters * side.node_v
    if not w.open:
        w.left_a += inflow + leaves
    w.open = True
    w.front_v = side.node_v
    w.front_a = inflow - enters - i
    return heat, gap


@inlined
def _leak(w, conductance, shunt, before_v, after_v):
    """Return the currents into earth at the two ends of an element, and count what leaves where the potential is positive.

    Where the potential changes its sign, the part up to there counts: tanh(a x/2)/Z V with tanh(a x) = sinh(a l)/(cosh(a l)
    - V'/V), for ends V > 0 > V'; a, Z and l are in the two conductances of the element (`kernels.spans.pi_element`).
    """
    before, after = shunt * before_v, shunt * after_v
    w.earth_a += before + after
    high, low = max(before_v, after_v), min(before_v, after_v)
    if low >= 0.0:
        w.leaked_a += before + after
    elif high > 0.0 and shunt > 0.0:
        whole = (high - low) * conductance + high * shunt
        part = high * high * shunt * (2.0 * conductance + shunt)
        w.leaked_a += part / (whole + np.sqrt(max(whole * whole - part, 0.0)))
    return before, after


@njit
def _finish(conductor, w, node_v, balance):
    heat = gap = 0.0
    left_v, right_v = node_v[conductor.left_node], node_v[conductor.right_node]
    if conductor.ohm_per_m > 0.0:
        conductance, shunt = w.end_s, w.end_shunt_s
        if w.nodes == 0:
            conductance, shunt = conductor.whole_s, conductor.whole_shunt_s
        drop = w.front_v - right_v
        leaves, enters = _leak(w, conductance, shunt, w.front_v, right_v)
        inflow = drop * conductance
        heat = drop * inflow + leaves * w.front_v + enters * right_v
        w.right_a -= inflow - enters
        if w.open:
            gap = abs(w.front_a - inflow - leaves)
        else:
            w.left_a += inflow + leaves
    else:
        leaves, enters = _leak(w, 0.0, conductor.whole_shunt_s, left_v, right_v)
        heat = leaves * left_v + enters * right_v
        w.left_a += leaves
        w.right_a += enters
    balance[conductor.left_node] += w.left_a
    balance[conductor.right_node] += w.right_a
    return heat, gap


@njit
def skeleton_balance(network, work, edges, balance):
    """Add ports and fixed resistances between skeleton nodes to `balance`; return their heat [W] and the worst node [A]."""
    heat = 0.0
    for p in range(network.ports.shape[0]):
        port = network.ports[p]
        if port.span < 0:
            i = port_current(network.segments, port, work.ports[p].u)
            balance[port.positive] += i
            balance[port.negative] -= i
    for e in range(edges.shape[0]):
        edge = edges[e]
        drop = work.node_v[edge.first] - work.node_v[edge.second]
        i = drop * edge.conductance_s
        heat += drop * i
        balance[edge.first] += i
        balance[edge.second] -= i
    worst = 0.0
    for n in range(balance.shape[0]):
        worst = max(worst, abs(balance[n]))
    return heat, worst


@njit
def link_current(links, terms, k, work, edges, ports, segments):
    """Return the current of link `k` [A]: what the balance of the nodes on one of its sides leaves for it."""
    total = 0.0
    for t in range(links[k].first_term, links[k].first_term + links[k].terms):
        term = terms[t]
        if term.kind == EDGE_CURRENT:
            edge = edges[term.index]
            i = (work.node_v[edge.first] - work.node_v[edge.second]) * edge.conductance_s
        elif term.kind == PORT_CURRENT:
            i = port_current(segments, ports[term.index], work.ports[term.index].u)
        elif term.kind == LEFT_END:
            i = work.conductors[term.index].left_a
        else:
            i = work.conductors[term.index].right_a
        total += term.sign * i
    return total
