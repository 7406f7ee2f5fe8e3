"""What ``dynamics run`` prints at the end of a case of stations: how many trains have run, how long they took and waited."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

SHOWN = {
    "trains_that_left": "trains that have left",
    "trains_still_there": "trains still on the line",
    "highest_speed_kmh": "highest speed",
    "mean_running_time_s": "mean running time",
    "waiting_time_s": "waiting for a track or the line",
}
"""Key figures that are printed, and how they are called."""


def show(run: Mapping[str, Any], figures: Sequence[Mapping[str, Any]]) -> None:
    """Print what has come out of a case of stations."""
    from tractionpower.cli.console import new_console, new_table

    console = new_console()
    table = new_table([""], ["", ""])
    table.show_header = False
    for figure in figures:
        if figure["name"] in SHOWN:
            table.add_row(SHOWN[figure["name"]], f"{figure['value']:.{1 if figure['unit'] else 0}f}", figure["unit"])
    console.print(table)
    console.print()
    for line in run["notes"]:
        console.print(line)
    console.print(f"{run['end_s']:g} s in {run['wall_seconds']:.1f} s, period {run['period_s']:g} s, method {run['method']}")
