"""The tally of a step: what forces have done to a train, added up over its phases."""

from __future__ import annotations

from tractionpower.kernels.effort import adhesion_limit, efficiency_at, greatest_effort
from tractionpower.kernels.jit import inlined
from tractionpower.kernels.train_tables import BY_NOTHING, INVERTER

TINY_S = 1e-9
"""Rest of a step that is not worth a phase [s]."""


@inlined
def clear(tally, v):
    """Start a step at the speed `v` [m/s]."""
    tally.entry_mps = v
    tally.traction_ns = tally.traction_j = tally.line_j = 0.0
    tally.brake_ns = tally.brake_j = tally.electric_ns = tally.electric_j = 0.0
    tally.resistance_ns = tally.resistance_j = tally.wished_ns = 0.0
    tally.moved_m = tally.moving_s = tally.on_line_s = 0.0
    tally.off_s = tally.off_m = tally.off_j = tally.dark_s = 0.0
    tally.off_brake_ns = tally.off_brake_j = 0.0
    tally.phase, tally.limited_by = -1, BY_NOTHING


@inlined
def powered_time(tally):
    """Return for how long a train moves and may take traction current [s]."""
    powered = tally.moving_s - tally.off_s
    return powered if powered > TINY_S else 0.0


@inlined
def mark(tally, phase, by):
    """Note the first phase of the step and what limits the effort in it."""
    if tally.phase < 0:
        tally.phase, tally.limited_by = phase, by


@inlined
def add_traction(tables, train, mover, tally, effort, way):
    """Add the tractive effort [N] of a phase over its way (distance [m], time [s])."""
    distance, spent = way
    work = effort * distance
    tally.traction_ns += effort * spent
    tally.traction_j += work
    if train.drive != INVERTER:
        tally.line_j += work
    elif train.map_loads == 0:
        tally.line_j += work / train.efficiency
    elif work > 0.0:
        mean = distance / spent
        share = effort / greatest_effort(tables, train, mover, mean)[0]
        tally.line_j += work / efficiency_at(tables, train, mean, share)


@inlined
def add_brake(train, tally, effort, distance, spent):
    """Add the brakes; the electric one gives what it and adhesion can at the mean speed."""
    mean = distance / spent if spent > 0.0 else 0.0
    electric = 0.0
    if mean > train.brake_from_mps and mean > 0.0:
        electric = min(effort, train.brake_n, train.brake_w / mean, adhesion_limit(train, mean))
    tally.brake_ns += effort * spent
    tally.brake_j += effort * distance
    tally.electric_ns += electric * spent
    tally.electric_j += electric * distance


@inlined
def add_resistance(tally, resistance, distance, spent):
    """Add the resistance [N] of a phase, its distance [m] and time [s]."""
    tally.resistance_ns += resistance * spent
    tally.resistance_j += resistance * distance
    tally.moved_m += distance
    tally.moving_s += spent
