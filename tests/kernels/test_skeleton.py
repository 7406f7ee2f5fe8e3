"""LDL^T with a structure made beforehand against numpy."""

from itertools import pairwise

import numpy as np
import pytest

from tractionpower.kernels.skeleton import factor_and_solve
from tractionpower.supply.ordering import order_nodes


def draw(seed, shift=0.0):
    """Return a random nodal matrix, its structure and its values; `shift` moves its eigenvalues."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 30))
    cliques = [rng.choice(n + 1, size=min(n + 1, int(rng.integers(2, 5))), replace=False).tolist() for _ in range(n + 5)]
    structure = order_nodes(n, cliques)
    rank = {node: k for k, node in enumerate(structure.order)} | {n: n}
    matrix = np.zeros((n + 1, n + 1))
    value = np.zeros(n + 1 + len(structure.row))
    for clique in cliques:
        for a, b in pairwise(clique):
            i, j, s = rank[a], rank[b], float(rng.uniform(0.1, 50.0))
            matrix[[i, j, i, j], [i, j, j, i]] += [s, s, -s, -s]
            value[[i, j]] += s
            value[structure.place(i, j)] -= s
    matrix[:n, :n] += (0.01 + shift) * np.eye(n)
    value[:n] += 0.01 + shift
    return structure, matrix[:n, :n], value, rng.normal(size=n + 1) * 1000.0


def solve(structure, value, b):
    potential = b.copy()
    done = factor_and_solve(structure.column_start, structure.row, structure.target, value.copy(), potential)
    return done, potential


@pytest.mark.parametrize("seed", range(60))
def test_random_matrices(seed):
    structure, matrix, value, b = draw(seed)
    done, potential = solve(structure, value, b)
    assert done
    np.testing.assert_allclose(potential[:-1], np.linalg.solve(matrix, b[:-1]), rtol=1e-9, atol=1e-7)
    assert potential[-1] == 0.0


@pytest.mark.parametrize("seed", range(60))
def test_an_indefinite_matrix_is_refused(seed):
    structure, matrix, value, b = draw(seed)
    values = np.linalg.eigvalsh(matrix)
    shift = -0.5 * (values[0] + values[-1]) if len(values) > 1 else -2.0 * values[0]
    structure, matrix, value, b = draw(seed, shift)
    assert np.linalg.eigvalsh(matrix)[0] < 0.0
    assert not solve(structure, value, b)[0]


def test_lines_and_trees_fill_nothing():
    n = 40
    line = order_nodes(n, [[k, k + 1] for k in range(n - 1)])
    tree = order_nodes(n, [[k, (k - 1) // 2] for k in range(1, n)])
    assert len(line.row) == len(tree.row) == n - 1
    assert len(order_nodes(n, [[k, (k + 1) % n] for k in range(n)]).row) <= 2 * n


def test_the_order_does_not_depend_on_that_of_the_cliques():
    cliques = [[k, (k * 7 + 3) % 20] for k in range(20)]
    assert order_nodes(20, cliques).order == order_nodes(20, cliques[::-1]).order
    assert sorted(order_nodes(20, cliques).order) == list(range(20))


def test_not_a_number_is_refused():
    structure, _, value, b = draw(3)
    value[0] = np.nan
    assert not solve(structure, value, b)[0]
