"""Spans: ports are inserted where they stand, the span is condensed onto its ends, and solved back from there.

One sweep from left to right keeps a small *frontal matrix* over the terminals of the left end and the present front
node of every conductor. Where a port stands, only the two conductors that it touches move on; the node left behind is
eliminated at once. The cost is linear in the number of ports and independent of the conductors that nobody touches.
Slots of the frontal matrix, lower triangle: terminals of the right end, of the left end, fronts, ground (a dummy).
"""

from __future__ import annotations

from tractionpower.kernels.jit import njit
from tractionpower.kernels.tables import FIRST, NEXT, SHARED, SHARED_NODE_M


@njit
def place_ports(network, work):
    """Sort the ports of the spans by place and compute all that depends on their places only."""
    _sort_ports(network.ports, work.order)
    for s in range(network.spans.shape[0]):
        work.spans[s].ports = 0
        work.spans[s].stale = True
    for c in range(network.conductors.shape[0]):
        work.conductors[c].last_m = 0.0
        work.conductors[c].nodes = 0
    for k in range(work.order.shape[0]):
        p = work.order[k]
        port = network.ports[p]
        span = work.spans[port.span]
        if span.ports == 0:
            span.first_port = k
        span.ports += 1
        _attach(network, work, work.sides[p, 0], port.positive, port)
        _attach(network, work, work.sides[p, 1], port.negative, port)
    _finish_conductors(network, work)


@njit
def _sort_ports(ports, order):
    # Insertion: from one step to the next the order hardly changes.
    for k in range(1, order.shape[0]):
        p = order[k]
        span, x = ports[p].span, ports[p].x_m
        m = k - 1
        while m >= 0 and (ports[order[m]].span > span or (ports[order[m]].span == span and ports[order[m]].x_m > x)):
            order[m + 1] = order[m]
            m -= 1
        order[m + 1] = p


@njit
def _attach(network, work, side, c, port):
    conductor, w = network.conductors[c], work.conductors[c]
    x = port.x_m
    side.conductor = c
    side.insertion = SHARED
    if conductor.ohm_per_m == 0.0 or x < SHARED_NODE_M:
        side.slot = conductor.left_slot
    elif network.spans[port.span].length_m - x < SHARED_NODE_M:
        side.slot = conductor.right_slot
    else:
        side.slot = conductor.front_slot
        if w.nodes == 0 or x - w.last_m >= SHARED_NODE_M:
            side.insertion = FIRST if w.nodes == 0 else NEXT
            side.conductance_s = 1.0 / (conductor.ohm_per_m * (x - w.last_m))
            w.last_m = x
            w.nodes += 1


@njit
def _finish_conductors(network, work):
    """Set the last conductance of every conductor; those without ports go into the base of this step."""
    base = work.step_base
    for k in range(base.shape[0]):
        base[k] = network.base[k]
    row = 0
    for s in range(network.spans.shape[0]):
        span = network.spans[s]
        work.spans[s].first_row = row
        row += 2 * work.spans[s].ports + span.conductors
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            conductor, w = network.conductors[c], work.conductors[c]
            if conductor.ohm_per_m == 0.0:
                continue
            w.end_s = 1.0 / (conductor.ohm_per_m * (span.length_m - w.last_m))
            if w.nodes == 0 and conductor.left_node != conductor.right_node:
                base[conductor.left_node] += w.end_s
                base[conductor.right_node] += w.end_s
                base[conductor.coupling] -= w.end_s


@njit
def condense(network, work):
    """Condense all spans that carry ports onto their ends and add them to the skeleton.

    Only spans marked as stale are swept anew; the others add what they left behind.

    Returns
    -------
    bool
        Whether all pivots were positive.
    """
    condensed, condensed_b, value, node_v = work.condensed, work.condensed_b, work.value, work.node_v
    terminals, scatter, spans = network.terminals, network.scatter, network.spans
    if not _sweep(network, work):
        return False
    for s in range(spans.shape[0]):
        if work.spans[s].ports > 0:
            span = spans[s]
            ends = span.right_terminals + span.left_terminals
            for i in range(span.first_terminal, span.first_terminal + ends):
                node_v[terminals[i]] += condensed_b[i]
            for k in range(span.first_scatter, span.first_scatter + ends * (ends + 1) // 2):
                value[scatter[k]] += condensed[k]
    return True


@njit
def _sweep(network, work):
    """Condense the stale spans; return whether all pivots were positive."""
    front, b, rows = work.front, work.front_b, work.row
    ports, sides, order = work.ports, work.sides, work.order
    conductors, conductor_work = network.conductors, work.conductors
    condensed, condensed_b = work.condensed, work.condensed_b
    for s in range(network.spans.shape[0]):
        span, span_work = network.spans[s], work.spans[s]
        if span_work.ports == 0 or not span_work.stale:
            continue
        first, ends = span.right_terminals, span.right_terminals + span.left_terminals
        slots = ends + span.fronts
        for p in range(slots + 1):
            b[p] = 0.0
            for q in range(p + 1):
                front[p, q] = 0.0
        row = span_work.first_row
        for k in range(span_work.first_port, span_work.first_port + span_work.ports):
            p = order[k]
            for m in range(2):
                side = sides[p, m]
                if side.insertion == FIRST:
                    _join(front, side.slot, conductors[side.conductor].left_slot, side.conductance_s)
                elif side.insertion == NEXT:
                    if not _advance(front, b, rows, row, side.slot, side.conductance_s, first, slots):
                        return False
                    row += 1
            i, j = sides[p, 0].slot, sides[p, 1].slot
            _join(front, i, j, ports[p].g)
            b[i] -= ports[p].j
            b[j] += ports[p].j
        for c in range(span.first_conductor + span.conductors - 1, span.first_conductor - 1, -1):
            if conductor_work[c].nodes > 0:
                f = conductors[c].front_slot
                _join(front, f, conductors[c].right_slot, conductor_work[c].end_s)
                if not _eliminate(front, b, rows, row, f):
                    return False
                row += 1
        k = span.first_scatter
        for i in range(ends):
            condensed_b[span.first_terminal + i] = b[i]
            for j in range(i + 1):
                condensed[k] = front[i, j]
                k += 1
        span_work.stale = False
    return True


@njit
def _join(front, i, j, conductance):
    """Put a conductance between two slots."""
    front[i, i] += conductance
    front[j, j] += conductance
    if i > j:
        front[i, j] -= conductance
    else:
        front[j, i] -= conductance


@njit
def _advance(front, b, rows, row, f, conductance, first, slots):
    """Move the front of one conductor to a new node in the same slot `f`; eliminate the node that it leaves.

    With d the pivot, the new node has ``g F_ff/d`` on the diagonal and ``g F_fp/d`` towards slot p: no differences.
    """
    d = front[f, f] + conductance
    if not d > 0.0:
        return False
    inverse = 1.0 / d
    share = conductance * inverse
    for p in range(first, f):
        rows[row, p] = front[f, p] * inverse
        front[f, p] *= share
    for p in range(f + 1, slots):
        rows[row, p] = front[p, f] * inverse
        front[p, f] *= share
    rows[row, f] = 0.0
    for p in range(first, slots):
        factor = rows[row, p]
        if factor != 0.0:
            for q in range(first, p + 1):
                front[p, q] -= factor * d * rows[row, q]
            b[p] -= factor * b[f]
    front[f, f] *= share
    rows[row, f] = -share
    rows[row, rows.shape[1] - 1] = b[f] * inverse
    b[f] *= share
    return True


@njit
def _eliminate(front, b, rows, row, f):
    """Eliminate slot `f`, the last one that is still coupled."""
    d = front[f, f]
    if not d > 0.0:
        return False
    inverse = 1.0 / d
    for p in range(f):
        factor = front[f, p] * inverse
        rows[row, p] = factor
        if factor != 0.0:
            for q in range(p + 1):
                front[p, q] -= factor * front[f, q]
            b[p] -= factor * b[f]
    rows[row, rows.shape[1] - 1] = b[f] * inverse
    return True


@njit
def expand(network, work):
    """From the potentials of the skeleton compute the voltages of all ports in spans [V]."""
    x, rows, sides, order = work.front_b, work.row, work.sides, work.order
    conductors, conductor_work, terminals, node_v = network.conductors, work.conductors, network.terminals, work.node_v
    last = rows.shape[1] - 1
    for s in range(network.spans.shape[0]):
        span, span_work = network.spans[s], work.spans[s]
        if span_work.ports == 0:
            continue
        first, ends = span.right_terminals, span.right_terminals + span.left_terminals
        slots = ends + span.fronts
        for i in range(ends):
            x[i] = node_v[terminals[span.first_terminal + i]]
        x[slots] = 0.0
        row = span_work.first_row - 1
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            if conductors[c].ohm_per_m > 0.0:
                x[conductors[c].front_slot] = 0.0
            row += conductor_work[c].nodes  # every inserted node is eliminated once: when left, or at the right end
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            if conductor_work[c].nodes > 0:
                f = conductors[c].front_slot
                v = rows[row, last]
                for p in range(f):
                    v -= rows[row, p] * x[p]
                x[f] = v
                row -= 1
        for k in range(span_work.first_port + span_work.ports - 1, span_work.first_port - 1, -1):
            p = order[k]
            for m in range(1, -1, -1):
                side = sides[p, m]
                side.node_v = x[side.slot]
                if side.insertion == NEXT:
                    v = rows[row, last]
                    for q in range(first, slots):
                        v -= rows[row, q] * x[q]
                    x[side.slot] = v
                    row -= 1
            work.ports[p].u_next = sides[p, 0].node_v - sides[p, 1].node_v
