"""The sheets of outages: what is out, what becomes of voltages, devices and trains, grid voltages side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.facts.outages import COMPUTED, KINDS_WORDS, Outages, worst
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL, fill
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.sizing.ratings import HOLDS, colour_use, colour_word

Case = Mapping[str, Any]
USE = "highest utilisation [%]"
LOWEST, ZONE, TRAIN = (
    "lowest voltage [V]",
    "lowest mean useful voltage of a zone [V]",
    "lowest mean useful voltage of a train [V]",
)


def add(book: Book, outages: Outages) -> None:
    """Add the sheet of outages and that of all cases."""
    page = book.page("Outages", "Outages: what is out, and what becomes of voltages, devices and trains")
    page.note(
        "A row for each outage, with the worst of all grid voltages where none is named; grouped by kind, along the line. Lowest"
        " voltage: at trains, loads and cross-sections that are fed. Added delay: how much later than without the outage, at the"
        " same grid voltage, the most delayed train is at a timed call; at least that of stuck trains."
        " An outage holds if no limit of the voltage, no rating and no tolerance of lateness is"
        " passed and all its cases were computed; trips of breakers are told, not judged."
    )
    rows = [_row(outages, first, cases) for first, cases in outages.groups()]
    block = page.table(*_filled(_columns(outages), rows), frozen=True)
    colour_word(block, HOLDS)
    _colour(block, outages)
    _every(book, outages)


def _filled(columns: Sequence[Column], rows: Sequence[Sequence[Any]]) -> tuple[list[Column], list[list[Any]]]:
    """Return columns and rows without the columns that are empty in every row: studies without ratings have many."""
    kept = [k for k in range(len(columns)) if k < KEPT or any(row[k] is not None and row[k] != "" for row in rows)]
    return [columns[k] for k in kept], [[row[k] for k in kept] for row in rows]


KEPT = 4
"""Columns that stay even where they are empty."""


def _columns(outages: Outages) -> list[Column]:
    grids = [f", {grid} grid" for grid in outages.grids] if len(outages.grids) > 1 else [""]
    return [
        Column("what is out", widest=48),
        Column("kind", widest=20),
        Column(HOLDS, "beside"),
        Column("why, and at which grid voltage", widest=50),
        *(Column(f"{LOWEST}{grid}", "0") for grid in grids),
        Column("on track", "beside"),
        Column("at [km]", "0.0"),
        Column("at", "time"),
        Column(ZONE, "0"),
        Column("zone", "beside", 26),
        Column(TRAIN, "0"),
        Column("train", "beside", 18),
        *(Column(f"{USE}{grid}", "0.0") for grid in grids),
        Column("device", "beside", 34),
        *(Column(f"late trains{grid}", "0") for grid in grids),
        Column("added delay, at most [s]", "0"),
        Column("train that is delayed most", "beside", 18),
        Column("trips", "0"),
        Column("greatest rail potential [V]", "0"),
    ]


def _row(outages: Outages, first: Case, cases: Mapping[str, Case]) -> list[Any]:
    computed = [case for case in cases.values() if case["status"] in COMPUTED]
    low = worst(computed, "lowest_voltage_v", lowest=True) or {}
    zone, train = (worst(computed, f"useful_{of}_v", lowest=True) or {} for of in ("zone", "train"))
    use = worst(computed, "utilisation_percent") or {}
    rail, trips = worst(computed, "rail_potential_v") or {}, worst(computed, "trips") or {}
    added = max((outages.added_s[case["case"]] for case in computed if case["case"] in outages.added_s), default=(None, ""))
    by_grid = [cases.get(grid) if cases.get(grid) in computed else None for grid in outages.grids]
    return [
        first["words"],
        KINDS_WORDS.get(first["kind"], first["kind"]),
        *_verdict(outages, cases),
        *_of_grids(by_grid, "lowest_voltage_v"),
        low.get("lowest_voltage_track"), low.get("lowest_voltage_km"), low.get("lowest_voltage_s"),
        zone.get("useful_zone_v"), zone.get("useful_zone"), train.get("useful_train_v"), train.get("useful_train"),
        *_of_grids(by_grid, "utilisation_percent"),
        use.get("utilisation_device"),
        *_of_grids(by_grid, "late_trains"),
        *added,
        trips.get("trips"), rail.get("rail_potential_v"),
    ]  # fmt: skip


def _of_grids(cases: Sequence[Case | None], name: str) -> list[Any]:
    return [None if case is None else case[name] for case in cases]


def _verdict(outages: Outages, cases: Mapping[str, Case]) -> tuple[str, str]:
    """Return whether an outage holds at all its grid voltages, and what it fails at."""
    found: dict[str, list[str]] = {}
    for grid, case in cases.items():
        for failure in outages.failures(case):
            grids = found.setdefault(failure.short, [])
            grids += [grid] if grid not in grids else []
    if not found:
        return "yes", ""
    if len(outages.grids) == 1:
        return "no", "; ".join(found)
    every = [grid for grid in outages.grids if grid in cases]
    return "no", "; ".join(f"{what} ({'all' if grids == every else ', '.join(grids)})" for what, grids in found.items())


def _colour(block: Block, outages: Outages) -> None:
    floors = {check.figure: check.value for check in outages.checks if check.is_floor}
    figures = {LOWEST: "lowest_voltage_v", ZONE: "useful_zone_v", TRAIN: "useful_train_v"}
    for heading in block.headings:
        figure = next((name for words, name in figures.items() if heading.startswith(words)), None)
        if heading.startswith(USE):
            colour_use(block, heading, outages.scenario.sizing.utilisation_percent)
        elif figure in floors:
            _red(block, heading, f"<{floors[figure]!r}")
        elif heading.startswith(("late trains", "stuck", "trips", "devices beyond")):
            _red(block, heading, ">0")


def _red(block: Block, heading: str, test: str) -> None:
    area = block.cells(heading)
    first = area.split(":")[0]
    rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}{test})"], fill=fill(RED_FILL))
    block.sheet.conditional_formatting.add(area, rule)


_CASES: tuple[tuple[Column, str], ...] = (
    (Column("what is out", widest=48), "words"),
    (Column("grid voltage", "beside"), "grid"),
    (Column("status", "beside"), "status"),
    (Column("reason", widest=50), "reason"),
    (Column(LOWEST, "0"), "lowest_voltage_v"),
    (Column("on track", "beside"), "lowest_voltage_track"),
    (Column("at [km]", "0.0"), "lowest_voltage_km"),
    (Column("at", "time"), "lowest_voltage_s"),
    (Column("highest voltage [V]", "0"), "highest_voltage_v"),
    (Column(ZONE, "0"), "useful_zone_v"),
    (Column(TRAIN, "0"), "useful_train_v"),
    (Column(USE, "0.0"), "utilisation_percent"),
    (Column("device", "beside", 34), "utilisation_device"),
    (Column("devices beyond their rating", "0"), "overloaded"),
    (Column("late trains", "0"), "late_trains"),
    (Column("latest [s]", "0"), "worst_late_s"),
    (Column("train", "beside", 18), "worst_late_train"),
    (Column("stuck trains", "0"), "stuck_trains"),
    (Column("trips", "0"), "trips"),
    (Column("greatest rail potential [V]", "0"), "rail_potential_v"),
    (Column("energy of the substations [kWh]", "0"), "energy_kwh"),
    (Column("heat in lines [kWh]", "0"), "line_loss_kwh"),
    (Column("highest demand of 15 min [kW]", "0"), "highest_demand_kw"),
    (Column("case", "beside", 48), "case"),
)


def _every(book: Book, outages: Outages) -> None:
    page = book.page("All cases", "All cases: every outage at every grid voltage")
    page.note(
        "`tractionpower run STUDY` with the changes of table case_changes repeats a case with all its tables. A case that failed"
        " or was refused has no figures. Latest: at least that where trains are stuck at the end."
    )
    counts = {"overloaded", "late_trains", "stuck_trains", "trips"}
    rows = [
        [None if name in counts and row["status"] not in COMPUTED else _plain(row[name]) for _, name in _CASES]
        for row in outages.by_id.values()
    ]
    block = page.table(*_filled([column for column, _ in _CASES], rows), frozen=True)
    _colour_status(block)
    _colour(block, outages)


def _colour_status(block: Block) -> None:
    for word in ("failed", "refused", "flagged"):
        rule = CellIsRule(operator="equal", formula=[f'"{word}"'], fill=fill(RED_FILL))
        block.sheet.conditional_formatting.add(block.cells("status"), rule)


def _plain(value: Any) -> Any:
    return None if value is None or value is pd.NA else value
