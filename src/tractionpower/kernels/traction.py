"""What traction takes from the line at a voltage, and the effort that voltage and current limits permit."""

from __future__ import annotations

from tractionpower.kernels.effort import efficiency_at, greatest_effort, look_up
from tractionpower.kernels.jit import inlined
from tractionpower.kernels.pantograph import auxiliary_current, current_limit
from tractionpower.kernels.series_motors import at_full, at_part
from tractionpower.kernels.train_tables import (
    BY_DRIVE,
    BY_NOTHING,
    BY_VOLTAGE,
    INVERTER,
    NO_DRIVE,
    SERIES_MOTORS,
)

AS_WISHED, BY_TABLE, AT_FULL, AT_LIMIT = 0, 1, 2, 8
"""Pieces of the characteristic of traction over the voltage."""

FULL = 1e-9
"""A wish this near to the greatest power is that."""

_HALVINGS = 50
_ROUNDS = 4
_CRAWL_MPS = 1e-3


@inlined
def traction(tables, train, mover, need_w, lines, midpoint):
    """Return what traction takes where it wishes the power `need_w`.

    Parameters
    ----------
    need_w : float
        Wished mean power of the step [W]: of an inverter drive from the line, of others at the wheel.
    lines : tuple
        Voltage [V], and largest train current that the line allows [A].
    midpoint : tuple
        Speed at the start of the step [m/s], half of its time over inertia [s/kg], resistance [N], mean speed [m/s].

    Returns
    -------
    power_w : float
        What it gets, of the kind of `need_w` [W].
    current_a, resistor_w : float
        Current from the line [A] and heat in starting resistors [W].
    by : int
        What limits it, if `power_w` is less than `need_w`.
    piece : int
        Which piece of the characteristic holds, one of `AS_WISHED`, `BY_TABLE`, `AT_FULL`, `AT_LIMIT`; added to the last one
        what sets the limit.
    """
    u, line_a = lines
    if not u > 0.0 or need_w <= 0.0:
        return 0.0, 0.0, 0.0, BY_VOLTAGE, AS_WISHED
    limit, by = current_limit(train, u, line_a)
    free = max(limit - auxiliary_current(train, u), 0.0)
    if train.drive == INVERTER:
        power, piece = u * free, AT_LIMIT + by
        if train.powers > 0:
            table, _ = look_up(tables.points, train.first_power, train.powers, u)
            table /= _efficiency_of(tables, train, mover, table, midpoint)
            if table < power:
                power, by, piece = table, BY_VOLTAGE, BY_TABLE
        if power >= need_w:
            power, piece = need_w, AS_WISHED
        return power, power / u, 0.0, by, piece
    if train.drive == NO_DRIVE:
        return 0.0, 0.0, 0.0, by, AS_WISHED
    power, resistor, piece, set_by = need_w, 0.0, AS_WISHED, by
    if train.drive == SERIES_MOTORS:
        notch = tables.notches[train.first_notch + mover.notch]
        current, most, resistor = at_full(tables, notch, u, midpoint)
        if need_w < most * (1.0 - FULL):
            current, resistor = at_part(tables, train, mover, u, need_w, midpoint)
    else:
        current, most = _table_at(tables, train, u, midpoint)
        if need_w < most * (1.0 - FULL):
            current *= need_w / most
    if need_w >= most * (1.0 - FULL):
        power, piece = min(most, need_w), AT_FULL
        if current <= free:
            by = BY_VOLTAGE if u < train.nominal_v else BY_DRIVE
    if current > free:  # the drive takes turns with off
        share = free / current
        return power * share, free, resistor * share, by, AT_LIMIT + set_by
    return power, current, resistor, by, piece


@inlined
def permitted_effort(tables, train, mover, v, lines):
    """Return the effort that voltage and limits permit at the speed `v` [m/s] itself.

    Returns
    -------
    effort_n, current_a, resistor_w : float
        Effort [N], current of traction [A], heat in starting resistors [W].
    by : int
        What limits it.
    """
    greatest, _, by = greatest_effort(tables, train, mover, v)
    need_w = greatest * v
    if train.drive == INVERTER:
        need_w /= efficiency_at(tables, train, v, 1.0)
    power, current, resistor_w, cut, _ = traction(tables, train, mover, need_w, lines, (v, 0.0, 0.0, v))
    if need_w <= 0.0:
        return 0.0, 0.0, 0.0, by
    if power >= need_w * (1.0 - FULL):
        return greatest, current, resistor_w, BY_NOTHING if greatest >= train.start_n else by
    if train.map_loads == 0:
        return greatest * power / need_w, current, resistor_w, cut
    low, high = 0.0, 1.0  # the efficiency depends on the share of the effort, which is sought
    for _ in range(_HALVINGS):
        share = 0.5 * (low + high)
        if share * greatest * v > power * efficiency_at(tables, train, v, share):
            high = share
        else:
            low = share
    return low * greatest, current, resistor_w, cut


@inlined
def _efficiency_of(tables, train, mover, wheel_w, midpoint):
    """Return the efficiency of an inverter drive that gives the power `wheel_w` [W], at the mean speed it leads to."""
    v, half, resistance, mean = midpoint
    if train.map_loads == 0 or mean <= 0.0:
        return train.efficiency
    for _ in range(_ROUNDS):
        mean = max(v + half * (min(wheel_w / mean, train.start_n) - resistance), _CRAWL_MPS)
    greatest, _, _ = greatest_effort(tables, train, mover, mean)
    return efficiency_at(tables, train, mean, min(wheel_w / (greatest * mean), 1.0))


@inlined
def _table_at(tables, train, u, midpoint):
    """Return current [A] and power at the wheel [W] of a table drive at full effort.

    Between the voltages of the table current and losses are linear in the voltage; beyond its ends effort and power are
    those of the nearest.
    """
    curves, first = tables.curves, train.first_curve
    last = first + train.curves - 1
    n = first
    while n < last and curves[n + 1].voltage_v <= u:
        n += 1
    low_i, low_w = _curve_at(tables, curves[n], midpoint)
    low_u = curves[n].voltage_v
    if n == last or u <= low_u:
        return low_i * low_u / u, low_w
    high_u = curves[n + 1].voltage_v
    high_i, high_w = _curve_at(tables, curves[n + 1], midpoint)
    x = (u - low_u) / (high_u - low_u)
    current = low_i + x * (high_i - low_i)
    low_loss, high_loss = low_u * low_i - low_w, high_u * high_i - high_w
    return current, u * current - (low_loss + x * (high_loss - low_loss))


@inlined
def _curve_at(tables, curve, midpoint):
    v, half, resistance, _ = midpoint
    effort, _ = look_up(tables.points, curve.first_effort, curve.efforts, v)
    mean = max(v + half * (effort - resistance), 0.0)
    effort, _ = look_up(tables.points, curve.first_effort, curve.efforts, mean)
    mean = max(v + half * (effort - resistance), 0.0)
    loss, _ = look_up(tables.points, curve.first_loss, curve.losses, mean)
    return (effort * mean + loss) / curve.voltage_v, effort * mean
