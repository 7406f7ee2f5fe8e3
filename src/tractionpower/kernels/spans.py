"""Spans: ports are inserted where they stand, the span is condensed onto its ends, and solved back from there.

One sweep from left to right keeps a small *frontal matrix* over the terminals of the left end and the present front
node of every conductor. Where a port stands, only the two conductors that it touches move on; the node left behind is
eliminated at once. The cost is linear in the number of ports and independent of the conductors that nobody touches.
A leaky conductor is cut into pi-elements by its nodes; they are exact for any length (`pi_element`).
Slots of the frontal matrix, both triangles: terminals of the right end, of the left end, fronts, ground (a dummy).
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.tables import FIRST, NEXT, SHARED, SHARED_NODE_M

SHORT_ANGLE, LONG_ANGLE = 1e-8, 700.0
"""Electric lengths a l: below it does not matter that a conductor leaks, above nothing gets through and sinh overflows."""


@njit
def place_ports(network, work):
    """Sort the ports of the spans by place and compute all that depends on their places only."""
    ports, conductor_work = network.ports, work.conductors
    _sort_ports(ports, work.order, work.in_service[0])
    _clear_spans(network, work)
    base = work.step_base
    for k in range(base.shape[0]):
        base[k] = network.base[k]
    for k in range(work.in_service[0]):
        p = work.order[k]
        port = ports[p]
        if port.span < 0:
            continue
        span, length = work.spans[port.span], network.spans[port.span].length_m
        if span.ports == 0:
            span.first_port = k
        span.ports += 1
        for m in range(2):
            c = port.positive if m == 0 else port.negative
            work.sides[p, m].conductor = c
            _attach(network.conductors[c], conductor_work[c], work.sides[p, m], port.x_m, length)
            if work.sides[p, m].insertion == FIRST:
                _withdraw(network.conductors[c], base)
    _finish_conductors(network, work)


@inlined
def _clear_spans(network, work):
    for s in range(network.spans.shape[0]):
        if work.spans[s].ports > 0:
            span = network.spans[s]
            work.spans[s].ports = 0
            for c in range(span.first_conductor, span.first_conductor + span.conductors):
                work.conductors[c].last_m = 0.0
                work.conductors[c].nodes = 0


@inlined
def _withdraw(conductor, base):
    """Take a conductor that ports stand on out of the skeleton: its span brings it in."""
    left, right = conductor.left_node, conductor.right_node
    base[left] -= conductor.whole_shunt_s
    base[right] -= conductor.whole_shunt_s
    if left != right:
        base[left] -= conductor.whole_s
        base[right] -= conductor.whole_s
        base[conductor.coupling] += conductor.whole_s


@njit
def _sort_ports(ports, order, count):
    # Insertion: from one step to the next the order hardly changes.
    last_span, last_x = -1, 0.0
    for k in range(count):
        p = order[k]
        span, x = ports[p].span, ports[p].x_m
        if span > last_span or (span == last_span and x >= last_x):
            last_span, last_x = span, x
            continue
        m = k - 1
        while m >= 0 and (ports[order[m]].span > span or (ports[order[m]].span == span and ports[order[m]].x_m > x)):
            order[m + 1] = order[m]
            m -= 1
        order[m + 1] = p


@inlined
def _attach(conductor, w, side, x, length):
    side.insertion = SHARED
    if conductor.ohm_per_m == 0.0 or x < SHARED_NODE_M:
        side.slot = conductor.left_slot
    elif length - x < SHARED_NODE_M:
        side.slot = conductor.right_slot
    else:
        side.slot = conductor.front_slot
        if w.nodes == 0 or x - w.last_m >= SHARED_NODE_M:
            side.insertion = FIRST if w.nodes == 0 else NEXT
            side.conductance_s, side.shunt_s = pi_element(conductor, x - w.last_m)
            w.last_m = x
            w.nodes += 1


@inlined
def pi_element(conductor, length):
    """Return conductance and shunt at either end [S] of the pi-element that stands for a `length` [m] of a conductor.

    Exact for r ohm/m and g S/m: 1/(Z sinh(a l)) and tanh(a l/2)/Z with a = sqrt(r g), Z = sqrt(r/g) (telegraph equation).
    """
    r, g = conductor.ohm_per_m, conductor.siemens_per_m
    if g == 0.0:
        return 1.0 / (r * length), 0.0
    angle = np.sqrt(r * g) * length
    if angle < SHORT_ANGLE:
        return 1.0 / (r * length), 0.5 * g * length
    z = np.sqrt(r / g)
    return 1.0 / (z * np.sinh(min(angle, LONG_ANGLE))), np.tanh(0.5 * angle) / z


@njit
def _finish_conductors(network, work):
    """List the spans with ports; set the last element of every conductor that ports stand on, and where their rows begin."""
    row = count = 0
    for s in range(network.spans.shape[0]):
        span, span_work = network.spans[s], work.spans[s]
        if span_work.ports == 0:
            continue
        work.active[count] = s
        count += 1
        span_work.stale = True
        span_work.first_row = row
        row += 2 * span_work.ports + span.conductors
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            w = work.conductors[c]
            if w.nodes > 0:
                w.end_s, w.end_shunt_s = pi_element(network.conductors[c], span.length_m - w.last_m)
    work.in_service[1] = count


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
        _clear(work.front.reshape(work.front.size))  # what the sweep left there when it gave up
        return False
    for n in range(work.in_service[1]):
        span = spans[work.active[n]]
        ends = span.right_terminals + span.left_terminals
        for i in range(span.first_terminal, span.first_terminal + ends):
            node_v[terminals[i]] += condensed_b[i]
        for k in range(span.first_scatter, span.first_scatter + ends * (ends + 1) // 2):
            value[scatter[k]] += condensed[k]
    return True


@njit
def _sweep(network, work):
    """Condense the stale spans; return whether all pivots were positive.

    The frontal matrix is clear before each span and left so: what is eliminated or taken is cleared on the way.
    """
    front, b, rows, order = work.front, work.front_b, work.row, work.order
    conductors, conductor_work = network.conductors, work.conductors
    for n in range(work.in_service[1]):
        span, span_work = network.spans[work.active[n]], work.spans[work.active[n]]
        if not span_work.stale:
            continue
        ends = span.right_terminals + span.left_terminals
        slots = ends + span.fronts
        _clear(b)
        row = span_work.first_row
        for k in range(span_work.first_port, span_work.first_port + span_work.ports):
            p = order[k]
            for m in range(2):
                side = work.sides[p, m]
                if side.insertion == FIRST:
                    left = conductors[side.conductor].left_slot
                    _join(front, side.slot, left, side.conductance_s)
                    if side.shunt_s > 0.0:
                        front[side.slot, side.slot] += side.shunt_s
                        front[left, left] += side.shunt_s
                elif side.insertion == NEXT:
                    if not _advance(front, b, rows[row], side, slots):
                        return False
                    row += 1
            w, i, j = work.ports[p], work.sides[p, 0].slot, work.sides[p, 1].slot
            _join(front, i, j, w.g)
            b[i] -= w.j
            b[j] += w.j
        for k in range(span.conductors):
            c = span.first_conductor + span.conductors - 1 - k
            if conductor_work[c].nodes > 0:
                f, right = conductors[c].front_slot, conductors[c].right_slot
                _join(front, f, right, conductor_work[c].end_s)
                if conductor_work[c].end_shunt_s > 0.0:
                    front[f, f] += conductor_work[c].end_shunt_s
                    front[right, right] += conductor_work[c].end_shunt_s
                if not _eliminate(front, b, rows[row], f):
                    return False
                row += 1
        for k in range(slots + 1):  # ground
            front[k, slots] = front[slots, k] = 0.0
        _take(front, b, ends, work.condensed[span.first_scatter :], work.condensed_b[span.first_terminal :])
        span_work.stale = False
    return True


@inlined
def _clear(values):
    for k in range(values.shape[0]):
        values[k] = 0.0


@inlined
def _take(front, b, ends, condensed, condensed_b):
    """Move what is left in the frontal matrix, the terminals, to where the span is kept."""
    k = 0
    for i in range(ends):
        condensed_b[i] = b[i]
        for j in range(i + 1):
            condensed[k] = front[i, j]
            front[i, j] = front[j, i] = 0.0
            k += 1


@inlined
def _join(front, i, j, conductance):
    """Put a conductance between two slots."""
    front[i, i] += conductance
    front[j, j] += conductance
    front[i, j] -= conductance
    front[j, i] -= conductance


@inlined
def _advance(front, b, row, side, slots):
    """Move the front of one conductor to a new node in the same slot; eliminate the node that it leaves.

    With d the pivot, the new node has ``g F_ff/d`` on the diagonal and ``g F_fp/d`` towards slot p: no differences.
    """
    f, conductance = side.slot, side.conductance_s
    own, b_f = front[f, f] + side.shunt_s, b[f]
    d = own + conductance
    if not d > 0.0:
        return False
    inverse = 1.0 / d
    for p in range(slots):
        row[p] = front[f, p] * inverse
    for p in range(slots):
        entry = front[p, f]
        if entry != 0.0:
            for q in range(slots):
                front[p, q] -= entry * row[q]
            b[p] -= row[p] * b_f
    share = conductance * inverse
    for p in range(slots):
        front[f, p] = conductance * row[p]
        front[p, f] = conductance * row[p]
    front[f, f] = own * share + side.shunt_s
    row[f] = -share
    row[row.shape[0] - 1] = b_f * inverse
    b[f] = share * b_f
    return True


@inlined
def _eliminate(front, b, row, f):
    """Eliminate slot `f`, the last one that is still coupled, and clear it."""
    d, b_f = front[f, f], b[f]
    if not d > 0.0:
        return False
    inverse = 1.0 / d
    for p in range(f):
        row[p] = front[f, p] * inverse
        front[f, p] = 0.0
    for p in range(f):
        entry = front[p, f]
        if entry != 0.0:
            front[p, f] = 0.0
            for q in range(f):
                front[p, q] -= entry * row[q]
            b[p] -= row[p] * b_f
    row[row.shape[0] - 1] = b_f * inverse
    front[f, f] = 0.0
    return True


@njit
def expand(network, work):
    """From the potentials of the skeleton compute the voltages of all ports in spans [V]."""
    x, rows, order = work.front_b, work.row, work.order
    conductors, conductor_work, terminals, node_v = network.conductors, work.conductors, network.terminals, work.node_v
    for n in range(work.in_service[1]):
        span, span_work = network.spans[work.active[n]], work.spans[work.active[n]]
        ends = span.right_terminals + span.left_terminals
        slots = ends + span.fronts
        for i in range(ends):
            x[i] = node_v[terminals[span.first_terminal + i]]
        for i in range(ends, slots + 1):
            x[i] = 0.0
        row = span_work.first_row
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            row += conductor_work[c].nodes  # every inserted node is eliminated once: when left, or at the right end
        for c in range(span.first_conductor, span.first_conductor + span.conductors):
            if conductor_work[c].nodes > 0:
                f = conductors[c].front_slot
                row -= 1
                x[f] = _eliminated(rows[row], x, 0, f)
        for k in range(span_work.ports):
            p = order[span_work.first_port + span_work.ports - 1 - k]
            for m in range(2):
                side = work.sides[p, 1 - m]
                side.node_v = x[side.slot]
                if side.insertion == NEXT:
                    row -= 1
                    x[side.slot] = _eliminated(rows[row], x, 0, slots)
            work.ports[p].u_next = work.sides[p, 0].node_v - work.sides[p, 1].node_v


@inlined
def _eliminated(row, x, first, end):
    """Return the potential of an eliminated node from those of the slots that it was coupled with."""
    v = row[row.shape[0] - 1]
    for q in range(first, end):
        v -= row[q] * x[q]
    return v
