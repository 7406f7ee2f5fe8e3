"""``tractionpower dynamics``: the train as many vehicles."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tractionpower.cli import drive, dynamics_check
from tractionpower.cli.case_call import CaseCall, CaseName, ChangesOfCase, call_case
from tractionpower.cli.look import look_of
from tractionpower.cli.messages import tell
from tractionpower.cli.options import Force, NoReports, ReportLanguage, Template, out_option, strict_option
from tractionpower.cli.progress import steps_bar
from tractionpower.cli.study_call import exit_code

if TYPE_CHECKING:
    from tractionpower.results.outcome import Outcome
    from tractionpower.results.store import RunWriter

app = typer.Typer(name="dynamics", help="The train as many vehicles: couplings, air brake, a driver.", no_args_is_help=True)


@app.callback()
def _of_dynamics() -> None:
    pass


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
    if call.kind == "dynamics":
        warn_of_compilation("advance_chain")
    outcome, writer = _compute(call, force=force)
    _show(outcome, call.units)
    if strict and not outcome.run["verdicts"]:
        tell("--strict: no coupling gives an endurable force, so nothing was judged")
    holds = all(verdict["met"] for verdict in outcome.run["verdicts"])
    call.leave(writer, exit_code(flagged=outcome.flagged, holds=holds, strict=strict), no_reports=no_reports)


def _compute(call: CaseCall, *, force: bool) -> tuple[Outcome, RunWriter]:
    """Compute the case and complete its results; when Ctrl-C comes what was computed is kept."""
    from tractionpower.dynamics.simulate import new_run

    with call.preparing(force=force) as writer:
        prepared = new_run(call.scenario, writer, call.name, call.loaded.problems)
    call.warn(prepared.warnings)
    try:
        with steps_bar("computing") as update:
            outcome = prepared.execute(update)
        writer.finish(outcome.run, outcome.key_figures)
    except KeyboardInterrupt:
        tell(f"interrupted; what was computed is kept in {prepared.keep_unfinished(writer)}")
        tell(f"`tractionpower report {writer.folder} --partial` makes reports of it")
        raise
    return outcome, writer


def _show(outcome: Outcome, units: str) -> None:
    from tractionpower.cli import dynamics_summary, stations_summary

    if outcome.run["kind"] == "stations":
        stations_summary.show(outcome.run, outcome.key_figures)
    else:
        dynamics_summary.show(outcome.run, outcome.key_figures, units)


app.command("drive")(drive.drive)
app.command("check")(dynamics_check.check)
