"""``tractionpower run STUDY``: compute a study and write its results."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tractionpower.cli.look import look_of
from tractionpower.cli.options import Changes, Force, NoReports, ReportLanguage, Study, Template, out_option, strict_option
from tractionpower.cli.progress import steps_bar
from tractionpower.cli.study_call import call_study, exit_code, keeping

if TYPE_CHECKING:
    from tractionpower.cosimulation.run import Run
    from tractionpower.results.outcome import Outcome
    from tractionpower.results.store import RunWriter


def run(
    study: Study,
    *,
    out: Annotated[Path | None, out_option("reports/<study>/")] = None,
    changes: Changes = None,
    no_reports: NoReports = False,
    template: Template = None,
    language: ReportLanguage = None,
    force: Force = False,
    strict: Annotated[bool, strict_option("a limit is violated")] = False,
) -> None:
    """Compute a study and write its results."""
    from tractionpower.cli.console import warn_of_compilation
    from tractionpower.cli.run_summary import show
    from tractionpower.cosimulation.run import Run

    call = call_study(study, changes, out, look=look_of(template, language))
    call.greet()
    warn_of_compilation("advance")
    with call.preparing(force=force) as writer:
        prepared = Run(call.scenario, writer, call.name)
    call.warn(prepared.warnings)
    outcome = _execute(prepared, writer)
    show(outcome, prepared)
    holds = all(verdict["met"] for verdict in outcome.run["verdicts"])
    call.leave(writer, exit_code(flagged=outcome.flagged, holds=holds, strict=strict), no_reports=no_reports)


def _execute(prepared: Run, writer: RunWriter) -> Outcome:
    with keeping(writer, prepared, prepared.keep_unfinished):
        with steps_bar("computing") as update:
            outcome = prepared.execute(update)
        writer.finish(outcome.run, outcome.key_figures)
    return outcome
