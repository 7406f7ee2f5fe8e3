"""``tractionpower contingency STUDY``: every outage, compared with the base case."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import look_of
from tractionpower.cli.messages import tell
from tractionpower.cli.options import (
    ChangesOfCases,
    Force,
    FullTables,
    NoReports,
    ReportLanguage,
    SchedulerOfCases,
    Study,
    Template,
    WorkersOfCases,
    out_option,
    strict_option,
)
from tractionpower.cli.study_call import call_study, execute_cases, exit_code

if TYPE_CHECKING:
    from tractionpower.errors import Problem
    from tractionpower.model.scenario import Scenario

Chosen = tuple[list[str], list[str], list[str]]
"""Kinds of outages, devices, grid voltages; what is empty is chosen by the study."""


def contingency(
    study: Study,
    *,
    out: Annotated[Path | None, out_option("reports/<study>-contingency/")] = None,
    changes: ChangesOfCases = None,
    pairs: Annotated[bool, typer.Option("--pairs", help="Also all pairs of the chosen outages, at normal grid voltage.")] = False,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", metavar="KIND", help="unit, substation, feeder, section_cabin or contact_line; default: all."),
    ] = None,
    device: Annotated[
        list[str] | None,
        typer.Option("--device", metavar="ID", help="Only outages of this device: A, 'A 1 low_km', 'track 1 km 0-10.8'."),
    ] = None,
    grid: Annotated[
        str | None, typer.Option("--grid", metavar="normal,low,high", help="Grid voltages of all cases; default of the study.")
    ] = None,
    workers: WorkersOfCases = None,
    scheduler: SchedulerOfCases = None,
    full_tables: FullTables = False,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[bool, strict_option("a limit is violated in a case")] = False,
) -> None:
    """Compute every outage and compare it with the base case."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.contingency_summary import show
    from tractionpower.io.wording import counted
    from tractionpower.studies.contingency.study import OutageStudy
    from tractionpower.studies.runner.into_folder import run_into

    call = call_study(study, changes, out, "contingency", look=look_of(template, language))
    grids = [word.strip() for word in grid.split(",")] if grid is not None else []
    call = replace(call, scenario=_choose(call.scenario, (only or [], device or [], grids)))
    with call.placed(), _as_options({"devices": "--device" if device else "", "kinds": "--only" if only else ""}):
        outages = OutageStudy(call.scenario, library=call.loaded.library, study=call.name, pairs=pairs, grids=grids or None)
    call.warn(outages.warnings)
    base = sum(case.base for case in outages.cases)
    out_of = {(case.kind, case.subject, case.mode) for case in outages.cases if not case.base}
    of_cases = counted(len(outages.cases) - base, "case")
    call.greet(f"; {counted(len(out_of), 'outage')} in {of_cases}, {counted(base, 'base case')}")
    warn_of_compilation("advance")
    writer = call.new_writer(force=force)
    running = partial(run_into, outages, writer, full_tables=call.cases_folder if full_tables else None)
    outcome = execute_cases(running, len(outages.cases), workers, scheduler=scheduler)
    if outcome.cases.reused:
        tell(f"{outcome.cases.reused} cases of an earlier call were not run again")
    show(outcome.run)
    code = exit_code(flagged=outcome.flagged, holds=outcome.holds, strict=strict)
    call.leave(writer, code, no_reports=no_reports)


@contextmanager
def _as_options(given: Mapping[str, str]) -> Iterator[None]:
    """Place what is wrong with a field of the study's `contingency` at the option that sets it, if one does."""
    from tractionpower.errors import InputError

    def placed(problem: Problem) -> Problem:
        field = problem.path.removeprefix("contingency.").partition("[")[0]
        option = given.get(field, "") if problem.path.startswith("contingency.") else ""
        return replace(problem, path="", place=option) if option else problem

    try:
        yield
    except InputError as error:
        raise InputError([placed(problem) for problem in error.problems]) from None


def _choose(scenario: Scenario, chosen: Chosen) -> Scenario:
    """Return the scenario with the outages that options choose."""
    from tractionpower.errors import UsageError
    from tractionpower.io.wording import did_you_mean
    from tractionpower.model.contingency import OUTAGE_KINDS
    from tractionpower.studies.contingency.outages import GRIDS

    kinds, devices, grids = chosen
    for option, given, allowed in (("--only", kinds, OUTAGE_KINDS), ("--grid", grids, GRIDS)):
        for word in given:
            if word not in allowed:
                remedy = did_you_mean(word, allowed)
                raise UsageError(f"{option} {word}: allowed are {', '.join(allowed)}{f'; {remedy}' if remedy else ''}")
    wish: dict[str, Any] = {}
    if kinds:
        wish["kinds"] = tuple(dict.fromkeys(kinds))
    if devices:
        wish["devices"] = tuple(dict.fromkeys(devices))
    if grids:
        wish["grid_voltages"] = tuple(dict.fromkeys(grids))
    return scenario.model_copy(update={"contingency": scenario.contingency.model_copy(update=wish)})
