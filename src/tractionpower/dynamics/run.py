"""The run of a case: it is checked and compiled, computed in blocks, and its rows go to a writer as they come."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from tractionpower.dynamics.checks import check_case
from tractionpower.dynamics.recorder import ChainRecorder
from tractionpower.dynamics.session import NotComputableError, Session
from tractionpower.errors import Problem, raise_errors
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.results.kept import input_hash_of
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.store import RunWriter
from tractionpower.results.versions import versions

BLOCK_S = 0.25
"""Wall time that a block of steps aims at, so that progress and Ctrl-C live [s]."""

KIND = "dynamics"
"""What ``run.json`` calls such results."""


class CaseRun:
    """One run of a case.

    Parameters
    ----------
    scenario
        What to run.
    writer
        Takes the rows.
    study
        Name of the case, for ``run.json``.
    new_session
        Makes the session of a case that has been checked.
    warnings
        What reading the case has found, to be kept with the results beside the warnings of the checks.

    Raises
    ------
    InputError
        With all problems of the case.
    """

    def __init__(
        self,
        scenario: DynamicsScenario,
        writer: Writer,
        study: str = "",
        new_session: Callable[[DynamicsScenario], Session] = Session,
        warnings: Iterable[Problem] = (),
    ) -> None:
        problems = check_case(scenario)
        raise_errors(problems)
        self.scenario, self.study, self.warnings = scenario, study, tuple(problems)
        self._found_reading = tuple(warnings)
        self.session = new_session(scenario)
        compiled = self.session.compiled
        names = compiled.vehicle_names, compiled.coupling_names
        self.recorder = ChainRecorder(scenario, names, compiled.chain.vehicles["inertia_kg"], self.session.state, writer)
        self.steps = math.ceil(scenario.case.run.duration_s / scenario.case.run.step_s)
        self._started = time.perf_counter()
        self._compile_s = 0.0
        self._failure = ""

    @property
    def done(self) -> int:
        """Steps computed so far."""
        return self.session.steps

    def execute(self, progress: Progress | None = None) -> Outcome:
        """Run to the end of the case, and return what came of it; a motion that cannot be computed on ends it early."""
        session, recorder = self.session, self.recorder
        before = time.perf_counter()
        session.advance(0.0)  # compiles the kernels where they are not in the cache
        self._compile_s = time.perf_counter() - before
        stretch_s, until_s = 100.0 * self.scenario.case.run.step_s, 0.0
        while not (session.has_ended or self._failure):
            until_s = max(until_s, session.time_s) + stretch_s
            before = time.perf_counter()
            try:
                session.advance(until_s)
            except NotComputableError as error:
                self._failure = str(error)
            recorder.add(*session.take_rows())
            wall_s = max(time.perf_counter() - before, 1e-6)
            stretch_s *= min(max(BLOCK_S / wall_s, 0.25), 4.0)
            if progress is not None:
                progress(self.done, self.steps)
        recorder.close(session.state, session.compiled.chain.bins)
        return self.outcome()

    def leave(self, scenario: DynamicsScenario, failure: str = "") -> Outcome:
        """End a run that a driver has ended: it is one of the case as he has driven it; `failure` says what ended it instead."""
        self.scenario, self._failure = scenario, failure
        self.recorder.close(self.session.state, self.session.compiled.chain.bins)
        return self.outcome()

    def outcome(self) -> Outcome:
        """Return what is known of the run up to now."""
        state = self.session.state
        summary = self.recorder.summary(state)
        if self._failure:
            summary["notes"].append(self._failure)
        run = {
            "format": 1,
            "status": self._status(closes=summary["ledgers"]["energy"]["closes"]),
            "kind": KIND,
            "study": self.study,
            "name": self.scenario.name,
            "input_hash": input_hash_of(self.scenario),
            "seed": 0,
            "versions": versions(),
            "wall_seconds": time.perf_counter() - self._started - self._compile_s,
            "compile_seconds": self._compile_s,
            "warnings": [str(problem) for problem in (*self._found_reading, *self.warnings)],
            **summary,
        }
        return Outcome(run, self.recorder.key_figures(state), self.warnings)

    def keep_unfinished(self, writer: RunWriter) -> Path:
        """Keep what an interrupted run has computed; return where it is."""
        self.recorder.add(*self.session.take_rows())
        self.recorder.close(self.session.state, self.session.compiled.chain.bins)
        unfinished = self.outcome()
        return writer.keep_unfinished(unfinished.run | {"status": "interrupted"}, unfinished.key_figures)

    def _status(self, *, closes: bool) -> str:
        if self._failure:
            return "flagged"
        if not self.session.has_ended:
            return "interrupted"
        return "complete" if closes else "flagged"
