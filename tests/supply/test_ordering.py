"""Elimination order and fill-in of the skeleton against dense elimination."""

from itertools import pairwise

import numpy as np
import pytest

from tractionpower.supply.ordering import order_nodes


def random_cliques(rng, nodes, count, size):
    cliques = [rng.choice(nodes + 1, int(rng.integers(2, size + 1)), replace=False).tolist() for _ in range(count)]
    return [*cliques, *([node] for node in range(nodes))]


def dense_fill(nodes, cliques, order):
    """Return which entries of the lower triangle of a dense factor are not zero, in the order of the elimination."""
    rank = {node: k for k, node in enumerate(order)}
    full = np.eye(nodes, dtype=bool)
    for clique in cliques:
        own = [rank[node] for node in clique if node < nodes]
        full[np.ix_(own, own)] = True
    for k in range(nodes):
        below = np.flatnonzero(full[:, k]) if k < nodes else []
        below = [i for i in below if i > k]
        full[np.ix_(below, below)] = True
    return np.tril(full, -1)


@pytest.mark.parametrize("seed", range(20))
def test_the_structure_is_that_of_dense_elimination(seed):
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(1, 30))
    cliques = random_cliques(rng, nodes, int(rng.integers(0, 30)), min(4, nodes + 1))
    structure = order_nodes(nodes, cliques)
    assert sorted(structure.order) == [*range(nodes)]
    fill = dense_fill(nodes, cliques, structure.order)
    for k in range(nodes):
        rows = structure.row[structure.column_start[k] : structure.column_start[k + 1]]
        assert rows.tolist() == np.flatnonzero(fill[:, k]).tolist()


@pytest.mark.parametrize("seed", range(10))
def test_a_factor_by_the_structure_is_that_of_numpy(seed):
    """Eliminate by `target` on a random positive matrix of the structure, and compare with numpy's Cholesky factor."""
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(3, 25))
    cliques = random_cliques(rng, nodes, 20, 4)
    structure = order_nodes(nodes, cliques)
    rank = {node: k for k, node in enumerate(structure.order)} | {nodes: nodes}
    value = np.zeros(nodes + 1 + len(structure.row))
    dense = np.zeros((nodes + 1, nodes + 1))
    for clique in cliques:
        for i, j in pairwise(clique):
            a, b, g = rank[i], rank[j], rng.uniform(0.5, 2.0)
            for place in ((a, a), (b, b)):
                value[structure.place(*place)] += g
                dense[place] += g
            value[structure.place(a, b)] -= g
            dense[a, b] -= g
            dense[b, a] -= g
    value[:nodes] += 0.1
    dense += 0.1 * np.eye(nodes + 1)
    factor, at = np.eye(nodes), 0
    for k in range(nodes):
        rows = structure.row[structure.column_start[k] : structure.column_start[k + 1]]
        places = nodes + 1 + np.arange(structure.column_start[k], structure.column_start[k + 1])
        column = value[places].copy()
        factor[rows, k] = column / value[k]
        for p in range(len(rows)):
            for q in range(p, len(rows)):
                value[structure.target[at]] -= column[p] * column[q] / value[k]
                at += 1
    assert at == len(structure.target)
    ours = factor * np.sqrt(value[:nodes])
    np.testing.assert_allclose(ours, np.linalg.cholesky(dense[:nodes, :nodes]), rtol=0.0, atol=1e-12 * np.abs(dense).max())


def test_places():
    structure = order_nodes(3, [[0, 1], [1, 2, 3]])
    n = 3
    assert [structure.place(k, k) for k in range(n)] == [0, 1, 2]
    assert structure.place(0, n) == structure.place(n, 1) == n  # ground has a dummy
    places = {structure.place(i, j) for i in range(n) for j in range(i) if (i, j) != (2, 0) and (i, j) != (0, 2)}
    assert all(place > n for place in places if place != n)
    for i in range(n):
        for j in range(structure.column_start[i], structure.column_start[i + 1]):
            assert structure.place(i, int(structure.row[j])) == structure.place(int(structure.row[j]), i) == n + 1 + j


def test_nothing_to_eliminate():
    structure = order_nodes(0, [[0]])
    assert (structure.order, structure.row.tolist(), structure.target.tolist()) == ([], [], [])
    assert structure.column_start.tolist() == [0]


def along(count, width, start=0):
    """Return the ends of spans along a line of `width` conductors with `count` cuts."""
    return [[start + width * k + c for k in pair for c in range(width)] for pair in pairwise(range(count))]


@pytest.mark.parametrize("width", [1, 2, 4])
def test_a_line_has_no_fill(width):
    """What a cut has below the diagonal are the other nodes of its own span and of the next one."""
    for count in (10, 100):
        structure = order_nodes(width * count, along(count, width))
        whole = width * (width - 1) // 2
        assert len(structure.row) == count * whole + (count - 1) * width * width


def test_a_tree_of_five_branches_has_no_fill():
    cliques, start = along(50, 2), 100
    for branch in range(5):
        cliques += [[20 * branch, 20 * branch + 1, start, start + 1], *along(40, 2, start)]
        start += 80
    structure = order_nodes(start, cliques)
    cuts = start // 2
    assert len(structure.row) == cuts * 1 + (cuts - 1) * 4  # as many spans as a line of these cuts


@pytest.mark.parametrize("kind", ["ring", "ladder", "feeders"])
def test_fill_grows_with_the_size_only(kind):
    entries = []
    for count in (100, 200, 400):
        cliques, nodes = along(count, 2), 2 * count
        if kind == "ring":
            cliques.append([0, 1, nodes - 2, nodes - 1])
        elif kind == "ladder":  # two lines with a bond at every fifth cut
            cliques += along(count, 2, nodes)
            cliques += [[2 * k + 1, nodes + 2 * k + 1] for k in range(0, count, 5)]
            nodes *= 2
        else:  # a busbar with feeders to both sides of every tenth cut
            cliques += [[nodes + k, 20 * k, 20 * k + 2] for k in range(count // 10)]
            nodes += count // 10
        entries.append(len(order_nodes(nodes, cliques).row))
    assert entries[2] - entries[1] == pytest.approx(2 * (entries[1] - entries[0]), rel=0.02)
    assert entries[2] < 4.2 * entries[0]
