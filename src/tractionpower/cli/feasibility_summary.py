"""What ``feasibility`` prints: the verdict, late trains, least reserves, where seconds are lost, what would save it."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

MOST_LATE, MOST_RESERVES, MOST_AREAS, MOST_REMEDIES, MOST_SENSITIVITIES = 12, 5, 8, 5, 3
"""Rows of the tables."""

LEAST_LOST_S = 0.05
"""Areas in which all trains lose less are left out [s]."""

CAUSES = {
    "voltage": "low voltage",
    "current_limit": "current limit",
    "timetable": "timetable too tight",
    "driving": "driving plan",
    "dwell": "dwell at stops",
    "knock_on": "delay from before",
    "not_reached": "not there",
    "": "",
}
"""Causes of delays in words."""

COLOURS = {"feasible": "bold green", "infeasible": "bold red", "not judged": "bold yellow"}
"""Styles of verdicts."""

WHY_WIDTH = 78
"""Width of the column of reasons [characters]; longer ones take more lines."""


def show(run: Mapping[str, Any]) -> None:
    """Print the verdict on a timetable from what ``run.json`` says."""
    from tractionpower.cli.console import new_console

    console, told = new_console(), run["feasibility"]
    console.print()
    console.print(headline(told), style=COLOURS[told["verdict"]])
    first = told["first"]
    if first:
        console.print(f"worst: train {first['train']}: {first['why']}")
    trains = told["trains"]
    _late(console, [train for train in trains if train["verdict"] in ("infeasible", "not finished")])
    _reserves(console, [train for train in trains if train["verdict"] == "feasible" and train["reserve_left_s"] is not None])
    _areas(console, told)
    _remedies(console, told)
    _sensitivities(console, told.get("sensitivities") or [])
    if run.get("flagged_steps"):
        console.print(f"\n{run['flagged_steps']} steps are flagged, see table events: the verdict is of what was computed")


def headline(told: Mapping[str, Any]) -> str:
    """Return the verdict on the timetable in one line."""
    trains, late = len(told["trains"]), told["late_trains"]
    tolerance = f"tolerance {told['tolerance_s']:g} s"
    if told["verdict"] == "not judged":
        return (
            "NOT JUDGED: no train comes to a call with a planned time within the time that counts;"
            f" give calls an arrival or a departure ({trains} train{'s' if trains > 1 else ''})"
        )
    if told["verdict"] == "infeasible":
        return f"INFEASIBLE: {late} of {trains} train{'s' if trains > 1 else ''} late or not there ({tolerance})"
    reserve = told["reserve_left_s"]
    if reserve is None:
        return f"FEASIBLE: no train is late ({trains} trains, {tolerance})"
    if reserve < 0.0:
        missing = f"{-reserve:.1f} s are missing at the tightest place"
        return f"FEASIBLE, but only within the tolerance: {missing} ({trains} trains, {tolerance})"
    return f"FEASIBLE, with {reserve:.0f} s of reserve left at the tightest place ({trains} trains, {tolerance})"


def _table(*columns: tuple[str, bool]) -> Table:
    """Return a table of columns: heading, and whether it holds numbers."""
    from rich.table import Table

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for heading, number in columns:
        width = WHY_WIDTH if heading in ("why", "what") else None
        table.add_column(heading, justify="right" if number else "left", no_wrap=number, vertical="top", max_width=width,
                         overflow="fold")  # fmt: skip
    return table


def _late(console: Console, late: Sequence[Mapping[str, Any]]) -> None:
    if not late:
        return
    table = _table(("late train", False), ("late [s]", True), ("at", False), ("main cause", False), ("why", False))
    # A train that did not come is worse than any that came late.
    order = sorted(late, key=lambda train: (train["verdict"] != "not finished", -(train["late_s"] or 0.0), train["train"]))
    for train in order[:MOST_LATE]:
        seconds = "-" if train["late_s"] is None else f"{train['late_s']:.0f}"
        cause = CAUSES.get(train["cause"] or "", train["cause"])
        table.add_row(train["train"], seconds, train["worst_station"], cause, reason(train))
    _put(console, table, len(late) - MOST_LATE, "late trains")


def reason(train: Mapping[str, Any]) -> str:
    """Return why a train is late, without what stands in other columns.

    >>> reason({"why": "late 13 s at A: 13 s lost to low voltage", "verdict": "infeasible"})
    '13 s lost to low voltage'
    """
    words: str = train["why"]
    return words.partition(": ")[2] or words if train["verdict"] == "infeasible" else words


def _reserves(console: Console, trains: Sequence[Mapping[str, Any]]) -> None:
    if not trains:
        return
    table = _table(("least reserve, trains on time", False), ("left [s]", True), ("at", False), ("lost to low voltage [s]", True))
    for train in sorted(trains, key=lambda train: (train["reserve_left_s"], train["train"]))[:MOST_RESERVES]:
        lost = train["lost_voltage_s"]
        table.add_row(
            train["train"], f"{train['reserve_left_s']:z.0f}", train["reserve_left_at"], "" if lost is None else f"{lost:z.1f}"
        )
    _put(console, table, len(trains) - MOST_RESERVES, "trains on time")


def _areas(console: Console, told: Mapping[str, Any]) -> None:
    areas = [area for area in told["lost_by_area"] if area["lost_s"] >= LEAST_LOST_S]
    if not areas:
        return
    table = _table(("seconds lost to low voltage, area of", False), ("all trains [s]", True), ("trains", True))
    for area in areas[:MOST_AREAS]:
        table.add_row(area["area"] or "no substation", f"{area['lost_s']:.1f}", str(area["trains"]))
    _put(console, table, len(areas) - MOST_AREAS, "areas")


def _remedies(console: Console, told: Mapping[str, Any]) -> None:
    search = told.get("search")
    if search is None:
        return
    found = told["remedies"]
    savers = [remedy for remedy in found if remedy["feasible"]]
    if savers:
        table = _table(("what would save it", False), ("size", True), ("verified", False), ("what", False))
        for remedy in savers[:MOST_REMEDIES]:
            size = (
                f"{remedy['size']:+g} {remedy['unit']}"
                if remedy["kind"] == "departure_shift"
                else f"{remedy['size']:g} {remedy['unit']}"
            )
            table.add_row(kind_in_words(remedy), size, "by a run" if remedy["verified"] else "no", remedy["words"])
        _put(console, table, len(savers) - MOST_REMEDIES, "changes that would save it")
        if savers[0]["changes"]:
            console.print("try it: " + " ".join(f"--set '{change}'" for change in savers[0]["changes"]))
    elif found:
        near = found[0]
        console.print(f"\nnothing within the bounds saves it ({search['tried']} runs); nearest: {near['words']}")
    elif told["verdict"] == "infeasible":
        console.print(f"\nnothing within the bounds saves it ({search['tried']} runs)")
    for note in search["notes"] if not savers or search["interrupted"] else ():
        console.print(note)


def _sensitivities(console: Console, rows: Sequence[Mapping[str, Any]]) -> None:
    """Print where a small change of a device does most, with what makes it."""
    told = [row for row in rows if row["lost_s_change"] is not None and abs(row["lost_s_change"]) >= LEAST_LOST_S]
    if not told:
        return
    table = _table(("what the lost seconds depend on", False), ("by", False), ("all trains [s]", True), ("what", False))
    for row in told[:MOST_SENSITIVITIES]:
        change = " ".join(f"--set '{text}'" for text in row["change"]) if len(row["change"]) == 1 else ""
        table.add_row(f"{row['kind'].replace('_', ' ')}, {row['subject']}", row["per"], f"{row['lost_s_change']:+.1f}", change)
    _put(console, table, len(told) - MOST_SENSITIVITIES, "in report.xlsx")


def kind_in_words(remedy: Mapping[str, Any]) -> str:
    """Return the kind of a change and what it is made on.

    >>> kind_in_words({"kind": "current_cap + departure_shift", "subject": "IC 1 + R 4"})
    'current cap + departure shift, IC 1 + R 4'
    """
    return f"{remedy['kind'].replace('_', ' ')}, {remedy['subject']}"


def _put(console: Console, table: Table, more: int, what: str) -> None:
    console.print()
    console.print(table)
    if more > 0:
        one = {"changes that": "change that", "trains": "train", "areas": "area"} if more == 1 else {}
        for several, single in one.items():
            what = what.replace(several, single)
        console.print(f"... and {more} more {what}")
