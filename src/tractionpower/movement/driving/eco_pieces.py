"""Ways through legs as the rows that a driver follows: a ceiling in pieces, and caps of the effort."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import PIECE, POINT
from tractionpower.movement.driving.eco_legs import Floats, LegModel

FULL_SHARE = 0.98
"""From this share of the greatest effort on, a way is one of greatest effort."""

COASTING_MPS2 = 5e-4
"""A force that changes the speed by less than this is none [m/s2]."""

CLEARANCE, CLEARANCE_W = 0.02, 1.0
"""By which share, and by how much beside it [m2/s2], the ceiling lies above the square of the speed while coasting: slopes that
change inside a stage must not brake the train, which would miss that later."""

_SAME_SLOPE = 1e-12
_POWERED, _COASTS = 1.0, 0.0


@dataclass(frozen=True, eq=False)
class LegPlan:
    """Rows of one leg, by the distance from its start: `pieces` as records of PIECE, `caps` of POINT, and its length [m]."""

    pieces: NDArray[np.void]
    caps: NDArray[np.void]
    length_m: float


def plan_of_leg(leg: LegModel, squares: Floats) -> LegPlan:
    """Return the rows of a way through a leg.

    Where the train accelerates with its greatest effort the ceiling is level at the speed it comes to, so that effort and
    ceiling do not disagree by rounding; where it coasts it is a little above the way and the cap is 0; else the ceiling is
    the way itself. The ceiling falls without jumps, as that of the train does.
    """
    _, efforts, shares = leg.cost(squares)
    stages, inertia = leg.stages, float(leg.eco["inertia_kg"][0])
    full = (shares >= FULL_SHARE) & (squares[1:] > squares[:-1])
    idle = np.abs(efforts) < COASTING_MPS2 * inertia
    slowing = (efforts < 0.0) & (squares[1:] < squares[:-1])
    low, high = squares[:-1].copy(), squares[1:].copy()
    goals = _goals(full, squares)
    low[full] = high[full] = goals[full]
    raised = idle & np.append(idle[1:], False)
    high[raised] = high[raised] * (1.0 + CLEARANCE) + CLEARANCE_W
    low[idle] = low[idle] * (1.0 + CLEARANCE) + CLEARANCE_W
    # The train's own ceiling is straight in each stage; behind a rise the plan may begin below it, never above.
    high = np.minimum(high, leg.ceilings[1:])
    low = np.minimum(low, leg.starts)
    pieces = np.zeros(len(stages), PIECE)
    pieces["from_m"], pieces["w"], pieces["dw"] = stages["from_m"], low, (high - low) / stages["length_m"]
    caps = np.zeros(len(stages), POINT)
    caps["x"], caps["y"] = stages["from_m"], np.where(idle | slowing, _COASTS, _POWERED)
    caps["y"][0] = _POWERED if squares[0] == 0.0 else caps["y"][0]
    length = float(stages["from_m"][-1] + stages["length_m"][-1])
    return LegPlan(_without_straight(pieces, high), caps[np.append(True, np.diff(caps["y"]) != 0.0)], length)


def _goals(full: NDArray[np.bool_], squares: Floats) -> Floats:
    """Return for each stage of greatest effort the square of the speed at the end of the last one in a row."""
    goals, goal = np.zeros(len(full)), 0.0
    for i in range(len(full) - 1, -1, -1):
        if not (full[i] and i + 1 < len(full) and full[i + 1]):
            goal = squares[i + 1]
        goals[i] = goal
    return goals


def _without_straight(pieces: NDArray[np.void], ends: Floats) -> NDArray[np.void]:
    """Return `pieces`, which come to the squares `ends`, without those that go on as the one before."""
    jumps = np.abs(pieces["w"][1:] - ends[:-1]) > 0.0
    bends = np.abs(np.diff(pieces["dw"])) > _SAME_SLOPE
    return pieces[np.concatenate(([True], jumps | bends))]


def join_plans(
    own: NDArray[np.void], plans: Sequence[tuple[float, LegPlan]], route_m: float
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return the rows of a run from those of its legs, with the train's own ceiling where there are none.

    Parameters
    ----------
    own
        Ceiling of the train.
    plans
        Where legs begin [m], in order, and their rows.
    route_m
        Where the run ends [m].
    """
    pieces: list[NDArray[np.void]] = []
    caps: list[tuple[float, float]] = []
    at = 0.0
    for start, plan in plans:
        if start > at:
            pieces.append(cut_ceiling(own, at, start))
            caps.append((at, _POWERED))
        rows, points = plan.pieces.copy(), plan.caps
        rows["from_m"] += start
        pieces.append(rows)
        caps += [(start + float(x), float(y)) for x, y in zip(points["x"], points["y"], strict=True)]
        at = start + plan.length_m
    if at < route_m:
        pieces.append(cut_ceiling(own, at, route_m))
        caps.append((at, _POWERED))
    last = own[-1:].copy()
    if pieces:
        final = pieces[-1][-1]
        last["w"] = max(float(final["w"] + final["dw"] * (route_m - final["from_m"])), 0.0)
    joined = np.concatenate((*pieces, last))
    kept = [row for n, row in enumerate(caps) if n == 0 or row[1] != caps[n - 1][1]]
    return joined, np.array(kept, POINT)


def cut_ceiling(own: NDArray[np.void], low: float, high: float) -> NDArray[np.void]:
    """Return the part of a ceiling between two places [m], without its end."""
    first = int(np.searchsorted(own["from_m"], low, side="right")) - 1
    last = int(np.searchsorted(own["from_m"], high, side="left"))
    rows = own[max(first, 0) : max(last, first + 1)].copy()
    rows["w"][0] += rows["dw"][0] * (low - rows["from_m"][0])
    rows["from_m"][0] = low
    return rows
