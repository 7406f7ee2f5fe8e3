"""Rows that count: those behind the warm-up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers, take_rows
from tractionpower.model.scenario import ROUNDING_S

Floats = NDArray[np.float64]


def counted(from_s: float, time_s: Floats, rows: Buffers) -> tuple[Floats, Buffers]:
    """Return the times [s] and rows of the steps from a time on."""
    first = int(np.searchsorted(time_s, from_s - ROUNDING_S))
    return (time_s, rows) if first == 0 else (time_s[first:], take_rows(rows, slice(first, None)))
