"""Currents of a solved network: at the ends of all conductors, losses, and the balance of every node.

This looks at the solution afresh from the node potentials, so that the balance is a check of the solver and no echo.
"""

from __future__ import annotations

from tractionpower.kernels.jit import njit
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.tables import SHARED


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
        Heat in the conductors of the spans [W].
    worst : float
        Largest imbalance of a node inside a span [A].
    """
    for k in range(balance.shape[0]):
        balance[k] = 0.0
    loss = worst = 0.0
    for s in range(network.spans.shape[0]):
        span = network.spans[s]
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            w = work.conductors[c]
            w.left_a = 0.0
            w.right_a = 0.0
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
    return loss, worst


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
    gap = abs(w.front_a - inflow) if w.open else 0.0
    if not w.open:
        w.left_a += inflow
    w.open = True
    w.front_v = side.node_v
    w.front_a = inflow - i
    return drop * inflow, gap


@njit
def _finish(conductor, w, node_v, balance):
    heat = gap = 0.0
    if conductor.ohm_per_m > 0.0:
        drop = w.front_v - node_v[conductor.right_node]
        outflow = drop * w.end_s
        heat = drop * outflow
        w.right_a -= outflow
        if w.open:
            gap = abs(w.front_a - outflow)
        else:
            w.left_a += outflow
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
