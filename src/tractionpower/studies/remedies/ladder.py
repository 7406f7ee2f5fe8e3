"""The smallest size of a change that suffices, by doubling and halving."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

Test = Callable[[int], bool]
"""Tells something of a number of steps; asked twice of the same it may answer from memory."""


def smallest(most: int, holds: Test, enough: Test) -> int | None:
    """Return the smallest number of steps from 1 to `most` that holds, or None if none of those tried does.

    Sizes are doubled until one holds, `most` last, then halved between it and the one before. So one step less than the
    answer does not hold, always; it is the smallest of all if everything beyond the smallest holds. Too much may do harm
    again, as a cap that makes the capped train late. So where no doubled size holds, but one is at least enough, the
    smallest size that is enough is found by halving, and is the answer if it holds. Zero is known not to be enough.

    Parameters
    ----------
    most
        Greatest number of steps.
    holds
        Whether a size makes all good.
    enough
        Whether a size mends what it is meant to mend, whatever harm it does elsewhere.
    """
    sizes = _doubled(most)
    for low, high in pairwise([0, *sizes]):
        if holds(high):
            return _halved(low, high, holds)
    first = next(((low, high) for low, high in pairwise([0, *sizes]) if enough(high)), None)
    if first is None:
        return None
    found = _halved(*first, enough)
    return found if holds(found) else None


def most_trials(most: int) -> int:
    """Return how many sizes `smallest` asks for at most.

    >>> [most_trials(most) for most in (1, 2, 36)]
    [1, 2, 11]
    """
    sizes = _doubled(most)
    return len(sizes) + max((high - low - 1).bit_length() for low, high in pairwise([0, *sizes]))


def _doubled(most: int) -> list[int]:
    sizes = [1]
    while sizes[-1] < most:
        sizes.append(min(2 * sizes[-1], most))
    return sizes


def _halved(low: int, high: int, is_so: Test) -> int:
    """Return the smallest number above `low` of which `is_so` holds, where it holds of `high` and not of `low`."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if is_so(middle) else (middle, high)
    return high
