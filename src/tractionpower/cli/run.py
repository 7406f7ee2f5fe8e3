"""``tractionpower run STUDY``: compute a study and write its results."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tractionpower.cosimulation.run import Outcome, Run
    from tractionpower.errors import OutputError
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter


def run(
    study: Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")],
    out: Annotated[Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>/ here.")] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change an input, e.g. supply.substations[A].state=bypassed."),
    ] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when a limit is violated.")] = False,
) -> None:
    """Compute a study and write its results."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.messages import tell, tell_beside, tell_problems
    from tractionpower.cli.report import tell_reports
    from tractionpower.cli.run_summary import show
    from tractionpower.io.scenario_files import load_scenario
    from tractionpower.reporting.reports import WORKBOOK

    loaded = load_scenario(study)
    scenario = loaded.changed(changes or [])
    folder = out if out is not None else Path("reports") / loaded.folder.name
    tell(f"{scenario.name or loaded.folder.name}: {loaded.origin}")
    warn_of_compilation("advance")
    prepared, writer = _prepare(loaded, scenario, folder, force)
    tell_problems(loaded.provenance.place([*loaded.problems, *prepared.warnings]))
    outcome = _execute(prepared, writer)
    show(outcome, prepared)
    if not no_reports:
        tell("writing figures and workbook")
    reports, unwritten = ([], None) if no_reports else write_run_reports(folder, scenario)
    if unwritten is not None:
        raise unwritten
    tell(f"results: {folder}")
    tell_reports(reports)
    if no_reports and (folder / WORKBOOK).exists():
        tell(f"{folder / WORKBOOK} is of an earlier run; `tractionpower report {folder}` writes it again")
    tell_beside(writer.beside)
    raise typer.Exit(_exit_code(outcome, strict))


def _prepare(loaded: LoadedScenario, scenario: Scenario, folder: Path, force: bool) -> tuple[Run, RunWriter]:
    from tractionpower.cosimulation.run import Run
    from tractionpower.errors import InputError
    from tractionpower.results.store import RunWriter

    study = loaded.folder.name
    writer = RunWriter(folder, study, scenario.input_hash, force=force, scenario=scenario)
    try:
        return Run(scenario, writer, study), writer
    except BaseException as error:
        writer.discard()
        if isinstance(error, InputError):
            raise InputError(loaded.provenance.place(error.problems)) from None
        raise


def _execute(prepared: Run, writer: RunWriter) -> Outcome:
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    from tractionpower.cli.closed_pipes import PatientConsole
    from tractionpower.cli.messages import tell

    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:3.0f} %"), TimeRemainingColumn(),
        console=PatientConsole(stderr=True), transient=True,
    )  # fmt: skip
    try:
        with bar:
            task = bar.add_task("computing", total=prepared.steps)
            outcome = prepared.execute(lambda done, total: bar.update(task, completed=done, total=total))
        writer.finish(outcome.run, outcome.key_figures)
    except KeyboardInterrupt:
        unfinished = prepared.outcome()
        kept = writer.keep_unfinished(unfinished.run, unfinished.key_figures)
        tell(f"interrupted after {prepared.done} of {prepared.steps} steps; what was computed is kept in {kept}")
        tell(f"`tractionpower report {writer.folder} --partial` makes reports of it")
        raise
    return outcome


def write_run_reports(folder: Path, scenario: Scenario) -> tuple[list[Path], OutputError | None]:
    """Write the reports and return them, or what hinders that, so that the tables are printed first."""
    from tractionpower.errors import OutputError
    from tractionpower.reporting.reports import write_reports
    from tractionpower.results.results import Results

    try:
        return write_reports(Results.open(folder), scenario, folder), None
    except OutputError as error:
        return [], error


def _exit_code(outcome: Outcome, strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if outcome.flagged:
        return NOT_COMPLETED
    if strict and not all(verdict["met"] for verdict in outcome.run["verdicts"]):
        return LIMIT_VIOLATED
    return DONE
