"""Pools: rows of many trains in one array per kind, equal blocks once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


class Pool:
    """Grows by blocks of rows; a block that is there already is not added again."""

    def __init__(self, dtype: np.dtype[np.void]) -> None:
        self._dtype = dtype
        self._blocks: list[NDArray[np.void]] = []
        self._known: dict[bytes, int] = {}
        self._rows = 0

    def add(self, rows: NDArray[np.void] | Sequence[tuple[object, ...]]) -> tuple[int, int]:
        """Add a block and return its first row and the number of its rows."""
        block = np.array(rows, self._dtype) if len(rows) else np.zeros(0, self._dtype)
        key = block.tobytes()
        if key not in self._known:
            self._known[key] = self._rows
            self._blocks.append(block)
            self._rows += len(block)
        return self._known[key], len(block)

    def array(self) -> NDArray[np.void]:
        """Return all rows."""
        return np.concatenate(self._blocks) if self._blocks else np.zeros(0, self._dtype)
