"""The electric side of a train beside its traction: auxiliaries, current limits, what the line takes back of braking."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined
from tractionpower.kernels.train_tables import (
    BY_LINE_CURRENT,
    BY_TRAIN_CURRENT,
    BY_VOLTAGE,
)


@inlined
def auxiliary_current(train, u):
    """Return the current of the auxiliaries at the voltage `u` [A].

    Constant power down to U_min2, below it P U / U_min2^2; resistive heating grows with U.
    """
    if u <= 0.0:
        return 0.0
    reduced = u / (train.lowest_v * train.lowest_v) if u < train.lowest_v else 1.0 / u
    return train.auxiliary_w * reduced + train.heating_s * u


@inlined
def current_limit(train, u, line_a):
    """Return the largest current of the train at the voltage `u` [A] and what sets it.

    Below the knee a U_n the train's own limit falls linearly to the current of the auxiliaries at U_min2, where it leaves
    nothing for traction (shape of EN 50388, figure 1); the limit `line_a` of the line holds as well, and the lower one wins.
    """
    limit, by = train.max_current_a, BY_TRAIN_CURRENT
    if u <= train.lowest_v and train.knee_v > 0.0:
        return 0.0, BY_VOLTAGE
    if u < train.knee_v:
        foot = auxiliary_current(train, train.lowest_v)
        share = (u - train.lowest_v) / (train.knee_v - train.lowest_v)
        limit, by = foot + (limit - foot) * share, BY_VOLTAGE
    return (line_a, BY_LINE_CURRENT) if line_a < limit else (limit, by)


@inlined
def feed_back_share(train, u):
    """Return which share of what is left of the braking power the line gets at the voltage `u`: 1, folding back to 0."""
    if not train.regenerates or u >= train.fold_to_v:
        return 0.0
    if u <= train.fold_from_v:
        return 1.0
    return (train.fold_to_v - u) / (train.fold_to_v - train.fold_from_v)
