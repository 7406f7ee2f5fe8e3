"""``tractionpower size STUDY``: does every device hold, and what is left?"""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import look_of
from tractionpower.cli.messages import tell
from tractionpower.cli.options import (
    Force,
    NoReports,
    ReportLanguage,
    Study,
    Template,
    VerdictAsJson,
    out_option,
    set_option,
    strict_option,
)
from tractionpower.cli.progress import steps_bar
from tractionpower.cli.study_call import StudyCall, call_study, exit_code, keeping, workers_or_cores

if TYPE_CHECKING:
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.ratings.study import Sized


def size(
    study: Study,
    *,
    out: Annotated[Path | None, out_option("reports/<study>-size/")] = None,
    changes: Annotated[list[str] | None, set_option(", e.g. supply.substations[A].units=2")] = None,
    search: Annotated[
        bool, typer.Option("--search", help="Search for the least equipment that meets the limits, outages included.")
    ] = False,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="With --search: its runs at a time; default: the cores.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="With --search: Dask scheduler whose workers run it.")
    ] = None,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[
        bool, strict_option("a device or a limit does not hold; without a rating a device is not rated, which is no violation")
    ] = False,
    as_json: VerdictAsJson = False,
) -> None:
    """Rate every device of the supply: what it carries, what it may, what is left."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.size_summary import show

    if not search:
        _refuse_without_search({"--workers": workers, "--scheduler": scheduler})
    call = call_study(study, changes, out, "size", look=look_of(template, language))
    call.greet()
    warn_of_compilation("advance")
    sized, writer = _size(call, force=force, goes_on=search)
    call.warn(sized.warnings)
    run, is_stopped = sized.outcome.run, False
    if search:
        run, is_stopped = _searched(call, run, writer, workers, scheduler)
    if as_json:
        call.echo(run["size"])
    else:
        show(run)
    flagged = is_stopped or sized.outcome.flagged
    code = exit_code(flagged=flagged, holds=_holds(sized, run), strict=strict)
    call.leave(writer, code, no_reports=no_reports)


def _refuse_without_search(given: Mapping[str, object]) -> None:
    from tractionpower.errors import UsageError

    options = [option for option, value in given.items() if value is not None]
    if options:
        raise UsageError(f"{' and '.join(options)}: only with --search; the ratings themselves are one run")


def _size(call: StudyCall, *, force: bool, goes_on: bool) -> tuple[Sized, RunWriter]:
    from tractionpower.studies.ratings.study import SizingRun
    from tractionpower.studies.sizing_search.search import varied_items

    with call.preparing(force=force) as writer:
        sizing = SizingRun(call.scenario, writer, study=call.name)
        if goes_on:
            varied_items(call.scenario)  # before the run: a search with nothing to vary is refused
    with keeping(writer, sizing.run, sizing.run.keep_unfinished):
        with steps_bar("running the timetable") as update:
            sized = sizing.execute(update)
        writer.finish(sized.outcome.run, sized.outcome.key_figures, is_continued=goes_on)  # whatever becomes of a search
    return sized, writer


def _searched(
    call: StudyCall, run: dict[str, Any], writer: RunWriter, workers: int | None, scheduler: str | None
) -> tuple[dict[str, Any], bool]:
    """Search for the least equipment; return what ``run.json`` says then, and whether Ctrl-C came.

    Runs of the search are kept beside the results until it comes to its end.
    """
    from tractionpower.studies.ratings.study import with_search
    from tractionpower.studies.runner.store import CaseStore
    from tractionpower.studies.sizing_search.search import search

    tell("the ratings are written; Ctrl-C ends the search, and the same command goes on from its runs")
    with steps_bar("searching", is_even=False) as update:
        found = search(
            call.scenario, call.loaded.library, CaseStore(writer.beside_parts), workers=workers_or_cores(workers),
            scheduler=scheduler,
            progress=lambda what, now: update(now.done, now.all, f"searching, {what}: {now.done} of {now.all} cases"),
        )  # fmt: skip
    said = with_search(run, found)
    writer.amend(said, is_continued=found.interrupted)
    if found.interrupted:
        tell("the search was broken off: the same command goes on from its runs")
    return said, found.interrupted


def _holds(sized: Sized, run: dict[str, Any]) -> bool:
    """Return whether every device and every limit holds, and what a search has found too."""
    found = run["size"].get("search")
    return sized.verdict != "fail" and all(verdict["met"] for verdict in run["verdicts"]) and (not found or found["holds"])
