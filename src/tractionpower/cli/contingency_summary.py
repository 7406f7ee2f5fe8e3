"""What ``contingency`` prints: whether all holds, the worst outages, the devices that do not hold, what was not computed."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

Row = Mapping[str, Any]

MOST_OUTAGES, MOST_DEVICES, MOST_REASONS = 15, 10, 5
"""Rows of the tables."""

COLOURS = {"holds": "bold green", "fails": "bold red", "not judged": "bold yellow"}
"""Styles of verdicts."""

COLUMNS = {
    "lowest_voltage_v": "lowest\nvoltage [V]",
    "useful_zone_v": "useful voltage\nof a zone [V]",
    "rail_potential_v": "rail potential\n[V]",
    "utilisation_percent": "utilisation\n[%]",
    "late_trains": "late\ntrains",
    "worst_late_s": "latest\n[s]",
    "stuck_trains": "stuck\ntrains",
    "trips": "trips",
}
"""Figures that are printed, and their headings; those that no case has are left out."""


def show(run: Mapping[str, Any]) -> None:
    """Print what came of the outages from what ``run.json`` says."""
    from tractionpower.cli.console import new_console

    console, told = new_console(), run["contingency"]
    console.print()
    console.print(headline(told), style=COLOURS[told["verdict"]])
    for verdict in run["verdicts"]:
        if not verdict["met"]:
            limit = f"{verdict['limit']} = {verdict['limit_value']:g} {verdict['unit']}".rstrip()
            value = f"{verdict['value']:.1f} {verdict['unit']}".rstrip()
            console.print(f"  {verdict['name']}: {value} against {limit} ({verdict['status']}), {verdict['place']}")
    _outages(console, told)
    _devices(console, told["devices"])
    _left_out(console, told)


def headline(told: Mapping[str, Any]) -> str:
    """Return in one line whether all holds."""
    from tractionpower.io.wording import counted
    from tractionpower.reporting.facts.outages import outcome_words

    missing, outages = len(told["not_computed"]), told["outages"]
    left = f"; {counted(missing, 'case')} could not be computed" if missing else ""
    words = outcome_words(outages["all"], outages["failing"], outages["beyond_base"])
    if told["verdict"] == "holds":
        return f"HOLDS: {words}"
    if told["verdict"] == "not judged":
        return f"NOT JUDGED: of those that were computed, {words}{left}"
    base = ", ".join(dict.fromkeys(word for row in told["base"] for word in row["fails"]))
    return f"FAILS: {words}{f'; with nothing out: {base}' if base else ''}{left}"


def _outages(console: Console, told: Mapping[str, Any]) -> None:
    """Print the base cases, and below them the worst outages."""
    from tractionpower.cli.console import new_table

    rows = [*told["base"], *told["worst"][:MOST_OUTAGES]]
    shown = [name for name in COLUMNS if any(row[name] for row in rows)]
    table = new_table(["the worst outages", "violates"], [COLUMNS[name] for name in shown])
    for row in rows:
        flagged = " (flagged)" if row["status"] == "flagged" else ""
        table.add_row(row["case"] + flagged, ", ".join(row["fails"]), *(_number(name, row) for name in shown))
    console.print()
    console.print(table)
    lasting = sum(kind["cases"] for kind in told["kinds"]) - MOST_OUTAGES
    if lasting > 0:
        console.print(f"... and {lasting} more, see table cases")


def _devices(console: Console, devices: Sequence[Row]) -> None:
    from tractionpower.cli.console import new_table

    if not devices:
        return
    numbers = ["utilisation [%]", "load [A]", "permitted [A]", "over", "cases"]
    table = new_table(["overloaded device", "by outage"], numbers)
    for row in devices[:MOST_DEVICES]:
        window = "run" if not row["window_s"] else f"{row['window_s'] / 60.0:g} min"
        load, permitted = f"{row['load_a']:.0f}", f"{row['permitted_a']:.0f}"
        table.add_row(row["device"], row["case"], f"{row['utilisation_percent']:.0f}", load, permitted, window, str(row["cases"]))
    console.print()
    console.print(table)
    if len(devices) > MOST_DEVICES:
        console.print(f"... and {len(devices) - MOST_DEVICES} more, see table device_envelope")


def _left_out(console: Console, told: Mapping[str, Any]) -> None:
    console.print()
    for row in told["not_computed"][:MOST_REASONS]:
        console.print(f"{row['case']}: {row['status']}: {row['reason']}", style="bold red")
    if len(told["not_computed"]) > MOST_REASONS:
        console.print(f"... and {len(told['not_computed']) - MOST_REASONS} more that could not be computed, see table cases")
    if told["unrated"]:
        from tractionpower.reporting.facts.device_words import counted_devices

        kinds = ", ".join(counted_devices(count, kind) for kind, count in told["unrated"].items())
        console.print(f"without a rating, so not judged: {kinds}")
    for note in told["notes"][:MOST_REASONS]:
        console.print(f"not looked at: {note}")
    if len(told["notes"]) > MOST_REASONS:
        console.print(f"... and {len(told['notes']) - MOST_REASONS} more that were not looked at, see run.json")


def _number(name: str, row: Row) -> str:
    value = row[name]
    if value is None:
        return ""
    if name == "worst_late_s" and row["stuck_trains"]:
        return f"at least {value:.1f}"  # a train that has not arrived counts with the time until the end of the clock
    return f"{value:.0f}" if name.endswith(("_v", "trains", "trips")) else f"{value:.1f}"
