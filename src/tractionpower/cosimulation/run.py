"""The run: tables are compiled, blocks of steps are computed, rows go to a writer as they come."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tractionpower.cosimulation.check import check_scenario, step_count
from tractionpower.cosimulation.recorder import Recorder, Watch
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.switching import Switchboard
from tractionpower.cosimulation.tables import compile_scenario, coupling_voltage
from tractionpower.errors import raise_errors
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import TRIGGERED, Buffers, State, new_buffers
from tractionpower.kernels.train_tables import TRAIN_ROW
from tractionpower.model.scenario import Scenario
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.store import RunWriter
from tractionpower.results.versions import versions

BLOCK_S = 0.25
"""Wall time that a block of steps aims at, so that progress and Ctrl-C live [s]."""

FIRST_BLOCK = 16
BUFFER_BYTES = 16_000_000


class Run:
    """One run of a scenario.

    Parameters
    ----------
    scenario
        What to run.
    writer
        Takes the rows.
    study
        Identifier of the study, for ``run.json``.
    watches
        Called with the rows of every step, whatever is written.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    """

    def __init__(self, scenario: Scenario, writer: Writer, study: str = "", watches: Sequence[Watch] = ()) -> None:
        started = time.perf_counter()
        problems = check_scenario(scenario)
        raise_errors(problems)
        self.scenario, self.study = scenario, study
        self.warnings = tuple(problems)
        self.compiled = compile_scenario(scenario)
        self.steps = step_count(scenario.clock)
        state = start_state(self.compiled)
        self.board = Switchboard(scenario, self.compiled, state)
        self.recorder = Recorder(scenario, self.compiled, state, writer, watches)
        self._closed = False
        self.compile_seconds = time.perf_counter() - started
        self.wall_seconds = 0.0

    def execute(self, progress: Progress | None = None) -> Outcome:
        """Run to the end of the clock and return the outcome.

        After an interruption `outcome` still tells what was done; rows computed so far are with the writer.
        """
        compiled, board = self.compiled, self.board
        buffers, spare = self._new_buffers(), self._new_buffers()
        started, block = time.perf_counter(), FIRST_BLOCK
        advance(compiled.block, self.state, buffers, self.done)  # no step: kernels are compiled or taken from the cache
        self.compile_seconds += time.perf_counter() - started
        started = time.perf_counter()
        with ThreadPoolExecutor(1) as recording:  # the block holds no lock: rows are recorded while the next ones are computed
            pending: Future[None] | None = None
            try:
                while self.done < self.steps:
                    block_started = time.perf_counter()
                    board.move(self.done)
                    until = min(self.done + block, self.steps, board.next_step)
                    compiled = board.compiled
                    rows, reason = advance(compiled.block, board.state, buffers, until)
                    if reason == TRIGGERED:
                        board.react(self.done, rows - 1, buffers)
                    pace = (time.perf_counter() - block_started) / max(rows, 1)
                    if pending is not None:
                        pending.result()
                    pending = recording.submit(self.recorder.add, self.done - rows, rows, buffers, compiled.supply)
                    buffers, spare = spare, buffers
                    block = max(FIRST_BLOCK, int(BLOCK_S / max(pace, 1e-9))) if self.done > FIRST_BLOCK else FIRST_BLOCK
                    self.wall_seconds = time.perf_counter() - started
                    if progress is not None:
                        progress(self.done, self.steps)
            finally:  # an interruption leaves whole steps, and a failure to write is told, whatever came first
                if pending is not None:
                    pending.result()
                ahead = self.done - self.recorder.steps
                if ahead > 0:
                    self.recorder.add(self.recorder.steps, ahead, buffers, compiled.supply)
                self.recorder.close(board.rows)
        self._closed = True
        return self.outcome()

    @property
    def state(self) -> State:
        """State of the run after the last step."""
        return self.board.state

    @property
    def done(self) -> int:
        """Number of steps computed."""
        return int(self.state.progress["step"][0])

    def _new_buffers(self) -> Buffers:
        """Return buffers of some `BUFFER_BYTES` for the steps, and as many for the trains."""
        sample = new_buffers(self.compiled.block, 1)
        steps = max(FIRST_BLOCK, min(self.steps, BUFFER_BYTES // sum(array.nbytes for array in sample[:-1])))
        return new_buffers(self.compiled.block, steps, BUFFER_BYTES // TRAIN_ROW.itemsize)

    def outcome(self) -> Outcome:
        """Return what is known of the run up to now."""
        run = {
            "format": 1,
            "status": self._status(),
            "study": self.study,
            "name": self.scenario.name,
            "input_hash": self.scenario.input_hash,
            "seed": self.scenario.seed,
            "step_s": self.scenario.clock.step_s,
            "start_s": self.scenario.clock.start,
            "end_s": self.scenario.clock.end if self.done == self.steps else self.recorder.now_s,
            **self._coupling(),
            "versions": versions(),
            "wall_seconds": self.wall_seconds,
            "compile_seconds": self.compile_seconds,
            "steps": self.done,
            **self.recorder.summary(),
        }
        return Outcome(run, self.recorder.key_figures(), self.warnings)

    def keep_unfinished(self, writer: RunWriter) -> Path:
        """Keep what an interrupted run has computed; return where it is."""
        unfinished = self.outcome()
        return writer.keep_unfinished(unfinished.run | {"status": "interrupted"}, unfinished.key_figures)

    def _coupling(self) -> dict[str, Any]:
        volts = coupling_voltage(self.scenario, self.compiled.supply)
        return {"coupling": self.scenario.coupling} | ({} if volts is None else {"coupling_voltage_v": volts})

    def _status(self) -> str:
        if self.done < self.steps or not self._closed:
            return "interrupted"
        return "flagged" if self.recorder.flagged else "complete"
