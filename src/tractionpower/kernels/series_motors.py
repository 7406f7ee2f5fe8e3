"""DC series motors with starting resistors: groupings and field steps (notches), natural curves, duty cycles.

With k motors in series in a branch and the voltage U, starting resistors apart: U = k (I R_m + c phi(alpha I) n). Below
the natural curve starting resistors hold the set current, so the effort is constant and what the motors do not take is
heat. Notches lie in the order of rising effort: groupings by falling number of motors in series, in each the full field
first. Between notches a duty cycle of two neighbours gives the mean effort wished.
"""

from __future__ import annotations

from tractionpower.kernels.jit import njit

_BETTER = 1.02
_MUCH_BETTER = 1.25
_AS_GOOD = 0.99
_LESS = 0.8
_ENOUGH = 1.05
_CRAWL_MPS = 0.1


@njit
def at_full(tables, notch, u, midpoint):
    """Return what a notch takes and gives when it is fully on at the voltage `u` [V].

    Points of the motor curve are taken at the mean speed that their own effort leads to, v_0 + half (F - W); between
    points current and losses are linear in the voltage, so that power is exactly their difference.

    Parameters
    ----------
    midpoint : tuple
        Speed v_0 [m/s], half of step over inertia [s/kg], resistance W [N], mean speed of the trial [m/s].

    Returns
    -------
    current_a, wheel_w, resistor_w : float
        Current from the line [A], power at the wheel [W], heat in starting resistors [W].
    """
    if u <= 0.0:
        return 0.0, 0.0, 0.0
    v, half, resistance, _ = midpoint
    low_u = low_i = low_loss = 0.0
    current = loss = 0.0
    for j in range(notch.first_point + 1, notch.first_point + notch.points):
        point = tables.motor[j]
        mean = max(v + half * (point.effort_n - resistance), 0.0)
        high_u = notch.series * (point.current_a * notch.motor_ohm + point.emf_vs_per_m * mean)
        current = notch.branches * point.current_a
        loss = high_u * current - point.effort_n * mean
        if high_u >= u:
            x = (u - low_u) / (high_u - low_u)
            current = low_i + x * (current - low_i)
            loss = low_loss + x * (loss - low_loss)
            return current, u * current - loss, 0.0
        low_u, low_i, low_loss = high_u, current, loss
    return current, low_u * current - loss, (u - low_u) * current


@njit
def _can_be_held(tables, notch, v, u):
    """Tell whether a notch keeps its set current at the speed `v` and voltage `u`: field steps have no resistors."""
    if notch.full_field:
        return True
    top = tables.motor[notch.first_point + notch.points - 1]
    return notch.series * (top.current_a * notch.motor_ohm + top.emf_vs_per_m * v) >= u


@njit
def choose_notch(tables, train, mover, t, free_a):
    """Return the notch for the greatest effort at the speed and the last voltage of `mover`.

    A notch is left for a higher one that gives 2 % more effort. For a lower one it is left if that gives a quarter more,
    so that groupings do not alternate; by a train that slows down also if that gives the same with a fifth less
    current. It is not left before the least time per notch is over, unless its motor current would pass the set one.

    Parameters
    ----------
    t : float
        Time [s].
    free_a : float
        Current that limits leave for traction at the last voltage [A].
    """
    v, u = mover.v_mps, mover.voltage_v
    first = train.first_notch
    held = min(mover.notch, train.notches - 1)
    can = _can_be_held(tables, tables.notches[first + held], v, u)
    if can and t - mover.notch_since_s < train.notch_s:
        return held
    best, most, staying, taken = 0, -1.0, -1.0, 0.0
    if can:
        staying, taken = _effort_at(tables, tables.notches[first + held], u, v, free_a)
        best, most = held, staying
    for n in range(train.notches):
        notch = tables.notches[first + n]
        if n == held or not _can_be_held(tables, notch, v, u):
            continue
        effort, current = _effort_at(tables, notch, u, v, free_a)
        if n > held or not can:
            better = effort > _BETTER * most
        else:
            better = effort > max(_MUCH_BETTER * staying, most)
            better = better or (mover.slowing and best >= held and effort > _AS_GOOD * most and current < _LESS * taken)
        if better:
            best, most = n, effort
    return best


@njit
def _effort_at(tables, notch, u, v, free_a):
    """Return effort [N] and current [A] of a notch, which takes turns with off where its current is above `free_a`."""
    speed = max(v, _CRAWL_MPS)
    current, power, _ = at_full(tables, notch, u, (speed, 0.0, 0.0, speed))
    if current > free_a:
        return power * free_a / current / speed, free_a
    return power / speed, current


@njit
def lowest_notch(tables, train, mover, best, need_w, midpoint):
    """Return the lowest notch up to `best` that gives `need_w` [W] at the wheel at the last voltage, with some reserve."""
    first, u = train.first_notch, mover.voltage_v
    for n in range(best):
        notch = tables.notches[first + n]
        if _can_be_held(tables, notch, mover.v_mps, u):
            _, power, _ = at_full(tables, notch, u, midpoint)
            if power >= need_w * (1.0 if n == mover.notch else _ENOUGH):
                return n
    return best


@njit
def notch_below(tables, train, mover, held, need_w, midpoint):
    """Return the highest notch below `held` that gives less than `need_w` [W] at the wheel at the last voltage, or -1: off."""
    first, u = train.first_notch, mover.voltage_v
    for n in range(held - 1, -1, -1):
        notch = tables.notches[first + n]
        if _can_be_held(tables, notch, mover.v_mps, u):
            _, power, _ = at_full(tables, notch, u, midpoint)
            if power < need_w:
                return n
    return -1


@njit
def at_part(tables, train, mover, u, need_w, midpoint):
    """Return current [A] and heat in starting resistors [W] of a duty cycle that gives `need_w` [W] at the wheel.

    The held notch and the one chosen below it take turns; where the voltage makes the lower one too strong, it and off.
    Both are chosen before the voltage is known, so the current is continuous in the voltage.
    """
    first = train.first_notch
    high_i, high_w, high_r = at_full(tables, tables.notches[first + mover.notch], u, midpoint)
    low_i = low_w = low_r = 0.0
    if mover.below >= 0:
        low_i, low_w, low_r = at_full(tables, tables.notches[first + mover.below], u, midpoint)
        if low_w > need_w:
            high_i, high_w, high_r = low_i, low_w, low_r
            low_i = low_w = low_r = 0.0
    if high_w <= low_w:
        return high_i, high_r
    duty = min(max((need_w - low_w) / (high_w - low_w), 0.0), 1.0)
    return low_i + duty * (high_i - low_i), low_r + duty * (high_r - low_r)
