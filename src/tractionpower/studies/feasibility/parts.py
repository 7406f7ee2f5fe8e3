"""How a delay is split by cause: chains of calls that differ in one thing, each later than the one before.

All chains follow the same rules: a train leaves a stop when its shortest dwell is over, not before its planned departure;
passes do not hold it; it becomes another one when the turn-round is over. They differ in the running times, the first one in
its dwells. What one is later than the one before is the share of its cause in the delay, wherever it arose; what the timetable
has to spare recovers every chain by the rules themselves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ORIGINS = ("timetable", "dwell", "current_limit", "voltage", "driving")
"""Where seconds of a delay first arise: by what each chain is later than the one before; the last one is the run itself."""

RUNNING = ("shortest", "shortest", "limited", "recorded")
"""Running times of the chains that are computed by the rules."""


@dataclass(frozen=True, slots=True)
class Stage:
    """A call as the rules see it.

    Attributes
    ----------
    running_s
        Running time from the call before, or from the start of the run, by `RUNNING` [s]; shape (chains,).
    dwell_s
        Shortest dwell by chain [s]; None: it does not stop.
    departure_s
        Before when it does not leave [s]; None: the timetable has no time.
    """

    running_s: Floats
    dwell_s: Floats | None
    departure_s: float | None = None


@dataclass(frozen=True, eq=False)
class Ruled:
    """Times of the chains by the rules [s]: arrival and departure by call and chain, and the end of the run by chain."""

    arrived_s: Floats
    left_s: Floats
    finished_s: Floats


def ruled(begin_s: Floats, stages: Sequence[Stage], rest_s: Floats) -> Ruled:
    """Return the times of the chains.

    Parameters
    ----------
    begin_s
        When the run begins, by chain [s].
    stages
        Its calls.
    rest_s
        Running time from the last call to the end of the run, by chain [s].
    """
    now, arrived, left = begin_s, np.zeros((len(stages), len(begin_s))), np.zeros((len(stages), len(begin_s)))
    for k, stage in enumerate(stages):
        now = arrived[k] = now + stage.running_s
        if stage.dwell_s is not None:
            now = now + stage.dwell_s
            if stage.departure_s is not None:
                now = np.maximum(now, stage.departure_s)
        left[k] = now
    return Ruled(arrived, left, now + rest_s)


@dataclass(frozen=True, slots=True)
class Lateness:
    """How late a train is at a timed call, and why.

    Attributes
    ----------
    late_s
        Computed less planned time [s]; negative is early.
    parts
        Parts of the delay [s]: ``knock_on``, and by `ORIGINS` what is new since the call before.
    origins
        The delay by `ORIGINS` [s], knock-on followed back to where it first arose.
    """

    late_s: float
    parts: dict[str, float]
    origins: dict[str, float]

    @property
    def delay_s(self) -> float:
        """How late it is [s], 0 if it is early."""
        return max(self.late_s, 0.0)


ON_TIME = Lateness(0.0, dict.fromkeys(("knock_on", *ORIGINS), 0.0), dict.fromkeys(ORIGINS, 0.0))
"""Before a train has been anywhere."""


def split(late_s: float, ruled_late_s: Floats, before: Mapping[str, float]) -> Lateness:
    """Return the lateness at a timed call with its parts.

    Parameters
    ----------
    late_s
        How late the train is [s]; negative is early.
    ruled_late_s
        How late it is in the chains by the rules [s]; one that is later than the next one counts as that: higher voltages
        than the nominal one make up for a timetable that is too tight.
    before
        Its delay by `ORIGINS` at the call before [s].
    """
    delays = np.maximum(np.append(ruled_late_s, late_s), 0.0)
    delays = np.minimum.accumulate(delays[::-1])[::-1]
    origins = dict(zip(ORIGINS, np.diff(delays, prepend=0.0).tolist(), strict=True))
    new = {name: max(origins[name] - before[name], 0.0) for name in ORIGINS}
    knock_on = max(float(delays[-1]) - sum(new.values()), 0.0)
    return Lateness(late_s, {"knock_on": knock_on, **new}, origins)
