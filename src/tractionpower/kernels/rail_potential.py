"""The potential of the rails against earth at any place, between the nodes of the network as well."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.jit import njit
from tractionpower.kernels.tables import SHARED

RAIL = np.dtype(
    [
        ("node", "i8"),  # -1: no potential is defined, or the place lies within a span
        ("span", "i8"),  # -1: at a node
        ("conductor", "i8"),
        ("x_m", "f8"),
        ("left", "f8"),  # shares of the potentials at both ends, while nothing stands on the conductor
        ("right", "f8"),
    ]
)
"""A place of the rails."""


@njit
def shares(r, g, x, length):
    """Return the shares of the potentials at both ends of a `length` [m] of rails at `x` [m] from its first end.

    sinh(a (l - x)) / sinh(a l) and sinh(a x) / sinh(a l) with a = sqrt(r g), for r [ohm/m] and g [S/m] (telegraph
    equation); linear without leakage.
    """
    a = np.sqrt(r * g)
    if a * length < 1e-4:  # then the hyperbola is a straight line within 1e-9
        return 1.0 - x / length, x / length
    scale = 1.0 / (1.0 - np.exp(-2.0 * a * length))  # exponentials that cannot overflow
    left = (np.exp(-a * x) - np.exp(-a * (2.0 * length - x))) * scale
    right = (np.exp(-a * (length - x)) - np.exp(-a * (length + x))) * scale
    return left, right


@njit
def rail_potential(network, work, place):
    """Return the rail potential [V] at a place of a solved network, NaN where none is defined."""
    if place.span < 0:
        return work.node_v[place.node] if place.node >= 0 else np.nan
    c = place.conductor
    conductor, span = network.conductors[c], work.spans[place.span]
    before_v, after_v = work.node_v[conductor.left_node], work.node_v[conductor.right_node]
    if work.conductors[c].nodes == 0:
        return place.left * before_v + place.right * after_v
    before, after = 0.0, network.spans[place.span].length_m
    for k in range(span.first_port, span.first_port + span.ports):
        p = work.order[k]
        x = network.ports[p].x_m
        for m in range(2):
            side = work.sides[p, m]
            if side.conductor == c and side.insertion != SHARED:
                if x <= place.x_m:
                    before, before_v = x, side.node_v
                elif x < after:
                    after, after_v = x, side.node_v
    left, right = shares(conductor.ohm_per_m, conductor.siemens_per_m, place.x_m - before, after - before)
    return left * before_v + right * after_v
