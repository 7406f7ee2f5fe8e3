"""``tractionpower sweep STUDY``: variants of a study, compared with the study as it is."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.sweep.study import Plan, SweepOutcome, SweepStudy


def sweep(
    study: Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")],
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
    out: Annotated[Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>-sweep/ here.")] = None,
    changes: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change an input in all cases, the base included.")
    ] = None,
    workers: Annotated[int | None, typer.Option("--workers", min=1, help="Cases at a time; default: the cores.")] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Dask scheduler whose workers run the cases.")
    ] = None,
    full_tables: Annotated[
        bool, typer.Option("--full-tables", help="Also write the whole results of each case, into DIR-cases/<case>/.")
    ] = False,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when a case violates a limit.")] = False,
) -> None:
    """Compare variants of a study with the study as it is."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.feasibility import study_name
    from tractionpower.cli.messages import tell, tell_beside
    from tractionpower.cli.report import tell_reports
    from tractionpower.cli.run import write_run_reports
    from tractionpower.cli.sweep_summary import show
    from tractionpower.io.scenario_files import load_scenario

    loaded = load_scenario(study)
    scenario = loaded.changed(changes or [])
    name = study_name(loaded)
    folder = out if out is not None else Path("reports") / f"{name}-sweep"
    plan = _plan(scenario, (vary or [], cases, ranges or []), sample, seed)
    tell(f"{scenario.name or name}: {loaded.origin}; {len(plan.cases) - 1} variants and the base")
    prepared, writer = _prepare(loaded, scenario, plan, (name, folder), force=force)
    warn_of_compilation("advance")
    whole = Path(f"{folder}-cases") if full_tables else None
    outcome = _execute(prepared, writer, workers=workers, scheduler=scheduler, full_tables=whole)
    show(outcome)
    if not no_reports:
        tell("writing figures and workbook")
    reports, unwritten = ([], None) if no_reports else write_run_reports(folder, scenario)
    if unwritten is not None:
        raise unwritten
    tell(f"results: {folder}")
    tell_reports(reports)
    tell_beside(writer.beside)
    raise typer.Exit(_exit_code(outcome, strict))


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


def _prepare(
    loaded: LoadedScenario, scenario: Scenario, plan: Plan, place: tuple[str, Path], *, force: bool
) -> tuple[SweepStudy, RunWriter]:
    """Try the cases and open the folder; `place` is the name of the study and the folder of the results."""
    from tractionpower.cli.messages import tell_problems
    from tractionpower.errors import InputError
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.sweep.study import SweepStudy

    name, folder = place
    try:
        study = SweepStudy(scenario, plan, library=loaded.library, study=name)
    except InputError as error:
        raise InputError(loaded.provenance.place(error.problems)) from None
    tell_problems(loaded.provenance.place([*loaded.problems, *study.warnings]))
    return study, RunWriter(folder, name, scenario.input_hash, force=force, scenario=scenario)


def _execute(study: SweepStudy, writer: RunWriter, *, workers: int | None, **how: Any) -> SweepOutcome:
    import os

    from tractionpower.cli.cases_bar import cases_bar
    from tractionpower.cli.messages import tell
    from tractionpower.studies.sweep.study import run_into

    with cases_bar(len(study.plan.cases)) as progress:
        outcome = run_into(study, writer, workers=workers or os.cpu_count() or 1, progress=progress, **how)
    if outcome.interrupted:
        tell(f"interrupted after {len(outcome.cases.rows)} of {len(study.plan.cases)} cases; the same command goes on from there")
        raise KeyboardInterrupt
    return outcome


def _exit_code(outcome: SweepOutcome, strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if outcome.flagged:
        return NOT_COMPLETED
    return LIMIT_VIOLATED if strict and not outcome.holds else DONE
