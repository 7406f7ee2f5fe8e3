"""The sheet of voltages by train: extremes with time and place, and mean useful voltages from the sums that make them."""

from __future__ import annotations

from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.reporting.texts import mark
from tractionpower.reporting.workbook.common.verdicts import Comparison
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.run.judged import judge
from tractionpower.reporting.workbook.run.sums import Told, number, room_above, write_above
from tractionpower.reporting.workbook.run.trains import USEFUL, colour_low, place_of, useful_name
from tractionpower.results.verdicts import AT_LEAST

_COLUMNS = (
    Column("train", widest=34, key="train"),
    Column("lowest voltage [V]", "0.0", key="lowest"),
    Column("above U_min2 by [V]", "0.0", key="margin"),
    Column("time of the lowest", "time"),
    Column("track", "beside", 10),
    Column("place [km]", "0.00"),
    Column("lowest mean of 10 s [V]", "0.0", key="ten"),
    Column("mean voltage [V]", "0.0", key="mean"),
    Column("highest voltage [V]", "0.0", key="highest"),
    Column("time of the highest", "time"),
    Column("sum U |I| dt [kWh]", "0.00", key="energy"),
    Column("sum |I| dt [Ah]", "0.00", key="charge"),
    Column("mean useful voltage, current-weighted [V]", "0.0", key="weighted"),
    Column("sum U dt with traction effort [V s]", "0", key="volts"),
    Column("time with traction effort [s]", "0", key="seconds"),
    Column("mean useful voltage, time mean [V]", "0.0", key="plain"),
)

WEIGHTED, PLAIN = "mean_useful_voltage_current_weighted_v", "mean_useful_voltage_time_mean_v"


def add(book: Book) -> None:
    """Add the sheet, if trains had voltages."""
    facts = book.facts
    rows = [_row(facts, train) for train in facts.trains]
    if not any(row[1] is not None for row in rows):
        return
    page = book.page("Voltages", "Voltages of trains at the pantograph")
    page.note(
        "Means of a step. Mean useful voltages are formulas: current-weighted, sum U |I| dt over sum |I| dt; time mean, sum U dt"
        " over the time of steps with traction effort. Red: below the limit of sheet Acceptance."
        " Voltages by kilometre are on sheet Voltage profile."
    )
    first = room_above(page, 5)
    block = page.table(_COLUMNS, rows, frozen=True)
    write_above(page, first, _summary(block, rows))
    book.define(USEFUL, page, block.cells("weighted"))
    for key in ("lowest", "highest", "weighted", "plain"):
        book.define(f"train_voltages_{key}", page, block.cells(key))
    for key in ("lowest", "ten"):
        colour_low(book, page, block.cells(key), "u_min2")
    for key in ("weighted", "plain"):
        colour_low(book, page, block.cells(key), useful_name(facts))
    judge(book, "lowest voltage", "MIN({train_voltages_lowest})", _least(rows, "lowest"))
    judge(book, "highest voltage", "MAX({train_voltages_highest})", _most(rows, "highest"))
    judge(book, "mean useful voltage of trains, current-weighted", "MIN({train_voltages_weighted})", _least(rows, "weighted"))
    judge(book, "mean useful voltage of trains, time mean", "MIN({train_voltages_plain})", _least(rows, "plain"))


def _row(facts: Facts, train: dict[str, Any]) -> list[Any]:
    place = place_of(train)

    def figure(which: str) -> float | None:
        return facts.value(place, which)

    lowest, when = figure("lowest_pantograph_voltage_v"), parse_time(facts.when(place, "lowest_pantograph_voltage_v"))
    told = when is not None and train.get("lowest_voltage_s") == when  # a part of the run may have another lowest voltage
    track, km = (train.get("lowest_voltage_track"), train.get("lowest_voltage_km")) if told else (None, None)
    limit = facts.limit("u_min2")
    margin = (
        None
        if lowest is None or limit is None
        else Formula(Comparison("{lowest}", "{limit_u_min2}", AT_LEAST).margin, lowest - limit.value)
    )
    energy, charge = figure("useful_energy_kwh"), figure("useful_charge_ah")
    volts, seconds = figure("voltage_of_useful_steps_vs"), figure("time_of_useful_steps_s")
    return [
        train["train"], lowest, margin, when, track, km, figure("lowest_10_s_mean_voltage_v"),
        figure("mean_pantograph_voltage_v"), figure("highest_pantograph_voltage_v"),
        parse_time(facts.when(place, "highest_pantograph_voltage_v")),
        energy, charge, quotient("1000*{energy}/{charge}", figure(WEIGHTED), energy, charge),
        volts, seconds, quotient("{volts}/{seconds}", figure(PLAIN), volts, seconds),
    ]  # fmt: skip


def quotient(text: str, value: float | None, above: float | None, below: float | None) -> Formula | float | None:
    """Return a mean as the quotient of its sums; the number where a run of an earlier version does not tell the sums."""
    return value if value is None or above is None or not below else Formula(text, value)


def _column(key: str) -> int:
    return next(k for k, column in enumerate(_COLUMNS) if column.key == key)


def _known(rows: list[list[Any]], key: str) -> list[float]:
    return [value for row in rows if (value := number(row[_column(key)])) is not None]


def _least(rows: list[list[Any]], key: str) -> float | None:
    return min(_known(rows, key), default=None)


def _most(rows: list[list[Any]], key: str) -> float | None:
    return max(_known(rows, key), default=None)


def _summary(block: Block, rows: list[list[Any]]) -> list[Told]:
    lowest, trains = block.cells("lowest"), block.cells("train")
    values = [number(row[_column("lowest")]) for row in rows]
    worst = min(value for value in values if value is not None)
    told: list[Told] = [
        (mark("lowest voltage [V]"), Formula(f"MIN({lowest})", worst), "0.0"),
        (
            mark("train of the lowest voltage"),
            Formula(f"INDEX({trains},MATCH(MIN({lowest}),{lowest},0))", str(rows[values.index(worst)][0])),
            "any",
        ),
    ]
    for label, key in (
        (mark("lowest mean useful voltage, current-weighted [V]"), "weighted"),
        (mark("lowest mean useful voltage, time mean [V]"), "plain"),
    ):
        least = _least(rows, key)
        if least is not None:
            told.append((label, Formula(f"MIN({block.cells(key)})", least), "0.0"))
    highest = _most(rows, "highest")
    if highest is not None:
        told.append((mark("highest voltage [V]"), Formula(f"MAX({block.cells('highest')})", highest), "0.0"))
    return told
