"""Plans run alone at the voltage that they are made for: when the train is where. Equal runs are computed once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.kernels.journey import ARRIVED, run_journey
from tractionpower.kernels.train_tables import POINT, new_train_state
from tractionpower.movement.blocks_of_rows import blocks_of_rows
from tractionpower.movement.compile import AT_START_M, Movement
from tractionpower.movement.driving.dues import Times
from tractionpower.movement.driving.optimal import Stretch, Voltage, kind_of
from tractionpower.movement.driving.plan import Plan, Rows, lay_plans

_NEVER_THE_SAME = 1e-6
_WHERE = ["time_s", "s_m", "v_mps"]


@dataclass(frozen=True, slots=True, eq=False)
class AlonePlan:
    """A plan run alone.

    Attributes
    ----------
    rows
        Its steps: time [s after midnight], place [m], speed [m/s], at their starts.
    arrived_s, left_s
        When it comes to its calls and leaves [s after midnight].
    finished_s
        When it comes to its end [s after midnight]; NaN: it does not.
    """

    rows: Rows
    arrived_s: Times
    left_s: Times
    finished_s: float

    def later(self, seconds: float) -> AlonePlan:
        """Return the same run some time later [s]."""
        rows = self.rows.copy()
        rows["time_s"] += seconds
        return AlonePlan(rows, self.arrived_s + seconds, self.left_s + seconds, self.finished_s + seconds)


class PlanRuns:
    """Plans of one movement run alone.

    Parameters
    ----------
    movement
        The trains.
    step_s
        Step [s].
    voltages
        Voltage for which the plan of each train is made, by number.
    """

    def __init__(self, movement: Movement, step_s: float, voltages: dict[int, Voltage]) -> None:
        self._movement, self._step_s, self._voltages = movement, step_s, voltages
        self._known: dict[Any, tuple[float, AlonePlan]] = {}

    def run(self, plans: dict[int, Plan], chosen: Iterable[int]) -> dict[int, AlonePlan]:
        """Return the runs of trains of some numbers by their plans, which have no dues."""
        keys = {k: self._key(k, plans[k]) for k in chosen}
        new = {key: k for k, key in keys.items() if key not in self._known}
        laid = lay_plans(self._movement, {k: plans[k] for k in new.values()})
        for key, k in new.items():
            self._known[key] = self._movement.runs[k].start_s, self._run(laid, k)
        found = {}
        for k, key in keys.items():
            start, alone = self._known[key]
            shift = self._movement.runs[k].start_s - start
            found[k] = alone if shift == 0.0 else alone.later(shift)
        return found

    def seconds(self, k: int, alone: AlonePlan, stretch: Stretch) -> float:
        """Return the running time of a stretch without dwells [s]; NaN if the train does not come through it."""
        item = self._movement.runs[k]
        since, until, stood = item.start_s, alone.finished_s, 0.0
        for n, planned in enumerate(item.calls):
            at = planned.at_m
            if abs(at - stretch.from_m) <= AT_START_M:
                since = max(since, float(alone.left_s[n] if planned.call.stops else alone.arrived_s[n]))
            elif abs(at - stretch.until_m) <= AT_START_M:
                until = float(alone.arrived_s[n])
            elif planned.call.stops and stretch.from_m < at < stretch.until_m:
                stood += float(alone.left_s[n] - alone.arrived_s[n])
        return until - since - stood

    def _key(self, k: int, plan: Plan) -> Any:
        train, start = self._movement.tables.trains[k], self._movement.runs[k].start_s
        stops = self._movement.tables.stops[train["first_stop"] : train["first_stop"] + train["stops"]]
        after = np.round((stops["departure_s"] - start) / _NEVER_THE_SAME)
        own = (stops["at_m"].tobytes(), stops["dwell_s"].tobytes(), stops["stops"].tobytes(), after.tobytes())
        voltage = self._voltages[k]
        volts = voltage if isinstance(voltage, int | float) else tuple(voltage)
        return kind_of(self._movement, k), plan.pieces.tobytes(), plan.caps.tobytes(), own, volts

    def _run(self, laid: Movement, k: int) -> AlonePlan:
        # A state of this train alone: turns and other trains do not matter.
        tables = laid.tables._replace(trains=laid.tables.trains[k : k + 1])
        state, start, voltage = new_train_state(tables), laid.runs[k].start_s, self._voltages[k]
        points = np.array([(0.0, voltage)] if isinstance(voltage, int | float) else list(voltage), POINT)
        blocks = list(blocks_of_rows(run_journey, (tables, state, 0), (start, self._step_s), points))
        _, end, _ = blocks[-1]
        train = laid.tables.trains[k]
        calls = slice(int(train["first_stop"]), int(train["first_stop"] + train["stops"]))
        finished = float(state.movers[0]["finished_s"]) if end == ARRIVED else float("nan")
        rows = np.concatenate([found[_WHERE] for found, _, _ in blocks])
        return AlonePlan(rows, state.arrived_s[calls].copy(), state.left_s[calls].copy(), finished)
