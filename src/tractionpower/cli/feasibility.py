"""``tractionpower feasibility STUDY``: does the timetable hold on this supply, and if not, what would save it?"""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import look_of
from tractionpower.cli.messages import tell
from tractionpower.cli.options import (
    Changes,
    Force,
    NoReports,
    ReportLanguage,
    Study,
    Template,
    VerdictAsJson,
    out_option,
    strict_option,
)
from tractionpower.cli.progress import steps_bar
from tractionpower.cli.study_call import StudyCall, call_study, exit_code, keeping

if TYPE_CHECKING:
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.feasibility import Judgement


def feasibility(
    study: Study,
    *,
    out: Annotated[Path | None, out_option("reports/<study>-feasibility/")] = None,
    changes: Changes = None,
    tolerance: Annotated[
        float | None, typer.Option("--tolerance", metavar="S", min=0, help="Lateness that is accepted [s]; default of the study.")
    ] = None,
    search: Annotated[
        bool | None, typer.Option("--search/--no-search", help="Search for what would save it; default: when infeasible.")
    ] = None,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[bool, strict_option("the timetable is infeasible")] = False,
    as_json: VerdictAsJson = False,
) -> None:
    """Judge whether the timetable holds on this supply."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.feasibility_summary import show

    call = call_study(study, changes, out, "feasibility", look=look_of(template, language))
    call.greet()
    warn_of_compilation("advance")
    judgement, writer = _judge(call, tolerance, force=force)
    call.warn(judgement.warnings)
    told, is_stopped = _searched(call.scenario, judgement, writer, search)
    if as_json:
        call.echo(told["feasibility"])
    else:
        show(told)
    flagged = is_stopped or judgement.outcome.flagged
    late_trains = judgement.outcome.run["feasibility"]["late_trains"]
    remark = "" if late_trains else "no train is late: there are no figures of delays; train_graph.png shows the trains"
    code = exit_code(flagged=flagged, holds=judgement.verdict != "infeasible", strict=strict)
    call.leave(writer, code, no_reports=no_reports, remark=remark)


def _judge(call: StudyCall, tolerance: float | None, *, force: bool) -> tuple[Judgement, RunWriter]:
    from tractionpower.studies.feasibility.study import Judging

    with call.preparing(force=force) as writer:
        judging = Judging(call.scenario, writer, study=call.name, tolerance_s=tolerance)
    with keeping(writer, judging.run, judging.keep_unfinished):
        with steps_bar("running the timetable") as update:
            judgement = judging.execute(update)
        outcome, is_late = judgement.outcome, judgement.verdict == "infeasible"
        writer.finish(outcome.run, outcome.key_figures, is_continued=is_late)  # whatever becomes of a search
    return judgement, writer


def _searched(scenario: Scenario, judgement: Judgement, writer: RunWriter, wanted: bool | None) -> tuple[dict[str, Any], bool]:
    """Search for what would save the timetable, where it is wanted; return what ``run.json`` says then, and whether Ctrl-C came.

    Trial runs are kept beside the results until a search comes to its end.
    """
    from tractionpower.studies.remedies.remedy import as_notes
    from tractionpower.studies.remedies.search import search

    run = judgement.outcome.run
    if not (wanted or (wanted is None and judgement.verdict == "infeasible")):
        return run, False
    tell("the verdict is written; Ctrl-C ends the search, and what it has found is kept")
    with steps_bar("searching what would save it", is_even=False) as update:
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
