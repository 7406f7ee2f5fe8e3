"""``tractionpower contingency STUDY``: every outage, compared with the base case."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from tractionpower.io.scenario_files import LoadedScenario
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.contingency.study import OutageOutcome, OutageStudy

Chosen = tuple[list[str], list[str], list[str]]
"""Kinds of outages, devices, grid voltages; what is empty is chosen by the study."""


def contingency(
    study: Annotated[str, typer.Argument(help="Folder with a study.yaml, such a file, or the name of a shipped line.")],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder of the results; default reports/<study>-contingency/ here.")
    ] = None,
    changes: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change an input in all cases, the base included.")
    ] = None,
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
    workers: Annotated[int | None, typer.Option("--workers", min=1, help="Cases at a time; default: the cores.")] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="Dask scheduler whose workers run the cases.")
    ] = None,
    full_tables: Annotated[
        bool, typer.Option("--full-tables", help="Also write the whole results of each case, into DIR-cases/<case>/.")
    ] = False,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures and no workbook.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace what is there, even results of another study.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 4 when a limit is violated in a case.")] = False,
) -> None:
    """Compute every outage and compare it with the base case."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.contingency_summary import show
    from tractionpower.cli.feasibility import study_name
    from tractionpower.cli.messages import tell, tell_beside
    from tractionpower.cli.report import tell_reports
    from tractionpower.cli.run import write_run_reports
    from tractionpower.io.scenario_files import load_scenario
    from tractionpower.results.store import RunWriter

    loaded = load_scenario(study)
    grids = [word.strip() for word in grid.split(",")] if grid is not None else []
    scenario = _choose(loaded.changed(changes or []), (only or [], device or [], grids))
    name = study_name(loaded)
    folder = out if out is not None else Path("reports") / f"{name}-contingency"
    outages = _prepare(loaded, scenario, name, pairs=pairs, grids=grids or None)
    base = sum(case.base for case in outages.cases)
    counts = f"{len(outages.cases) - base} outages, {base} base case{'s' if base > 1 else ''}"
    tell(f"{scenario.name or name}: {loaded.origin}; {counts}")
    warn_of_compilation("advance")
    writer = RunWriter(folder, name, scenario.input_hash, force=force, scenario=scenario)
    how = {"scheduler": scheduler, "full_tables": Path(f"{folder}-cases") if full_tables else None}
    outcome = _execute(outages, writer, workers=workers, **how)
    show(outcome.run)
    if not no_reports:
        tell("writing figures and workbook")
    reports, unwritten = ([], None) if no_reports else write_run_reports(folder, scenario)
    if unwritten is not None:
        raise unwritten
    tell(f"results: {folder}")
    tell_reports(reports)
    tell_beside(writer.beside)
    raise typer.Exit(_exit_code(outcome, strict))


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


def _prepare(loaded: LoadedScenario, scenario: Scenario, name: str, *, pairs: bool, grids: list[str] | None) -> OutageStudy:
    """Find the outages, and tell problems by file and line."""
    from tractionpower.cli.messages import tell_problems
    from tractionpower.errors import InputError
    from tractionpower.studies.contingency.study import OutageStudy

    try:
        outages = OutageStudy(scenario, library=loaded.library, study=name, pairs=pairs, grids=grids)
    except InputError as error:
        raise InputError(loaded.provenance.place(error.problems)) from None
    tell_problems(loaded.provenance.place([*loaded.problems, *outages.warnings]))
    return outages


def _execute(outages: OutageStudy, writer: RunWriter, *, workers: int | None, **how: Any) -> OutageOutcome:
    import os

    from tractionpower.cli.cases_bar import cases_bar
    from tractionpower.cli.messages import tell
    from tractionpower.studies.contingency.study import run_into

    with cases_bar(len(outages.cases)) as progress:
        outcome = run_into(outages, writer, workers=workers or os.cpu_count() or 1, progress=progress, **how)
    if outcome.interrupted:
        tell(f"interrupted after {len(outcome.cases.rows)} of {len(outages.cases)} cases; the same command goes on from there")
        raise KeyboardInterrupt
    if outcome.cases.reused:
        tell(f"{outcome.cases.reused} cases of an earlier call were not run again")
    return outcome


def _exit_code(outcome: OutageOutcome, strict: bool) -> int:
    from tractionpower.cli.messages import DONE, LIMIT_VIOLATED, NOT_COMPLETED

    if outcome.flagged:
        return NOT_COMPLETED
    return LIMIT_VIOLATED if strict and not outcome.holds else DONE
