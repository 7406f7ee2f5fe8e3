"""The characteristic of a port: I(U) = a + b U + c/U between break voltages, continuous at the breaks."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import njit


@njit
def find_segment(segments, port, u):
    """Return the number of the segment of `port` in which `u` [V] lies."""
    s = port.first_segment
    last = s + port.segments - 1
    while s < last and u >= segments[s + 1].from_v:
        s += 1
    return s


@njit
def current(segment, u):
    """Return I(U) [A] of a segment."""
    i = segment.a + segment.b * u
    if segment.c != 0.0:
        i += segment.c / u
    return i


@njit
def slope(segment, u):
    """Return dI/dU [S] of a segment."""
    g = segment.b
    if segment.c != 0.0:
        g -= segment.c / (u * u)
    return g


@njit
def steepest(segments, port, s, u, near_v):
    """Return the slope [S] of `port` at `u` [V] in its segment `s`; within `near_v` [V] of a kink the larger one.

    A diode at its no-load voltage counts as conducting. Otherwise an idle busbar, a rounding above that voltage, would
    hang on its blocked rectifier alone.
    """
    g = slope(segments[s], u)
    if s > port.first_segment and u - segments[s].from_v < near_v:
        g = max(g, slope(segments[s - 1], u))
    if s < port.first_segment + port.segments - 1 and segments[s + 1].from_v - u < near_v:
        g = max(g, slope(segments[s + 1], u))
    return g


@njit
def port_current(segments, port, u):
    """Return the current [A] that `port` takes at the voltage `u` [V]."""
    return port.scale * current(segments[find_segment(segments, port, u)], u)


@njit
def port_integral(segments, port, low, high):
    """Return the integral of the current of `port` over its voltage, from `low` to `high` [W]."""
    if low > high:
        return -port_integral(segments, port, high, low)
    total = 0.0
    last = port.first_segment + port.segments - 1
    for s in range(port.first_segment, last + 1):
        segment = segments[s]
        start = max(low, segment.from_v)
        end = high if s == last else min(high, segments[s + 1].from_v)
        if end > start:
            total += (end - start) * (segment.a + 0.5 * segment.b * (end + start))
            if segment.c != 0.0:
                total += segment.c * np.log(end / start)
    return port.scale * total


@njit
def linearise(network, work, share, keep_a, near_v):
    """Replace every port by its tangent at its voltage: i(u) = g u + j.

    Falling characteristics (constant power) enter with `share` of their slope only; 1 is Newton's method, 0 makes
    the linear network positive definite whatever the ports are. A tangent that still meets its characteristic within
    `keep_a` [A] is kept, and with it all that was computed for its span. Within `near_v` [V] of a kink the larger slope
    counts.

    Returns
    -------
    float
        The largest difference between the characteristic of a port and what the linear network carries [A].
    """
    ports, segments, port_work = network.ports, network.segments, work.ports
    worst = 0.0
    for k in range(work.in_service[0]):
        p = work.order[k]
        port, w = ports[p], port_work[p]
        s = find_segment(segments, port, w.u)
        segment = segments[s]
        i = port.scale * current(segment, w.u)
        gap = abs(i - w.i)
        if gap > keep_a:
            g = port.scale * steepest(segments, port, s, w.u, near_v)
            if g < 0.0:
                g *= share
            w.g = g
            w.j = i - g * w.u
            if port.span >= 0:
                work.spans[port.span].stale = True
        if not gap <= worst:
            worst = gap if gap >= 0.0 else np.inf  # not a number must not pass for a balance
    return worst
