"""Where a case is run, in whatever process: the base is changed, measured, and the outcome packed."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from tractionpower.errors import InputError, OutputError
from tractionpower.model.change import apply_changes
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.studies.runner.case import REFUSED, CaseResult, Work
from tractionpower.studies.runner.packed import pack


class Task(NamedTuple):
    """A case on its way: its number in the study, its changes, and where its whole results go, if anywhere."""

    number: int
    changes: tuple[str, ...]
    folder: Path | None = None


@dataclass(frozen=True, slots=True)
class Reply:
    """How a case ended.

    Attributes
    ----------
    data
        The outcome; None if it failed.
    reason, trace
        Why it failed, in one line and with the traceback.
    seconds
        What it took [s].
    refused
        Whether the inputs have errors.
    """

    data: bytes | None
    reason: str = ""
    trace: str = ""
    seconds: float = 0.0
    refused: bool = False


@dataclass(frozen=True)
class Bench:
    """What is the same in all cases; other processes are sent it once."""

    base: Scenario
    library: Library
    work: Work

    def run(self, task: Task) -> Reply:
        """Run a case; whatever is wrong with it is in the reply."""
        started = time.perf_counter()
        try:
            reply = self._measured(task)
        except InputError as error:
            reply = Reply(pack(refusal(error)), refused=True)
        except OutputError:  # of whole results: the next ones cannot be written either
            raise
        except Exception as error:  # a defect in one case shall not stop the others
            reply = Reply(None, f"{type(error).__name__}: {error}".strip(": "), traceback.format_exc())
        return replace(reply, seconds=time.perf_counter() - started)

    def _measured(self, task: Task) -> Reply:
        scenario = apply_changes(self.base, task.changes, self.library)
        data = pack(self.work(scenario))
        if task.folder is not None:
            from tractionpower.cosimulation.simulate import simulate  # noqa: PLC0415 - few need it, and it takes a third of a start

            simulate(scenario, task.folder, force=True)
        return Reply(data)


def refusal(error: InputError) -> CaseResult:
    """Return the outcome of a case whose inputs have errors, all of which are told."""
    errors = [problem for problem in error.problems if problem.severity == "error"] or error.problems
    return CaseResult({"status": REFUSED, "reason": " | ".join(str(problem).removeprefix("error: ") for problem in errors)})
