"""What is kept of each step of a chain: extremes and turning points of coupling forces, time spent in bins; and rows."""

from __future__ import annotations

from tractionpower.kernels.air_brake import reduction_at
from tractionpower.kernels.chain_forces import set_applied, set_friction, stretch_of
from tractionpower.kernels.chain_state import TURN_N
from tractionpower.kernels.jit import inlined, njit

SPEED_BINS, FORCE_BINS, ACCELERATION_BINS = 0, 1, 2


@inlined
def _bin_of(bins, value):
    """Return the bin of a value: 0 is below the first, the last above all."""
    place = (value - bins.from_) / bins.width
    if place < 0.0:
        return 0
    return bins.bins + 1 if place >= bins.bins else int(place) + 1


@njit
def tally(chain, state, buffers, control, h):
    """Count a step of `h` [s]; speeds at its beginning are those of `note_speeds`."""
    ledger, first = state.ledger[0], state.movers[0]
    _follow_vehicles(state, buffers, h)
    speed = _bin_of(chain.bins[SPEED_BINS], first.v_mps)
    state.drive_speed[min(max(control.drive, 0), state.drive_speed.shape[0] - 1), speed] += h
    state.brake_speed[min(max(control.brake, 0), state.brake_speed.shape[0] - 1), speed] += h
    state.acceleration[_bin_of(chain.bins[ACCELERATION_BINS], (first.v_mps - first.before_mps) / h)] += h
    links = state.links
    if links.shape[0] > 0:
        state.force[_bin_of(chain.bins[FORCE_BINS], links[0].force_n)] += h
    for j in range(links.shape[0]):
        link = links[j]
        force = link.force_n
        if force > link.greatest_n:
            link.greatest_n, link.greatest_at_s = force, ledger.time_s
        if force < link.least_n:
            link.least_n, link.least_at_s = force, ledger.time_s
        _count_turn(link, j, force, buffers)


@njit
def note_speeds(state):
    """Note the speeds of all vehicles at the beginning of a step."""
    for i in range(state.movers.shape[0]):
        state.movers[i].before_mps = state.movers[i].v_mps


@njit
def _follow_vehicles(state, buffers, h):
    """Keep the extremes of all vehicles, and note where the train has come to a stand."""
    ledger, first = state.ledger[0], state.movers[0]
    moved, rate = first.s_m - first.start_m, 1.0 / h
    standing = True
    for i in range(state.movers.shape[0]):
        mover = state.movers[i]
        standing &= mover.v_mps == 0.0
        if abs(mover.v_mps) > abs(mover.greatest_mps):
            mover.greatest_mps, mover.greatest_at_s = mover.v_mps, ledger.time_s
        gained = (mover.v_mps - mover.before_mps) * rate
        if abs(gained) > abs(mover.sharpest_mps2):
            mover.sharpest_mps2, mover.sharpest_at_s = gained, ledger.time_s
        further = mover.s_m - mover.start_m - moved
        if abs(further) > abs(mover.furthest_m):
            mover.furthest_m, mover.furthest_at_s = further, ledger.time_s
    if standing and not ledger.standing:
        note_mark(state, buffers, -1)
    ledger.standing = standing


@njit
def note_mark(state, buffers, control):
    """Note that a row of the controls holds from now on, or (-1) that the train has come to a stand."""
    mark = buffers.marks[buffers.used[2]]
    buffers.used[2] += 1
    mark.time_s, mark.control = state.ledger[0].time_s, control
    mark.s_m, mark.v_mps = state.movers[0].s_m, state.movers[0].v_mps


@njit
def _count_turn(link, j, force, buffers):
    """Follow the force of a coupling, and note an extreme once the force has come back from it."""
    if link.turning == 0.0:
        if abs(force - link.turn_n) >= TURN_N:
            _note_turn(buffers, j, link.turn_n)  # the first extreme is where it began
            link.turning = 1.0 if force > link.turn_n else -1.0
            link.turn_n = force
        return
    if (force - link.turn_n) * link.turning > 0.0:
        link.turn_n = force
    elif (link.turn_n - force) * link.turning >= TURN_N:
        _note_turn(buffers, j, link.turn_n)
        link.turning, link.turn_n = -link.turning, force


@njit
def _note_turn(buffers, j, force):
    turn = buffers.turns[buffers.used[1]]
    turn.link, turn.force_n = j, force
    buffers.used[1] += 1


@njit
def record(chain, state, buffers, control, work):
    """Write a row of the whole chain as it is now."""
    k = buffers.used[0]
    buffers.used[0] += 1
    ledger = state.ledger[0]
    ledger.recorded += 1
    row = buffers.chain[k]
    row.time_s, row.drive, row.brake = ledger.time_s, control.drive, control.brake
    row.electric, row.independent_pa = control.electric, control.independent_pa
    row.reduction_pa = reduction_at(chain, state, ledger.time_s)
    row.traction_j, row.electric_j, row.brake_j = ledger.traction_j, ledger.electric_j, ledger.brake_j
    row.resistance_j, row.grade_j, row.coupling_j = ledger.resistance_j, ledger.grade_j, ledger.coupling_j
    set_present(chain, state, work)
    for i in range(state.movers.shape[0]):
        mover, kept = state.movers[i], buffers.vehicles[k, i]
        kept.s_m, kept.v_mps, kept.a_mps2 = mover.s_m, mover.v_mps, mover.a_mps2
        kept.traction_n = mover.traction_n if chain.vehicles[i].engine >= 0 else 0.0
        kept.electric_n, kept.brake_n, kept.resistance_n = mover.electric_acting_n, mover.brake_n, mover.resistance_n
        kept.grade_n = mover.grade_n
        kept.cylinder_pa = max(mover.cylinder_pa, mover.independent_pa)
        if i + 1 < state.movers.shape[0]:
            link = buffers.links[k, i]
            link.force_n = work.force[i]
            link.stretch_m = stretch_of(chain, i, mover.s_m, state.movers[i + 1].s_m)
            link.rate_mps = mover.v_mps - state.movers[i + 1].v_mps


@njit
def set_present(chain, state, work):
    """Write forces and accelerations of this instant into the state of the vehicles; friction as it acts, also at rest."""
    movers = state.movers
    for i in range(movers.shape[0]):
        work.stage_s[i], work.stage_v[i] = movers[i].s_m, movers[i].v_mps
    set_applied(chain, state, work.stage_s, work.stage_v, False, work)
    set_friction(chain, state, work.stage_s, work.stage_v, 1.0, work)
    for i in range(movers.shape[0]):
        mover, applied = movers[i], work.applied[i]
        greatest = work.friction[i]
        friction = greatest if mover.v_mps > 0.0 else -greatest
        if mover.v_mps == 0.0:
            friction = min(max(applied, -greatest), greatest)
            part = abs(friction) / greatest if greatest > 0.0 else 0.0
            mover.resistance_n *= part
            mover.brake_n *= part
            mover.electric_acting_n *= part
        mover.a_mps2 = (applied - friction) / chain.vehicles[i].inertia_kg


@njit
def present_reduction(chain, state):
    """Return the reduction of the pipe at the driver's valve now [Pa]."""
    return reduction_at(chain, state, state.ledger[0].time_s)
