"""What ``run`` prints at its end: loads of the substations, verdicts, trains, ledgers."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tractionpower.cosimulation.run import Run
    from tractionpower.results.outcome import Outcome

COLUMNS = {
    "highest_current_a": "highest\ncurrent [A]",
    "rms_current_a": "RMS\ncurrent [A]",
    "highest_rms_current_60_min_a": "RMS of the\nhighest hour [A]",
    "highest_power_kw": "highest\npower [kW]",
    "highest_mean_power_15_min_kw": "mean of the highest\nquarter of an hour [kW]",
    "energy_kwh": "energy\n[kWh]",
}
"""Key figures of a substation that are printed, and their headings; windows longer than the run are left out."""

MOST = 12
"""Trains that are named in one line."""

STATUS = {
    "before": "had left before the clock",
    "left": "left the line",
    "stays": "stay at the end of their route",
    "on_line": "are on the line at the end",
    "outside": "have not entered",
    "stuck": "are STUCK",
}


def show(outcome: Outcome, prepared: Run) -> None:
    """Print what a designer asks first."""
    from tractionpower.cli.console import new_console, new_table

    console = new_console()
    figures = {(figure["name"], figure["place"]): figure["value"] for figure in outcome.key_figures}
    names = [substation.id for substation in prepared.scenario.supply.substations]
    columns = {name: heading for name, heading in COLUMNS.items() if any((name, f"substation {one}") in figures for one in names)}
    table = new_table(["substation"], list(columns.values()))
    for one in names:
        table.add_row(one, *(f"{figures[name, f'substation {one}']:z.1f}" for name in columns))
    console.print(table)
    console.print()
    for verdict in outcome.run["verdicts"]:
        console.print(sentence(verdict))
    for line in (*_trains(outcome), *_ledgers(outcome.run)):
        console.print(line)
    if outcome.run["flagged_steps"]:
        console.print(f"{outcome.run['flagged_steps']} steps are flagged, see table events:")
        for message in prepared.recorder.events.messages():
            console.print("  " + message)


def sentence(verdict: dict[str, Any]) -> str:
    """Return a verdict in words."""
    unit = verdict["unit"]
    where = " ".join(f"at {word}," if word else "" for word in (verdict["place"], verdict["time"])).strip().rstrip(",")
    word = "met" if verdict["met"] else "VIOLATED"
    limit = f"{verdict['limit']} {verdict['limit_value']:g} {unit}"
    if "voltage_v" in verdict:  # a spell above a touch voltage
        limit = f"may last {verdict['limit_value']:g} s, {verdict['limit']}: {verdict['voltage_v']:g} V"
    limit += f", source status: {verdict['status']}"
    return f"{verdict['name']} {verdict['value']:z.1f} {unit}{' ' if where else ''}{where}: {word} ({limit})"


def _trains(outcome: Outcome) -> Iterator[str]:
    """Yield where the trains are, which is the latest, and what else is to be known of them."""
    counts = Counter(train["status"] for train in outcome.run["trains"])
    if not counts:
        return
    told = ", ".join(f"{counts[status]} {words}" for status, words in STATUS.items() if counts[status])
    yield f"trains: {told}"
    late = [(f["value"], f["place"]) for f in outcome.key_figures if f["name"] == "late_at_end_s"]
    if late:
        seconds, train = max(late)
        many = sum(value >= 0.5 for value, _ in late)
        yield f"late at their last timed call: {many} of {len(late)}" + (f", most {train} by {seconds:.0f} s" if many else "")
    overdue = [train["train"] for train in outcome.run["trains"] if train["overdue_s"] > 0.0]
    if overdue:
        more = f" and {len(overdue) - MOST} more" if len(overdue) > MOST else ""
        yield f"overdue at a call that they have not reached: {', '.join(overdue[:MOST])}{more}"
    yield from outcome.run["notes"]
    if outcome.run["overlaps"]["count"]:
        yield outcome.run["overlaps"]["message"]


def _ledgers(run: dict[str, Any]) -> Iterator[str]:
    ledgers = run["ledgers"]
    closes = "closes" if ledgers["electric"]["closes"] else "DOES NOT CLOSE"
    worst = f"worst step {ledgers['electric']['worst_gap_w']:.2g} W"
    yield f"electric ledger {closes} ({worst}); every node balances within {run['worst_residual_a']:.2g} A"
    if run["trains"]:
        for name in ("mechanical", "pantograph_to_wheel"):
            closes = "closes" if ledgers[name]["closes"] else "DOES NOT CLOSE"
            gap = f"gap at most {ledgers[name]['worst_gap_share']:.1g}, train {ledgers[name]['train']}"
            yield f"ledger {name.replace('_', ' ')} {closes} ({gap})"
