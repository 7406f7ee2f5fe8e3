"""What a train as a whole takes from the line over one step, traction, auxiliaries and braking netted; and its row."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined, njit
from tractionpower.kernels.pantograph import auxiliary_current, feed_back_share
from tractionpower.kernels.traction import traction
from tractionpower.kernels.train_tables import BY_VOLTAGE, INVERTER, TABLE

OWN_CUT, COVERED, FED_BACK = 16, 32, 64
"""Added to the piece of traction for a regime: the line cuts the auxiliaries, braking covers a part, or all and more."""


@inlined
def demanded_traction(tables, train, trial, demand, u):
    """Return what `traction.traction` does, for a demand at the voltage `u` [V].

    Below U_min2 the current of a table drive falls with the voltage, and its power with the square, as auxiliaries do.
    """
    midpoint = (demand.speed_mps, demand.half_s_per_kg, demand.resistance_n, demand.mean_mps)
    at = max(u, train.lowest_v) if train.drive == TABLE else u
    got_w, taken, resistor_w, by, piece = traction(tables, train, trial, demand.need_w, (at, demand.line_a), midpoint)
    if at > u:
        share = max(u, 0.0) / at
        got_w, taken, by = got_w * share * share, taken * share, BY_VOLTAGE
    return got_w, taken, resistor_w, by, piece


@inlined
def own_current(train, demand, u):
    """Return the mean current of auxiliaries and heating in the step at the voltage `u` [V], without regard to braking [A].

    Below U_min2 it falls with the voltage, where the limit of the line cuts it, too.
    """
    at = max(u, train.lowest_v)
    return min(auxiliary_current(train, at), demand.line_a) * demand.on_line * (max(u, 0.0) / at)


@njit
def demand_current(tables, train, trial, demand, u):
    """Return the mean current of a train in a step at the voltage `u` [V], positive from the line.

    The electric brake feeds the train's own needs first; fold-back acts on what is left. Below U_min2 the current of a
    train that brakes falls with the voltage.

    Returns
    -------
    current : float
        Current at the pantograph [A].
    regime : int
        Number of the piece of the characteristic; within one the current is smooth.
    """
    if u <= 0.0:
        return 0.0, 0
    brakes = demand.gained_w > 0.0 and train.regenerates
    at = max(u, train.lowest_v) if brakes else u
    current, regime = own_current(train, demand, at), 0
    if demand.need_w > 0.0:
        _, taken, _, _, regime = demanded_traction(tables, train, trial, demand, at)
        current += taken * demand.moving
    if auxiliary_current(train, max(at, train.lowest_v)) > demand.line_a:
        regime += OWN_CUT
    if brakes:
        own_w = at * current
        if own_w >= demand.gained_w:
            current, regime = (own_w - demand.gained_w) / at, regime + COVERED
        else:
            current, regime = -feed_back_share(train, at) * (demand.gained_w - own_w) / at, regime + FED_BACK
        current *= u / at
    return current, regime


@inlined
def fill_row(train, tally, row, spent, line, parts):
    """Fill what the electric side of a step says: brakes, auxiliaries, power, losses.

    What the line refuses of the braking power goes to the braking resistors, and the rest to the friction brakes, which
    does not change the motion.

    Parameters
    ----------
    spent : float
        Length of the step [s].
    line : tuple
        Voltage [V] and current [A] of the train.
    parts : tuple
        Power of auxiliaries and of traction from the line, heat in starting resistors [W].
    """
    u, current = line
    auxiliary_w, traction_w, resistor_w = parts
    row.voltage_v, row.current_a, row.power_w = u, current, u * current
    row.wheel_w, row.brake_w = tally.traction_j / spent, tally.brake_j / spent
    row.returned_w = max(-row.power_w, 0.0)
    gained = train.brake_efficiency * tally.electric_j / spent
    recovered = 0.0
    if train.regenerates and tally.brake_j > 0.0:  # where braking was not as expected, the friction brakes make it up
        recovered = min(max(auxiliary_w + traction_w - row.power_w, 0.0), train.brake_efficiency * row.brake_w)
        gained = max(gained, recovered)
    refused = gained - recovered if train.regenerates else 0.0
    off_w = row.electric_brake_n = 0.0
    if tally.off_brake_j > 0.0:  # where nothing can be fed back
        off_w = train.brake_efficiency * tally.off_brake_j / spent
        row.electric_brake_n = tally.off_brake_ns / spent
    heated = min(gained - recovered, max(train.rheostat_w - off_w, 0.0))
    if recovered + heated > 0.0:
        electric_w = (recovered + heated) / train.brake_efficiency
        slow = tally.electric_ns / tally.electric_j if tally.electric_j > 0.0 else tally.brake_ns / tally.brake_j
        row.electric_brake_n = min(row.electric_brake_n + electric_w * slow, tally.brake_ns / spent)
    row.braking_resistor_w = heated + off_w
    row.auxiliary_w, row.starting_resistor_w = auxiliary_w, resistor_w
    row.refused_w, row.recovered_w = refused, recovered
    if train.drive == INVERTER:
        row.drive_loss_w, row.fitted_w = (tally.line_j - tally.traction_j) / spent, 0.0
    else:
        row.drive_loss_w = traction_w - resistor_w - row.wheel_w
        row.fitted_w = row.power_w + recovered - auxiliary_w - traction_w
    row.traction_n = tally.traction_ns / spent
    row.friction_brake_n = tally.brake_ns / spent - row.electric_brake_n
    row.resistance_n = tally.resistance_ns / spent
    row.moved_m, row.on_line_s = tally.moved_m, tally.on_line_s
