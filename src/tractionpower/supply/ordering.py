"""The skeleton's structure: elimination order and fill-in, made once for every position of the switches."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Structure:
    """Structure of an LDL^T factor.

    Attributes
    ----------
    column_start, row, target
        See `tractionpower.kernels.tables.Network`.
    order
        The nodes in the order of their elimination.
    places
        For each column the place of each of its rows in the values.
    """

    column_start: NDArray[np.int64]
    row: NDArray[np.int64]
    target: NDArray[np.int64]
    order: list[int]
    places: list[dict[int, int]]

    def place(self, i: int, j: int) -> int:
        """Return the place of entry (i, j) in the values; ground (one past the last node) has a dummy."""
        if i == j:
            return i
        low, high = (i, j) if i < j else (j, i)
        ground = len(self.order)
        return ground if high == ground else self.places[low][high]


def order_nodes(nodes: int, cliques: Iterable[Iterable[int]]) -> Structure:
    """Return a fill-reducing structure (minimum degree; no fill for lines and trees).

    Parameters
    ----------
    nodes
        Number of nodes, without ground.
    cliques
        Sets of nodes that are coupled with each other: ends of a span, of a feeder, of a source.
    """
    neighbours: list[set[int]] = [set() for _ in range(nodes)]
    for clique in cliques:
        members = {node for node in clique if node < nodes}
        for node in members:
            neighbours[node] |= members - {node}
    queue = [(len(others), node) for node, others in enumerate(neighbours)]
    heapify(queue)
    order: list[int] = []
    columns: list[set[int]] = []
    done = [False] * nodes
    while queue:
        degree, node = heappop(queue)
        if done[node] or degree != len(neighbours[node]):  # its degree has changed since, and it is queued again
            continue
        done[node] = True
        order.append(node)
        columns.append(neighbours[node])
        for other in neighbours[node]:
            neighbours[other] |= neighbours[node]
            neighbours[other] -= {other, node}
            heappush(queue, (len(neighbours[other]), other))
    return _number(order, columns)


def _number(order: list[int], columns: list[set[int]]) -> Structure:
    rank = {node: k for k, node in enumerate(order)}
    rows = [sorted(rank[node] for node in column) for column in columns]
    starts = np.concatenate([[0], np.cumsum([len(column) for column in rows])]).astype(np.int64)
    flat = np.array([r for column in rows for r in column], dtype=np.int64)
    n = len(order)
    places = [{r: n + 1 + first + k for k, r in enumerate(column)} for first, column in zip(starts.tolist(), rows, strict=False)]
    target = [i if i == j else places[i][j] for column in rows for p, i in enumerate(column) for j in column[p:]]
    return Structure(starts, flat, np.array(target, dtype=np.int64), order, places)
