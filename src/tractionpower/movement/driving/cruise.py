"""Cruising at a common share of the speed limit, so that a group of legs takes its time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import POINT
from tractionpower.movement.compile import Movement, ceiling_of
from tractionpower.movement.driving.eco_legs import Floats, LegModel, Supplies, cut_stages
from tractionpower.movement.driving.eco_pieces import cut_ceiling
from tractionpower.movement.driving.eco_targets import Group

Rows = NDArray[np.void]

_HALVINGS = 16
_LOWEST = 0.02


@dataclass(frozen=True, eq=False)
class CruiseRun:
    """A run whose speed limits are scaled: train `k`, its own ceiling, supplies and drives on them, ceilings by factor."""

    movement: Movement
    k: int
    own: NDArray[np.void]
    supplies: Supplies
    eco: NDArray[np.void]
    drives: Floats
    scaled: dict[float, NDArray[np.void]] = field(default_factory=dict)
    times: dict[tuple[Any, ...], float] = field(default_factory=dict)

    def ceiling(self, factor: float, slowest_mps: float) -> NDArray[np.void]:
        """Return the ceiling with all limits times `factor`, none that is higher reduced below `slowest_mps`."""
        if factor not in self.scaled:
            item = self.movement.runs[self.k]
            limits = np.fmin(item.path.limit_mps, item.formation.max_mps)
            reduced = np.minimum(limits, np.maximum(limits * factor, slowest_mps))
            self.scaled[factor] = ceiling_of(replace(item, path=replace(item.path, limit_mps=reduced)))
        return self.scaled[factor]

    def time(self, group: Group, factor: float, slowest_mps: float) -> float:
        """Return the running time of a group up to the end of its last part with a time [s]."""
        until = max(end for end, seconds in group.parts if not np.isnan(seconds))
        key = (group.places_m, until, factor)
        if key not in self.times:
            self.times[key] = self._time(group.places_m, until, self.ceiling(factor, slowest_mps))
        return self.times[key]

    def _time(self, places_m: tuple[float, ...], until: float, pieces: NDArray[np.void]) -> float:
        total = 0.0
        for low, high in pairwise(places_m):
            mark = [until - low] if low < until < high else []
            stages, ceilings, starts = cut_stages(
                self.movement, self.k, pieces, self.supplies, (low, high), [low + m for m in mark]
            )
            start_w = float(self.movement.tables.trains[self.k]["start_mps"]) ** 2 if low == 0.0 else 0.0
            leg = LegModel(self.eco, self.drives, stages, ceilings, starts, start_w)
            way = leg.way((np.inf,) * (1 + len(mark)))
            total += float(way.times[stages["from_m"] < until].sum())
        return total


def cruise_pieces(run: CruiseRun, groups: Sequence[Group], slowest_mps: float) -> tuple[Rows, Rows, list[float]]:
    """Return ceiling and caps of a run that cruises at a share of the speed limits, one share for each group of legs.

    A group with several parts meets the last of their times only: a change of the share in the middle of a leg would be a
    jump of the ceiling downwards. What a group is late by, the next one makes up for. The last value are the running times
    of the groups until their last part with a time [s].
    """
    route_m, at, pieces = float(run.own["from_m"][-1]), 0.0, []
    last, late, times = run.own[-1:].copy(), 0.0, []
    for group in groups:
        low, high = group.places_m[0], group.places_m[-1]
        target = sum(seconds for _, seconds in group.parts if not np.isnan(seconds)) - late
        factor = _factor(run, group, target, slowest_mps)
        times.append(run.time(group, factor, slowest_mps))
        late = max((times[-1] - target if factor >= 1.0 else 0.0) - group.spare_s, 0.0)
        if low > at:
            pieces.append(cut_ceiling(run.own, at, low))
        ceiling = run.ceiling(factor, slowest_mps) if factor < 1.0 else run.own
        pieces.append(cut_ceiling(ceiling, low, high))
        last, at = ceiling[-1:].copy(), high
    if at < route_m:
        pieces.append(cut_ceiling(run.own, at, route_m))
        last = run.own[-1:].copy()
    return np.concatenate((*pieces, last)), np.array([(0.0, 1.0)], POINT), times


def _factor(run: CruiseRun, group: Group, target: float, slowest_mps: float) -> float:
    """Return the factor of the speed limits, a multiple of a power of 1/2, with which a group takes a time [s]."""
    if run.time(group, 1.0, slowest_mps) >= target:
        return 1.0
    low, high = 0.0, 1.0
    if run.time(group, _LOWEST, slowest_mps) <= target:
        return _LOWEST
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if run.time(group, max(middle, _LOWEST), slowest_mps) > target:
            low = middle
        else:
            high = middle
    return high
