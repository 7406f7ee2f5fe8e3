"""Sums by group, one row after the other: they do not depend on how many rows come at a time."""

from __future__ import annotations

from tractionpower.kernels.jit import njit


@njit
def add_by_group(totals, group, values):
    """Add each row of `values`, shape (rows, columns), to the row `group` of `totals`, shape (groups, columns)."""
    for n in range(group.shape[0]):
        for c in range(values.shape[1]):
            totals[group[n], c] += values[n, c]
