"""A study of many cases into a folder: each case kept at once, the results moved in when all are there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol, TypeVar

from tractionpower.results.store import RunWriter
from tractionpower.studies.runner.outcomes import CasesRun
from tractionpower.studies.runner.store import CaseStore


class CasesOutcome(Protocol):
    """How a study of cases ended."""

    @property
    def cases(self) -> CasesRun:
        """All that was run."""

    @property
    def run(self) -> dict[str, Any]:
        """What ``run.json`` holds, without the files."""

    @property
    def key_figures(self) -> list[dict[str, Any]]:
        """Key figures of the study."""

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended it."""


Ended_co = TypeVar("Ended_co", bound=CasesOutcome, covariant=True)


class CasesStudy(Protocol[Ended_co]):
    """A study of cases that can be executed."""

    @property
    def execute(self) -> Callable[..., Ended_co]:
        """Runs, for a writer of tables and a store, the cases that the store does not keep."""


def run_into(study: CasesStudy[Ended_co], writer: RunWriter, *, full_tables: Path | None = None, **how: Any) -> Ended_co:
    """Run a study into a folder; `how` are the keywords of its `execute`.

    Where `full_tables` is given, each case also leaves the whole results of its run in a folder of its own there.

    Each case is kept beside the results as soon as it is there, so the same call goes on where an earlier one was stopped,
    and runs again what failed.
    """
    try:
        outcome = study.execute(writer, CaseStore(writer.beside_parts, full_tables), **how)
    except BaseException:
        writer.discard()  # not what is kept of the cases
        raise
    if outcome.interrupted:
        writer.keep_unfinished(outcome.run, outcome.key_figures)
    else:
        writer.finish(outcome.run, outcome.key_figures, is_continued=outcome.cases.failed > 0)
    return outcome
