"""A train alone, in blocks of rows: until it has come to its end, cannot go on, or takes longer than two days."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.journey import OUT_OF_ROWS
from tractionpower.kernels.train_tables import TRAIN_ROW, TrainState, TrainTables

LONGEST_S = 48 * 3600.0
"""A run that takes longer is given up [s]."""

BLOCK = 4096
"""Rows of a block."""


def blocks_of_rows(
    run: Callable[..., Any],
    trains: tuple[TrainTables, TrainState, int],
    clock: tuple[float, float],
    voltage: NDArray[np.void],
) -> Iterator[tuple[NDArray[np.void], int, float]]:
    """Yield the rows of a train alone, how it ended, and the end of the last row [s]; the last ones tell how the run ended.

    Parameters
    ----------
    run
        The kernel: `run_journey` or `run_over_speed`.
    trains
        Tables, state, and number of the train.
    clock
        Start of the first step, and step [s].
    voltage
        Voltage [V] over the distance of the front [m], records of `POINT`.
    """
    (start, step), end = clock, OUT_OF_ROWS
    while end == OUT_OF_ROWS and start - clock[0] < LONGEST_S:
        rows = np.zeros(BLOCK, TRAIN_ROW)
        count, end, start = run(*trains, (start, step), voltage, rows)
        yield rows[:count], int(end), float(start)
