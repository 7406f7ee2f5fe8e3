"""The run of a case of stations: it is checked, simulated in blocks, and its rows go to a writer as they come."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from pathlib import Path

from tractionpower.dynamics.traindyn.station_checks import check_stations
from tractionpower.dynamics.traindyn.station_recorder import StationRecorder
from tractionpower.dynamics.traindyn.stations import StationsModel, import_simpy
from tractionpower.errors import Problem, raise_errors
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.results.kept import input_hash_of
from tractionpower.results.outcome import Outcome, Progress, Writer
from tractionpower.results.store import RunWriter
from tractionpower.results.versions import versions

KIND = "stations"
"""What ``run.json`` calls such results."""

BLOCK_S = 600.0
"""Simulated time between two calls of progress [s]."""


class StationsRun:
    """One run of a case of stations.

    Parameters
    ----------
    scenario
        The case.
    writer
        Takes the rows of the tables ``point_masses`` and ``station_events``.
    study
        Name of the case, for ``run.json``.
    warnings
        What reading the case has found, to be kept with the results beside the warnings of the checks.

    Raises
    ------
    InputError
        With all problems of the case.
    UsageError
        If SimPy is not installed.
    """

    def __init__(self, scenario: StationsCase, writer: Writer, study: str = "", warnings: Iterable[Problem] = ()) -> None:
        problems = check_stations(scenario)
        raise_errors(problems)
        self.scenario, self.study, self.warnings = scenario, study, tuple(problems)
        self._found_reading = tuple(warnings)
        self._env = import_simpy().Environment()
        self._recorder = StationRecorder(scenario, writer)
        self._model = StationsModel(scenario, self._env, self._recorder)
        self._started = time.perf_counter()

    @property
    def steps(self) -> int:
        """Samples up to the end of the case."""
        return math.ceil(self.scenario.run.duration_s / self.scenario.run.period_s)

    @property
    def done(self) -> int:
        """Samples so far."""
        return int(self._env.now / self.scenario.run.period_s)

    def execute(self, progress: Progress | None = None) -> Outcome:
        """Run until all trains have left, or to the end of the case; progress is told in samples."""
        env, over, total = self._env, self._model.over, self.scenario.run.duration_s
        while env.now < total and not over.processed:
            env.run(until=over | env.timeout(min(BLOCK_S, total - env.now)))
            self._recorder.flush()
            if progress is not None:
                progress(self.done, self.steps)
        self._model.finish()
        if progress is not None:
            progress(self.steps, self.steps)
        return self.outcome("complete")

    def outcome(self, status: str) -> Outcome:
        """Return what is known of the run up to now."""
        case = self.scenario
        run = {
            "format": 1,
            "status": status,
            "kind": KIND,
            "study": self.study,
            "name": case.name,
            "input_hash": input_hash_of(case),
            "seed": case.seed,
            "versions": versions(),
            "wall_seconds": time.perf_counter() - self._started,
            "warnings": [str(problem) for problem in (*self._found_reading, *self.warnings)],
            "verdicts": [],
            "ledgers": {},
            "notes": self._recorder.notes(),
            "method": case.run.method,
            "period_s": case.run.period_s,
            "end_s": float(self._env.now),
            "trains": case.traffic.trains,
        }
        return Outcome(run, self._recorder.key_figures(), self.warnings)

    def keep_unfinished(self, writer: RunWriter) -> Path:
        """Keep what an interrupted run has computed; return where it is."""
        self._recorder.flush()
        unfinished = self.outcome("interrupted")
        return writer.keep_unfinished(unfinished.run, unfinished.key_figures)
