"""Newton's method for the DC network: descent on its potential, from a warm start or from no load.

With node potentials V and port voltages u, Kirchhoff's equations are the gradient of
``Phi(V) = 1/2 V'G V + sum over ports of the integral of I(u) du`` with I counted as taken from the line. The linear
network is exact, so after each linear solution all that is left of the gradient sits at the ports: the difference
between what a port's characteristic demands and what the linear network carries. Everything below works on ports only.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.ports import find_segment, linearise, port_current, port_integral
from tractionpower.kernels.skeleton import factor_and_solve
from tractionpower.kernels.spans import condense, expand

TOLERANCE_A = 1e-6
"""A solution is accepted when every port balances within this current, and so every node but the reference [A]."""

FLAG_A = 1e-3
"""A step with a larger imbalance is flagged [A]."""

KEEP_A = 0.5 * TOLERANCE_A  # a tangent that meets its characteristic so closely is kept within a step
ALL = -1.0  # no tangent is kept

STALL = 3  # iterations without halving the imbalance, after which it is taken for rounding

WARM_ITERATIONS = 12
SMOOTH_V = 20.0  # a voltage that changes less from one step to the next is drawn on by a straight line
ABSURD_V = 1e5  # Newton's method has lost its way

COLD_ITERATIONS = 300
STEP_V = 300.0  # longest step of a descent
SHORTEST = 1e-9  # shortest part of a step
HUMP_W = 1e-3  # a direction that falls less is too short to lead over a hump
KINK_V = 1e-6  # so near to a kink, rounding decides the side: the larger slope counts
WIDE_KINK_V = 0.1  # many hard ceilings make a descent zigzag; so near to a kink the larger slope counts in every other
PATIENCE = 100  # iteration after these

CONVERGED, NOT_CONVERGED, NOT_SERVABLE = 0, 1, 2


@njit
def solve_linear(network, work):
    """Solve the network with every port replaced by its tangent; fill `u_next` of all ports and the node potentials.

    Returns
    -------
    bool
        Whether the matrix is positive definite. If not, nothing may be used.
    """
    value, node_v, ports, order = work.value, work.node_v, network.ports, work.order
    for k in range(value.shape[0]):
        value[k] = work.step_base[k]
    for k in range(node_v.shape[0]):
        node_v[k] = 0.0
    between = 0
    while between < work.in_service[0] and ports[order[between]].span < 0:
        port, w = ports[order[between]], work.ports[order[between]]
        value[port.positive] += w.g
        value[port.negative] += w.g
        value[port.coupling] -= w.g
        node_v[port.positive] -= w.j
        node_v[port.negative] += w.j
        between += 1
    if not condense(network, work):
        return False
    if not factor_and_solve(network.column_start, network.row, network.target, value, node_v):
        return False
    expand(network, work)
    for k in range(between):
        port = ports[order[k]]
        work.ports[order[k]].u_next = node_v[port.positive] - node_v[port.negative]
    return True


@njit
def solve_warm(network, work):
    """Solve from the port voltages at hand.

    A warm start is a shortcut and must not choose between solutions: it is refused where the matrix is not positive
    definite, where a port moves by more than one segment, and where a demand sits below half the highest no-load
    voltage, since a second stable solution can only be there.

    Returns
    -------
    iterations, worst
        Number of linear solutions, 0 when refused; largest imbalance of a port [A].
    """
    ports, order, count = work.ports, work.order, work.in_service[0]
    for k in range(count):
        w = ports[order[k]]
        _bound(network.segments, network.ports[order[k]], w)
        change = w.u - w.before_v
        w.before_v = w.u
        if abs(change) < SMOOTH_V:  # trains move on steadily: the line through the last two solutions saves an iteration
            w.u += change
    before = np.inf
    for iteration in range(WARM_ITERATIONS + 1):
        worst = linearise(network, work, 1.0, KEEP_A if iteration > 0 else ALL, KINK_V)
        if iteration > 0:
            if worst <= TOLERANCE_A or (iteration > STALL and 0.5 * before <= worst <= FLAG_A):
                return iteration, worst
            before = worst
        if not solve_linear(network, work):
            return 0, worst
        for k in range(count):
            w = ports[order[k]]
            if not w.lowest_v <= w.u_next < w.highest_v:
                return 0, worst
            w.u = w.u_next
            w.i = w.g * w.u + w.j
    return 0, np.inf


@inlined
def _bound(segments, port, w):
    """Set the range of voltages that a warm solution may take `port` to."""
    s = find_segment(segments, port, w.u)
    last = port.first_segment + port.segments - 1
    w.lowest_v = segments[s - 1].from_v if s > port.first_segment + 1 else -ABSURD_V
    if port.demand:
        w.lowest_v = max(w.lowest_v, 0.5 * port.start_v)
    w.highest_v = segments[s + 2].from_v if s + 2 <= last else ABSURD_V


@njit
def solve_cold(network, work):
    """Solve from no load by descent; it finds the stable solution with the highest voltages.

    Returns
    -------
    iterations, worst
        Number of descent steps; largest imbalance of a port [A].
    """
    for k in range(work.in_service[0]):
        w = work.ports[work.order[k]]
        w.before_v = np.inf  # nothing to draw a line through
        w.u = network.ports[work.order[k]].start_v
        w.i = 0.0
    best, stalled, worst, way = np.inf, 0, np.inf, 1.0
    for iteration in range(COLD_ITERATIONS):
        near = WIDE_KINK_V if iteration > PATIENCE and iteration % 2 else KINK_V
        worst = linearise(network, work, 1.0, ALL, near)
        stalled = 0 if worst < 0.5 * best else stalled + 1
        best = min(best, worst)
        if iteration > 0 and (worst <= TOLERANCE_A or (worst <= FLAG_A and stalled > STALL)):
            if way < 1.0:
                _recover_potentials(network, work)
            return iteration, worst
        share = 1.0
        while not solve_linear(network, work):
            if share == 0.0:  # not even without falling characteristics: not a number, or lost in rounding
                return COLD_ITERATIONS, np.inf
            share = 0.5 * share if share > 0.01 else 0.0
            linearise(network, work, share, ALL, near)
        way = _descend(network, work)
    _recover_potentials(network, work)
    return COLD_ITERATIONS, worst


@njit
def _recover_potentials(network, work):
    """Compute the node potentials that belong to the port voltages, after a step that was shortened.

    Voltages and currents of the ports are those of the linear network, whatever conductance stands for a port.
    """
    for k in range(work.in_service[0]):
        port, w = network.ports[work.order[k]], work.ports[work.order[k]]
        w.g = 1.0
        w.j = w.i - w.u
        if port.span >= 0:
            work.spans[port.span].stale = True
    solve_linear(network, work)


@njit
def _descend(network, work):
    """Go along the direction of the last linear solution to where the potential stops falling steeply.

    Returns
    -------
    float
        How much of the way was gone, 1 for all of it.
    """
    longest = 0.0
    for k in range(work.in_service[0]):
        w = work.ports[work.order[k]]
        w.i_next = w.g * w.u_next + w.j
        longest = max(longest, abs(w.u_next - w.u))
    high = 1.0 if longest <= STEP_V else STEP_V / longest
    start = _fall(network, work, 0.0)
    t, fall = high, _fall(network, work, high)
    if start < 0.0 and fall > -0.5 * start:  # start is zero where nothing but rounding is left
        low, low_fall, high_fall = 0.0, start, fall
        for _ in range(60):
            t = low + (high - low) * low_fall / (low_fall - high_fall)
            fall = _fall(network, work, t)
            if abs(fall) <= -0.5 * start:
                break
            if fall > 0.0:  # Illinois: halve the weight of the end that stays
                high, high_fall, low_fall = t, fall, 0.5 * low_fall
            else:
                low, low_fall, high_fall = t, fall, 0.5 * high_fall
    if start < -HUMP_W:
        while t > SHORTEST and _rise(network, work, t) > 0.0:  # the root lies beyond a hump
            t *= 0.5
    for k in range(work.in_service[0]):
        w = work.ports[work.order[k]]
        w.u += t * (w.u_next - w.u)
        w.i += t * (w.i_next - w.i)
    return t


@njit
def _rise(network, work, t):
    """Return by how much the potential is higher `t` of the way along the direction [W]."""
    rise = 0.0
    for k in range(work.in_service[0]):
        port, w = network.ports[work.order[k]], work.ports[work.order[k]]
        du = t * (w.u_next - w.u)
        rise += port_integral(network.segments, port, w.u, w.u + du) - du * (w.i + 0.5 * t * (w.i_next - w.i))
    return rise


@njit
def _fall(network, work, t):
    """Return the derivative of the potential along the direction, `t` of the way [W]."""
    total = 0.0
    for k in range(work.in_service[0]):
        port, w = network.ports[work.order[k]], work.ports[work.order[k]]
        du = w.u_next - w.u
        total += du * (port_current(network.segments, port, w.u + t * du) - w.i - t * (w.i_next - w.i))
    return total


@njit
def find_unserved(network, work):
    """Return the port whose demand cannot be served in the present solution, or -1."""
    found = -1
    for k in range(work.in_service[0]):
        p = work.order[k]
        port, u = network.ports[p], work.ports[p].u
        if port.scale > 0.0 and port.floor_v > 0.0 and not port.floor_v <= u <= port.ceiling_v and (found < 0 or p < found):
            found = p
    return found


@njit
def _cut_demand(network, work, factor):
    for k in range(work.in_service[0]):
        port = network.ports[work.order[k]]
        if port.demand:
            port.scale = factor * work.ports[work.order[k]].full_scale


@njit
def solve(network, work, warm):
    """Solve the network for the stable solution that descent from no load finds.

    When the demand cannot be served, all demand is cut by the largest common factor that can, and `scale` of the
    ports stays cut: devices write it anew before the next solution.

    Parameters
    ----------
    network : Network
    work : Work
        `place_ports` must have been called for the present places.
    warm : bool
        Whether the port voltages in `work` are those of a neighbouring state.

    Returns
    -------
    status : int
        `CONVERGED`, `NOT_CONVERGED` (imbalance above `FLAG_A`) or `NOT_SERVABLE`.
    iterations : int
        Linear solutions or descent steps.
    worst : float
        Largest imbalance of a port [A].
    factor : float
        Common factor by which all demand had to be cut, 1 when it is served.
    port : int
        The port that cannot be served, else -1.
    """
    iterations, worst = 0, np.inf
    if warm:
        iterations, worst = solve_warm(network, work)
    if iterations == 0:
        iterations, worst = solve_cold(network, work)
    unserved = find_unserved(network, work)
    if unserved < 0:
        return (CONVERGED if worst <= FLAG_A else NOT_CONVERGED), iterations, worst, 1.0, -1
    for k in range(work.in_service[0]):
        work.ports[work.order[k]].full_scale = network.ports[work.order[k]].scale
    low, high, found = 0.0, 1.0, False
    while not found:
        found = high - low <= 1e-7  # then once more, for the solution itself
        factor = low if found else 0.5 * (low + high)
        _cut_demand(network, work, factor)
        more, worst = solve_cold(network, work)
        iterations += more
        if worst <= 2.0 * TOLERANCE_A and find_unserved(network, work) < 0:  # just beyond the fold it is small, too
            low = factor
        else:
            high = factor
    return NOT_SERVABLE, iterations, worst, factor, unserved
