"""Driving with the least energy for a running time: dynamic programming over the distance with a price of time.

For a price lambda of time the plan minimises (Howlett and Pudney 1995, energy-efficient train control, in Lagrange's form)

    J = sum over stages of  E + lambda t,      M (w' - w) / 2 = (F - B - W) ds,      t = 2 ds / (v + v'),      w = v2

with E the net energy at the pantograph and W the resistance at the middle of the stage. In a stage w is linear in the
distance, as in the pieces of a speed ceiling. The best controls are greatest effort, holding the speed, coasting, the electric
brake, and the service brake (Pontryagin's principle; recalled from Scheepmaker, Goverde and Kroon 2017); efforts between are
tried as well, because the efficiency of a drive may depend on its load. What each control costs and where it leads does not
depend on lambda, so it is found once (`lay_choices`), and a price takes one sweep over the table (`sweep`). The value is
interpolated between levels of w; the trajectory itself (`follow`) is not bound to levels.
"""

from __future__ import annotations

import numpy as np

from tractionpower.kernels.eco_drive import BRAKE_N, FIRST_POWER, FULL_N, SHARES, column_at, row_of
from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.wayside import additional_resistance

FULL, PART, HOLD, COAST, ELECTRIC, SERVICE = range(6)
"""Controls in a stage; all are clipped to the ceiling, which ends in braking where it falls."""

CONTROLS = 6

MODES = 4
"""Greatest effort; holding or some effort; coasting; braking."""

STAGE = np.dtype(
    [
        ("from_m", "f8"),
        ("length_m", "f8"),
        ("constant_n", "f8"),  # mean resistance by gradient, curves, tunnels
        ("drag", "f8"),  # what tunnels add to c [N s2/m2]
        ("service_mps2", "f8"),  # deceleration of the service brake, gradient included
        ("drive", "i8"),  # table of the drive
        ("part", "i8"),  # price of time that holds
        ("back", "f8"),  # share of what the brake feeds back that is taken at the voltage here
        ("floor_w", "f8"),  # square of the speed at its end below which the train does not coast (`lay_floors`)
    ]
)
"""A stage of the way."""

ECO = np.dtype(
    [
        ("inertia_kg", "f8"),
        ("a_n", "f8"),
        ("b_ns_per_m", "f8"),
        ("c_ns2_per_m2", "f8"),
        ("own_w", "f8"),  # auxiliaries, which braking feeds first
        ("gain", "f8"),  # efficiency of the electric brake where it feeds back, else 0
        ("back", "f8"),  # share of what is fed back and taken that counts
        ("slow_w", "f8"),  # square of the lowest cruising speed
        ("dv", "f8"),  # between rows of the drive, and between levels of the value
        ("level_v", "f8"),
    ]
)
"""What the planner needs of a train."""

_LEAST_W = 1e-4
_DEAR, _STALLED = 30.0, 1e6  # for a square of the speed [J/(kg m2/s2)], and beside that [J/kg]
_ARRIVING_W = 9.0  # square of the speed at which a train coasts to a stop, at least


@njit
def lay_slopes(tables, k, movers, stages):
    """Fill resistances and braking rates of `stages` for train `k`; `movers` holds one record for the search of knots."""
    train, mover = tables.trains[k], movers[0]
    for i in range(stages.shape[0]):
        length = stages[i].length_m
        constant, drag = additional_resistance(tables, train, mover, stages[i].from_m + 0.5 * length, length)
        stages[i].constant_n, stages[i].drag = constant, drag
        rate = train.service_mps2 + constant / train.inertia_kg
        stages[i].service_mps2 = max(rate, 0.1 * train.service_mps2)


@inlined
def _resistance(eco, stage, v):
    return eco.a_n + stage.constant_n + (eco.b_ns_per_m + (eco.c_ns2_per_m2 + stage.drag) * v) * v


@njit
def lay_floors(stages, ceilings, drives, eco_of):
    """Fill down to which speed a train may coast: to the lowest cruising speed, and below it where that leads to the stop.

    Where there is no power, and before that, it is the lowest cruising speed: a train must not come to a stand there.
    """
    eco, last = eco_of[0], stages.shape[0]
    floor = min(_ARRIVING_W, eco.slow_w) if ceilings[last] < _ARRIVING_W else eco.slow_w
    for i in range(last - 1, -1, -1):
        if drives[stages[i].drive, 0, FULL_N] <= 0.0:
            floor = eco.slow_w
        stages[i].floor_w = floor
        if floor < eco.slow_w:
            needed = floor + 2.0 * stages[i].length_m / eco.inertia_kg * _resistance(eco, stages[i], np.sqrt(floor))
            floor = min(max(needed, min(_ARRIVING_W, eco.slow_w)), eco.slow_w)


@inlined
def _led_to(drive, eco, stage, w, share, column):
    """Return the w [m2/s2] to which a share of a column's effort leads: the midpoint rule, by two predictions."""
    factor = 2.0 * stage.length_m / eco.inertia_kg
    after = w
    for _ in range(2):
        v = np.sqrt(max(0.5 * (w + after), 0.0))
        force = share * column_at(drive, row_of(drive, eco, v), column) if share != 0.0 else 0.0
        after = max(w + factor * (force - _resistance(eco, stage, v)), 0.0)
    v = np.sqrt(0.5 * (w + after))
    force = share * column_at(drive, row_of(drive, eco, v), column) if share != 0.0 else 0.0
    return w + factor * (force - _resistance(eco, stage, v))


@inlined
def _reach(drive, eco, stage, w, ceiling):
    """Return the w at the end of a stage by each control, clipped to the ceiling and to the lowest speeds."""
    high = min(max(_led_to(drive, eco, stage, w, 1.0, FULL_N), _LEAST_W), ceiling)
    coast = _led_to(drive, eco, stage, w, 0.0, FULL_N)
    low = min(max(w - 2.0 * stage.service_mps2 * stage.length_m, eco.slow_w), high)
    electric = coast
    if eco.gain > 0.0:
        electric = _led_to(drive, eco, stage, w, -1.0, BRAKE_N)
    hold = min(max(w, low), high)
    coast = min(max(coast, min(low, stage.floor_w)), high)
    return high, 0.5 * (hold + high), hold, coast, min(max(electric, low), high), low


@inlined
def _price(drive, eco, stage, w, after):
    """Return net energy at the pantograph without auxiliaries [J] and time [s] of a stage from `w` to `after`."""
    speeds = np.sqrt(w) + np.sqrt(after)
    spent = 2.0 * stage.length_m / speeds if speeds > 0.0 else 1e6
    v = 0.5 * speeds
    force = eco.inertia_kg * (after - w) / (2.0 * stage.length_m) + _resistance(eco, stage, np.sqrt(0.5 * (w + after)))
    row = row_of(drive, eco, v)
    if force > 0.0:
        full = column_at(drive, row, FULL_N)
        x = min(force / full, 1.0) * SHARES if full > 0.0 else 0.0
        n = min(int(x), SHARES - 1)
        below = column_at(drive, row, FIRST_POWER + n)
        return (below + (x - n) * (column_at(drive, row, FIRST_POWER + n + 1) - below)) * spent, spent
    gained = eco.gain * min(-force, column_at(drive, row, BRAKE_N)) * v
    own = min(gained, eco.own_w)
    return -(own + eco.back * stage.back * (gained - own)) * spent, spent


@inlined
def _too_slow(eco, stage, w, after):
    """Return what it costs to be slower than the train may be and not to accelerate [J]: who loses time would stall."""
    if after > w:
        return 0.0
    stalls = _STALLED if after <= _LEAST_W else 0.0
    return eco.inertia_kg * (stalls + _DEAR * max(stage.floor_w - after, 0.0))


@inlined
def _cell(eco, w, ceiling, levels):
    """Return where `w` lies between levels, as the number of the level below plus the share of the next."""
    v = np.sqrt(w) / eco.level_v
    j = min(int(v), levels - 2)
    below, above = (j * eco.level_v) ** 2, min(((j + 1) * eco.level_v) ** 2, ceiling)
    if above <= below:
        return float(j)
    return j + min(max((w - below) / (above - below), 0.0), 0.999999)


@njit
def lay_choices(stages, ceilings, drives, eco_of, choices):
    """Fill what every control costs from every level of every stage.

    Parameters
    ----------
    stages, ceilings
        Stages, and squares of the ceiling at their ends [m2/s2], one more.
    drives
        Tables of the drive, by `STAGE.drive`.
    eco_of
        One record of ECO.
    choices
        By stage, level, control: energy [J], time [s], place between levels at the end; levels above the ceiling stay empty.
    """
    eco, levels = eco_of[0], choices.shape[1]
    for i in range(stages.shape[0]):
        stage, drive, ceiling = stages[i], drives[stages[i].drive], ceilings[i + 1]
        for j in range(levels):
            w = min((j * eco.level_v) ** 2, ceilings[i])
            reached = _reach(drive, eco, stage, w, ceiling)
            for c in range(CONTROLS):
                energy, spent = _price(drive, eco, stage, w, reached[c])
                slow = _too_slow(eco, stage, w, reached[c]) if ceiling >= stage.floor_w else 0.0
                choices[i, j, c, 0], choices[i, j, c, 1] = energy + slow, spent
                choices[i, j, c, 2] = _cell(eco, reached[c], ceiling, levels)
            if w >= ceilings[i]:
                break


@inlined
def _mode(control):
    return 0 if control == FULL else 1 if control <= HOLD else 2 if control == COAST else 3


@njit
def sweep(stages, ceilings, eco_of, choices, prices, switch_s, value):
    """Fill the least `value` [J] at the start of every stage, by mode of the stage before and level.

    Parameters
    ----------
    prices : ndarray
        Prices of time by part [W]; below 0 time is paid for: the train brakes and runs slowly to lose it.
    switch_s : float
        What a change of the mode costs, as a time [s]. Holding a speed and running up and down about it need nearly the same
        energy, so without this cost the control would chatter.
    """
    eco, levels, last = eco_of[0], choices.shape[1], stages.shape[0]
    value[last] = 0.0
    for i in range(last - 1, -1, -1):
        price = prices[stages[i].part]
        change = abs(price) * switch_s
        for j in range(levels):
            best = np.inf
            for mode in range(MODES):
                value[i, mode, j] = np.inf
            for c in range(CONTROLS):
                x, mode = choices[i, j, c, 2], _mode(c)
                n = int(x)
                ahead = value[i + 1, mode, n] + (x - n) * (value[i + 1, mode, n + 1] - value[i + 1, mode, n])
                cost = choices[i, j, c, 0] + price * choices[i, j, c, 1] + ahead
                value[i, mode, j] = min(value[i, mode, j], cost)
                best = min(best, cost)
            for mode in range(MODES):
                value[i, mode, j] = min(value[i, mode, j], best + change)
            if (j * eco.level_v) ** 2 >= ceilings[i]:
                for mode in range(MODES):
                    for above in range(j + 1, levels):
                        value[i, mode, above] = value[i, mode, j]
                break


@njit
def follow(stages, ceilings, drives, eco_of, prices, value, switch_s, squares):
    """Run the best way through the stages and return its energy [J]; without `value` (no rows) the greatest effort.

    Parameters
    ----------
    squares : ndarray
        Squares of the speed at the ends of stages [m2/s2]; the first is given.
    """
    eco, before, total = eco_of[0], -1, 0.0
    for i in range(stages.shape[0]):
        stage, drive, ceiling, w = stages[i], drives[stages[i].drive], ceilings[i + 1], squares[i]
        reached = _reach(drive, eco, stage, w, ceiling)
        best, chosen, paid = np.inf, FULL, 0.0
        for c in range(CONTROLS):
            energy, spent = _price(drive, eco, stage, w, reached[c])
            if value.shape[0] == 0:
                paid = energy
                break
            price, mode = prices[stage.part], _mode(c)
            x = _cell(eco, reached[c], ceiling, value.shape[2])
            n = int(x)
            ahead = value[i + 1, mode, n] + (x - n) * (value[i + 1, mode, n + 1] - value[i + 1, mode, n])
            cost = energy + price * spent + ahead
            if ceiling >= stage.floor_w:
                cost += _too_slow(eco, stage, w, reached[c])
            if mode != before:
                cost += abs(price) * switch_s
            if cost < best:
                best, chosen, paid = cost, c, energy
        squares[i + 1], before = reached[chosen], _mode(chosen)
        total += paid
    return total


@njit
def keep_to_effort(stages, drives, eco_of, squares):
    """Lower `squares` [m2/s2] to what the greatest effort comes to."""
    for i in range(stages.shape[0]):
        stage = stages[i]
        high = _led_to(drives[stage.drive], eco_of[0], stage, squares[i], 1.0, FULL_N)
        squares[i + 1] = min(squares[i + 1], max(high, _LEAST_W))


@njit
def cost_of(stages, drives, eco_of, squares, efforts, shares):
    """Return the energy [J] of a way given by its `squares`.

    Fills the mean force of each stage [N], brakes negative, and its share of the greatest effort, 0 where it is not positive.
    """
    eco, total = eco_of[0], 0.0
    for i in range(stages.shape[0]):
        stage, drive = stages[i], drives[stages[i].drive]
        energy, _ = _price(drive, eco, stage, squares[i], squares[i + 1])
        change = eco.inertia_kg * (squares[i + 1] - squares[i]) / (2.0 * stage.length_m)
        efforts[i] = change + _resistance(eco, stage, np.sqrt(0.5 * (squares[i] + squares[i + 1])))
        full = column_at(drive, row_of(drive, eco, 0.5 * (np.sqrt(squares[i]) + np.sqrt(squares[i + 1]))), FULL_N)
        shares[i] = 0.0
        if efforts[i] > 0.0:
            shares[i] = efforts[i] / full if full > 0.0 else 1.0
        total += energy
    return total
