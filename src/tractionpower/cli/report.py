"""``tractionpower report DIR``: the reports of an earlier run again, without a simulation."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder that a run has written.")],
    partial: Annotated[
        bool, typer.Option("--partial", help="Read what a run that broke off has left; the reports go into DIR/partial.")
    ] = False,
) -> None:
    """Write the reports of an earlier run again."""
    from tractionpower.cli.messages import tell, tell_reports
    from tractionpower.errors import UsageError
    from tractionpower.reporting.measured import write_measured_reports
    from tractionpower.reporting.reports import write_reports
    from tractionpower.results.results import Results
    from tractionpower.results.store import PARTIAL

    results = Results.open(folder, partial=partial)
    if results.run.get("kind") == "measured":
        tell_reports(write_measured_reports(results, folder))
        return
    if "journeys" in results.run:
        raise UsageError(f"{folder} holds theoretical journeys, not a run; `tractionpower journey` draws them")
    scenario = results.scenario
    if scenario is None:
        raise UsageError(f"{folder}: the inputs are not kept with these results (scenario.json); run the study again")
    if not results.tables:
        raise UsageError(f"{folder}: no table is there to report on; run the study again")
    tell_reports(write_reports(results, scenario, folder / PARTIAL if partial else folder))
    if results.run.get("status") != "complete":
        tell(f"the run is {results.run.get('status')}: the reports hold what is in its tables")
