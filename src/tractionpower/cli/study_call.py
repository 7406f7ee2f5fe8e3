"""How a command that computes a study begins and ends, whatever it computes: load, refuse, keep, report, exit."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Protocol, TypeVar

import typer

from tractionpower.cli.look import Look
from tractionpower.cli.messages import (
    DONE,
    LIMIT_VIOLATED,
    NOT_COMPLETED,
    echo_json,
    tell,
    tell_problems,
    tell_results,
)
from tractionpower.cli.progress import cases_bar

if TYPE_CHECKING:
    from tractionpower.cosimulation.run import Run
    from tractionpower.errors import Problem
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.report import Report
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.runner.outcomes import CasesRun


class CasesOutcome(Protocol):
    """How a study of many cases ended."""

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C came."""

    @property
    def cases(self) -> CasesRun:
        """What became of the cases."""


Ended = TypeVar("Ended", bound=CasesOutcome)


@dataclass(frozen=True, slots=True)
class Call:
    """A study, or a case of train dynamics, for which a command was called.

    Attributes
    ----------
    loaded
        What its files say.
    scenario
        What is computed: that with what the options change.
    name
        Its name in the results.
    folder
        Where the results go.
    kind
        What is computed, as ``run.json`` says it; empty: a run.
    look
        How the reports look.
    """

    loaded: Any
    scenario: Any
    name: str
    folder: Path
    kind: str = ""
    look: Look = field(default_factory=Look)

    @property
    def template(self) -> Report | None:
        """Template of the reports that its files name."""
        return None

    def greet(self, more: str = "") -> None:
        """Say what is computed, and where it is from."""
        tell(f"{self.scenario.name or self.name}: {self.loaded.origin}{more}")

    def warn(self, warnings: Iterable[Problem]) -> None:
        """Tell the warnings of the files and those found since, by file and line."""
        tell_problems(self.loaded.provenance.place([*self.loaded.problems, *warnings]))

    @contextmanager
    def placed(self) -> Iterator[None]:
        """Give the errors of what is done inside their files and lines."""
        from tractionpower.errors import InputError

        try:
            yield
        except InputError as error:
            raise InputError(self.loaded.provenance.place(error.problems)) from None

    def new_writer(self, *, force: bool, study: str = "") -> RunWriter:
        """Return a writer into the folder; `study` is its name there where that is another one."""
        from tractionpower.results.kept import input_hash_of
        from tractionpower.results.store import RunWriter

        scenario = self.scenario
        digest = input_hash_of(scenario)
        return RunWriter(self.folder, study or self.name, digest, kind=self.kind, force=force, scenario=scenario)

    @contextmanager
    def preparing(self, *, force: bool, study: str = "") -> Iterator[RunWriter]:
        """Open the folder, and leave no trace there of what fails inside."""
        writer = self.new_writer(force=force, study=study)
        try:
            with self.placed():
                yield writer
        except BaseException:
            writer.discard()
            raise

    def echo(self, verdict: Mapping[str, Any]) -> None:
        """Print a verdict as JSON."""
        echo_json({"format": 1, "study": self.name, "folder": str(self.folder), **verdict})

    def leave(self, writer: RunWriter, code: int, *, no_reports: bool, remark: str = "") -> NoReturn:
        """Write the reports, say where everything is, and end the command; `remark` is a word on the reports.

        What hinders the reports ends the command too, so results are printed before.
        """
        from tractionpower.reporting.reports import WORKBOOK, write_reports
        from tractionpower.results.results import Results

        reports: Sequence[Path] = []
        if not no_reports:
            tell("writing figures and workbook")
            report = self.look.report(self.folder, self.template)
            reports = write_reports(Results.open(self.folder), self.scenario, self.folder, report)
        tell_results(self.folder, reports, writer.beside)
        if reports and remark:
            tell(remark)
        workbook = self.folder / WORKBOOK
        if no_reports and workbook.exists():
            tell(f"{workbook} is of an earlier run; `tractionpower report {self.folder}` writes it again")
        raise typer.Exit(code)


@dataclass(frozen=True, slots=True)
class StudyCall(Call):
    """A study for which a command was called."""

    loaded: LoadedScenario
    scenario: Scenario

    @property
    def template(self) -> Report | None:
        """Template of the reports that the study names."""
        return self.loaded.report

    @property
    def cases_folder(self) -> Path:
        """Where cases leave their whole results, if they are to."""
        return Path(f"{self.folder}-cases")


def call_study(
    study: str, changes: Sequence[str] | None, out: Path | None, kind: str = "", *, look: Look | None = None
) -> StudyCall:
    """Load a study and change it; results go to `out`, or into a folder of the study and the `kind` of what is computed."""
    from tractionpower.io.scenario_files import load_scenario

    loaded = load_scenario(study)
    scenario = loaded.changed(changes or [])
    name = _study_name(loaded) if kind else loaded.folder.name
    folder = out if out is not None else Path("reports") / (f"{name}-{kind}" if kind else name)
    (look or Look()).check(loaded, scenario)
    return StudyCall(loaded, scenario, name, folder, kind, look or Look())


def _study_name(loaded: LoadedScenario) -> str:
    """Return the name of a study: its folder, and the study file where that is not ``study.yaml``."""
    from tractionpower.io.finder import STUDY_FILE

    file = loaded.file.name
    return loaded.folder.name if file == STUDY_FILE else f"{loaded.folder.name}-{loaded.file.stem}"


@contextmanager
def keeping(writer: RunWriter, run: Run, keep: Callable[[RunWriter], Path]) -> Iterator[None]:
    """Keep what was computed when Ctrl-C comes while `run` goes on, and say where it is."""
    try:
        yield
    except KeyboardInterrupt:
        kept = keep(writer)
        tell(f"interrupted after {run.done} of {run.steps} steps; what was computed is kept in {kept}")
        tell(f"`tractionpower report {writer.folder} --partial` makes reports of it")
        raise


def execute_cases(run: Callable[..., Ended], total: int, workers: int | None, **how: Any) -> Ended:
    """Run the cases of a study with a bar; `how` are further keywords of `run`, which keeps the cases when Ctrl-C comes."""
    with cases_bar(total) as progress:
        outcome = run(workers=workers_or_cores(workers), progress=progress, **how)
    if outcome.interrupted:
        tell(f"interrupted after {len(outcome.cases.rows)} of {total} cases; the same command goes on from there")
        raise KeyboardInterrupt
    return outcome


def workers_or_cores(workers: int | None) -> int:
    """Return how many runs go on at a time: as wanted, or one for each core."""
    import os

    return workers or os.cpu_count() or 1


def exit_code(*, flagged: bool, holds: bool, strict: bool) -> int:
    """Return how a command ends: not completed, a limit violated where that counts, or done."""
    if flagged:
        return NOT_COMPLETED
    return LIMIT_VIOLATED if strict and not holds else DONE
