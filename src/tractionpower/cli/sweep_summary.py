"""What ``sweep`` prints at its end: figures of the cases and the base, the best and the worst, what did not run."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tractionpower.studies.sweep.study import SweepOutcome

COLUMNS = {
    "lowest_voltage_v": "lowest\nvoltage [V]",
    "useful_zone_v": "mean useful voltage\nof a zone [V]",
    "utilisation_percent": "highest\nutilisation [%]",
    "worst_late_s": "greatest\nlateness [s]",
    "energy_kwh": "energy\n[kWh]",
    "line_loss_kwh": "loss in the\nline [kWh]",
    "highest_demand_kw": "highest\ndemand [kW]",
}
"""Figures that are printed, and their headings; those that no case has are left out."""

MOST = 30
"""Cases that are printed; table ``cases`` and the workbook have all."""

MOST_REASONS = 5


def show(outcome: SweepOutcome) -> None:
    """Print what came of the cases."""
    from tractionpower.cli.console import new_console, new_table

    rows = outcome.cases.rows
    shown = [name for name in COLUMNS if any(_is_number(row.get(name)) for row in rows)]
    console = new_console()
    table = new_table(["case", "changes"], [COLUMNS[name] for name in shown])
    for row in rows[:MOST]:
        is_told = row["status"] in ("complete", "flagged")
        changed = row["subject"] if is_told else f"{row['subject']}: {row['status'].upper()}"
        table.add_row(row["case"], changed, *(_number(row.get(name)) for name in shown))
    console.print(table)
    if len(rows) > MOST:
        console.print(f"... and {len(rows) - MOST} more cases, see table cases")
    console.print()
    subjects = {row["case"]: row["subject"] for row in rows}
    for name, found in outcome.run["sweep"]["extremes"].items():
        if name in shown:
            told = (f"{word} {_number(one['value'])} ({one['case']}: {subjects[one['case']]})" for word, one in found.items())
            console.print(f"{COLUMNS[name].replace(chr(10), ' ')}: {', '.join(told)}")
    for status, words in (("refused", "the inputs have errors"), ("failed", "not completed"), ("flagged", "flagged")):
        found = [row for row in rows if row["status"] == status]
        for row in found[:MOST_REASONS]:
            console.print(f"case {row['case']}, {words}: {row['reason']}")
        if len(found) > MOST_REASONS:
            console.print(f"... and {len(found) - MOST_REASONS} more cases of this kind")
    if outcome.cases.reused:
        console.print(f"{outcome.cases.reused} cases of an earlier call were not run again")


def _is_number(value: Any) -> bool:
    return value is not None and not math.isnan(value)


def _number(value: Any) -> str:
    return f"{value:z.1f}" if _is_number(value) else ""
