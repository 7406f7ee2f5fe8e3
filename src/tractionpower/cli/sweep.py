"""``tractionpower sweep STUDY``: variants of a study, compared with the study as it is."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.look import look_of
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
    from tractionpower.model.scenario import Scenario
    from tractionpower.studies.sweep.study import Plan


def sweep(
    study: Study,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option("--vary", metavar="KEY=V1,V2,...", help="Values of an input; with several, all combinations are cases."),
    ] = None,
    cases: Annotated[
        Path | None, typer.Option("--cases", metavar="FILE.csv", help="Cases: a column for each path, a row for each case.")
    ] = None,
    sample: Annotated[int | None, typer.Option("--sample", metavar="N", min=1, help="Cases drawn at random.")] = None,
    ranges: Annotated[
        list[str] | None,
        typer.Option("--range", metavar="KEY=LOW..HIGH", help="Range of what is drawn; log:LOW..HIGH: even logarithms."),
    ] = None,
    seed: Annotated[int | None, typer.Option("--seed", min=0, help="Seed of what is drawn; default that of the study.")] = None,
    out: Annotated[Path | None, out_option("reports/<study>-sweep/")] = None,
    changes: ChangesOfCases = None,
    workers: WorkersOfCases = None,
    scheduler: SchedulerOfCases = None,
    full_tables: FullTables = False,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[bool, strict_option("a case violates a limit")] = False,
) -> None:
    """Compare variants of a study with the study as it is."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.sweep_summary import show
    from tractionpower.studies.runner.into_folder import run_into
    from tractionpower.studies.sweep.study import SweepStudy

    call = call_study(study, changes, out, "sweep", look=look_of(template, language))
    plan = _plan(call.scenario, (vary or [], cases, ranges or []), sample, seed)
    call.greet(f"; {len(plan.cases) - 1} variants and the base")
    with call.placed():
        prepared = SweepStudy(call.scenario, plan, library=call.loaded.library, study=call.name)
    call.warn(prepared.warnings)
    writer = call.new_writer(force=force)
    warn_of_compilation("advance")
    running = partial(run_into, prepared, writer, full_tables=call.cases_folder if full_tables else None)
    outcome = execute_cases(running, len(plan.cases), workers, scheduler=scheduler)
    show(outcome)
    code = exit_code(flagged=outcome.flagged, holds=outcome.holds, strict=strict)
    call.leave(writer, code, no_reports=no_reports)


def _plan(scenario: Scenario, told: tuple[list[str], Path | None, list[str]], sample: int | None, seed: int | None) -> Plan:
    """Return the cases; all that cannot be read of the options is told at once."""
    from tractionpower.errors import InputError, Problem
    from tractionpower.studies.sweep.cases_file import read_cases
    from tractionpower.studies.sweep.keys import parse_ranges, parse_varied
    from tractionpower.studies.sweep.study import plan_sweep

    vary, file, ranges = told
    problems: list[Problem] = []

    def read(how: Callable[[], Any]) -> Any:
        try:
            return how()
        except InputError as error:
            problems.extend(error.problems)

    varied, drawn_from = read(lambda: parse_varied(vary)), read(lambda: parse_ranges(ranges))
    given = read(lambda: ([], []) if file is None else read_cases(file))
    if problems:
        raise InputError(problems)
    return plan_sweep(scenario, varied, given, drawn_from, sample=sample, seed=seed)
