"""Sets of nodes that turn out to be one."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tractionpower.supply.merging import Merger, Nodes


def test_nodes_are_numbered_as_they_are_asked_for():
    nodes = Nodes()
    assert [nodes("a"), nodes("b", 1), nodes("a"), nodes("b", 2)] == [0, 1, 0, 2]
    assert len(nodes) == 3
    assert nodes.get("b", 2) == 2
    assert nodes.get("c") is None
    assert len(nodes) == 3  # asking whether it exists does not make it


def test_the_smallest_number_stands_for_its_set():
    merger = Merger(5, [(4, 3), (3, 1)])
    assert [merger.find(node) for node in range(5)] == [0, 1, 2, 1, 1]


def test_joining_tells_whether_it_changes_anything():
    merger = Merger(3)
    assert merger.join(2, 1)
    assert not merger.join(1, 2)
    assert not merger.join(0, 0)


def test_sets_come_in_the_order_of_their_first_members():
    merger = Merger(6, [(5, 1), (4, 2)])
    assert merger.sets([4, 1, 2, 3, 5]) == [[4, 2], [1, 5], [3]]


def test_random_pairs_against_connected_components():
    rng = np.random.default_rng(3)
    for count, pairs in ((1, 0), (40, 20), (300, 280), (300, 900)):
        ends = rng.integers(0, count, (pairs, 2))
        merger = Merger(count, [tuple(pair) for pair in ends.tolist()])
        _, label = connected_components(coo_array((np.ones(pairs), (ends[:, 0], ends[:, 1])), (count, count)), directed=False)
        ours = np.array([merger.find(node) for node in range(count)])
        assert [min(np.flatnonzero(label == label[node])) for node in range(count)] == ours.tolist()


def test_a_long_chain_is_found_at_once():
    """Far beyond the depth of recursion, and from the worst side."""
    count = 100_000
    merger = Merger(count, ((k, k + 1) for k in reversed(range(count - 1))))
    assert merger.find(count - 1) == 0
