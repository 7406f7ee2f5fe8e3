"""Plans by rules: a reduced cruising speed, coasting from marks or before stops, a capped effort."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tractionpower.kernels.train_tables import LEAVE, POINT
from tractionpower.model.driving import CoastingMark, Rules
from tractionpower.movement.compile import AT_START_M, PlannedRun, ceiling_of
from tractionpower.movement.driving.plan import Plan, Rows
from tractionpower.movement.formation import KMH

MOST_OF_A_LEG = 0.5
"""Before a stop a train coasts over no more than this share of the way from the stop before."""

Stretch = tuple[float, float]
"""Where coasting begins and ends [m]."""


def rule_plan(item: PlannedRun, rules: Rules) -> tuple[Rows, Rows]:
    """Return ceiling and caps of a run (see `plans.Plan`) by its rules.

    The ceiling has its own braking curves: with a lower share of the limits a train brakes later, from less speed.
    """
    share = 1.0 if rules.speed_percent is None else rules.speed_percent / 100.0
    most = np.inf if rules.speed_kmh is None else rules.speed_kmh / KMH
    full = 1.0 if rules.effort_percent is None else rules.effort_percent / 100.0
    return ceiling_of(item, share, most), caps_of(coasting_stretches(item, rules), full)


def caps_of(stretches: list[Stretch], full: float) -> Rows:
    """Return the share of the greatest effort by place: `full`, and 0 on the stretches where the train coasts."""
    rows = [(0.0, full)]
    for low, high in _joined(stretches):
        rows += [(low, 0.0), (high, full)] if low > 0.0 else [(high, full)]
        if low <= 0.0:
            rows[0] = (0.0, 0.0)
    return np.array(rows, POINT)


def hold_floor(plan: Plan, rows: Rows, floor_mps: float) -> tuple[Rows, Rows]:
    """Return ceiling and caps of a plan that holds the speed `floor_mps` where it would coast below it [m/s].

    `rows` are the steps of the plan alone, records of `TRAIN_ROW`, from which it is known where that is.
    """
    pieces, stretches, ends = plan.pieces, [], [*plan.caps["x"][1:].tolist(), plan.pieces["from_m"][-1]]
    full = float(plan.caps["y"].max())
    for (low, share), high in zip(plan.caps.tolist(), ends, strict=True):
        if share > 0.0:
            continue
        slow = rows["s_m"][(rows["s_m"] > low) & (rows["s_m"] < high) & (rows["v_mps"] < floor_mps)]
        at = float(slow[0]) if len(slow) else high
        stretches.append((low, at))
        if at < high:
            pieces = lower(pieces, (at, high), floor_mps**2)
    return pieces, caps_of(stretches, full)


def lower(pieces: Rows, between: Stretch, w: float) -> Rows:
    """Return a ceiling that is lowered to `w` [m2/s2] between two places [m]."""
    low, high = between
    last, inside = pieces[-1:], pieces[:-1]
    ends = pieces["from_m"][1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossings = inside["from_m"] + (w - inside["w"]) / inside["dw"]
    crossings = crossings[(crossings > inside["from_m"]) & (crossings < ends)]
    cuts = np.unique(np.concatenate((inside["from_m"], [place for place in (low, high) if place < last["from_m"][0]], crossings)))
    cut = inside[np.searchsorted(inside["from_m"], cuts, side="right") - 1].copy()
    cut["w"] += cut["dw"] * (cuts - cut["from_m"])
    cut["from_m"] = cuts
    middle = cut["w"] + 0.5 * cut["dw"] * (np.append(cuts[1:], last["from_m"]) - cuts)
    above = (cuts >= low) & (cuts < high) & (middle > w)
    cut["w"][above], cut["dw"][above] = w, 0.0
    return np.concatenate((cut, last))


def coasting_stretches(item: PlannedRun, rules: Rules) -> list[Stretch]:
    """Return where the driver coasts [m], in the order of the route."""
    found = list(_from_marks(item, rules.coast_from))
    if rules.coast_before_stops_km is not None:
        found += _before_stops(item, rules.coast_before_stops_km * 1e3)
    return sorted(found)


def mark_places(item: PlannedRun, mark: CoastingMark) -> tuple[float | None, float | None]:
    """Return where on its route a run comes to a coasting mark and to its end [m]; None where it does not, or has none."""
    start = place_on(item, mark.track, mark.km)
    end = None if mark.to_km is None or start is None else place_on(item, mark.track, mark.to_km, start)
    return start, end


def place_on(item: PlannedRun, track: str | None, km: float, from_m: float = 0.0) -> float | None:
    """Return the first place of a route at a kilometre behind `from_m` [m]; None if it has none."""
    tracks = [track] if track is not None else [leg.axis.track for leg in item.path.legs]
    places = [item.path.distance(name, km, from_m=from_m) for name in tracks]
    return min((place for place in places if place is not None), default=None)


def stops_of(item: PlannedRun) -> list[float]:
    """Return where a run stops behind its start [m], its end included if it stops there."""
    stops = {planned.at_m for planned in item.calls if planned.call.stops and planned.at_m > AT_START_M}
    return sorted(stops | ({item.route_m} if item.end != LEAVE else set()))


def _from_marks(item: PlannedRun, marks: tuple[CoastingMark, ...]) -> Iterator[Stretch]:
    places = [(mark, *mark_places(item, mark)) for mark in marks]
    ends = sorted([*stops_of(item), *(start for _, start, _ in places if start is not None), item.route_m])
    for mark, start, end in places:
        if start is None or start >= item.route_m or (mark.to_km is not None and end is None):  # told by the checks
            continue
        yield start, min(item.route_m if end is None else end, next(place for place in ends if place > start))


def _before_stops(item: PlannedRun, way_m: float) -> Iterator[Stretch]:
    before = 0.0
    for stop in stops_of(item):
        yield max(stop - way_m, stop - MOST_OF_A_LEG * (stop - before)), stop
        before = stop


def _joined(stretches: list[Stretch]) -> list[Stretch]:
    joined: list[Stretch] = []
    for low, high in sorted(stretches):
        if joined and low <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return joined
