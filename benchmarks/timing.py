"""Times of actions that take turns, so that a noisy machine is noisy for all of them alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import median
from time import perf_counter

Action = Callable[[], float | None]
"""What is timed; it may return the seconds that count when they are not all that it takes."""


@dataclass(frozen=True)
class Times:
    """Durations of the repeats of one action [s]."""

    seconds: tuple[float, ...]

    @property
    def least(self) -> float:
        return min(self.seconds)

    @property
    def median(self) -> float:
        return median(self.seconds)

    def each(self, number: int) -> Times:
        """Return the times of one of `number` equal parts."""
        return Times(tuple(value / number for value in self.seconds))

    def minus(self, seconds: float) -> Times:
        """Return the times without a part that does not count."""
        return Times(tuple(value - seconds for value in self.seconds))


def take_turns(actions: Mapping[str, Action], rounds: int, between: str | None = None) -> dict[str, Times]:
    """Run every action once unmeasured, then `rounds` times in turn; the action `between` before each of the others."""
    order = list(actions)
    if between is not None:
        order = [turn for name in actions if name != between for turn in (between, name)]
    for action in actions.values():
        action()
    seconds: dict[str, list[float]] = {name: [] for name in actions}
    for _ in range(rounds):
        for name in order:
            start = perf_counter()
            own = actions[name]()
            whole = perf_counter() - start
            seconds[name].append(whole if own is None else own)
    return {name: Times(tuple(values)) for name, values in seconds.items()}
