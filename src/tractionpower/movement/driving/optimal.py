"""Plans that use spare time for saving energy: arriving on time, a reserve, a given running time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.driving import Eco, Reserve, ToTime
from tractionpower.movement.compile import Movement
from tractionpower.movement.driving.cruise import CruiseRun, cruise_pieces
from tractionpower.movement.driving.eco_legs import Floats, LegModel, Supplies, cut_stages, drive_table, eco_record, supplies_of
from tractionpower.movement.driving.eco_pieces import LegPlan, join_plans, plan_of_leg
from tractionpower.movement.driving.eco_search import GroupLeg, InTime, ways_in_time
from tractionpower.movement.driving.eco_targets import Group, corrected, leg_places, spread_groups, timed_groups
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


@dataclass(frozen=True, slots=True)
class Stretch:
    """What the planner expects of a stretch between two places.

    Attributes
    ----------
    part
        Number of the part whose time it is, in the order of all parts.
    from_m, until_m
        Where it begins and ends [m].
    seconds
        Running time, without dwells [s].
    is_shortest
        Whether there is no time to spare.
    """

    part: int
    from_m: float
    until_m: float
    seconds: float
    is_shortest: bool


@dataclass(frozen=True, eq=False)
class SavingPlan:
    """Ceiling and caps of a plan as in `plan.Plan`, what is expected of it, and of how many parts."""

    rows: PlanRows
    stretches: tuple[Stretch, ...]
    parts: int


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
    planner = Planner(movement, voltage)
    return {k: planner.plan(k, saving).rows for k, saving in chosen}


class Planner:
    """Plans of one movement at one voltage, with what runs and legs have in common."""

    def __init__(self, movement: Movement, voltage: Voltage) -> None:
        given = [(0.0, voltage)] if isinstance(voltage, int | float) else list(voltage)
        self._movement, self._voltage = movement, np.array(given, float).reshape(-1, 2)
        self._drives: dict[Any, Floats] = {}
        self._legs: dict[Any, LegModel] = {}
        self._cut: dict[Any, LegModel] = {}
        self._supplies: dict[Any, Supplies] = {}
        self._cruises: dict[Any, CruiseRun] = {}
        self._plans: dict[Any, SavingPlan] = {}
        self._groups: dict[Any, tuple[list[LegPlan], InTime]] = {}

    def plan(self, k: int, saving: Saving, late_s: Sequence[float] = ()) -> SavingPlan:
        """Return the plan of train `k`; `late_s` says by how much the plan without it is late, by part [s]."""
        item = self._movement.runs[k]
        kind = kind_of(self._movement, k)
        if isinstance(saving, ToTime):
            groups = timed_groups(item)
        else:
            places = leg_places(item)
            pairs = pairwise(places)
            shortest = [] if isinstance(saving, Eco) else [self._shortest(k, saving, ends) for ends in pairs]
            groups = spread_groups(item, saving, shortest)
        if late_s:
            groups = corrected(groups, late_s)
        key = (kind, saving.method, saving.returned_percent, saving.slowest_kmh, tuple(groups))
        if key not in self._plans:
            self._plans[key] = self._make(k, saving, groups)
        return self._plans[key]

    def _shortest(self, k: int, saving: Saving, ends: tuple[float, float]) -> float:
        return float(self._leg(k, saving, ends, ()).way((np.inf,)).times.sum())

    def _make(self, k: int, saving: Saving, groups: Sequence[Group]) -> SavingPlan:
        own = self._ceiling(k)
        if saving.method == "cruise":
            pieces, caps, times = cruise_pieces(self._cruise(k, saving), groups, saving.slowest_kmh / KMH)
            return SavingPlan((pieces, caps), tuple(_whole_groups(groups, times)), sum(len(group.parts) for group in groups))
        plans: list[tuple[float, LegPlan]] = []
        stretches: list[Stretch] = []
        late = 0.0
        for group in groups:
            found, in_time = self._of_group(k, saving, group, late)
            plans += zip(group.places_m[:-1], found, strict=True) if found else []
            late = max(in_time.late_s - group.spare_s, 0.0)
            starts = [group.places_m[0], *(end for end, _ in group.parts)]
            for low, high, seconds in zip(starts[:-1], starts[1:], in_time.times_s.tolist(), strict=True):
                stretches.append(Stretch(len(stretches), low, high, seconds, in_time.ways is None))
        rows = join_plans(own, plans, float(self._movement.tables.trains[k]["route_m"]))
        return SavingPlan(rows, tuple(stretches), len(stretches))

    def _cruise(self, k: int, saving: Saving) -> CruiseRun:
        key = kind_of(self._movement, k), saving.slowest_kmh
        if key not in self._cruises:
            supplies = supplies_of(self._movement, k, self._voltage)
            eco = eco_record(self._movement.tables.trains[k], self._voltage, 1.0, saving.slowest_kmh / KMH)
            drives = np.stack([self._drive(k, lines) for lines in supplies.lines])
            self._cruises[key] = CruiseRun(self._movement, k, self._ceiling(k), supplies, eco, drives)
        return self._cruises[key]

    def _of_group(self, k: int, saving: Saving, group: Group, late: float) -> tuple[list[LegPlan], InTime]:
        """Return the rows of legs, none if there is no time to spare; and how the group keeps its times.

        `late` is by how much it comes into the group later than planned [s].
        """
        marks = [end for end, _ in group.parts]
        legs = []
        for low, high in pairwise(group.places_m):
            inside = tuple(mark - low for mark in marks if low < mark < high)
            legs.append(GroupLeg(self._leg(k, saving, (low, high), inside), sum(mark <= low for mark in marks)))
        targets = tuple(round(seconds - (late if n == 0 else 0.0), 6) for n, (_, seconds) in enumerate(group.parts))
        key = (tuple((id(item.leg), item.first) for item in legs), targets, group.waits)
        if key not in self._groups:
            found = ways_in_time(legs, targets, group.waits)
            ways = [] if found.ways is None else found.ways
            self._groups[key] = [plan_of_leg(item.leg, squares) for item, squares in zip(legs, ways, strict=False)], found
        return self._groups[key]

    def _ceiling(self, k: int) -> Rows:
        train = self._movement.tables.trains[k]
        return self._movement.tables.pieces[train["first_piece"] : train["first_piece"] + train["pieces"]]

    def _leg(self, k: int, saving: Saving, ends: tuple[float, float], inside: tuple[float, ...]) -> LegModel:
        """Return the leg between two stops of a run; `inside` are places of passing, from its start [m]."""
        kind = kind_of(self._movement, k)
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


def kind_of(movement: Movement, k: int) -> Kind:
    """Return what runs that are alike have in common."""
    row = movement.tables.trains[k : k + 1].copy()
    for name in _OWN:
        row[name] = 0
    return tuple(row[0].item())  # not its bytes: between columns lies what happened to be in memory


def _whole_groups(groups: Sequence[Group], times_s: Sequence[float]) -> Iterator[Stretch]:
    """Yield the stretches of a run that keeps the last time of each group only; what it misses, its last part is told."""
    part = 0
    for group, seconds in zip(groups, times_s, strict=True):
        last = max(n for n, (_, planned) in enumerate(group.parts) if not np.isnan(planned))
        yield Stretch(part + last, group.places_m[0], group.parts[last][0], seconds, False)
        part += len(group.parts)
