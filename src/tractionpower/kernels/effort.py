"""The greatest tractive effort of a drive over the speed, whatever the voltage, and what the line gives for it."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined
from tractionpower.kernels.train_tables import (
    BY_ADHESION,
    BY_DRIVE,
    BY_NOTHING,
    BY_VOLTAGE,
    INVERTER,
    NO_DRIVE,
    SERIES_MOTORS,
)


@inlined
def look_up(points, first, count, x):
    """Return y and its slope at `x` on a curve of `count` points from `first` on; constant beyond its ends."""
    last = first + count - 1
    if x < points[first].x:
        return points[first].y, 0.0
    if x >= points[last].x:
        return points[last].y, 0.0
    low, high = first, last
    while high - low > 1:
        middle = (low + high) // 2
        if points[middle].x <= x:
            low = middle
        else:
            high = middle
    slope = (points[high].y - points[low].y) / (points[high].x - points[low].x)
    return points[low].y + slope * (x - points[low].x), slope


@inlined
def greatest_effort(tables, train, mover, v):
    """Return the greatest effort at the wheel at the speed `v` [m/s] where the voltage does not limit it.

    An inverter drive gives min(F_start, P/v, pull-out ~ 1/v2); a table its curve of the highest voltage; series motors
    what the current of the starting resistors gives on the grouping and field step that are held. Adhesion limits all:
    mu = a / (v + b) + c (Curtius and Kniffler).

    Returns
    -------
    effort_n, slope : float
        Effort [N] and its derivative by the speed [N s/m].
    by : int
        What limits it.
    """
    effort, slope, by = train.start_n, 0.0, BY_NOTHING
    if train.drive == INVERTER:
        if effort * v > train.power_w:
            effort = train.power_w / v
            slope, by = -effort / v, BY_DRIVE
        if effort * v * v > train.pull_out_w_mps:
            effort = train.pull_out_w_mps / (v * v)
            slope, by = -2.0 * effort / v, BY_DRIVE
    elif train.drive == SERIES_MOTORS:
        if mover.relay_open:
            return 0.0, 0.0, BY_VOLTAGE
        notch = tables.notches[train.first_notch + mover.notch]
        effort, by = tables.motor[notch.first_point + notch.points - 1].effort_n, BY_DRIVE
    elif train.drive == NO_DRIVE:
        return 0.0, 0.0, BY_DRIVE
    else:
        curve = tables.curves[train.first_curve + train.curves - 1]
        effort, slope = look_up(tables.points, curve.first_effort, curve.efforts, v)
        by = BY_NOTHING if effort >= train.start_n else BY_DRIVE
    adhesion = adhesion_limit(train, v)
    if adhesion < effort:
        shifted = v + train.adhesion_b_mps
        return adhesion, -train.adhesive_n * train.adhesion_a_mps / (shifted * shifted), BY_ADHESION
    return effort, slope, by


@inlined
def adhesion_limit(train, v):
    """Return the effort that adhesion permits at the speed `v` [m/s]: mu = a / (v + b) + c (Curtius and Kniffler) [N]."""
    return train.adhesive_n * (train.adhesion_a_mps / (v + train.adhesion_b_mps) + train.adhesion_c)


@inlined
def efficiency_at(tables, train, v, share):
    """Return the efficiency of an inverter drive at the speed `v` [m/s] and a share of its greatest effort.

    The map is bilinear between its points and constant beyond its ends.
    """
    if train.map_loads == 0:
        return train.efficiency
    loads, first = tables.points, train.first_map
    # A curve over speed for each load lies behind the loads themselves, which are the points (load, first of curve).
    n = 0
    while n + 1 < train.map_loads and loads[first + n + 1].x <= share:
        n += 1
    low, _ = look_up(loads, int(loads[first + n].y), train.map_speeds, v)
    if n + 1 == train.map_loads or share <= loads[first + n].x:
        return low
    high, _ = look_up(loads, int(loads[first + n + 1].y), train.map_speeds, v)
    return low + (high - low) * (share - loads[first + n].x) / (loads[first + n + 1].x - loads[first + n].x)
