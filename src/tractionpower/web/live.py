"""A case that is driven, and what of it is kept: rows go to the writer while it runs, in a thread of their own."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from queue import SimpleQueue
from typing import Any, cast

import numpy as np

from tractionpower.dynamics.driven import DrivenSession
from tractionpower.dynamics.run import CaseRun
from tractionpower.dynamics.session import Rows
from tractionpower.errors import Problem
from tractionpower.model.dynamics.case import Command, DynamicsScenario
from tractionpower.results.outcome import Outcome
from tractionpower.results.store import RunWriter
from tractionpower.web.recording import Driven, as_driven, write_case

DRIVEN = "driven"
"""Folder of the case as it was driven, beside the results."""

PART_S = 10.0
"""Clock time after which rows are written as parts of the tables; commands are written as they come [s]."""


class LiveRun:
    """A run whose controls a driver sets; it is the keeper of the desk.

    Parameters
    ----------
    scenario
        The case; of its commands those at the very beginning are taken.
    writer
        Takes the rows, while driving.
    study
        Name of the case, for ``run.json``.
    warnings
        What reading the case has found, to be kept with the results.

    Raises
    ------
    InputError
        With all problems of the case.
    """

    def __init__(self, scenario: DynamicsScenario, writer: RunWriter, study: str, warnings: Iterable[Problem] = ()) -> None:
        self._run = CaseRun(scenario, writer, study, DrivenSession, warnings)
        self.session = cast(DrivenSession, self._run.session)
        self._scenario, self._writer = scenario, writer
        self._driven = Driven(row for row in scenario.case.commands if row.time_s == 0.0)
        self._rows: SimpleQueue[tuple[Rows, DynamicsScenario] | None] = SimpleQueue()
        self._failure: BaseException | None = None
        self._thread = threading.Thread(target=self._write_all, name="writer")

    @property
    def warnings(self) -> tuple[Any, ...]:
        """Warnings of the checks."""
        return self._run.warnings

    def begin(self) -> None:
        """Compile what is not compiled yet, and begin to write."""
        self.session.advance(0.0)
        self.session.snapshot()
        self.session.statistics()
        write_case(self._as_driven(), self._writer.running / DRIVEN)
        self._thread.start()

    def note(self, time_s: float, setting: Mapping[str, Any]) -> None:
        """Note what was set, and when [s]."""
        self._driven.note(time_s, setting)

    def take(self) -> None:
        """Hand what was recorded over to be written; what went wrong there before is raised here."""
        if self._failure is not None:
            raise self._failure
        self._rows.put((self.session.take_rows(), self._as_driven()))

    def close(self) -> None:
        """Wait until everything is written."""
        if self._thread.ident is not None:
            self._rows.put(None)
            self._thread.join()
        if self._failure is not None:
            raise self._failure

    def abandon(self) -> None:
        """End a drive that something outside it has ended: what was recorded is kept as parts, or nothing where nothing was."""
        if self._thread.ident is not None:
            self._rows.put(None)
            self._thread.join()
        if self.has_driven:
            self._run.keep_unfinished(self._writer)
        else:
            self._writer.discard()

    def finish(self, failure: str = "") -> Outcome:
        """Complete the results, and keep the case as it was driven beside them; `failure` says what has ended the drive."""
        if not failure:
            self.session.end()
        self._write([self.session.take_rows()])
        scenario = self._as_driven()
        outcome = self._run.leave(scenario, failure)
        self._writer.keep(scenario)
        self._writer.finish(outcome.run, outcome.key_figures)
        write_case(scenario, self.folder)
        return outcome

    @property
    def folder(self) -> Path:
        """Folder of the case as it was driven."""
        return self._writer.folder / DRIVEN

    @property
    def has_driven(self) -> bool:
        """Whether the train has been computed on at all."""
        return self.session.steps > 0

    def _as_driven(self) -> DynamicsScenario:
        return as_driven(self._scenario, self._driven.commands(), self.session.time_s)

    def _write_all(self) -> None:
        try:
            waiting: list[Rows] = []
            written: tuple[Command, ...] = ()
            due = time.monotonic() + PART_S
            while (item := self._rows.get()) is not None:
                rows, scenario = item
                waiting.append(rows)
                is_due = time.monotonic() >= due
                if is_due or scenario.case.commands != written:
                    write_case(scenario, self._writer.running / DRIVEN, with_stock=False)
                    written = scenario.case.commands
                if is_due:
                    self._write(waiting)
                    waiting, due = [], time.monotonic() + PART_S
            self._write(waiting)
        except BaseException as error:  # raised where the desk hands over the next rows
            self._failure = error

    def _write(self, waiting: list[Rows]) -> None:
        if waiting:
            self._run.recorder.add(*(np.concatenate(parts) for parts in zip(*waiting, strict=True)))
