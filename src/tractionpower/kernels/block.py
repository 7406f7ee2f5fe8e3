"""The clock: a block of steps, each of them devices, network, record, motion.

A block can end after any step and be resumed; the result does not depend on where it ends.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.block_tables import BUFFER_FULL, DONE, OVERCURRENT, TRIGGERED
from tractionpower.kernels.fleet import answer_trains, ask_line, enter_trains, revise_braking
from tractionpower.kernels.flows import conductor_flows, link_current, skeleton_balance
from tractionpower.kernels.jit import njit
from tractionpower.kernels.motion import TINY_S
from tractionpower.kernels.network import CONVERGED, FLAG_A, NOT_CONVERGED, solve
from tractionpower.kernels.ports import port_current
from tractionpower.kernels.rail_potential import rail_potential
from tractionpower.kernels.spans import place_ports

MOST_REVISIONS = 4
"""Solutions of one step more, where a train would brake otherwise than it thought before the voltage was known."""


@njit
def advance(tables, state, buffers, until_step):
    """Run steps until `until_step` or until the buffers are full.

    Parameters
    ----------
    tables : BlockTables
    state : State
        Changed in place.
    buffers : Buffers
        Row k receives the k-th step of this call.
    until_step : int
        The step not to be run any more.

    Returns
    -------
    steps : int
        Number of steps run.
    reason : int
        `DONE`, `BUFFER_FULL`, or `TRIGGERED`: `state.fired` tells the triggers that the last step has fired.
    """
    progress = state.progress[0]
    row = used = 0
    _restore_loads(tables, state)
    while progress.step < until_step:
        t = tables.clock[0] + progress.step * tables.clock[1]
        enter_trains(tables, state, t)
        if row == buffers.steps.shape[0] or used + progress.active > buffers.trains.shape[0]:
            return row, BUFFER_FULL
        changed = _switch_loads(tables, state, t)
        ask_line(tables, state, t)
        if changed or progress.stale or progress.active > 0 or not progress.solved:
            for revision in range(1 + MOST_REVISIONS):
                _solve_step(tables, state, progress.solved)
                progress.solved, progress.stale = True, False
                if revision == MOST_REVISIONS or not revise_braking(tables, state, t):
                    break
        else:
            state.result[0].iterations = 0
        state.result[0].trains = progress.active
        _record(tables, state, buffers, row)
        used = answer_trains(tables, state, t, buffers.trains, used)
        progress.step += 1
        row += 1
        if _watch(tables, state, buffers, row - 1, t):
            return row, TRIGGERED
    return row, DONE


@njit
def _watch(tables, state, buffers, row, t):
    """Look at all triggers after the step at `t` [s]; tell whether one fires."""
    fires = False
    for k in range(tables.triggers.shape[0]):
        trigger = tables.triggers[k]
        state.fired[k] = False
        if trigger.kind == OVERCURRENT:
            value = abs(buffers.link_a[row, trigger.index])
        else:
            value = abs(buffers.rail_v[row, trigger.index])
        if not value > trigger.above:
            state.since_s[k] = np.inf
            continue
        state.since_s[k] = min(state.since_s[k], t)
        if t + tables.clock[1] - state.since_s[k] >= trigger.delay_s - TINY_S:
            state.fired[k] = fires = True
    return fires


@njit
def _restore_loads(tables, state):
    """Write what the state says into the tables, which another run may have used since."""
    for k in range(tables.loads.shape[0]):
        port = tables.network.ports[tables.loads[k].port]
        port.scale = state.result[0].factor * state.load_scale[k] if port.start_v > 0.0 else 0.0


@njit
def _switch_loads(tables, state, t):
    """Set the demand of loads by the time of day; tell whether one has changed."""
    changed = False
    for k in range(tables.loads.shape[0]):
        load, n = tables.loads[k], state.load_step[k]
        while n + 1 < load.steps and tables.load_steps[load.first_step + n + 1].time_s <= t:
            n += 1
        state.load_step[k] = n
        scale = tables.load_steps[load.first_step + n].factor if n >= 0 and load.from_s <= t < load.to_s else 0.0
        changed = changed or scale != state.load_scale[k]
        state.load_scale[k] = scale
    return changed


@njit
def _solve_step(tables, state, warm):
    network, work, result = tables.network, state.work, state.result[0]
    for k in range(tables.loads.shape[0]):  # the step before may have cut them
        port = network.ports[tables.loads[k].port]
        port.scale = state.load_scale[k] if port.start_v > 0.0 else 0.0  # nothing feeds a dead line
    place_ports(network, work)
    status, iterations, worst, factor, port = solve(network, work, warm)
    heat, gap, leaked = conductor_flows(network, work, state.balance)
    edge_heat, node_gap = skeleton_balance(network, work, tables.edges, state.balance)
    result.worst_a = max(worst, gap, node_gap)
    result.status = NOT_CONVERGED if status == CONVERGED and not result.worst_a <= FLAG_A else status
    result.iterations = iterations
    result.factor = factor
    result.port = port
    result.conductor_w = heat + edge_heat
    result.leaked_a = leaked
    result.source_w = 0.0
    result.regulation_w = 0.0
    result.load_w = 0.0
    result.train_w = 0.0
    result.gross_w = 0.0
    # The currents are those that the network carries: a port differs from its characteristic by `worst` at most, which at
    # light load and with many ports would be more than the ledger of a step allows.
    for k in range(tables.sources.shape[0]):
        source = tables.sources[k]
        if source.port >= 0:
            w = work.ports[source.port]
            result.source_w -= source.no_load_v * w.i
            result.regulation_w -= (source.no_load_v - w.u) * w.i
            result.gross_w += abs(source.no_load_v * w.i)
    for k in range(tables.loads.shape[0]):
        w = work.ports[tables.loads[k].port]
        result.load_w += w.u * w.i
        result.gross_w += abs(w.u * w.i)
    for n in range(state.progress[0].active):
        w = work.ports[tables.fleet[state.active[n]].port]
        result.train_w += w.u * w.i
        result.gross_w += abs(w.u * w.i)


@njit
def _record(tables, state, buffers, row):
    network, work = tables.network, state.work
    buffers.steps[row] = state.result[0]
    for k in range(tables.sources.shape[0]):
        source = tables.sources[k]
        buffers.source_v[row, k] = np.nan
        buffers.source_a[row, k] = 0.0
        if source.positive >= 0:
            buffers.source_v[row, k] = work.node_v[source.positive] - work.node_v[source.negative]
        if source.port >= 0:
            u = work.ports[source.port].u
            buffers.source_a[row, k] = -port_current(network.segments, network.ports[source.port], u)
    for k in range(tables.loads.shape[0]):
        port = tables.loads[k].port
        u = work.ports[port].u
        buffers.load_v[row, k] = u
        buffers.load_a[row, k] = port_current(network.segments, network.ports[port], u)
    for k in range(tables.links.shape[0]):
        buffers.link_a[row, k] = link_current(tables.links, tables.terms, k, work, tables.edges, network.ports, network.segments)
    for k in range(tables.rails.shape[0]):
        buffers.rail_v[row, k] = rail_potential(network, work, tables.rails[k])
    for k in range(tables.earth.shape[0]):
        buffers.earth_a[row, k] = 0.0
        if tables.earth[k] >= 0:
            edge = tables.edges[tables.earth[k]]
            buffers.earth_a[row, k] = (work.node_v[edge.first] - work.node_v[edge.second]) * edge.conductance_s
    for k in range(tables.sections.shape[0]):
        section = tables.sections[k]
        if section.port >= 0:
            buffers.section_v[row, k] = work.ports[section.port].u
        elif section.contact < 0:
            buffers.section_v[row, k] = np.nan
        else:
            buffers.section_v[row, k] = work.node_v[section.contact] - work.node_v[section.rail]
    for k in range(tables.gauges.shape[0]):
        conductor = work.conductors[tables.gauges[k].conductor]
        buffers.gauge_a[row, k] = conductor.right_a if tables.gauges[k].right else conductor.left_a
