"""``tractionpower journey STUDY``: theoretical journeys at a given voltage, without the network."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import math
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tractionpower.cli.messages import DONE, NOT_COMPLETED, tell, tell_results
from tractionpower.cli.options import Force, Study, out_option, set_option
from tractionpower.cli.study_call import StudyCall, call_study

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from tractionpower.errors import OutputError
    from tractionpower.model.line import Line
    from tractionpower.model.scenario import Scenario
    from tractionpower.results.store import RunWriter
    from tractionpower.studies.journeys import JourneyOutcome

MOST = 12
"""Trains that get a figure and a list of calls when none are named."""

FIGURES = {
    "length_km": ("length\n[km]", ".1f"),
    "running_time_s": ("running\ntime", ""),
    "journey_time_s": ("with\nstops", ""),
    "mean_speed_kmh": ("mean\nspeed\n[km/h]", ".1f"),
    "highest_speed_kmh": ("top\nspeed\n[km/h]", ".1f"),
    "energy_taken_kwh": ("from the\nline\n[kWh]", ".1f"),
    "energy_returned_kwh": ("returned\n[kWh]", ".1f"),
    "highest_current_a": ("greatest\ncurrent\n[A]", ".0f"),
}
"""Key figures that are printed: heading, and form of the number; times where that is empty."""


class Form(StrEnum):
    """Over what the motion is integrated."""

    TIME = "time"
    SPEED = "speed"


def journey(  # noqa: PLR0917 - typer makes options of them
    study: Study,
    train: Annotated[
        list[str] | None, typer.Option("--train", metavar="ID", help="A train of the timetable; left out: all.")
    ] = None,
    voltage: Annotated[
        float | None, typer.Option("--voltage", metavar="V", help="Voltage at the pantograph; default nominal voltage.")
    ] = None,
    form: Annotated[Form, typer.Option("--form", help="Integrate in steps of time or of speed.")] = Form.TIME,
    step: Annotated[float | None, typer.Option("--step", metavar="S", help="Step; default that of the study's clock.")] = None,
    changes: Annotated[list[str] | None, set_option(", e.g. trains[en57].max_speed_kmh=100")] = None,
    out: Annotated[Path | None, out_option("reports/<study>/journey/")] = None,
    no_reports: Annotated[bool, typer.Option("--no-reports", help="Write the tables only, no figures.")] = False,
    force: Force = False,
) -> None:
    """Run trains at a given voltage, without the network."""
    from tractionpower.cli.console import new_console, warn_of_compilation
    from tractionpower.studies.journeys import choose_runs, why_not_complete

    _check_number("--voltage", voltage, "V", 1.0, 100_000.0)
    _check_number("--step", step, "s", 0.02, 5.0)
    call = call_study(study, changes, out)
    if out is None:
        call = replace(call, folder=call.folder / "journey")
    scenario, folder = call.scenario, call.folder
    runs = choose_runs(scenario, train)
    call.greet()
    warn_of_compilation("run_journey" if form is Form.TIME else "run_over_speed")
    outcome, writer = _compute(call, force, voltage_v=voltage, step_s=step, form=form.value, runs=runs)
    shown = runs if train else runs[:MOST]
    unwritten = None if no_reports else _write_figures(outcome, scenario, folder, shown)
    _show(new_console(), outcome, scenario.line, shown)
    if len(shown) < len(runs):
        tell(f"calls and figures of the first {MOST} of {len(runs)} trains; --train ID shows others, the tables hold all")
    for name, ledger in outcome.run["ledgers"].items():
        closes = "closes" if ledger["closes"] else "DOES NOT CLOSE"
        tell(f"ledger {name.replace('_', ' ')} {closes}: gap at most {ledger['worst_gap_share']:.1g} (train {ledger['train']})")
    for each in outcome.journeys:
        if each.status != "complete":
            tell(why_not_complete(each))
    if unwritten is not None:
        raise unwritten
    tell_results(folder, [], writer.beside)
    raise typer.Exit(DONE if outcome.complete else NOT_COMPLETED)


def _check_number(option: str, value: float | None, unit: str, least: float, most: float) -> None:
    from tractionpower.errors import UsageError

    if value is not None and not (math.isfinite(value) and least <= value <= most):
        raise UsageError(f"{option} {value:g}: allowed are {least:g} to {most:g} {unit}")


def _compute(call: StudyCall, force: bool, **options: Any) -> tuple[JourneyOutcome, RunWriter]:
    from tractionpower.studies.journeys import compute_journeys

    study = f"{call.name}, journey"  # so that it never mixes with a run of the same study
    with call.preparing(force=force, study=study) as writer:
        outcome = compute_journeys(call.scenario, writer, study, **options)
        call.warn(outcome.warnings)
        writer.finish(outcome.run, outcome.key_figures)
    return outcome, writer


def _write_figures(outcome: JourneyOutcome, scenario: Scenario, folder: Path, shown: Sequence[str]) -> OutputError | None:
    """Write the figures; return what hinders that, so that the tables are printed first."""
    from tractionpower.errors import OutputError
    from tractionpower.reporting.figures.trains.journeys import write_journey_figures

    try:
        write_journey_figures(outcome, scenario, folder / "figures", shown)
    except OSError as error:
        return OutputError(f"the tables are complete, but figures cannot be written into {folder / 'figures'}: {error}")
    return None


def _show(console: Console, outcome: JourneyOutcome, line: Line, shown: Sequence[str]) -> None:
    """Print what each journey takes, and its calls beside the timetable."""
    from tractionpower.cli.console import new_table
    from tractionpower.studies.journeys import route_in_words

    figures = {(figure["name"], figure["place"]): figure["value"] for figure in outcome.key_figures}
    table = new_table(["train", "route"], [heading for heading, _ in FIGURES.values()])
    for each in outcome.journeys:
        name = each.run.id
        values = {key: _shown(figures[key, f"train {name}"], form) for key, (_, form) in FIGURES.items()}
        if each.status != "complete":
            values |= {"running_time_s": each.status, "journey_time_s": ""}
        table.add_row(name, route_in_words(each, line), *values.values())
    console.print(f"theoretical journeys at {outcome.voltage_v:g} V")
    console.print(table)
    if any(outcome.calls[name] for name in shown):
        console.print()
        _show_calls(console, outcome, line, shown)


def _show_calls(console: Console, outcome: JourneyOutcome, line: Line, shown: Sequence[str]) -> None:
    from tractionpower.cli.console import new_table

    names = {station.id: station.name or station.id for station in line.stations}
    table = new_table(["train", "station", ""], ["planned", "computed", "late [s]"])
    for train in shown:
        last = ("", "")
        for row in outcome.calls[train]:
            station = names.get(row.station, row.station)
            late = f"{row.late_s:+.0f}" if math.isfinite(row.late_s) else ""
            head = (train if train != last[0] else "", station if (train, station) != last else "")
            table.add_row(*head, row.kind, _time(row.planned_s), _time(row.actual_s), late)
            last = (train, station)
    console.print(table)


def _shown(value: float, form: str) -> str:
    return f"{value:{form}}" if form else _time(value)


def _time(seconds: float) -> str:
    from tractionpower.model.base import format_time

    return format_time(float(round(seconds))) if math.isfinite(seconds) else ""
