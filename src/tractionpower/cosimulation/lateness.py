"""How late trains are at their timed calls, from a run of which nothing is recorded."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tractionpower.cosimulation.calls import call_rows
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.kernels.train_tables import GONE, OUTSIDE, STAYING
from tractionpower.model.scenario import ROUNDING_S
from tractionpower.movement.journey import calls_of

STUCK_S = 60.0
"""A train that has held itself for so long at the end of the run is stuck [s]."""

NAN = float("nan")


class TrainLateness(NamedTuple):
    """What has become of a train.

    Attributes
    ----------
    late_s
        Greatest lateness at its timed calls [s], not below 0; one that it has not come to counts with the time until the
        end of the run, so it is later than that. NaN without a timed call that was due, and for a train that holds or is dark
        before any call at which it was late: nothing says how late it becomes.
    holds
        Whether it stands at the end of the run for want of effort or power.
    dark
        Whether it is on a dead contact line then.
    finished_s
        When it left the line or came to stay [s after midnight]; NaN: not within the clock.
    """

    late_s: float
    holds: bool
    dark: bool
    finished_s: float = NAN


def lateness_of(run: QuietRun) -> dict[str, TrainLateness]:
    """Return how late each train of an executed run is; calls within the warm-up do not count."""
    clock, movement, state = run.scenario.clock, run.movement, run.trains
    from_s, until_s = clock.counts_from_s, clock.end
    found = {}
    for k, planned in enumerate(movement.runs):
        calls = calls_of(planned, state, int(movement.tables.trains[k]["first_stop"]))
        late = []
        for row in call_rows(planned.run.id, calls, planned.route_m):
            if np.isfinite(row.planned_s) and not (row.actual_s < from_s - ROUNDING_S):
                overdue = until_s - row.planned_s
                late += [max(0.0, row.late_s)] if np.isfinite(row.actual_s) else [overdue] * (overdue >= 0.0)
        mover = state.movers[k]
        on_line = mover["status"] not in (OUTSIDE, GONE, STAYING)
        holds, dark = bool(mover["held_s"] >= STUCK_S), bool(np.isfinite(mover["lost_s"]))
        latest, stands = max(late, default=NAN), on_line and (holds or dark)
        late_s = latest if latest > 0.0 or not stands else NAN
        found[planned.run.id] = TrainLateness(late_s, on_line and holds, on_line and dark, float(mover["finished_s"]))
    return found
