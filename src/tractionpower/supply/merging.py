"""Nodes that turn out to be one."""

from __future__ import annotations

from collections.abc import Hashable, Iterable


class Nodes:
    """Numbers for nodes by their names, in the order in which they are first asked for."""

    def __init__(self) -> None:
        self._number: dict[Hashable, int] = {}

    def __len__(self) -> int:
        return len(self._number)

    def __call__(self, *name: Hashable) -> int:
        """Return the number of a node."""
        return self._number.setdefault(name, len(self._number))

    def get(self, *name: Hashable) -> int | None:
        """Return the number of a node, or None if nobody has asked for it."""
        return self._number.get(name)


class Merger:
    """Sets of numbers that are joined step by step (union-find); the smallest one stands for its set."""

    def __init__(self, count: int, pairs: Iterable[tuple[int, int]] = ()) -> None:
        self._parent = list(range(count))
        for first, second in pairs:
            self.join(first, second)

    def find(self, node: int) -> int:
        """Return the number that stands for `node`."""
        parent = self._parent
        while node != parent[node]:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    def join(self, first: int, second: int) -> bool:
        """Join two sets; return False if they were one before."""
        a, b = self.find(first), self.find(second)
        if a == b:
            return False
        self._parent[max(a, b)] = min(a, b)
        return True

    def sets(self, members: Iterable[int]) -> list[list[int]]:
        """Return `members` by the set they belong to, in the order of the first member of each."""
        found: dict[int, list[int]] = {}
        for member in members:
            found.setdefault(self.find(member), []).append(member)
        return list(found.values())
