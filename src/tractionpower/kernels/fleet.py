"""The trains on the line within one step: they enter, ask the line, do what it permits, leave."""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.demand import demand_current
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.tally import TINY_S
from tractionpower.kernels.train_port import write_constant_port, write_port
from tractionpower.kernels.train_step import brakes_after_traction, expect_braking, settle, wish
from tractionpower.kernels.train_tables import GONE, STAYING
from tractionpower.kernels.turns import hands_over, may_begin, note_finish


@njit
def enter_trains(tables, state, t):
    """Put the trains that start before the end of the step at `t` [s] on the line, and those that others become there.

    A train that others become takes their place in the step after the one in which the last of them has finished.
    """
    progress = state.progress[0]
    before = progress.active
    if progress.turning:
        _turn(tables, state, t)
    while progress.entered < tables.entries.shape[0]:
        k = tables.entries[progress.entered]
        if tables.trains.trains[k].start_s >= t + tables.clock[1] - TINY_S:
            break
        progress.entered += 1
        if state.trains.movers[k].status != GONE:  # before the clock began
            _enter(tables, state, k)
    if progress.active != before:
        _choose_ports(tables, state)


@inlined
def _enter(tables, state, k):
    """Put train `k` on the line; trains there are in the order of their numbers."""
    progress = state.progress[0]
    at = progress.active
    while at > 0 and state.active[at - 1] > k:
        state.active[at] = state.active[at - 1]
        at -= 1
    state.active[at] = k
    progress.active += 1
    w = state.work.ports[tables.fleet[k].port]
    w.before_v, w.i = np.inf, 0.0
    _place(tables, state, k)
    w.u = tables.network.ports[tables.fleet[k].port].start_v


@njit
def _turn(tables, state, t):
    """Let trains whose forerunners have all finished begin, and take those off the line."""
    progress, trains = state.progress[0], state.trains
    stay = 0
    for n in range(progress.active):
        k = state.active[n]
        state.active[stay] = k
        if not hands_over(tables.trains, trains, k):
            stay += 1
    if stay != progress.active:
        progress.active = stay
        _choose_ports(tables, state)  # as many may come as go
    progress.turning = False
    for k in range(tables.fleet.shape[0]):
        if tables.trains.trains[k].waits == 0 or trains.missing[k] != 0:
            continue
        if not may_begin(tables.trains, trains, k, t + tables.clock[1] - TINY_S):
            progress.turning = True
            continue
        if trains.movers[k].status != GONE:  # before the clock began
            _enter(tables, state, k)
            _choose_ports(tables, state)


@inlined
def _choose_ports(tables, state):
    """Put the ports of the trains on the line into service behind the fixed ones."""
    work, progress = state.work, state.progress[0]
    fixed = tables.network.ports.shape[0] - tables.fleet.shape[0]
    for p in range(fixed):
        work.order[p] = p
    for n in range(progress.active):
        work.order[fixed + n] = tables.fleet[state.active[n]].port
    work.in_service[0] = fixed + progress.active
    progress.stale = True


@inlined
def _place(tables, state, k):
    """Put the port of train `k` to where its front is."""
    fleet, s = tables.fleet[k], state.trains.movers[k].s_m
    n = state.way[k]
    while n + 1 < fleet.ways and tables.ways[fleet.first_way + n + 1].from_m <= s:
        n += 1
    state.way[k] = n
    way, port = tables.ways[fleet.first_way + n], tables.network.ports[fleet.port]
    port.span, port.positive, port.negative, port.start_v = way.span, way.positive, way.negative, way.start_v
    port.x_m = min(max(way.x_m + way.sign * (s - way.from_m), 0.0), way.length_m)


@njit
def ask_line(tables, state, t):
    """Let all trains on the line try the step from `t` [s] and write what they take over the voltage into their ports.

    With the coupling of constant voltage they take the current of that voltage whatever the line gives.
    """
    h, fixed_v = tables.clock[1], tables.clock[2]
    segments = tables.network.segments
    for n in range(state.progress[0].active):
        k = state.active[n]
        _place(tables, state, k)
        port = tables.network.ports[tables.fleet[k].port]
        is_dead = not port.start_v > 0.0  # no source reaches the line
        mover = state.trains.movers[k]
        if mover.voltage_v == 0.0 and not is_dead:  # the line is live again, and nobody has taken anything from it yet
            mover.voltage_v = port.start_v
        wish(tables.trains, state.trains, k, t, h, is_dead)
        port.scale = 0.0 if is_dead else 1.0
        if fixed_v > 0.0:
            write_constant_port(tables.trains, state.trains, k, port, segments, fixed_v)
        else:
            write_port(tables.trains, state.trains, k, port, segments, tables.fleet[k].room, state.breaks)


@njit
def revise_braking(tables, state, t):
    """Let trains that brake after traction see the voltage found; tell whether one brakes otherwise than it thought.

    Then its port is written anew, and the network is to be solved again.
    """
    if tables.clock[2] > 0.0:
        return False
    changed = False
    for n in range(state.progress[0].active):
        k = state.active[n]
        if brakes_after_traction(tables.trains.trains[k], state.trains.wishes[k]):
            port = tables.network.ports[tables.fleet[k].port]
            u = state.work.ports[tables.fleet[k].port].u
            if expect_braking(tables.trains, state.trains, k, (t, tables.clock[1]), u):
                write_port(tables.trains, state.trains, k, port, tables.network.segments, tables.fleet[k].room, state.breaks)
                changed = True
    return changed


@njit
def answer_trains(tables, state, t, rows, used):
    """Let all trains do what their voltage permits; their rows go to `rows` from `used` on, whose new end is returned.

    Trains that have left the line go out of service.
    """
    progress, fixed_v = state.progress[0], tables.clock[2]
    stay = 0
    for n in range(progress.active):
        k = state.active[n]
        port = tables.network.ports[tables.fleet[k].port]
        u = state.work.ports[tables.fleet[k].port].u if port.start_v > 0.0 else 0.0
        i, row = port_current(tables.network.segments, port, u), rows[used]
        at, own, served = u, i, port.scale
        if fixed_v > 0.0 and port.start_v > 0.0:
            train, trial, demand = tables.trains.trains[k], state.trains.trials[k], state.trains.demands[k]
            at, served = fixed_v, 1.0
            own, _ = demand_current(tables.trains, train, trial, demand, fixed_v)
        was = state.trains.movers[k].status
        settle(tables.trains, state.trains, k, (t, tables.clock[1]), (at, own, served), row)
        if was < STAYING and state.trains.movers[k].status >= STAYING and note_finish(tables.trains, state.trains, k):
            progress.turning = True
        row.coupling_w = u * i - at * own
        earthed = tables.ways[tables.fleet[k].first_way + state.way[k]].earthed
        row.rail_v = state.work.sides[tables.fleet[k].port, 1].node_v if earthed else np.nan
        row.voltage_v, row.current_a, row.power_w, row.returned_w = u, i, u * i, max(-u * i, 0.0)
        used += 1
        state.active[stay] = k
        if state.trains.movers[k].status != GONE:
            stay += 1
    if stay != progress.active:
        progress.active = stay
        _choose_ports(tables, state)
    return used
