"""``tractionpower dynamics``: the train as many vehicles."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tractionpower.cli import drive
from tractionpower.cli.case_call import CaseCall, CaseName, ChangesOfCase, call_case
from tractionpower.cli.dynamics_stations import run_stations_case
from tractionpower.cli.look import look_of
from tractionpower.cli.options import Force, NoReports, ReportLanguage, Template, out_option, strict_option
from tractionpower.cli.progress import steps_bar
from tractionpower.cli.study_call import exit_code, keeping

if TYPE_CHECKING:
    from tractionpower.dynamics.run import CaseRun, Outcome
    from tractionpower.results.store import RunWriter

app = typer.Typer(name="dynamics", help="The train as many vehicles: couplings, air brake, a driver.", no_args_is_help=True)


@app.callback()
def _of_dynamics() -> None:
    pass


app.command("drive")(drive.drive)


@app.command("run")
def run(
    case: CaseName,
    *,
    out: Annotated[Path | None, out_option("reports/dynamics-<case>/")] = None,
    changes: ChangesOfCase = None,
    method: Annotated[
        str | None,
        typer.Option(
            "--method", metavar="symplectic|rk4|euler|variable", help="Method of integration instead of that of the case."
        ),
    ] = None,
    step_s: Annotated[float | None, typer.Option("--step-s", metavar="S", help="Step instead of that of the case [s].")] = None,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[bool, strict_option("a force that a coupling endures is exceeded")] = False,
) -> None:
    """Compute a case of train dynamics and write its results."""
    from tractionpower.cli.console import warn_of_compilation

    call = call_case(case, changes or (), out, look_of(template, language), {"method": method, "step_s": step_s})
    call.greet()
    if call.kind == "stations":
        run_stations_case(call, force=force, no_reports=no_reports)
    warn_of_compilation("advance_chain")
    outcome, writer = _compute(call, force=force)
    _show(outcome)
    holds = all(verdict["met"] for verdict in outcome.run["verdicts"])
    call.leave(writer, exit_code(flagged=outcome.flagged, holds=holds, strict=strict), no_reports=no_reports)


def _compute(call: CaseCall, *, force: bool) -> tuple[Outcome, RunWriter]:
    from tractionpower.dynamics.run import CaseRun

    with call.preparing(force=force) as writer:
        prepared = CaseRun(call.scenario, writer, call.name)
    call.warn(prepared.warnings)
    with keeping(writer, prepared, prepared.keep_unfinished):
        outcome = _execute(prepared)
        writer.finish(outcome.run, outcome.key_figures)
    return outcome, writer


def _execute(prepared: CaseRun) -> Outcome:
    with steps_bar("computing") as update:
        return prepared.execute(update)


def _show(outcome: Outcome) -> None:
    from tractionpower.cli.dynamics_summary import show

    show(outcome.run, outcome.key_figures)
