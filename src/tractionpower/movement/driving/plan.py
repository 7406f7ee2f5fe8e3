"""Driving plans as rows: what a driver does along the route while the train is on time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import PIECE, POINT
from tractionpower.movement.compile import Movement
from tractionpower.movement.pools import Pool

Rows = NDArray[np.void]


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

    pieces: Rows
    caps: Rows
    dues: Rows
    late_after_s: float


def lay_plans(movement: Movement, plans: Mapping[int, Plan]) -> Movement:
    """Return the trains of `movement` with the plans of some of them, by their number; the others are driven flat out."""
    tables = movement.tables
    pieces, points, trains = Pool(PIECE), Pool(POINT), tables.trains.copy()
    pieces.add(tables.pieces)
    points.add(tables.points)
    for k, plan in plans.items():
        row = trains[k]
        row["first_plan"], row["plans"] = pieces.add(plan.pieces)
        row["first_cap"], row["caps"] = points.add(plan.caps)
        row["first_due"], row["dues"] = points.add(plan.dues)
        row["late_s"] = plan.late_after_s
    return replace(movement, tables=tables._replace(trains=trains, pieces=pieces.array(), points=points.array()))
