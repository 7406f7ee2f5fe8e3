"""Plans that use spare time for saving energy: arriving on time, a reserve, a given running time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.driving import Eco, Reserve, ToTime
from tractionpower.movement.compile import Movement
from tractionpower.movement.driving.cruise import CruiseRun, cruise_pieces
from tractionpower.movement.driving.eco_legs import Floats, LegModel, Supplies, cut_stages, drive_table, eco_record, supplies_of
from tractionpower.movement.driving.eco_pieces import LegPlan, join_plans, plan_of_leg
from tractionpower.movement.driving.eco_search import GroupLeg, lateness, shortest_times, ways_in_time
from tractionpower.movement.driving.eco_targets import Group, leg_places, spread_groups, timed_groups
from tractionpower.movement.formation import KMH

Saving = ToTime | Reserve | Eco
Voltage = float | Sequence[tuple[float, float]]
"""A voltage [V], or points (distance of the front from the start of the route [m], voltage [V])."""

Rows = NDArray[np.void]
PlanRows = tuple[Rows, Rows]
"""Pieces and caps, as in `plans.Plan`."""

Kind = tuple[float, ...]
"""The row of a run in the tables without what is its own."""

_OWN = ("first_stop", "stops", "start_s", "first_plan", "plans", "first_cap", "caps", "first_due", "dues", "late_s")


def optimal_plans(movement: Movement, chosen: Sequence[tuple[int, Saving]], voltage: Voltage) -> dict[int, PlanRows]:
    """Return ceiling and effort caps of the plans of trains, by their rows in the tables.

    Runs that are alike, and legs that are, are planned once.

    Parameters
    ----------
    movement
        Trains with their tables; plans that they have already do not matter.
    chosen
        Rows of trains, and how each is driven.
    voltage
        Voltage at the pantograph that the plans are made for.

    Returns
    -------
    Pieces and caps as in `plans.Plan`, by row. A stretch that has no time to spare keeps the train's own ceiling and greatest
    effort.
    """
    given = [(0.0, voltage)] if isinstance(voltage, int | float) else list(voltage)
    planner = _Planner(movement, np.array(given, float).reshape(-1, 2))
    return {k: planner.plan(k, saving) for k, saving in chosen}


class _Planner:
    """Plans of one movement at one voltage, with what runs and legs have in common."""

    def __init__(self, movement: Movement, voltage: Floats) -> None:
        self._movement, self._voltage = movement, voltage
        self._drives: dict[Any, Floats] = {}
        self._legs: dict[Any, LegModel] = {}
        self._cut: dict[Any, LegModel] = {}
        self._supplies: dict[Any, Supplies] = {}
        self._plans: dict[Any, PlanRows] = {}
        self._groups: dict[Any, tuple[list[LegPlan], float]] = {}

    def plan(self, k: int, saving: Saving) -> PlanRows:
        """Return the plan of train `k`."""
        item = self._movement.runs[k]
        kind = self._kind(k)
        if isinstance(saving, ToTime):
            groups = timed_groups(item)
        else:
            places = leg_places(item)
            pairs = pairwise(places)
            shortest = [] if isinstance(saving, Eco) else [self._shortest(k, saving, ends) for ends in pairs]
            groups = spread_groups(item, saving, shortest)
        key = (kind, saving.method, saving.returned_percent, saving.slowest_kmh, tuple(groups))
        if key not in self._plans:
            self._plans[key] = self._make(k, saving, groups)
        return self._plans[key]

    def _shortest(self, k: int, saving: Saving, ends: tuple[float, float]) -> float:
        return float(self._leg(k, saving, ends, ()).way((np.inf,)).times.sum())

    def _make(self, k: int, saving: Saving, groups: Sequence[Group]) -> PlanRows:
        own = self._ceiling(k)
        if saving.method == "cruise":
            supplies = supplies_of(self._movement, k, self._voltage)
            eco = eco_record(self._movement.tables.trains[k], self._voltage, 1.0, saving.slowest_kmh / KMH)
            drives = np.stack([self._drive(k, lines) for lines in supplies.lines])
            return cruise_pieces(CruiseRun(self._movement, k, own, supplies, eco, drives), groups, saving.slowest_kmh / KMH)
        plans, late = [], 0.0
        for group in groups:
            found, late = self._of_group(k, saving, group, late)
            plans += found
        return join_plans(own, plans, float(self._movement.tables.trains[k]["route_m"]))

    def _of_group(self, k: int, saving: Saving, group: Group, late: float) -> tuple[list[tuple[float, LegPlan]], float]:
        """Return where legs begin and their rows, none if there is no time to spare; and how late the train leaves [s].

        `late` is by how much it comes into the group later than planned [s].
        """
        marks = [end for end, _ in group.parts]
        legs = []
        for low, high in pairwise(group.places_m):
            inside = tuple(mark - low for mark in marks if low < mark < high)
            legs.append(GroupLeg(self._leg(k, saving, (low, high), inside), sum(mark <= low for mark in marks)))
        targets = tuple(round(seconds - (late if n == 0 else 0.0), 6) for n, (_, seconds) in enumerate(group.parts))
        key = (tuple((id(item.leg), item.first) for item in legs), targets)
        if key not in self._groups:
            self._groups[key] = _plan_group(legs, targets)
        plans, late = self._groups[key]
        return list(zip(group.places_m[:-1], plans, strict=True)) if plans else [], max(late - group.spare_s, 0.0)

    def _kind(self, k: int) -> Kind:
        """Return what runs that are alike have in common."""
        row = self._movement.tables.trains[k : k + 1].copy()
        for name in _OWN:
            row[name] = 0
        return tuple(row[0].item())  # not its bytes: between columns lies what happened to be in memory

    def _ceiling(self, k: int) -> Rows:
        train = self._movement.tables.trains[k]
        return self._movement.tables.pieces[train["first_piece"] : train["first_piece"] + train["pieces"]]

    def _leg(self, k: int, saving: Saving, ends: tuple[float, float], inside: tuple[float, ...]) -> LegModel:
        """Return the leg between two stops of a run; `inside` are places of passing, from its start [m]."""
        kind = self._kind(k)
        key = (kind, saving.returned_percent, saving.slowest_kmh, ends, inside)
        if key not in self._cut:
            self._cut[key] = self._cut_leg(k, kind, saving, ends, inside)
        return self._cut[key]

    def _cut_leg(self, k: int, kind: Kind, saving: Saving, ends: tuple[float, float], inside: tuple[float, ...]) -> LegModel:
        if kind not in self._supplies:
            self._supplies[kind] = supplies_of(self._movement, k, self._voltage)
        supplies, train = self._supplies[kind], self._movement.tables.trains[k]
        marks = tuple(ends[0] + mark for mark in inside)
        stages, ceilings, starts = cut_stages(self._movement, k, self._ceiling(k), supplies, ends, marks)
        stages["from_m"] -= ends[0]
        used, stages["drive"] = np.unique(stages["drive"], return_inverse=True)
        drives = [self._drive(k, supplies.lines[n]) for n in used]
        eco = eco_record(train, self._voltage, saving.returned_percent / 100.0, saving.slowest_kmh / KMH)
        start_w = float(train["start_mps"]) ** 2 if ends[0] == 0.0 else 0.0
        content = b"".join(np.round(stages[name], 4).tobytes() for name in stages.dtype.names or ())
        content += np.round(ceilings, 4).tobytes() + eco.tobytes()
        key = (content, start_w, tuple(id(drive) for drive in drives))
        if key not in self._legs:
            self._legs[key] = LegModel(eco, np.stack(drives), stages, ceilings, starts, start_w)
        return self._legs[key]

    def _drive(self, k: int, lines: tuple[float, float]) -> Floats:
        train = self._movement.tables.trains[k]
        names = train.dtype.names or ()
        drive = names[names.index("adhesive_n") : names.index("first_knot")]
        key = (lines, self._movement.runs[k].formation.max_mps, tuple(train[name].item() for name in drive))
        if key not in self._drives:
            self._drives[key] = drive_table(self._movement, k, lines)
        return self._drives[key]


def _plan_group(legs: Sequence[GroupLeg], targets: Sequence[float]) -> tuple[list[LegPlan], float]:
    """Return the rows of each leg, none if there is no time to spare; and how late the train is at the end [s]."""
    late = lateness(shortest_times(legs, len(targets)), np.nan_to_num(np.array(targets), nan=np.inf))
    ways = ways_in_time(legs, targets)
    if ways is None:
        return [], late
    return [plan_of_leg(item.leg, squares) for item, squares in zip(legs, ways, strict=True)], late
