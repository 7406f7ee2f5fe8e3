"""Driving plans as rows: what a driver does along the route while the train is on time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import PIECE, POINT


@dataclass(frozen=True, eq=False)
class Plan:
    """A plan of one run, by the distance of the front [m].

    Attributes
    ----------
    pieces
        The ceiling that the driver keeps, records of `PIECE` in the form of `ceiling_of`: not above the train's own ceiling,
        the last piece at the end of the run. A train that is faster than it coasts.
    caps
        Share of the greatest effort, from each place to the next, records of `POINT`: 1 all, 0 coasting. The first at 0.
    dues
        When the front must be at a place [s after midnight] so that the plan still brings it to its next timed call on time,
        records of `POINT`, straight between; empty: the train is never late.
    late_after_s
        Lateness from which on the train is driven flat out until it is on time again [s].
    """

    pieces: NDArray[np.void]
    caps: NDArray[np.void]
    dues: NDArray[np.void]
    late_after_s: float


NO_PLAN = Plan(np.zeros(0, PIECE), np.zeros(0, POINT), np.zeros(0, POINT), np.inf)
"""Flat out."""
