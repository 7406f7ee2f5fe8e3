"""The sheet of the timetable: planned and simulated times at every call, and what the deviation is made of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.reporting.figures.delays.delay_styles import cause_in_words
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, RED_FILL, SECONDS_PER_DAY
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.rules import Rule
from tractionpower.reporting.workbook.run.sums import Told, number, room_above, total, write_above

LATE_FROM, VERY_LATE_FROM = "late_from_s", "very_late_from_s"
"""Names of the cells from which on a call is late, and very late [s]."""

LATE_S, VERY_LATE_S = 1.0, 60.0

KINDS = {"arrival": mark("arrival"), "departure": mark("departure"), "pass": mark("pass")}

PARTS = ("voltage", "current_limit", "dwell", "driving", "timetable", "knock_on")
"""Parts of a delay in the order of the columns."""

_LATE, _VERY = mark("late from [s], can be edited"), mark("very late from [s], can be edited")

_COLUMNS = (
    Column("train", widest=24, key="train"),
    Column("station", widest=28),
    Column("event"),
    Column("planned", "time", key="planned"),
    Column("simulated", "time", key="simulated"),
    Column("deviation [s]", "0.0", key="deviation"),
    Column("dwell [s]", "0"),
)


def add(book: Book) -> None:
    """Add the sheet, if there are any calls."""
    frame = book.facts.table("calls")
    if frame.empty:
        return
    causes = _causes(book)
    page = book.page("Timetable", "Timetable: planned and simulated")
    page.note("Deviation: simulated less planned, positive is late, negative is early. Times go beyond 24:00:00 on the next day.")
    columns = list(_COLUMNS)
    if causes:
        page.note(
            "Causes add up to the delay, which is the deviation where that is positive. Delay from before is what the train"
            " brought along from the timed call before. Sheet Delays follows it back to where its seconds first arose."
        )
        columns += [Column("main cause", widest=20)]
        columns += [Column(f"{tr(cause_in_words(part))} [s]", "0.0", key=part) for part in PARTS]
    else:
        page.note(
            "What deviations are made of (voltage, current limit, driving, stops, other trains) tells command feasibility, which"
            " also lets each train run alone: there this sheet has a column for each cause."
        )
    calls: list[dict[Any, Any]] = frame.to_dict("records")
    rows = [_row(book, call, causes) for call in calls]
    first = room_above(page, 11 + (len(PARTS) if causes else 0))
    block = page.table(columns, rows, frozen=True)
    tolerance = (book.facts.feasibility or {}).get("tolerance_s")
    late_s = max(LATE_S, float(tolerance)) if tolerance is not None else LATE_S
    write_above(page, first, _summary(block, rows, late_s, bool(causes)), {_LATE: LATE_FROM, _VERY: VERY_LATE_FROM}, value_in=3)
    for name, value, colour in ((VERY_LATE_FROM, VERY_LATE_S, RED_FILL), (LATE_FROM, late_s, AMBER_FILL)):
        book.rules.append(Rule(page.sheet, block.cells("deviation"), f"{{cell}}>={{{name}}}", colour, {name: value}))


def colour_late(book: Book, page: Page, area: str) -> None:
    """Let times late of an area show amber and red from the numbers of seconds on that the sheet of the timetable tells."""
    for name, value, colour in ((VERY_LATE_FROM, VERY_LATE_S, RED_FILL), (LATE_FROM, LATE_S, AMBER_FILL)):
        book.rules.append(Rule(page.sheet, area, f"{{cell}}>={{{name}}}", colour, {name: value}))


def _causes(book: Book) -> dict[tuple[Any, ...], dict[str, Any]]:
    """Return the parts of delays by call; empty where the run was not judged."""
    frame = book.facts.table("delays")
    rows: list[dict[Any, Any]] = [] if frame.empty else frame.to_dict("records")
    return {_key(row): row for row in rows}


def _key(call: dict[str, Any]) -> tuple[Any, ...]:
    planned = number(call["planned_s"])
    return str(call["train"]), str(call["station"]), str(call["kind"]), None if planned is None else round(planned, 3)


def _row(book: Book, call: dict[str, Any], causes: dict[tuple[Any, ...], dict[str, Any]]) -> list[Any]:
    kind, station = str(call["kind"]), str(call["station"])
    row = [
        call["train"], book.facts.station_names.get(station) or station, tr(KINDS.get(kind, kind)),
        call["planned_s"], call["actual_s"], _deviation(call), call["dwell_s"],
    ]  # fmt: skip
    if causes:
        found = causes.get(_key(call), {})
        row += [tr(cause_in_words(str(found.get("cause") or ""))), *(_shown(found.get(f"{part}_s")) for part in PARTS)]
    return row


def _deviation(call: dict[str, Any]) -> Formula | float | None:
    """Return simulated less planned time as a formula; of a time before midnight, which Excel does not show, the number."""
    planned, simulated = number(call["planned_s"]), number(call["actual_s"])
    if planned is None or simulated is None:
        return None
    if min(planned, simulated) < 0.0:
        return simulated - planned
    value = SECONDS_PER_DAY * (simulated / SECONDS_PER_DAY - planned / SECONDS_PER_DAY)  # as the workbook computes it
    return Formula("86400*({simulated}-{planned})", value)


def _shown(seconds: Any) -> float | None:
    known = number(seconds)
    return None if known is None or abs(known) < 0.05 else known  # zeros would drown what matters


def _summary(block: Block, rows: Sequence[Sequence[Any]], late_s: float, causes: bool) -> list[Told]:
    deviations = [number(row[5]) for row in rows]
    known = [value for value in deviations if value is not None]
    missing = sum(number(row[3]) is not None and number(row[4]) is None for row in rows)
    area, trains = block.cells("deviation"), block.cells("train")
    planned, simulated = block.cells("planned"), block.cells("simulated")
    told: list[Told] = [
        (mark("calls with a planned and a simulated time"), Formula(f"COUNT({area})", len(known)), "0"),
        (_LATE, late_s, "editable 0.0"),
        (mark("late calls"), _count(area, LATE_FROM, late_s, known), "0"),
        (_VERY, VERY_LATE_S, "editable 0.0"),
        (mark("very late calls"), _count(area, VERY_LATE_FROM, VERY_LATE_S, known), "0"),
    ]
    if any(number(row[3]) is not None and (number(row[3]) or 0.0) < 0.0 for row in rows):
        told.append((mark("planned calls that were not reached"), missing, "0"))
    else:
        counted = f"SUMPRODUCT(ISNUMBER({planned})*(1-ISNUMBER({simulated})))"
        told.append((mark("planned calls that were not reached"), Formula(counted, missing), "0"))
    if known:
        most, first = max(known), min(known)
        late, early = (str(rows[deviations.index(value)][0]) for value in (most, first))
        told += [
            (mark("largest lateness [s]"), Formula(f"MAX(0,MAX({area}))", max(0.0, most)), "0.0"),
            (mark("train that is latest"), _train_of(f"MAX({area})", ">0", area, trains, late if most > 0.0 else ""), "any"),
            (mark("largest earliness [s]"), Formula(f"MAX(0,-MIN({area}))", max(0.0, -first)), "0.0"),
            (mark("train that is earliest"), _train_of(f"MIN({area})", "<0", area, trains, early if first < 0.0 else ""), "any"),
            (mark("mean deviation [s]"), Formula(f"AVERAGE({area})", total(known) / len(known)), "0.0"),
        ]
    if causes:
        for part in PARTS:
            value = total(row[block.column(part) - 1] for row in rows)
            label = tr("sum of {cause} [s]", cause=tr(cause_in_words(part)))
            told.append((label, Formula(f"SUM({block.cells(part)})", value), "0.0"))
    return told


def _train_of(which: str, test: str, area: str, trains: str, value: str) -> Formula:
    """Return the train of an extreme deviation; none where nobody is late, or early."""
    return Formula(f'IF({which}{test},INDEX({trains},MATCH({which},{area},0)),"")', value)


def _count(area: str, name: str, least_s: float, known: Sequence[float]) -> Formula:
    return Formula(f'COUNTIF({area},">="&{{{name}}})', sum(value >= least_s for value in known))
