"""``tractionpower size STUDY``: does every device hold, and what is left?"""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.ratings.study import Sized


def size(
    study: Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")],
    *,
    out: Annotated[Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>-size/ here.")] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change an input, e.g. supply.substations[A].units=2."),
    ] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when a device or a limit does not hold.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdict as JSON.")] = False,
) -> None:
    """Rate every device of the supply: what it carries, what it may, what is left."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.feasibility import study_name
    from tractionpower.cli.messages import tell, tell_beside, tell_problems
    from tractionpower.cli.report import tell_reports
    from tractionpower.cli.run import write_run_reports
    from tractionpower.cli.size_summary import show
    from tractionpower.io.scenario_files import load_scenario
    from tractionpower.reporting.reports import WORKBOOK

    loaded = load_scenario(study)
    scenario = loaded.changed(changes or [])
    name = study_name(loaded)
    folder = out if out is not None else Path("reports") / f"{name}-size"
    tell(f"{scenario.name or name}: {loaded.origin}")
    warn_of_compilation("advance")
    sized, writer = _size(loaded, scenario, (name, folder), force=force)
    tell_problems(loaded.provenance.place([*loaded.problems, *sized.warnings]))
    run = sized.outcome.run
    if as_json:
        document = {"format": 1, "study": name, "folder": str(folder), **run["size"]}
        typer.echo(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        show(run)
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
    raise typer.Exit(_exit_code(sized, strict))


def _size(loaded: LoadedScenario, scenario: Scenario, place: tuple[str, Path], *, force: bool) -> tuple[Sized, RunWriter]:
    """Rate the devices of a scenario; `place` is the name of the study and the folder of the results."""
    from tractionpower.cli.console import progress_bar
    from tractionpower.cli.messages import tell
    from tractionpower.errors import InputError
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.ratings.study import SizingRun

    name, folder = place
    writer = RunWriter(folder, name, scenario.input_hash, force=force, scenario=scenario)
    try:
        sizing = SizingRun(scenario, writer, study=name)
    except BaseException as error:
        writer.discard()
        if isinstance(error, InputError):
            raise InputError(loaded.provenance.place(error.problems)) from None
        raise
    try:
        with progress_bar("running the timetable") as update:
            sized = sizing.execute(update)
        writer.finish(sized.outcome.run, sized.outcome.key_figures)
    except KeyboardInterrupt:
        kept = sizing.keep_unfinished(writer)
        tell(f"interrupted after {sizing.run.done} of {sizing.run.steps} steps; what was computed is kept in {kept}")
        tell(f"`tractionpower report {folder} --partial` makes reports of it")
        raise
    return sized, writer


def _exit_code(sized: Sized, strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if sized.outcome.flagged:
        return NOT_COMPLETED
    holds = sized.verdict != "fail" and all(verdict["met"] for verdict in sized.outcome.run["verdicts"])
    return LIMIT_VIOLATED if strict and not holds else DONE
