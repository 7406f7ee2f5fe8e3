"""Sums by group: the same number whatever the pieces, that of adding one after the other."""

import math

import numpy as np
import pytest

from tractionpower.kernels.sums import add_by_group

ROWS, GROUPS, COLUMNS = 500, 7, 3


def drawn(seed):
    rng = np.random.default_rng(seed)
    return rng.integers(0, GROUPS, ROWS), rng.normal(size=(ROWS, COLUMNS)) * 10.0 ** rng.integers(-8, 9, (ROWS, COLUMNS))


@pytest.mark.parametrize("seed", range(5))
def test_it_is_the_sum(seed):
    group, values = drawn(seed)
    totals = np.zeros((GROUPS, COLUMNS))
    add_by_group(totals, group, values)
    for k in range(GROUPS):
        for c in range(COLUMNS):
            mine = values[group == k, c]
            assert totals[k, c] == pytest.approx(math.fsum(mine), abs=1e-12 * np.abs(mine).sum())


@pytest.mark.parametrize("cuts", [[1], [250], [3, 4, 499], list(range(1, ROWS))])
def test_pieces_give_the_same_bits(cuts):
    group, values = drawn(9)
    whole, parts = np.full((GROUPS, COLUMNS), 0.1), np.full((GROUPS, COLUMNS), 0.1)
    add_by_group(whole, group, values)
    for some, numbers in zip(np.split(values, cuts), np.split(group, cuts), strict=True):
        add_by_group(parts, numbers, some)
    assert whole.tobytes() == parts.tobytes()


def test_nothing_to_add_changes_nothing():
    totals = np.arange(6.0).reshape(2, 3)
    add_by_group(totals, np.zeros(0, np.int64), np.zeros((0, 3)))
    np.testing.assert_array_equal(totals, np.arange(6.0).reshape(2, 3))
