"""Rows cut into pieces, as they reach what sums up a run."""

import itertools

import numpy as np
from hypothesis import strategies as st

SEEDS = st.integers(0, 2**32)
CUTS = st.lists(st.integers(0, 400), max_size=8)


def pieces(rows, cuts):
    """Return slices that cover `rows` rows, cut somewhere (some of them may be empty)."""
    bounds = [0, *sorted(cut % (rows + 1) for cut in cuts), rows]
    return [slice(first, end) for first, end in itertools.pairwise(bounds)]


def ragged(rng, trains, steps, step_s):
    """Return rows of trains that come and go, ordered by time: numbers of steps, of trains, and times [s]."""
    here = rng.random((steps, trains)) < rng.choice([0.5, 0.95, 1.0], trains)
    here &= np.arange(steps)[:, np.newaxis] >= rng.integers(0, max(steps // 2, 1), trains)
    step, train = np.nonzero(here)
    return step, train, 30_000.0 + step * step_s


def runs_of(steps):
    """Return lists of positions in `steps`, one for each unbroken run of steps."""
    runs = []
    for position, step in enumerate(steps):
        if position and step == steps[position - 1] + 1:
            runs[-1].append(position)
        else:
            runs.append([position])
    return runs
