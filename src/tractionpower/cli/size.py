"""``tractionpower size STUDY``: does every device hold, and what is left?"""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.library import Library
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
    search: Annotated[
        bool, typer.Option("--search", help="Search for the least equipment that meets the limits, outages included.")
    ] = False,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="Runs of the search at a time; default: the cores.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Dask scheduler whose workers run the search.")
    ] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when a device or a limit does not hold.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdict as JSON.")] = False,
) -> None:
    """Rate every device of the supply: what it carries, what it may, what is left."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.feasibility import study_name
    from tractionpower.cli.messages import NOT_COMPLETED, tell, tell_beside, tell_problems
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
    sized, writer = _size(loaded, scenario, (name, folder), force=force, goes_on=search)
    tell_problems(loaded.provenance.place([*loaded.problems, *sized.warnings]))
    run, is_stopped = sized.outcome.run, False
    if search:
        run, is_stopped = _searched(scenario, loaded.library, run, writer, (workers, scheduler))
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
    raise typer.Exit(NOT_COMPLETED if is_stopped else _exit_code(sized, run, strict))


def _size(
    loaded: LoadedScenario, scenario: Scenario, place: tuple[str, Path], *, force: bool, goes_on: bool
) -> tuple[Sized, RunWriter]:
    """Rate the devices of a scenario; `place` is the name of the study and the folder of the results."""
    from tractionpower.cli.console import progress_bar
    from tractionpower.cli.messages import tell
    from tractionpower.errors import InputError
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.ratings.study import SizingRun
    from tractionpower.studies.sizing_search.search import varied_items

    name, folder = place
    writer = RunWriter(folder, name, scenario.input_hash, force=force, scenario=scenario)
    try:
        sizing = SizingRun(scenario, writer, study=name)
        if goes_on:
            varied_items(scenario)  # before the run: a search with nothing to vary is refused
    except BaseException as error:
        writer.discard()
        if isinstance(error, InputError):
            raise InputError(loaded.provenance.place(error.problems)) from None
        raise
    try:
        with progress_bar("running the timetable") as update:
            sized = sizing.execute(update)
        writer.finish(sized.outcome.run, sized.outcome.key_figures, is_continued=goes_on)  # whatever becomes of a search
    except KeyboardInterrupt:
        kept = sizing.keep_unfinished(writer)
        tell(f"interrupted after {sizing.run.done} of {sizing.run.steps} steps; what was computed is kept in {kept}")
        tell(f"`tractionpower report {folder} --partial` makes reports of it")
        raise
    return sized, writer


def _searched(
    scenario: Scenario, library: Library, run: dict[str, Any], writer: RunWriter, where: tuple[int | None, str | None]
) -> tuple[dict[str, Any], bool]:
    """Search for the least equipment; return what ``run.json`` says then, and whether Ctrl-C came.

    Runs of the search are kept beside the results until it comes to its end; `where` are workers and scheduler.
    """
    import os

    from tractionpower.cli.console import progress_bar
    from tractionpower.cli.messages import tell
    from tractionpower.studies.ratings.study import with_search
    from tractionpower.studies.runner.store import CaseStore
    from tractionpower.studies.sizing_search.search import search

    tell("the ratings are written; Ctrl-C ends the search, and the same command goes on from its runs")
    workers, scheduler = where
    with progress_bar("searching") as update:
        found = search(
            scenario, library, CaseStore(writer.beside_parts), workers=workers or os.cpu_count() or 1, scheduler=scheduler,
            progress=lambda what, now: update(now.done, now.all, f"searching, {what}: {now.done} of {now.all} cases"),
        )  # fmt: skip
    said = with_search(run, found)
    writer.amend(said, is_continued=found.interrupted)
    if found.interrupted:
        tell("the search was broken off: the same command goes on from its runs")
    return said, found.interrupted


def _exit_code(sized: Sized, run: dict[str, Any], strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if sized.outcome.flagged:
        return NOT_COMPLETED
    found = run["size"].get("search")
    holds = sized.verdict != "fail" and all(verdict["met"] for verdict in run["verdicts"]) and (not found or found["holds"])
    return LIMIT_VIOLATED if strict and not holds else DONE
