"""A change whose size is open: the search looks for the smallest size that saves the timetable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Candidate:
    """A kind of change on one subject.

    Attributes
    ----------
    kind, subject
        Kind of change, and the train, class or service that it changes.
    unit
        Unit of its size.
    step
        Step of its size; negative for what is moved to earlier times.
    most
        Number of steps of the greatest size.
    change
        The changes by path for a size.
    tell
        The change in words for a size.
    cost
        Its cost in points for a size.
    """

    kind: str
    subject: str
    unit: str
    step: float
    most: int
    change: Callable[[float], tuple[str, ...]]
    tell: Callable[[float], str]
    cost: Callable[[float], float]

    def size(self, steps: int) -> float:
        """Return the size of a number of steps."""
        return round(self.step * steps, 9)


def combined(first: Candidate, steps: int, second: Candidate) -> Candidate:
    """Return `second` on top of `first` at a size that is fixed."""
    size = first.size(steps)
    fixed, cost, words = first.change(size), first.cost(size), first.tell(size)
    return Candidate(
        f"{first.kind} + {second.kind}",
        f"{first.subject} + {second.subject}",
        second.unit,
        second.step,
        second.most,
        lambda size: (*fixed, *second.change(size)),
        lambda size: f"{words} {second.tell(size)}",
        lambda size: cost + second.cost(size),
    )


def touch_the_same(first: Candidate, second: Candidate) -> bool:
    """Tell whether two candidates change a value that both name: then they cannot be joined."""
    paths = [{change.split("=")[0] for change in each.change(each.size(1))} for each in (first, second)]
    return not paths[0].isdisjoint(paths[1])


def steps_within(greatest: float, step: float) -> int:
    """Return the number of whole steps that a bound has room for.

    >>> steps_within(0.3, 0.1), steps_within(-5.0, 1.0)
    (3, 0)
    """
    return max(0, int(greatest / step + 1e-9))
