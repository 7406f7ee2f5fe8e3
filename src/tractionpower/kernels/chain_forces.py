"""Forces on the vehicles of a chain at an instant."""

from __future__ import annotations

from tractionpower.kernels.air_brake import brake_force
from tractionpower.kernels.couplings import commit_coupling, coupling_force
from tractionpower.kernels.engines import electric_effort, lagged, steady_effort
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.way import bend_resistance, height_at, row_at, slope_at


@inlined
def stretch_of(chain, j, ahead_m, behind_m):
    """Return how much longer coupling j is than in the middle of its slack [m], by the places of its two vehicles [m]."""
    return ahead_m - behind_m - (chain.vehicles[j + 1].behind_m - chain.vehicles[j].behind_m)


@inlined
def adhesion(vehicle, speed):
    """Return the coefficient of adhesion of a vehicle (Curtius and Kniffler) at a speed [m/s]."""
    return vehicle.adhesion_a / (speed + vehicle.adhesion_b) + vehicle.adhesion_c


@njit
def begin_efforts(chain, state, control, work):
    """Note the efforts of the drives at the beginning of a step, and what they tend to there."""
    for i in range(state.movers.shape[0]):
        if chain.vehicles[i].engine >= 0:
            mover = state.movers[i]
            work.efforts[i, 0], work.efforts[i, 1] = mover.traction_n, mover.electric_n
            work.aims[i, 0], work.aims[i, 1] = _aims(chain, i, control, abs(mover.v_mps))


@njit
def take_back_efforts(chain, state, work):
    """Set the efforts of the drives back to those at the beginning of a step that is refused."""
    for i in range(state.movers.shape[0]):
        if chain.vehicles[i].engine >= 0:
            state.movers[i].traction_n, state.movers[i].electric_n = work.efforts[i, 0], work.efforts[i, 1]


@njit
def set_efforts(chain, state, control, v, tau_s, work):
    """Write the efforts of the drives `tau_s` after the beginning of a step, at which the speeds are `v` [m/s].

    The lag of Zobory and Bekefi, eq. 2, as the differential equation that it solves, integrated exactly for a steady effort
    that changes linearly with time.
    """
    for i in range(state.movers.shape[0]):
        row = chain.vehicles[i].engine
        if row >= 0:
            engine, mover = chain.engines[row], state.movers[i]
            traction, electric = _aims(chain, i, control, abs(v[i]))
            mover.traction_n = lagged(work.efforts[i, 0], work.aims[i, 0], traction, tau_s, engine.time_constant_s)
            mover.electric_n = lagged(work.efforts[i, 1], work.aims[i, 1], electric, tau_s, engine.electric_s)


@njit
def _aims(chain, i, control, speed):
    """Return the steady tractive and electric effort of the powered vehicle i [N]."""
    vehicle = chain.vehicles[i]
    cap = chain.engines[vehicle.engine].adhesive_n * adhesion(vehicle, speed)
    traction = min(steady_effort(chain, vehicle.engine, control.drive, speed), cap)
    return traction, electric_effort(chain, vehicle.engine, control.electric, speed)


@njit
def set_applied(chain, state, s, v, is_taken, work):
    """Write what acts on each vehicle besides friction into `work.applied` [N]: tractive effort, gradient, couplings.

    Where the instant `is_taken` over, and not only tried, the couplings remember it.
    """
    movers = state.movers
    n = movers.shape[0]
    mean_grade = chain.chain[0].mean_grade
    mean = _mean_slope(chain, movers, s) if mean_grade else 0.0
    ahead = 0.0
    for i in range(n):
        mover, vehicle = movers[i], chain.vehicles[i]
        if mean_grade:
            mover.grade_n = vehicle.weight_n * mean
        else:
            mover.slope_row = row_at(chain.slopes, s[i], mover.slope_row)
            mover.grade_n = vehicle.weight_n * slope_at(chain.slopes, mover.slope_row, s[i])
        behind = 0.0
        if i + 1 < n:
            stretch = stretch_of(chain, i, s[i], s[i + 1])
            link, row, rate = state.links[i], chain.couplings[i], v[i] - v[i + 1]
            if is_taken:
                work.damper[i] = commit_coupling(chain, link, row, stretch, rate)
                behind = link.force_n
            else:
                behind, work.damper[i] = coupling_force(chain, link, row, stretch, rate)
            work.force[i] = behind
        traction = mover.traction_n if vehicle.engine >= 0 else 0.0
        work.applied[i] = traction - mover.grade_n + ahead - behind
        ahead = behind


@njit
def _mean_slope(chain, movers, s):
    """Return the mean slope under the train (Arshad et al., eq. 11)."""
    length = chain.chain[0].length_m
    head = s[0] + chain.vehicles[0].behind_m
    tail = head - length
    front, rear = movers[0], movers[movers.shape[0] - 1]
    front.slope_row = row_at(chain.slopes, head, front.slope_row)
    row = row_at(chain.slopes, tail, rear.slope_row if movers.shape[0] > 1 else front.slope_row)
    return (height_at(chain.slopes, front.slope_row, head) - height_at(chain.slopes, row, tail)) / length


@njit
def set_friction(chain, state, s, v, share, work):
    """Write the most that friction can be on each vehicle, at places `s` [m] and speeds `v` [m/s], into `work.friction` [N].

    `share` is how far the step has come, between the cylinder pressures at its beginning and its end. One call for all: the
    tables of a chain are too many to be handed over for each vehicle.
    """
    for i in range(state.movers.shape[0]):
        work.friction[i] = _resisting(chain, i, state.movers[i], s[i], v[i], share)


@inlined
def _resisting(chain, i, mover, s_m, v_mps, share):
    """Write what resists vehicle i by friction at a place and speed, and return its sum [N].

    Running resistance with curve and tunnel, air brake, electric brake. Adhesion caps the brakes, or the whole as Zobory and
    Bekefi print it (eq. 6); the parts shrink alike then.
    """
    vehicle = chain.vehicles[i]
    speed = abs(v_mps)
    mover.curve_row = row_at(chain.bends, s_m, mover.curve_row)
    running = vehicle.a_n + (vehicle.b_ns_per_m + vehicle.c_ns2_per_m2 * speed) * speed
    running += vehicle.weight_n * bend_resistance(chain.bends, chain.bend, mover.curve_row, s_m)
    braking = 0.0
    if vehicle.brake >= 0:
        cylinder = mover.cylinder_before_pa + share * (mover.cylinder_pa - mover.cylinder_before_pa)
        independent = mover.independent_before_pa + share * (mover.independent_pa - mover.independent_before_pa)
        braking = brake_force(chain, i, cylinder, independent, speed)
    electric = mover.electric_n if vehicle.engine >= 0 else 0.0
    cap_all = chain.chain[0].cap_all
    wheels = braking + electric
    if wheels > 0.0 or cap_all:
        whole = wheels + running if cap_all else wheels
        cap = vehicle.adhesive_n * adhesion(vehicle, speed)
        if whole > cap:
            part = cap / whole
            braking, electric = braking * part, electric * part
            if cap_all:
                running *= part
    mover.resistance_n, mover.brake_n, mover.electric_acting_n = running, braking, electric
    return running + braking + electric
