"""A train as many vehicles in motion: a case that is advanced in time, with the controls of its commands or of a driver."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.compile import CompiledChain, compile_chain
from tractionpower.dynamics.controls import append_control, check_setting
from tractionpower.errors import TractionPowerError
from tractionpower.kernels.chain import advance_chain
from tractionpower.kernels.chain_state import (
    BUFFER_FULL,
    CHAIN_ROW,
    ENDED,
    LINK_ROW,
    MARK,
    NOT_FINITE,
    STEP_TOO_SMALL,
    TURN,
    VEHICLE_ROW,
    ChainBuffers,
    ChainState,
    new_chain_work,
)
from tractionpower.kernels.chain_tally import present_reduction, set_present
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.results.dynamics_snapshot import Air, distributions, snapshot

ROWS = 1024
"""Rows that a block may record before they are taken away."""

TURNS = 65_536
"""Turning points of coupling forces that a block may note, at least; a step may note one for each coupling."""

MARKS = 256
"""Commands and standstills that a block may note."""


class NotComputableError(TractionPowerError):
    """The motion cannot be computed on: a state is no number any more, or a variable step has become too small."""


class Rows(NamedTuple):
    """What was recorded: record arrays of `CHAIN_ROW` (rows), `VEHICLE_ROW`, `LINK_ROW` (rows, n), `TURN` and `MARK`."""

    chain: NDArray[np.void]
    vehicles: NDArray[np.void]
    links: NDArray[np.void]
    turns: NDArray[np.void]
    marks: NDArray[np.void]


class Session:
    """A case in motion.

    Parameters
    ----------
    scenario
        The case with all that it names; checked.
    live
        A driver sets the controls: commands of the case are left out but for those at the very beginning, and it does not
        end by time.
    """

    def __init__(self, scenario: DynamicsScenario, *, live: bool = False) -> None:
        self.compiled: CompiledChain = compile_chain(scenario, live=live)
        self.state = self.compiled.new_state()
        self._work = new_chain_work(len(self.compiled.vehicle_names))
        self._buffers = _new_buffers(len(self.compiled.vehicle_names))
        self._kept: list[Rows] = []

    @property
    def time_s(self) -> float:
        """Time since the start [s]."""
        return float(self.state.ledger[0]["time_s"])

    @property
    def steps(self) -> int:
        """Steps computed so far."""
        return int(self.state.ledger[0]["steps"])

    @property
    def has_ended(self) -> bool:
        """Whether the case has come to its end."""
        return bool(self.state.ledger[0]["ended"])

    def advance(self, until_s: float) -> Literal["done", "ended"]:
        """Run until a time [s] or the end of the case; what was recorded is kept until `take_rows`.

        Raises
        ------
        NotComputableError
            If it cannot be computed on; what was recorded up to there can be taken.
        """
        while True:
            reason = advance_chain(self.compiled.chain, self.state, self._buffers, self._work, until_s)
            if reason != BUFFER_FULL:
                break
            self._collect()
        if reason in (NOT_FINITE, STEP_TOO_SMALL):
            what = "a speed is no number any more" if reason == NOT_FINITE else "the variable step has become shorter than 1 ns"
            raise NotComputableError(f"at {self.time_s:.3f} s {what}; shorten step_s, or soften the stiffest coupling")
        return "ended" if reason == ENDED else "done"

    def take_rows(self) -> Rows:
        """Return what was recorded since the last call."""
        self._collect()
        taken, self._kept = self._kept, []
        return Rows(*(np.concatenate(parts) for parts in zip(*taken, strict=True)))

    def set(
        self,
        *,
        drive: int | None = None,
        brake: int | str | None = None,
        electric: float | None = None,
        independent_bar: float | None = None,
    ) -> None:
        """Set controls from now on; None leaves one as it is.

        Parameters
        ----------
        drive
            Level of the drive control, 0 to the highest of the case.
        brake
            Level of the brake control, or ``"charge"``, ``"full_service"``, ``"emergency"``.
        electric
            Level of the electric brake.
        independent_bar
            Cylinder pressure of the independent brake [bar].

        Raises
        ------
        UsageError
            If the case has no such level or word; nothing is set then.
        """
        case, setting = self.compiled.scenario.case, (drive, brake, electric, independent_bar)
        check_setting(case, setting)
        self.state = append_control(case, self.state, setting)

    def snapshot(self) -> dict[str, Any]:
        """Return what is the case now, in units of the boundary: time, controls, motion of the first vehicle, forces."""
        chain = self.compiled.chain
        set_present(chain, self.state, self._work)
        air = Air(present_reduction(chain, self.state), float(chain.air[0]["pipe_pa"]))
        forces = self._work.force[: len(self.state.links)].copy()
        return snapshot(self.state, forces, self._work.applied.copy(), air, chain.vehicles["weight_n"])

    def distributions(self) -> dict[str, Any]:
        """Return the distributions of levels, speed, force of the first coupling and acceleration up to now."""
        return distributions(self.state, self.compiled.chain.bins)

    def copy(self) -> ChainState:
        """Return a copy of the state, to be put back by `restore`."""
        return copied(self.state)

    def restore(self, state: ChainState) -> None:
        """Go back to a copied state; what was recorded since stays recorded."""
        self.state = copied(state)

    def _collect(self) -> None:
        buffers, (rows, turns, marks) = self._buffers, self._buffers.used
        taken = (
            buffers.chain[:rows], buffers.vehicles[:rows], buffers.links[:rows], buffers.turns[:turns], buffers.marks[:marks]
        )  # fmt: skip
        self._kept.append(Rows(*(part.copy() for part in taken)))
        self._taken(self._kept[-1])
        buffers.used[:] = 0

    def _taken(self, rows: Rows) -> None:
        """Look at rows that have just been taken out of the buffers; those who want to derive from this class."""


def copied(state: ChainState) -> ChainState:
    """Return a copy of a state."""
    return state._replace(**{name: array.copy() for name, array in state._asdict().items()})


def _new_buffers(vehicles: int) -> ChainBuffers:
    links = max(vehicles - 1, 0)
    rows = max(ROWS * 8 // (vehicles + 7), 64)
    return ChainBuffers(
        np.zeros(rows, CHAIN_ROW), np.zeros((rows, vehicles), VEHICLE_ROW), np.zeros((rows, links), LINK_ROW),
        np.zeros(max(TURNS, 2 * links), TURN), np.zeros(MARKS, MARK), np.zeros(3, np.int64),
    )  # fmt: skip
