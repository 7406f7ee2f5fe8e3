"""Traction and electric brake of a vehicle: steady effort by level and speed, and its lag behind a change."""

from __future__ import annotations

import math

from tractionpower.kernels.effort import look_up
from tractionpower.kernels.jit import inlined


@inlined
def steady_effort(chain, engine_row, level, v):
    """Return the steady effort of a level of the drive control at the speed `v` [m/s], either way: F_inf(u1, v) [N].

    min(effort, power / v, pull-out ~ 1/v2), or by points, linear between them, held below the first and nothing beyond the last
    (Zobory and Bekefi, section 4, figure 8). Level 0 gives nothing, a level above the highest what the highest gives.
    """
    engine = chain.engines[engine_row]
    if level < 1 or engine.levels < 1:
        return 0.0
    row = chain.levels[engine.first_level + min(level, engine.levels) - 1]
    speed = abs(v)
    if row.points > 0:
        if speed > chain.curves[row.first_point + row.points - 1].x:
            return 0.0
        effort, _ = look_up(chain.curves, row.first_point, row.points, speed)
        return effort
    effort = row.effort_n
    if effort * speed > row.power_w:
        effort = row.power_w / speed
    if row.pull_out_w_mps > 0.0 and effort * speed * speed > row.pull_out_w_mps:
        effort = row.pull_out_w_mps / (speed * speed)
    return effort


@inlined
def electric_effort(chain, engine_row, share, v):
    """Return the steady effort of the electric brake at a share of its greatest, against the motion [N].

    share min(effort, power / v), fading linearly to nothing below the speed at which it fades. `v` [m/s], either way.
    """
    engine = chain.engines[engine_row]
    speed = abs(v)
    if share <= 0.0 or speed == 0.0:
        return 0.0
    effort = engine.electric_n
    if effort * speed > engine.electric_w:
        effort = engine.electric_w / speed
    if speed < engine.fades_mps:
        effort *= speed / engine.fades_mps
    return min(share, 1.0) * effort


@inlined
def lagged(before, aim_before, aim_after, tau_s, time_constant_s):
    """Return what follows an aim with the time constant T [s], the time `tau_s` [s] later: F' = (aim - F)/T.

    Exact for an aim that goes linearly from `aim_before` to `aim_after`; for a constant one this is eq. 2 of Zobory and
    Bekefi. A time constant of 0 follows at once.
    """
    if time_constant_s <= 0.0:
        return aim_after
    if tau_s <= 0.0:
        return before
    x = tau_s / time_constant_s
    came = -math.expm1(-x)  # share of the way to a constant aim
    return before + (aim_before - before) * came + (aim_after - aim_before) * (1.0 - came / x)
