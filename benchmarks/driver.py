"""Compiled drivers of the benchmarks. All of them are in this file: numba notices a change in the file it compiles only."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.flows import conductor_flows, skeleton_balance
from tractionpower.kernels.jit import njit
from tractionpower.kernels.network import solve
from tractionpower.kernels.spans import place_ports

TRAIN_SEGMENTS = 4
TRACTION_ZERO_V, TRACTION_FULL_V = 2000.0, 2700.0
FEED_BACK_FULL_V, FEED_BACK_ZERO_V = 3800.0, 3900.0
SPEED_MPS, CYCLE_S = 33.0, 600.0


@njit
def cycle_share(t):
    """Return the share of full power at `t` [s] of the cycle."""
    t = t % CYCLE_S
    if t < 120.0:
        return 1.0
    if t < 360.0:
        return 0.4
    return 0.04 if t < 480.0 else -0.6


@njit
def write_train(segments, first, p):
    """Write the characteristic of a train that wants the power `p` [W], negative feeding back."""
    for k in range(first, first + TRAIN_SEGMENTS):
        segments[k].a = 0.0
        segments[k].b = 0.0
        segments[k].c = 0.0
    segments[first].from_v = -np.inf
    segments[first + 1].from_v = TRACTION_ZERO_V
    if p >= 0.0:
        width = TRACTION_FULL_V - TRACTION_ZERO_V
        segments[first + 1].a = p / width
        segments[first + 1].c = -p * TRACTION_ZERO_V / width
        segments[first + 2].from_v = TRACTION_FULL_V
        segments[first + 2].c = p
        segments[first + 3].from_v = 1e5
        segments[first + 3].c = p
    else:
        width = FEED_BACK_ZERO_V - FEED_BACK_FULL_V
        segments[first].b = p / TRACTION_ZERO_V**2
        segments[first + 1].c = p
        segments[first + 2].from_v = FEED_BACK_FULL_V
        segments[first + 2].a = -p / width
        segments[first + 2].c = p * FEED_BACK_ZERO_V / width
        segments[first + 3].from_v = FEED_BACK_ZERO_V


@njit
def set_train(network, spot, k, x, p):
    """Put train `k` at `x` [m] of the line with the power `p` [W].

    `spot` bundles the port of the first train and, by track, the places of the cuts [m], the spans between them and their
    conductors: contact line, rails.
    """
    first_port, cuts, spans, contact, rails = spot
    track = k % spans.shape[0]
    n = min(max(np.searchsorted(cuts[track], x, side="right") - 1, 0), spans.shape[1] - 1)
    port = network.ports[first_port + k]
    port.span = spans[track, n]
    port.x_m = x - cuts[track, n]
    port.positive = contact[track, n]
    port.negative = rails[track, n]
    write_train(network.segments, port.first_segment, p)


@njit
def move_trains(network, spot, trains, t):
    """Place all trains and set their characteristics at the time `t` [s]."""
    start_m, direction, phase_s, power_w = trains
    for k in range(start_m.shape[0]):
        length = spot[1][k % spot[1].shape[0], -1]
        x = (start_m[k] + direction[k] * SPEED_MPS * t) % length
        set_train(network, spot, k, x, power_w[k] * cycle_share(t + phase_s[k]))


@njit
def run_steps(network, work, spot, trains, t0, steps, solve_too):
    """Move the trains every second and, if asked to, solve; the first step starts cold.

    Returns
    -------
    iterations, cold : int
        Linear solutions of all steps, steps after the first whose warm start was refused.
    worst, lowest : float
        Largest imbalance of a port [A], lowest voltage of a train [V].
    """
    iterations, cold, worst, lowest = 0, 0, 0.0, np.inf
    for step in range(steps):
        move_trains(network, spot, trains, t0 + step)
        if solve_too:
            place_ports(network, work)
            _, n, imbalance, _, _ = solve(network, work, step > 0)
            iterations += n
            cold += step > 0 and np.isinf(work.ports[0].before_v)  # a cold start leaves nothing to draw a line through
            worst = max(worst, imbalance)
            for p in range(spot[0], spot[0] + trains[0].shape[0]):
                lowest = min(lowest, work.ports[p].u)
    return iterations, cold, worst, lowest


@njit
def find_worst_balance(network, work, edges, balance, spot, trains, t0, steps):
    """Solve the same steps and return the largest imbalance of any node [A], computed afresh from the potentials."""
    worst = 0.0
    for step in range(steps):
        move_trains(network, spot, trains, t0 + step)
        place_ports(network, work)
        _, _, imbalance, _, _ = solve(network, work, step > 0)
        _, inside, _ = conductor_flows(network, work, balance)
        _, ends = skeleton_balance(network, work, edges, balance)
        worst = max(worst, imbalance, inside, ends)
    return worst


@njit
def run_snapshots(network, work, spot, x, p, warm, sweeps, voltage):
    """Solve the snapshots one after the other, `sweeps` times; the first of each sweep starts cold.

    Parameters
    ----------
    x, p : ndarray, shape (snapshots, trains)
        Places [m] and powers [W] of the trains.
    warm : bool
        Whether a snapshot starts from the solution before; else each starts from no load.
    voltage : ndarray, shape (snapshots, ports)
        Out: voltages of all ports [V].

    Returns
    -------
    iterations : int
        Linear solutions of all sweeps.
    worst : float
        Largest imbalance of a port [A].
    """
    iterations, worst = 0, 0.0
    for _ in range(sweeps):
        for n in range(x.shape[0]):
            for k in range(x.shape[1]):
                set_train(network, spot, k, x[n, k], p[n, k])
            place_ports(network, work)
            _, more, imbalance, _, _ = solve(network, work, warm and n > 0)
            iterations += more
            worst = max(worst, imbalance)
            for k in range(voltage.shape[1]):
                voltage[n, k] = work.ports[k].u
    return iterations, worst
