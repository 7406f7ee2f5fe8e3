"""Sums and extremes of rail potentials, in one pass over the steps: places are many, and a day has many steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.jit import njit

RAIL_SUM = np.dtype(
    [
        ("count", "i8"),  # steps in which the potential is defined
        ("lowest_v", "f8"),
        ("lowest_s", "f8"),
        ("highest_v", "f8"),
        ("highest_s", "f8"),
        ("sum_v", "f8"),
        ("positive_v", "f8"),  # sum of what lies above earth
    ]
)
"""What is known of the rail potential of a place."""


def new_rail_sums(places: int) -> NDArray[np.void]:
    """Return sums of which nothing is known yet."""
    sums = np.zeros(places, RAIL_SUM)
    sums["lowest_v"], sums["highest_v"] = np.inf, -np.inf
    sums["lowest_s"] = sums["highest_s"] = np.nan
    return sums


@njit
def add_rails(sums, time_s, potential_v):
    """Add steps, one after the other; a potential that is not a number is not defined and does not count.

    Parameters
    ----------
    sums
        Records of `RAIL_SUM`, shape (places,).
    time_s, potential_v
        Start of the steps [s], shape (rows,), and potentials against remote earth [V], shape (rows, places).
    """
    for n in range(potential_v.shape[0]):
        for k in range(potential_v.shape[1]):
            u = potential_v[n, k]
            if np.isnan(u):
                continue
            place = sums[k]
            place.count += 1
            place.sum_v += u
            if u > 0.0:
                place.positive_v += u
            if u < place.lowest_v:
                place.lowest_v, place.lowest_s = u, time_s[n]
            if u > place.highest_v:
                place.highest_v, place.highest_s = u, time_s[n]
