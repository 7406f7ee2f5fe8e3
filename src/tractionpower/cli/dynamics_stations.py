"""``tractionpower dynamics run`` of a case of kind stations: trains as point masses on a line with stations."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from tractionpower.cli.case_call import CaseCall
from tractionpower.cli.messages import DONE, tell
from tractionpower.cli.progress import steps_bar

if TYPE_CHECKING:
    from tractionpower.results.store import RunWriter


def run_stations_case(call: CaseCall, *, force: bool, no_reports: bool) -> NoReturn:
    """Compute a case of stations, write its results, and end the command."""
    from tractionpower.dynamics.traindyn.station_checks import check_stations
    from tractionpower.dynamics.traindyn.stations import import_simpy
    from tractionpower.errors import raise_errors

    with call.preparing(force=force) as writer:
        import_simpy()
        problems = check_stations(call.scenario)
        raise_errors(problems)
    call.warn(problems)
    _show(_compute(call, writer))
    call.leave(writer, DONE, no_reports=no_reports)


def _compute(call: CaseCall, writer: RunWriter) -> Sequence[Mapping[str, Any]]:
    """Run the trains, complete the results, and return the key figures."""
    from tractionpower.dynamics.traindyn.stations import run_stations

    told, started = _about(call), time.perf_counter()
    try:
        with steps_bar("running the trains") as update:
            outcome = run_stations(call.scenario, writer, update)
        told |= {"wall_seconds": time.perf_counter() - started, **outcome.run}
        writer.finish(told, outcome.key_figures)
    except KeyboardInterrupt:
        tell(f"interrupted; what was computed is kept in {writer.keep_unfinished(told | {'status': 'interrupted'})}")
        raise
    return outcome.key_figures


def _about(call: CaseCall) -> dict[str, Any]:
    """Return what ``run.json`` says of any run."""
    from tractionpower.results.kept import input_hash_of
    from tractionpower.results.versions import versions

    return {
        "format": 1,
        "kind": call.kind,
        "study": call.name,
        "name": call.scenario.name,
        "input_hash": input_hash_of(call.scenario),
        "versions": versions(),
        "verdicts": [],
        "ledgers": {},
    }


def _show(figures: Sequence[Mapping[str, Any]]) -> None:
    from tractionpower.cli.console import new_console, new_table
    from tractionpower.model.quantity import Quantity

    table = new_table([""], ["", ""])
    table.show_header = False
    for figure in figures:
        table.add_row(Quantity(figure["name"], "").words, f"{figure['value']:z.1f}", figure["unit"])
    new_console().print(table)
