"""What a program must offer to be compared."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from snapshots import Snapshots


class Solver(Protocol):
    """Solves all snapshots one after the other."""

    def __call__(self) -> NDArray[np.float64]:
        """Return the node voltages [V], shape (snapshots, nodes)."""


@dataclass(frozen=True)
class Peer:
    """A way of using a program.

    Attributes
    ----------
    use
        How it is used, for the table.
    prepare
        Makes the solver. What it does is not timed.
    aim
        How many times our time it is expected to take; only the fastest supported way of a program has one.
    own_clock
        Whether the solver keeps its own time of the last call in an attribute ``seconds``, which is taken instead.
    """

    program: str
    use: str
    prepare: Callable[[Snapshots], Solver]
    aim: float | None = None
    own_clock: bool = False

    @property
    def name(self) -> str:
        return f"{self.program}: {self.use}"
