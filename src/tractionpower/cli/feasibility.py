"""``tractionpower feasibility STUDY``: does the timetable hold on this supply, and if not, what would save it?"""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.feasibility import Judgement


def feasibility(
    study: Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>-feasibility/ here.")
    ] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change an input, e.g. supply.substations[A].state=bypassed."),
    ] = None,
    tolerance: Annotated[
        float | None, typer.Option("--tolerance", metavar="S", min=0, help="Lateness that is accepted [s]; default of the study.")
    ] = None,
    search: Annotated[
        bool | None, typer.Option("--search/--no-search", help="Search for what would save it; default: when infeasible.")
    ] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when the timetable is infeasible.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdict as JSON.")] = False,
) -> None:
    """Judge whether the timetable holds on this supply."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.feasibility_summary import show
    from tractionpower.cli.messages import NOT_COMPLETED, tell, tell_beside, tell_problems
    from tractionpower.cli.report import tell_reports
    from tractionpower.cli.run import write_run_reports
    from tractionpower.io.scenario_files import load_scenario
    from tractionpower.reporting.reports import WORKBOOK

    loaded = load_scenario(study)
    scenario = loaded.changed(changes or [])
    name = study_name(loaded)
    folder = out if out is not None else Path("reports") / f"{name}-feasibility"
    tell(f"{scenario.name or name}: {loaded.origin}")
    warn_of_compilation("advance")
    judgement, writer = _judge(loaded, scenario, (name, folder), tolerance, force=force)
    tell_problems(loaded.provenance.place([*loaded.problems, *judgement.warnings]))
    told, is_stopped = _searched(scenario, judgement, writer, search)
    if as_json:
        document = {"format": 1, "study": name, "folder": str(folder), **told["feasibility"]}
        typer.echo(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        show(told)
    if not no_reports:
        tell("writing figures and workbook")
    reports, unwritten = ([], None) if no_reports else write_run_reports(folder, scenario)
    if unwritten is not None:
        raise unwritten
    tell(f"results: {folder}")
    tell_reports(reports)
    if reports and not judgement.outcome.run["feasibility"]["late_trains"]:
        tell("no train is late: there are no figures of delays; train_graph.png shows the trains")
    if no_reports and (folder / WORKBOOK).exists():
        tell(f"{folder / WORKBOOK} is of an earlier run; `tractionpower report {folder}` writes it again")
    tell_beside(writer.beside)
    raise typer.Exit(NOT_COMPLETED if is_stopped else _exit_code(judgement, strict))


def study_name(loaded: LoadedScenario) -> str:
    """Return the name of a study: its folder, and the study file where that is not ``study.yaml``."""
    from tractionpower.io.finder import STUDY_FILE

    file = loaded.file.name
    return loaded.folder.name if file == STUDY_FILE else f"{loaded.folder.name}-{loaded.file.stem}"


def _judge(
    loaded: LoadedScenario, scenario: Scenario, place: tuple[str, Path], tolerance: float | None, *, force: bool
) -> tuple[Judgement, RunWriter]:
    """Judge a scenario; `place` is the name of the study and the folder of the results."""
    from tractionpower.cli.console import progress_bar
    from tractionpower.cli.messages import tell
    from tractionpower.errors import InputError
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.feasibility.study import Judging

    name, folder = place
    writer = RunWriter(folder, name, scenario.input_hash, force=force, scenario=scenario)
    try:
        judging = Judging(scenario, writer, study=name, tolerance_s=tolerance)
    except BaseException as error:
        writer.discard()
        if isinstance(error, InputError):
            raise InputError(loaded.provenance.place(error.problems)) from None
        raise
    try:
        with progress_bar("running the timetable") as update:
            judgement = judging.execute(update)
        outcome, is_late = judgement.outcome, judgement.verdict == "infeasible"
        writer.finish(outcome.run, outcome.key_figures, is_continued=is_late)  # whatever becomes of a search
    except KeyboardInterrupt:
        kept = judging.keep_unfinished(writer)
        tell(f"interrupted after {judging.run.done} of {judging.run.steps} steps; what was computed is kept in {kept}")
        tell(f"`tractionpower report {folder} --partial` makes reports of it")
        raise
    return judgement, writer


def _searched(scenario: Scenario, judgement: Judgement, writer: RunWriter, wanted: bool | None) -> tuple[dict[str, Any], bool]:
    """Search for what would save the timetable, where it is wanted; return what ``run.json`` says then, and whether Ctrl-C came.

    Trial runs are kept beside the results until a search comes to its end.
    """
    from tractionpower.cli.console import progress_bar
    from tractionpower.cli.messages import tell
    from tractionpower.studies.remedies.remedy import as_notes
    from tractionpower.studies.remedies.search import search

    run = judgement.outcome.run
    if not (wanted or (wanted is None and judgement.verdict == "infeasible")):
        return run, False
    tell("the verdict is written; Ctrl-C ends the search, and what it has found is kept")
    with progress_bar("searching what would save it") as update:
        remedies = search(scenario, judgement, update, folder=writer.beside_parts)
    if remedies.reused:
        tell(f"{remedies.reused} trial runs of before are reused")
    said = {
        "remedies": as_notes(remedies),
        "sensitivities": as_notes(remedies.sensitivities),
        "search": {"tried": remedies.tried, "interrupted": remedies.interrupted, "notes": list(remedies.notes)},
    }
    run = {**run, "feasibility": {**run["feasibility"], **said}}
    writer.amend(run, is_continued=remedies.interrupted)
    if remedies.interrupted:
        tell("the search was broken off: the same command goes on from its trial runs")
    return run, remedies.stopped


def _exit_code(judgement: Judgement, strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if judgement.outcome.flagged:
        return NOT_COMPLETED
    return LIMIT_VIOLATED if strict and judgement.verdict == "infeasible" else DONE
