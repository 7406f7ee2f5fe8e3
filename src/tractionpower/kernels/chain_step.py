"""Steps of a chain of vehicles: leapfrog with friction as an impulse, and Runge-Kutta methods that meet each standstill.

Dry friction makes the equations discontinuous where a speed passes through zero. A leapfrog step takes friction as an impulse
that can bring a vehicle to a stand but not reverse it. In a Runge-Kutta step the direction of each vehicle is fixed and
those at rest are held; where a speed would pass through zero, the step is cut there and directions are judged anew.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.chain_forces import (
    begin_efforts,
    set_applied,
    set_efforts,
    set_friction,
    stretch_of,
    take_back_efforts,
)
from tractionpower.kernels.chain_state import DONE, STEP_TOO_SMALL
from tractionpower.kernels.chain_tables import EULER, RK4, VARIABLE
from tractionpower.kernels.couplings import commit_coupling
from tractionpower.kernels.jit import inlined, njit

_LEAST_PART = 1e-3
"""Part of a step below which it is not cut further where a vehicle comes to a stand."""

_LEAST_STEP_S = 1e-9
_SPEED_SCALE_MPS, _PLACE_SCALE_M = 1.0, 0.1
"""What the relative tolerance of a variable step is relative to: at least this speed, and this place."""

# Butcher tableaux by method; the row of SYMPLECTIC is not used
_A, _B, _C, _E = np.zeros((4, 7, 6)), np.zeros((4, 7)), np.zeros((4, 7)), np.zeros((4, 7))
_COUNT = np.array([0, 4, 1, 7])

_A[RK4, 1, 0], _A[RK4, 2, 1], _A[RK4, 3, 2] = 0.5, 0.5, 1.0
_B[RK4, :4] = 1 / 6, 1 / 3, 1 / 3, 1 / 6
_C[RK4, :4] = 0.0, 0.5, 0.5, 1.0

_B[EULER, 0] = 1.0

# Dormand and Prince, J. Comp. Appl. Math. 6 (1980), 19: RK5(4)7M
_A[VARIABLE] = [
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
    [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
    [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
    [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
    [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
]
_B[VARIABLE] = 35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84, 0.0
_C[VARIABLE] = 0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0
_E[VARIABLE] = _B[VARIABLE] - np.array([5179 / 57600, 0.0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40])


@njit
def leap(chain, state, control, h, work):
    """Move the chain by a leapfrog step of `h` [s]: half a step on, new speeds by the forces there, half a step on.

    Places move by the mean of the old and the new speed, so that force times way is exactly the change of kinetic energy. What
    depends on speed takes the one that the last step lets expect in the middle, which keeps the second order.
    """
    movers, ledger = state.movers, state.ledger[0]
    n = movers.shape[0]
    for i in range(n):
        mover = movers[i]
        work.middle_v[i] = mover.v_mps + 0.5 * h * mover.gain_mps2
        work.stage_s[i] = mover.s_m + 0.5 * h * mover.v_mps
    begin_efforts(chain, state, control, work)
    set_efforts(chain, state, control, work.middle_v, 0.5 * h, work)
    set_applied(chain, state, work.stage_s, work.middle_v, True, work)
    set_friction(chain, state, work.stage_s, work.middle_v, 0.5, work)
    for i in range(n):
        mover = movers[i]
        inertia = chain.vehicles[i].inertia_kg
        greatest = work.friction[i]
        free, drop = mover.v_mps + h * work.applied[i] / inertia, h * greatest / inertia
        after = free - drop if free > drop else (free + drop if free < -drop else 0.0)
        way = 0.5 * h * (mover.v_mps + after)
        mover.gain_mps2 = (after - mover.v_mps) / h if after != 0.0 else 0.0
        _count_works(ledger, chain, i, mover, greatest, (free - after) * inertia / h, way)
        work.stage_v[i] = way
        mover.v_mps = after
        mover.s_m += way
    for j in range(n - 1):
        link = state.links[j]
        longer = work.stage_v[j] - work.stage_v[j + 1]
        link.absorbed_j += work.force[j] * longer
        link.damper_j += work.damper[j] * longer
        ledger.coupling_j += work.force[j] * longer
    for i in range(n):
        work.stage_v[i] = movers[i].v_mps
    set_efforts(chain, state, control, work.stage_v, h, work)


@inlined
def _count_works(ledger, chain, i, mover, greatest, friction, way):
    """Add the works of a step of one vehicle; of the greatest friction the parts act in proportion."""
    if chain.vehicles[i].engine >= 0:
        ledger.traction_j += mover.traction_n * way
    ledger.grade_j += mover.grade_n * way
    if greatest > 0.0:
        part = friction / greatest * way
        ledger.resistance_j += mover.resistance_n * part
        ledger.brake_j += mover.brake_n * part
        ledger.electric_j += mover.electric_acting_n * part


@njit
def runge(chain, state, control, whole, work):
    """Move the chain by `whole` [s] with the Runge-Kutta method of the case, in one step or as many as it takes.

    Returns
    -------
    int
        `DONE`, or `STEP_TOO_SMALL`.
    """
    method, ledger = chain.chain[0].method, state.ledger[0]
    offset = 0.0
    wanted = ledger.step_s if method == VARIABLE else whole
    while whole - offset > 1e-12 * whole:
        h = min(wanted, whole - offset)
        _set_directions(chain, state, offset / whole, work)
        begin_efforts(chain, state, control, work)
        error, theta = _attempt(chain, state, control, (offset, h, whole), work)
        if method == VARIABLE and error > 1.0:
            wanted = h * max(0.2, 0.9 * error**-0.2)
            ledger.rejected += 1
            take_back_efforts(chain, state, work)
            if wanted < _LEAST_STEP_S:
                return STEP_TOO_SMALL
            continue
        taken = h
        if theta < 1.0:
            taken = max(theta * h, min(_LEAST_PART * whole, h))
            if taken < h:
                _attempt(chain, state, control, (offset, taken, whole), work)
            ledger.splits += 1
        elif method == VARIABLE:
            grown = h * min(5.0, 0.9 * max(error, 1e-8) ** -0.2)
            wanted = grown if h == wanted else max(wanted, grown)  # the end of the whole may have cut it
        _accept(chain, state, control, taken, theta, work)
        offset += taken
    if method == VARIABLE:
        ledger.step_s = wanted
    return DONE


@njit
def _set_directions(chain, state, share, work):
    """Judge which way each vehicle moves; hold those that are slow and that friction can hold (Zobory and Bekefi, eq. 6)."""
    movers, least = state.movers, chain.chain[0].standstill_mps
    slow = False
    for i in range(movers.shape[0]):
        mover = movers[i]
        work.stage_s[i], work.stage_v[i] = mover.s_m, mover.v_mps
        mover.direction = 1.0 if mover.v_mps > 0.0 else -1.0
        slow |= abs(mover.v_mps) <= least
    if not slow:
        return
    set_applied(chain, state, work.stage_s, work.stage_v, False, work)
    set_friction(chain, state, work.stage_s, work.stage_v, share, work)
    for i in range(movers.shape[0]):
        mover = movers[i]
        if abs(mover.v_mps) > least:
            continue
        greatest = work.friction[i]
        applied = work.applied[i]
        if greatest > 0.0 and abs(applied) <= greatest:
            _halt(chain, state, i)
            mover.direction = 0.0
        elif greatest > 0.0 or mover.v_mps == 0.0:
            mover.direction = 1.0 if applied > 0.0 else -1.0
            if mover.v_mps * mover.direction < 0.0:
                _halt(chain, state, i)


@njit
def _halt(chain, state, i):
    """Bring a vehicle to a stand; friction has taken what little motion it had."""
    mover = state.movers[i]
    state.ledger[0].resistance_j += 0.5 * chain.vehicles[i].inertia_kg * mover.v_mps * mover.v_mps
    mover.v_mps = 0.0


@njit
def _attempt(chain, state, control, times, work):
    """Compute a step, written into `work.stage_s` and `work.stage_v`, from the state, which stays; directions are fixed.

    Returns
    -------
    error : float
        Estimated error over the tolerance; 0 where the method has no estimate.
    theta : float
        Part of the step after which the first vehicle would pass through zero; 1 where none does.
    """
    method = chain.chain[0].method
    a, b, c, e, stages = _A[method], _B[method], _C[method], _E[method], _COUNT[method]
    offset, h, whole = times
    movers = state.movers
    n = movers.shape[0]
    for q in range(stages):
        for i in range(n):
            ds = dv = 0.0
            for r in range(q):
                if a[q, r] != 0.0:
                    ds += a[q, r] * work.speeds[r, i]
                    dv += a[q, r] * work.accelerations[r, i]
            work.stage_s[i] = movers[i].s_m + h * ds
            work.stage_v[i] = movers[i].v_mps + h * dv
            work.speeds[q, i] = work.stage_v[i]
        set_efforts(chain, state, control, work.stage_v, c[q] * h, work)
        set_applied(chain, state, work.stage_s, work.stage_v, False, work)
        _evaluate(chain, state, q, (offset + c[q] * h) / whole, work)
    error, theta = 0.0, 1.0
    tolerance = chain.chain[0].tolerance
    for i in range(n):
        ds = dv = es = ev = 0.0
        for q in range(stages):
            ds += b[q] * work.speeds[q, i]
            dv += b[q] * work.accelerations[q, i]
            es += e[q] * work.speeds[q, i]
            ev += e[q] * work.accelerations[q, i]
        v, direction = movers[i].v_mps, movers[i].direction
        after = v + h * dv
        work.stage_s[i], work.stage_v[i] = movers[i].s_m + h * ds, after
        if after * direction < 0.0 and work.friction[i] > 0.0:  # without friction, a speed passes through zero smoothly
            theta = min(theta, max(v * direction, 0.0) / abs(v - after))
        error = max(error, abs(h * ev) / (tolerance * max(abs(v), _SPEED_SCALE_MPS)), abs(h * es) / (tolerance * _PLACE_SCALE_M))
    return error, theta


@njit
def _evaluate(chain, state, q, share, work):
    """Write accelerations and powers of stage `q`."""
    movers = state.movers
    n = movers.shape[0]
    set_friction(chain, state, work.stage_s, work.stage_v, share, work)
    for k in range(work.powers.shape[1]):
        work.powers[q, k] = 0.0
    for i in range(n):
        mover, v = movers[i], work.stage_v[i]
        greatest = work.friction[i]
        direction = mover.direction
        work.accelerations[q, i] = (work.applied[i] - direction * greatest) / chain.vehicles[i].inertia_kg
        if direction == 0.0:
            work.accelerations[q, i] = 0.0
        if chain.vehicles[i].engine >= 0:
            work.powers[q, 0] += mover.traction_n * v
        work.powers[q, 1] += mover.electric_acting_n * v * direction
        work.powers[q, 2] += mover.brake_n * v * direction
        work.powers[q, 3] += mover.resistance_n * v * direction
        work.powers[q, 4] += mover.grade_n * v
        if i + 1 < n:
            rate = v - work.stage_v[i + 1]
            work.link_powers[q, i, 0], work.link_powers[q, i, 1] = work.force[i] * rate, work.damper[i] * rate


@njit
def _accept(chain, state, control, h, theta, work):
    """Take over the last attempt, a step of `h` [s]; whoever would have passed through zero stands."""
    movers, ledger = state.movers, state.ledger[0]
    n = movers.shape[0]
    method = chain.chain[0].method
    b = _B[method]
    for i in range(n):
        mover = movers[i]
        before = mover.v_mps
        mover.s_m, mover.v_mps = work.stage_s[i], work.stage_v[i]
        crossed = mover.v_mps * mover.direction < 0.0 and work.friction[i] > 0.0
        # the attempt that was cut at a zero ends there up to rounding of the guess
        nearly = theta < 1.0 and before != 0.0 and abs(mover.v_mps) < _LEAST_PART * abs(before)
        if crossed or nearly:
            _halt(chain, state, i)
        work.stage_v[i] = mover.v_mps
    for q in range(work.powers.shape[0]):
        if b[q] == 0.0:
            continue
        part = b[q] * h
        ledger.traction_j += part * work.powers[q, 0]
        ledger.electric_j += part * work.powers[q, 1]
        ledger.brake_j += part * work.powers[q, 2]
        ledger.resistance_j += part * work.powers[q, 3]
        ledger.grade_j += part * work.powers[q, 4]
        for j in range(n - 1):
            state.links[j].absorbed_j += part * work.link_powers[q, j, 0]
            state.links[j].damper_j += part * work.link_powers[q, j, 1]
            ledger.coupling_j += part * work.link_powers[q, j, 0]
    for j in range(n - 1):
        stretch = stretch_of(chain, j, work.stage_s[j], work.stage_s[j + 1])
        commit_coupling(chain, state.links[j], chain.couplings[j], stretch, work.stage_v[j] - work.stage_v[j + 1])
    set_efforts(chain, state, control, work.stage_v, h, work)
