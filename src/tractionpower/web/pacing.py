"""Keeping a simulation in step with the clock on the wall, and measuring how well that works."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

TICK_S = 0.01
"""Wall time between two calls of the model: 100 a second (Zobory and Bekefi, section 7: steps of the order of 0.01 s)."""

MOST_BEHIND_S = 0.25
"""Lag up to which the model catches up; time beyond it is given up, and counted."""

FACTORS = (1, 2, 5, 10)
"""Simulated seconds in a second of the clock."""


@dataclass(frozen=True, slots=True)
class Pace:
    """How the model keeps up with the clock.

    Attributes
    ----------
    lag_ms
        Longest lag of the last second: time between the instant at which a state was due and that at which it was ready.
    longest_lag_ms
        Longest lag since the start.
    given_up_s
        Clock time that the model could not catch up.
    steps_per_s, frames_per_s
        Steps of the model, and frames sent, in the last second of the clock.
    """

    lag_ms: float
    longest_lag_ms: float
    given_up_s: float
    steps_per_s: float
    frames_per_s: float


class Pacer:
    """Gives the instants at which the model moves on, by absolute deadlines: one that is late does not delay the others.

    Parameters
    ----------
    tick_s
        Wall time between two deadlines [s].
    clock, sleep
        Clock of the wall [s], and what waits for some time [s].
    most_behind_s
        Lag beyond which the schedule is given up and begins anew [s].
    """

    def __init__(
        self,
        tick_s: float = TICK_S,
        *,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
        most_behind_s: float = MOST_BEHIND_S,
    ) -> None:
        self.tick_s = tick_s
        self._clock, self._sleep, self._most_behind_s = clock, sleep, most_behind_s
        self._due = clock()
        self._lags: deque[tuple[float, float]] = deque()
        self._longest_s = self._given_up_s = 0.0

    def begin(self) -> None:
        """Begin the schedule now: at the start, and after a pause."""
        self._due = self._clock()

    def wait(self) -> None:
        """Wait for the next deadline; when it has passed already, return at once."""
        self._due += self.tick_s
        ahead = self._due - self._clock()
        if ahead > 0.0:
            self._sleep(ahead)

    def done(self) -> None:
        """Note that the state that was due at the deadline is ready."""
        now = self._clock()
        lag = max(now - self._due, 0.0)
        self._longest_s = max(self._longest_s, lag)
        self._lags.append((now, lag))
        while self._lags[0][0] < now - 1.0:
            self._lags.popleft()
        if lag > self._most_behind_s:
            self._given_up_s += lag - self.tick_s
            self._due = now - self.tick_s  # the next state is due at once

    @property
    def lag_s(self) -> float:
        """Longest lag of the last second [s]."""
        return max((lag for _, lag in self._lags), default=0.0)

    @property
    def longest_lag_s(self) -> float:
        """Longest lag since the start [s]."""
        return self._longest_s

    @property
    def given_up_s(self) -> float:
        """Clock time given up since the start [s]."""
        return self._given_up_s


class Rate:
    """How fast a counter grows over the last second of the clock."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._noted: deque[tuple[float, int]] = deque()

    def note(self, count: int) -> float:
        """Note what the counter says now, and return its growth [1/s]."""
        now = self._clock()
        self._noted.append((now, count))
        while len(self._noted) > 2 and self._noted[1][0] <= now - 1.0:
            self._noted.popleft()
        (first, counted), (last, total) = self._noted[0], self._noted[-1]
        return (total - counted) / (last - first) if last > first else 0.0
