"""What ``compare`` prints: inputs that differ, the figures of the runs side by side, verdicts that are not the same."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from tractionpower.studies.compare.study import Comparison

FIGURES = (
    "lowest_voltage_v",
    "highest_voltage_v",
    "highest_rail_potential_v",
    "lowest_rail_potential_v",
    "source_energy_kwh",
    "line_loss_kwh",
)
"""Figures of a run that are printed; table ``compare`` has all."""

OF_DEVICES = (
    ("rms_current_a", "substation ", "RMS current of "),
    ("highest_clock_15_min_power_kw", "substation ", "highest quarter of an hour of "),
    ("late_at_end_s", "train ", "late at its last timed call, "),
)
"""Figures of devices of which the greatest rise is printed: name, what its place begins with, words."""

MOST_INPUTS = 8


def show(comparison: Comparison) -> None:
    """Print what a designer asks first."""
    from tractionpower.cli.console import new_console, new_table
    from tractionpower.model.quantity import unit_of

    console = new_console()
    names = [variant.name for variant in comparison.variants]
    _show_inputs(console, comparison)
    found = _by_figure(comparison)
    table = new_table(["figure"], names)
    for (name, place), rows in found.items():
        if (name in FIGURES and not place) or place.startswith("case base"):
            table.add_row(f"{name}, {place}" if place else name, *(_cell(rows.get(one)) for one in names))
    for name, begins, words in OF_DEVICES:
        devices = {place: rows for (figure, place), rows in found.items() if figure == name and place.startswith(begins)}
        most = max(devices, key=lambda one: _greatest(devices[one]), default="")
        if most and _greatest(devices[most]) > 0.0:
            told = f"{words}{most} [{unit_of(name)}], risen most"
            table.add_row(told, *(_cell(devices[most].get(one)) for one in names))
    console.print(table)
    _show_verdicts(console, comparison, names)


def _show_inputs(console: Console, comparison: Comparison) -> None:
    for name, inputs in comparison.inputs.items():
        if inputs:
            console.print(f"{name} differs from {comparison.variants[0].name} in")
            for item in inputs[:MOST_INPUTS]:
                console.print(f"  {item}")
            if len(inputs) > MOST_INPUTS:
                console.print(f"  ... and {len(inputs) - MOST_INPUTS} more inputs")
    console.print()


def _show_verdicts(console: Console, comparison: Comparison, names: list[str]) -> None:
    """Print verdicts that are violated in one of the folders."""
    words = {"yes": "met", "no": "VIOLATED", "": "not judged"}
    judged: dict[str, dict[str, str]] = {}
    for row in comparison.verdicts:
        judged.setdefault(f"{row['figure']} ({row['limit']})", {})[row["folder"]] = row["met"]
    violated = {name: met for name, met in judged.items() if "no" in met.values()}
    if judged:
        console.print()
        console.print(f"{len(judged) - len(violated)} of {len(judged)} limits are met in all folders that judge them")
    for name, met in violated.items():
        console.print(f"{name}: {', '.join(f'{one} {words[met[one]]}' for one in names if one in met)}")


def _by_figure(comparison: Comparison) -> dict[tuple[str, str], dict[str, dict[str, Any]]]:
    found: dict[tuple[str, str], dict[str, dict[str, Any]]] = {}
    for row in comparison.figures:
        found.setdefault((row["figure"], row["place"]), {})[row["folder"]] = row
    return found


def _greatest(rows: dict[str, dict[str, Any]]) -> float:
    """Return by how much a figure is above that of the base, in the folder where it has risen most."""
    return max((row["difference"] for row in rows.values() if not math.isnan(row["difference"])), default=0.0)


def _cell(row: dict[str, Any] | None) -> str:
    """Return a value, with the difference from the base in per cent where there is one."""
    if row is None:
        return "-"
    percent = row["percent"]
    return f"{row['value']:z.1f}" + ("" if math.isnan(percent) else f" ({percent:+.1f} %)")
