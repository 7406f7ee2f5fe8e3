"""What ``size`` prints: the verdict, the worst device of each kind, breakers, contracts, voltages, what nobody has rated."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

COLOURS = {"pass": "bold green", "fail": "bold red", "not rated": "bold yellow"}
"""Styles of verdicts."""

MOST = 8
"""Devices that are named in one line."""


def show(run: Mapping[str, Any]) -> None:
    """Print the verdict on the devices from what ``run.json`` says."""
    from tractionpower.cli.console import new_console, new_table
    from tractionpower.cli.run_summary import sentence
    from tractionpower.model.base import format_time
    from tractionpower.studies.ratings.words import KINDS, window_words

    console, told = new_console(), run["size"]
    console.print()
    console.print(headline(told), style=COLOURS[told["verdict"]])
    for line in _failing(told):
        console.print(line)
    if told["worst"]:
        numbers = ["utilisation\n[%]", "load\n[A]", "permitted\n[A]", "left\n[A]"]
        table = new_table(["worst of all", "device", "window that rules", "begins", "verdict", "status of the rating"], numbers)
        for row in told["worst"]:
            begins = "" if row["window_s"] == 0.0 else format_time(row["from_s"])
            verdict = "holds" if row["met"] == "yes" else "FAILS"
            texts = (KINDS[row["kind"]], row["device"], window_words(row["window_s"]), begins, verdict, row["status"])
            figures = (row[name] for name in ("utilisation_percent", "load_a", "permitted_a", "left_a"))
            table.add_row(*texts, *(f"{value:z.1f}" if k == 0 else f"{value:z.0f}" for k, value in enumerate(figures)))
        console.print()
        console.print(table)
    console.print()
    for verdict in run["verdicts"]:
        if not verdict["name"].startswith("utilisation of "):  # they stand in the table
            console.print(sentence(verdict))
    for note in (*told["notes"], *run["notes"]):
        console.print(note)
    if "search" in told:
        _search(console, told["search"])
    if run["flagged_steps"]:
        console.print(f"{run['flagged_steps']} steps are flagged, see table events: the verdict is of what was computed")


def _search(console: Console, found: Mapping[str, Any]) -> None:
    """Print the equipment that a search has found."""
    from tractionpower.cli.console import new_table

    console.print()
    console.print(search_headline(found), style=COLOURS["pass" if found["holds"] else "fail"])
    if found["design"]:
        table = new_table(["equipment", "as declared", "found", "why"], [])
        for row in found["design"]:
            table.add_row(row["item"], row["declared"], row["found"], row["why"])
        console.print(table)
    if found["remaining"]:
        for row in found["remaining"][:MOST]:
            console.print(f"remains, {row['case']}: {row['words']}")
        if len(found["remaining"]) > MOST:
            console.print(f"... and {len(found['remaining']) - MOST} more")
    if found["changes"]:
        console.print("try it: " + " ".join(f"--set '{change}'" for change in found["changes"]))


def search_headline(found: Mapping[str, Any]) -> str:
    """Return in one line what a search for equipment came to."""
    effort = f"{found['runs']} runs, {found['rounds']} designs"
    cost = f"{found['cost_found']:g} points against {found['cost_declared']:g} as declared"
    if found["interrupted"]:
        return f"SEARCH BROKEN OFF after {effort}: what stands below is not verified"
    if not found["holds"]:
        return f"NO DESIGN within the bounds meets all limits ({effort}); the nearest: {cost}"
    if not found["design"]:
        return f"NO LESS: what is declared meets all limits in {found['cases']} cases, and no item can be lessened ({effort})"
    return f"FOUND: meets all limits in {found['cases']} cases, {cost} ({effort})"


def headline(told: Mapping[str, Any]) -> str:
    """Return the verdict on the devices in one line."""
    from tractionpower.io.wording import counted

    permitted, rated, devices = told["permitted_percent"], told["rated"], told["devices"]
    bare = f"; {devices - rated} more have no rating and are not judged" if rated < devices else ""
    if told["verdict"] == "not rated":
        return f"NOT RATED: none of {devices} devices has a rating; give substations a unit or rated_current_a"
    if told["verdict"] == "fail":
        counts = [(len(told["failing"]), "", f"of {rated} rated devices beyond {permitted:g} %"),
                  (len(told["failing_breakers"]), "feeder", "beyond what breakers are set to"),
                  (len(told["failing_contracts"]), "supply point", "beyond contract")]  # fmt: skip
        words = (f"{counted(number, noun) if noun else number} {beyond}" for number, noun, beyond in counts if number)
        return f"FAIL: {', '.join(words)}{bare}"
    worst = max(told["worst"], key=lambda row: row["utilisation_percent"])
    most = f"most {worst['device']}, {worst['utilisation_percent']:.1f} %"
    return f"PASS: all {rated} rated devices within {permitted:g} % ({most}){bare}"


def _failing(told: Mapping[str, Any]) -> Iterator[str]:
    """Yield what fails, by name."""
    words = {
        "failing": "beyond their ratings",
        "failing_breakers": "beyond breaker settings",
        "failing_contracts": "beyond contracts",
    }
    for name, what in words.items():
        if told[name]:
            yield f"{what}, the worst first: {_named(told[name])}"


def _named(devices: Sequence[str]) -> str:
    more = f" and {len(devices) - MOST} more" if len(devices) > MOST else ""
    return ", ".join(devices[:MOST]) + more
