"""The air brake: reduction of the pipe, its delay along the train, cylinders, force of the blocks.

The reduction at the driver's valve tends exponentially to the one commanded (Zobory and Bekefi, eq. 3); a vehicle sees it
later by its delay; its cylinder aims at `gain` times that reduction, at most at its greatest pressure, and follows the aim
with a time constant of its own, one for filling and one for emptying. All of it is integrated in closed form: a step is
cut where a command arrives, where the aim meets the greatest pressure, and where filling turns to emptying.
"""

from __future__ import annotations

import math

from tractionpower.kernels.jit import inlined

_DEAD = 40.0
"""Time constants after which an exponential is nothing beside what it tends to (4e-18)."""


@inlined
def move_brakes(chain, state, t_s, h_s):
    """Move the pressures of all cylinders and independent brakes from the time `t_s` to `t_s + h_s` [s].

    What they were is kept in `cylinder_before_pa` and `independent_before_pa`. The rows of `state.pipe` and `state.controls`
    beyond `ledger.pipe_rows` and `ledger.control_rows` are not read.
    """
    air, pipe, rows = chain.air[0], state.pipe, state.ledger[0].pipe_rows
    for i in range(state.movers.shape[0]):
        kind = chain.vehicles[i].brake
        mover = state.movers[i]
        mover.cylinder_before_pa, mover.independent_before_pa = mover.cylinder_pa, mover.independent_pa
        if kind >= 0:
            brake = chain.brakes[kind]
            row = _arrived(pipe, rows, mover.pipe_row, t_s - brake.delay_s)
            mover.cylinder_pa, mover.pipe_row = _cylinder(air, pipe, (rows, row), brake.delay_s, mover.cylinder_pa, t_s, h_s)
            if brake.independent:
                mover.independent_pa = _independent(state, air.independent_s, mover.independent_pa, t_s, h_s)


@inlined
def reduction_at(chain, state, t_s):
    """Return the reduction of the pipe at the driver's valve at the time `t_s` [s] (Zobory and Bekefi, eq. 3) [Pa]."""
    pipe, low, high = state.pipe, 0, state.ledger[0].pipe_rows
    while high - low > 1:
        middle = (low + high) // 2
        if pipe[middle].from_s <= t_s:
            low = middle
        else:
            high = middle
    row = pipe[low]
    return row.target_pa + (row.start_pa - row.target_pa) * _left(t_s - row.from_s, row.time_constant_s)


@inlined
def brake_force(chain, vehicle_row, cylinder_pa, independent_pa, v):
    """Return the braking force of the blocks of a vehicle at the speed `v` [m/s], not capped by adhesion [N].

    Force of all blocks by cylinder, piston and rigging (Zobory and Bekefi, eq. 4), times their friction (eq. 5). Air brake
    and independent brake act on the same cylinder: the greater pressure counts.
    """
    kind = chain.vehicles[vehicle_row].brake
    if kind < 0:
        return 0.0
    brake = chain.brakes[kind]
    force = max(cylinder_pa, independent_pa) * brake.newton_per_pa
    if force <= 0.0:
        return 0.0
    return force * friction_of(chain.frictions[brake.friction], chain.grid, force / brake.blocks, abs(v))


@inlined
def friction_of(law, grid, force, speed):
    """Return the coefficient of friction of a block at its force [N] and the speed [m/s].

    By the formula of the record, or bilinear in a table whose edges are held.
    """
    if law.speeds == 0:
        by_force = (law.f1 * force + 1.0) / (law.f2 * force + 1.0)
        return law.mu * by_force * (law.v1 * speed + 1.0) / (law.v2 * speed + 1.0)
    first_force = law.first_speed + law.speeds
    table = first_force + law.forces
    i, x = _between(grid, law.first_speed, law.speeds, speed)
    j, y = _between(grid, first_force, law.forces, force)
    lower, upper = table + i * law.forces + j, table + min(i + 1, law.speeds - 1) * law.forces + j
    right = min(j + 1, law.forces - 1) - j
    slow = grid[lower] + y * (grid[lower + right] - grid[lower])
    fast = grid[upper] + y * (grid[upper + right] - grid[upper])
    return slow + x * (fast - slow)


@inlined
def _between(grid, first, count, at):
    """Return behind which of `count` rising numbers `at` lies, and how far on to the next (0 to 1)."""
    k = 0
    while k + 2 < count and grid[first + k + 1] <= at:
        k += 1
    if count < 2:
        return 0, 0.0
    here, after = grid[first + k], grid[first + k + 1]
    return k, min(max((at - here) / (after - here), 0.0), 1.0)


@inlined
def _left(time_s, time_constant_s):
    """Return what is left after a time of a difference that dies away exponentially."""
    if time_s <= 0.0:
        return 1.0 if time_constant_s > 0.0 else 0.0
    if time_s >= _DEAD * time_constant_s:  # also where there is no time constant
        return 0.0
    return math.exp(-time_s / time_constant_s)


@inlined
def _arrived(pipe, rows, row, t_s):
    """Return the row of the pipe that holds at the time `t_s` at the driver's valve, searched from `row` both ways."""
    row = min(row, rows - 1)
    while row > 0 and pipe[row].from_s > t_s:
        row -= 1
    while row + 1 < rows and pipe[row + 1].from_s <= t_s:
        row += 1
    return row


@inlined
def _cylinder(air, pipe, span, delay_s, pressure, t_s, h_s):
    """Return the pressure of a cylinder after `h_s`, and the row of the pipe that has arrived then.

    `span` are the rows in use and the one that holds at the beginning.
    """
    rows, row = span
    begin = 0.0
    while True:
        here = pipe[row]
        end = h_s
        more = row + 1 < rows
        if more:
            arrives = pipe[row + 1].from_s + delay_s - t_s
            more = arrives <= h_s
            if more:
                end = arrives
        if end > begin or not more:
            since = t_s - delay_s - here.from_s + begin
            aim = air.gain * here.target_pa
            away = air.gain * (here.start_pa - here.target_pa) * _left(since, here.time_constant_s)
            most = air.cylinder_emergency_pa if here.emergency else air.cylinder_pa
            fill = air.emergency_fill_s if here.emergency else air.fill_s
            pressure = _follow(pressure, (aim, away, here.time_constant_s, most), fill, air.release_s, end - begin)
            begin = end
        if not more:
            return pressure, row
        row += 1


@inlined
def _follow(pressure, aim, fill_s, release_s, length_s):
    """Return the pressure of a cylinder after `length_s` [s] on one row of the pipe.

    Parameters
    ----------
    pressure
        At the beginning [Pa].
    aim
        A, B, T and M of min(A + B exp(-s/T), M): what the cylinder follows over the time s [Pa, Pa, s, Pa].
    fill_s, release_s
        Time constant below the aim, and above it [s].
    length_s
        How long [s].
    """
    rest, away, lag_s, most = aim
    time_left = length_s
    while True:
        end, met = time_left, False
        # Where A and A + B lie on either side of M, the aim crosses it once; the ratio tells whether it has done so already.
        if away * (most - rest) > 0.0:
            ahead = away > most - rest if away > 0.0 else away < most - rest
            capped = ahead == (away > 0.0)
            if ahead:
                until = lag_s * math.log(away / (most - rest))
                if until < end:
                    end, met = until, True
        else:
            capped = rest > most or (rest == most and away > 0.0)
        if capped:
            pressure = most + (pressure - most) * _left(end, fill_s if pressure < most else release_s)
            away = most - rest if met else away * _left(end, lag_s)
        else:
            pressure, away, until = _chase(pressure, (rest, away, lag_s), fill_s, release_s, end)
            if until < end:
                end, met = until, True
            elif met:
                away = most - rest
        if not met:
            return pressure
        time_left -= end


@inlined
def _chase(pressure, aim, fill_s, release_s, length_s):
    """Return a pressure that follows A + B exp(-s/T) until it meets it or the time is over, B then, and the time.

    The solution of p' = (A + B exp(-s/T) - p) / T_c is A + (p - A) exp(-s/T_c) + B g(s). A pressure and an aim that approach
    each other meet once, and the other time constant holds from there on; those that part never meet.
    """
    rest, away, lag_s = aim
    gap = rest + away - pressure
    if (gap > 0.0 and fill_s <= 0.0) or (gap < 0.0 and release_s <= 0.0):
        gap, pressure = 0.0, rest + away
    own_s = fill_s if gap > 0.0 or (gap == 0.0 and away < 0.0) else release_s
    if own_s <= 0.0:
        away *= _left(length_s, lag_s)
        return rest + away, away, length_s
    if gap * away > 0.0:
        q = (lag_s - own_s) / own_s * gap / away
        if q > -1.0:
            until = lag_s * gap / away * (math.log1p(q) / q if q != 0.0 else 1.0)
            if until < length_s:
                away *= _left(until, lag_s)
                return rest + away, away, until
    shared = away * _share(length_s, own_s, lag_s) if away != 0.0 else 0.0
    pressure = rest + (pressure - rest) * _left(length_s, own_s) + shared
    return pressure, away * _left(length_s, lag_s), length_s


@inlined
def _share(time_s, own_s, lag_s):
    """Return g = (exp(-s/T) - exp(-s/T_c)) T / (T - T_c), what an exponential aim has passed on; T = T_c is no exception."""
    z = time_s * (1.0 / own_s - 1.0 / lag_s)
    if z > 0.0:
        return time_s / own_s * _left(time_s, lag_s) * (-math.expm1(-z) / z)
    return time_s / own_s * _left(time_s, own_s) * (math.expm1(z) / z if z < 0.0 else 1.0)


@inlined
def _independent(state, time_constant_s, pressure, t_s, h_s):
    """Return the pressure of an independent brake after `h_s`: it follows what the driver sets, without delay."""
    controls, last = state.controls, state.ledger[0].control_rows - 1
    row = min(max(state.ledger[0].control_row, 0), last)
    while row > 0 and controls[row].at_s > t_s:
        row -= 1
    while row < last and controls[row + 1].at_s <= t_s:
        row += 1
    begin = t_s
    while True:
        end = t_s + h_s
        more = row < last and controls[row + 1].at_s < end
        if more:
            end = controls[row + 1].at_s
        aim = controls[row].independent_pa
        pressure = aim + (pressure - aim) * _left(end - begin, time_constant_s)
        if not more:
            return pressure
        begin = end
        row += 1
