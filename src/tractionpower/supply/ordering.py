"""The skeleton's structure: elimination order and fill-in, made once for every position of the switches."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

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
    """

    column_start: NDArray[np.int64]
    row: NDArray[np.int64]
    target: NDArray[np.int64]
    order: list[int]

    def place(self, i: int, j: int) -> int:
        """Return the place of entry (i, j) in the values; ground (one past the last node) has a dummy."""
        n = len(self.order)
        low, high = min(i, j), max(i, j)
        if low == high:
            return low
        if high == n:
            return n
        first, last = self.column_start[low], self.column_start[low + 1]
        return int(n + 1 + first + np.searchsorted(self.row[first:last], high))


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
    remaining = set(range(nodes))
    order: list[int] = []
    columns: list[set[int]] = []
    while remaining:
        node = min(remaining, key=lambda k: (len(neighbours[k]), k))
        remaining.discard(node)
        order.append(node)
        columns.append(neighbours[node])
        for other in neighbours[node]:
            neighbours[other] |= neighbours[node]
            neighbours[other] -= {other, node}
    return _number(order, columns)


def _number(order: list[int], columns: list[set[int]]) -> Structure:
    rank = {node: k for k, node in enumerate(order)}
    rows = [sorted(rank[node] for node in column) for column in columns]
    starts = np.concatenate([[0], np.cumsum([len(column) for column in rows])]).astype(np.int64)
    flat = np.array([r for column in rows for r in column], dtype=np.int64)
    structure = Structure(starts, flat, np.empty(0, np.int64), order)
    target = [structure.place(column[p], column[q]) for column in rows for p in range(len(column)) for q in range(p, len(column))]
    return Structure(starts, flat, np.array(target, dtype=np.int64), order)
