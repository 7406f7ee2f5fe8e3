"""The port of a train: what it takes over the voltage in one step, as segments I(U) = a + b U + c/U.

Auxiliaries, inverter drives, the natural curves of series motors and braking with fold-back have this form exactly. What has
not, duty cycles of motors, drives by tables, heating while the line refuses power, is fitted piece by piece: through both
ends and the middle, so that any sum of constant current, conductance and power is met, split where the regime changes.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.demand import demand_current
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.train_tables import INVERTER, SERIES_MOTORS, TABLE

ROOM = 40
"""Segments that the port of a train has room for, beside two for each voltage of its tables."""

BREAKS = 64
"""Length of the scratch memory for break voltages."""

_FULL = 1e-9
_NARROW_V = 2.0  # a narrower piece is fitted by a straight line
_FINE_V = 1e-3
_APART_V = 0.01
_AROUND_V = (-400.0, -100.0, 0.0, 100.0, 400.0)  # of the last voltage, where duty cycles are fitted


@inlined
def _put(segments, s, from_v, a, b, c):
    segments[s].from_v = from_v
    segments[s].a, segments[s].b, segments[s].c = a, b, c
    return s + 1


@njit
def write_port(tables, state, k, port, segments, room, breaks):
    """Write the segments of the port of train `k` from its trial and demand.

    Parameters
    ----------
    tables : TrainTables
    state : TrainState
    k : int
    port : record of PORT
        Its number of segments is set.
    segments : ndarray of SEGMENT
    room : int
        Segments that it may have.
    breaks : ndarray
        Scratch memory [V].
    """
    train, demand = tables.trains[k], state.demands[k]
    first = port.first_segment
    end = _put(segments, first, -np.inf, 0.0, 0.0, 0.0)
    own_a = train.auxiliary_w / train.lowest_v + 2.0 * train.heating_s * train.nominal_v  # more than auxiliaries ever take
    brakes = demand.gained_w > 0.0 and train.regenerates
    drives = demand.need_w > 0.0
    limit_a = min(train.max_current_a, demand.line_a)
    if limit_a < own_a or (brakes and (drives or train.heating_s > 0.0)):
        end = _fit(tables, state, k, segments, (end, first + room), breaks)
    elif brakes:
        end = _write_braking(train, demand, segments, end)
    elif not drives:
        end = _write_own(train, demand, segments, end, 0.0)
    elif train.drive == INVERTER and train.powers == 0 and train.knee_v > train.lowest_v and demand.line_a >= train.max_current_a:
        end = _write_inverter(train, demand, segments, end)
    elif (
        train.drive == SERIES_MOTORS
        and train.knee_v <= train.lowest_v
        and _is_full(tables, train, state.trials[k], demand, limit_a - own_a)
    ):
        end = _write_motors(tables, train, state.trials[k], demand, segments, end)
    else:
        end = _fit(tables, state, k, segments, (end, first + room), breaks)
    port.segments = end - first


@njit
def write_constant_port(tables, state, k, port, segments, u):
    """Write the current of train `k` at the voltage `u` [V] for any voltage from U_min2 on, falling to zero below it.

    What is fed back folds back all the same: nothing else keeps the voltage of a line that nobody draws from.
    """
    train, demand = tables.trains[k], state.demands[k]
    i, _ = demand_current(tables, train, state.trials[k], demand, u)
    first, low = port.first_segment, train.lowest_v
    end = _put(segments, first, -np.inf, 0.0, 0.0, 0.0)
    end = _put(segments, end, 0.0, 0.0, i / low, 0.0)
    end = _put(segments, end, low, i, 0.0, 0.0)
    if i < 0.0:
        slope = i / (train.fold_to_v - train.fold_from_v)
        end = _put(segments, end, train.fold_from_v, slope * train.fold_to_v, -slope, 0.0)
        end = _put(segments, end, train.fold_to_v, 0.0, 0.0, 0.0)
    port.segments = end - first


@inlined
def _write_own(train, demand, segments, end, more_w):
    """Write auxiliaries and heating, with a constant power `more_w` [W] beside them."""
    power, heating, low = demand.on_line * train.auxiliary_w + more_w, demand.on_line * train.heating_s, train.lowest_v
    end = _put(segments, end, 0.0, 0.0, power / (low * low) + heating, 0.0)
    return _put(segments, end, low, 0.0, heating, power)


@inlined
def _write_braking(train, demand, segments, end):
    """Write a train without heating that brakes: what auxiliaries leave goes back, folding back with the voltage."""
    left = demand.gained_w - demand.on_line * train.auxiliary_w
    end = _write_own(train, demand, segments, end, -demand.gained_w)
    if left > 0.0:
        high, width = train.fold_to_v, train.fold_to_v - train.fold_from_v
        end = _put(segments, end, train.fold_from_v, left / width, 0.0, -left * high / width)
        end = _put(segments, end, high, 0.0, 0.0, 0.0)
    return end


@inlined
def _write_inverter(train, demand, segments, end):
    """Write traction up to its current limit, which falls below the knee, and of the wished power above."""
    low, knee, most = train.lowest_v, train.knee_v, train.max_current_a
    auxiliary, heating, moving, need = train.auxiliary_w, train.heating_s, demand.moving, demand.need_w
    end = _put(segments, end, 0.0, 0.0, demand.on_line * (auxiliary / (low * low) + heating), 0.0)
    foot = auxiliary / low + heating * low
    rise = (most - foot) / (knee - low)
    start = foot - rise * low
    still = demand.on_line - moving
    # The limit I gives the power u I - P - h u2: a parabola in u on both pieces.
    met = _root(rise - heating, start, auxiliary + need)
    end = _put(segments, end, low, moving * start, moving * rise + still * heating, still * auxiliary)
    if met > knee:
        met = max(_root(-heating, most, auxiliary + need), knee)
        end = _put(segments, end, knee, moving * most, still * heating, still * auxiliary)
    return _put(segments, end, met, 0.0, demand.on_line * heating, demand.on_line * auxiliary + moving * need)


@inlined
def _root(square, linear, constant):
    """Return the least u with square u2 + linear u = constant; infinite if there is none."""
    inside = linear * linear + 4.0 * square * constant
    if inside < 0.0:
        return np.inf
    divisor = linear + np.sqrt(inside)
    return 2.0 * constant / divisor if divisor > 0.0 else np.inf


@inlined
def _is_full(tables, train, trial, demand, free_a):
    """Tell whether series motors wish all that their notch gives at any voltage, and no current limit is near."""
    notch = tables.notches[train.first_notch + trial.notch]
    top = tables.motor[notch.first_point + notch.points - 1]
    mean = max(demand.speed_mps + demand.half_s_per_kg * (top.effort_n - demand.resistance_n), 0.0)
    return demand.need_w >= top.effort_n * mean * (1.0 - _FULL) and notch.branches * top.current_a <= free_a


@inlined
def _write_motors(tables, train, trial, demand, segments, end):
    """Write the natural curve of a notch, straight between the points of `series_motors.at_full`, and its set current above."""
    notch = tables.notches[train.first_notch + trial.notch]
    auxiliary, heating, low = demand.on_line * train.auxiliary_w, demand.on_line * train.heating_s, train.lowest_v
    own_b, own_c = auxiliary / (low * low) + heating, 0.0
    from_v = from_a = 0.0
    last = notch.first_point + notch.points
    for j in range(notch.first_point + 1, last + 1):
        a, b, until_v, until_a = from_a, 0.0, np.inf, from_a
        if j < last:
            point = tables.motor[j]
            mean = max(demand.speed_mps + demand.half_s_per_kg * (point.effort_n - demand.resistance_n), 0.0)
            until_v = notch.series * (point.current_a * notch.motor_ohm + point.emf_vs_per_m * mean)
            until_a = demand.moving * notch.branches * point.current_a
            if until_v <= from_v:
                from_a = until_a
                continue
            b = (until_a - from_a) / (until_v - from_v)
            a = from_a - b * from_v
        if from_v < low or own_c != 0.0:
            end = _put(segments, end, from_v, a, b + own_b, own_c)
        if own_c == 0.0 and until_v > low:  # the auxiliaries take constant power from here on
            own_b, own_c = heating, auxiliary
            end = _put(segments, end, max(low, from_v), a, b + own_b, own_c)
        from_v, from_a = until_v, until_a
    return end


@inlined
def _add_break(breaks, count, u, low, high):
    """Insert `u` into the rising `breaks` unless it is outside (low, high) or as good as there; return their number."""
    if not low < u < high or count == breaks.shape[0]:
        return count
    at = count
    while at > 0 and breaks[at - 1] > u:
        at -= 1
    if (at > 0 and u - breaks[at - 1] < _APART_V) or (at < count and breaks[at] - u < _APART_V):
        return count
    for n in range(count, at, -1):
        breaks[n] = breaks[n - 1]
    breaks[at] = u
    return count + 1


@njit
def _find_breaks(tables, train, trial, breaks):
    """Fill `breaks` with the voltages between which the characteristic is to be fitted; return their number."""
    low, high = train.lowest_v, 2.0 * train.nominal_v
    if train.drive == SERIES_MOTORS and train.knee_v <= low:  # no limit keeps motors from going on at lower voltages
        low *= 0.25
    breaks[0], breaks[1] = low, high
    count = _add_break(breaks, 2, train.lowest_v, low, high)
    count = _add_break(breaks, count, train.knee_v, low, high)
    count = _add_break(breaks, count, train.nominal_v, low, high)
    if train.regenerates:
        count = _add_break(breaks, count, train.fold_from_v, low, high)
        count = _add_break(breaks, count, train.fold_to_v, low, high)
    if train.drive == TABLE:
        for n in range(train.first_curve, train.first_curve + train.curves):
            count = _add_break(breaks, count, tables.curves[n].voltage_v, low, high)
    for n in range(train.first_power, train.first_power + train.powers):
        count = _add_break(breaks, count, tables.points[n].x, low, high)
    if train.drive == SERIES_MOTORS:
        for away in _AROUND_V:
            count = _add_break(breaks, count, trial.voltage_v + away, low, high)
    return count


@njit
def _fit(tables, state, k, segments, place, breaks):
    """Fit the characteristic between break voltages, from `place` (first segment, end of the room) on; return the end."""
    end, room = place
    train, trial, demand = tables.trains[k], state.trials[k], state.demands[k]
    count = _find_breaks(tables, train, trial, breaks)
    low = breaks[0]
    low_a, low_regime = demand_current(tables, train, trial, demand, low)
    end = _put(segments, end, 0.0, 0.0, low_a / low, 0.0)
    for n in range(1, count):
        high = breaks[n]
        high_a, high_regime = demand_current(tables, train, trial, demand, high)
        while low_regime != high_regime and end + count - n + 1 < room:
            kink = _find_kink(tables, train, trial, demand, (low, high, low_regime))
            kink_a, low_regime = demand_current(tables, train, trial, demand, kink)
            if kink - low > 2.0 * _FINE_V:
                end = _fit_piece(tables, state, k, segments, end, (low, low_a, kink, kink_a))
            if kink >= high:
                break
            low, low_a = kink, kink_a
        if high - low > 2.0 * _FINE_V:
            end = _fit_piece(tables, state, k, segments, end, (low, low_a, high, high_a))
        low, low_a, low_regime = high, high_a, high_regime
    return end


@njit
def _find_kink(tables, train, trial, demand, ends):
    """Return the voltage from which the regime is no longer that of the lower end."""
    low, high, regime = ends
    while high - low > _FINE_V:
        middle = 0.5 * (low + high)
        _, found = demand_current(tables, train, trial, demand, middle)
        if found == regime:
            low = middle
        else:
            high = middle
    return high


@njit
def _fit_piece(tables, state, k, segments, end, ends):
    """Put a segment through both ends of a piece and its middle."""
    low, low_a, high, high_a = ends
    b, c = (high_a - low_a) / (high - low), 0.0
    if high - low > _NARROW_V:
        middle = 0.5 * (low + high)
        middle_a, _ = demand_current(tables, tables.trains[k], state.trials[k], state.demands[k], middle)
        c = (b - (middle_a - low_a) / (middle - low)) * low * middle * high / (high - middle)
        b += c / (low * high)
    return _put(segments, end, low, low_a - b * low - c / low, b, c)
