"""The sheet of feasibility: the verdict on the timetable, and on each train, by formulas on the tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.figures.delays.delay_styles import cause_in_words
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.common.accepted import Accepted
from tractionpower.reporting.workbook.feasibility.sentences import live, sentence
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Block, Column, Page
from tractionpower.reporting.workbook.frame.rules import Rule

VERDICT, LEFT, LATE = "verdict", "reserve left [s]", "late at worst [s]"

FEASIBLE, INFEASIBLE = mark("feasible"), mark("infeasible")
NOT_FINISHED, NOT_JUDGED = mark("not finished"), mark("not judged")

LIMIT = "limit_tolerance_s"
"""Name of the cell that holds the tolerance."""

COUNT, RESERVE = "feasibility_late_trains", "feasibility_reserve_left_s"
"""Names of the cells that count the trains that are late or not there, and hold the least reserve."""

LATE_RANGE = "feasibility_late_s"

_COLUMNS = (
    Column("train", widest=18),
    Column(VERDICT, widest=12, key="verdict"),
    Column(LATE, "0.0", key="late"),
    Column("where it is latest", "beside", 16),
    Column("main cause", widest=14),
    Column("why", widest=54),
    Column(LEFT, "0.0", key="left"),
    Column("where the reserve is least", "beside", 22),
    Column("lost to low voltage [s]", "0.0"),
    Column("most of it in the area of", "beside", 14),
    Column("shortest running time [h:min:s]", "time"),
    Column("quality index (running-time ratio)", "0.000"),
    Column("mean useful voltage, weighted by current [V]", "0"),
    Column("mean useful voltage, mean over time [V]", "0"),
)

TIGHT_S = 10.0
"""A reserve that is smaller shows amber [s]."""

_LATE_TRAINS = mark("Infeasible: {late} of {all} trains late or not there")
_NONE_LATE = mark("Feasible: none of {all} trains is late")
_RESERVE = mark("; {seconds} s of reserve left at the tightest place")
_NO_RESERVE = mark("; no reserve is known")
_MISSING = mark("; {seconds} s are missing at the tightest place, which is within the tolerance of {tolerance} s")
_WORST = mark(". Worst: train {train}, {why}")


def add(book: Book) -> None:
    """Add the sheet, if the run was judged."""
    told = book.facts.feasibility
    if told is None:
        return
    page = book.page("Feasibility", "Is the timetable feasible on this supply?")
    _banner(page, *verdict_in_words(told))
    page.note(
        "A train is late if a timed arrival, departure or passing is later than planned by more than the tolerance, which can be"
        " edited on sheet Acceptance. Reserve left: by how much a train could come earlier than planned, driven flat out on the"
        " voltages of the run; negative: so much is missing. Quality index: running time on the voltages of the run by that at"
        " nominal voltage. Trains do not see each other; what one loses does not hold up another."
    )
    trains = _ordered(told["trains"], book)
    top = page.next
    page.next += 6
    tolerance = float(told["tolerance_s"])
    block = page.table(_COLUMNS, (_row(train, tolerance) for train in trains), frozen=True)
    book.define("feasibility_verdicts", page, block.cells("verdict"))
    book.define(LATE_RANGE, page, block.cells("late"))
    book.define("feasibility_reserves_s", page, block.cells("left"))
    _counts(book, page, top, (told, trains))
    _colour(book, block, tolerance)
    _tell_acceptance(book, told, trains)


def verdict_in_words(told: dict[str, Any]) -> tuple[Formula | str, str]:
    """Return the verdict on a timetable in a sentence that follows the tolerance, and the style that suits it now."""
    trains, late = len(told["trains"]), told["late_trains"]
    if told["verdict"] == "not judged":
        words = tr("Not judged: none of {all} trains comes to a call with a planned time within the time that counts", all=trains)
        return words, "doubt"
    good = tr(_NONE_LATE, all=trains)
    tail, more = _reserve(told)
    words = live(_LATE_TRAINS, {"late": f"{{{COUNT}}}"}, all=trains)
    if told["verdict"] == "feasible":
        shown = good + tail
    else:
        first = told.get("first")
        worst = tr(_WORST, train=first["train"], why=recorded(str(first["why"]))) if first else ""
        shown = tr(_LATE_TRAINS, late=late, all=trains) + worst
        words += f"&{sentence(worst, {})}"
    formula = f"IF({{{COUNT}}}>0,{words},{sentence(good, {})}&{more})"
    return Formula(formula, shown), "good" if told["verdict"] == "feasible" else "bad"


def _reserve(told: dict[str, Any]) -> tuple[str, str]:
    """Return what is told of the reserve where no train is late: as a text, and as a part of a live formula."""
    reserve = told.get("reserve_left_s")
    if reserve is None:
        words = tr(_NO_RESERVE)
        return words, sentence(words, {})
    missing = live(_MISSING, {"seconds": f"ROUND(-{{{RESERVE}}},1)", "tolerance": f"N({{{LIMIT}}})"})
    left = live(_RESERVE, {"seconds": f"ROUND({{{RESERVE}}},0)"})
    if reserve < 0.0:
        words = tr(_MISSING, seconds=number(math.floor(-reserve * 10.0 + 0.5) / 10.0), tolerance=number(told["tolerance_s"]))
    else:
        words = tr(_RESERVE, seconds=math.floor(reserve + 0.5))
    return words, f"IF({{{RESERVE}}}<0,{missing},{left})"


def _banner(page: Page, text: Formula | str, style: str) -> None:
    """Write the verdict large over the first columns; its colour follows the trains that are late."""
    shown = str(page.put(page.next, 1, text, f"big {style}"))
    page.sheet.merge_cells(start_row=page.next, start_column=1, end_row=page.next, end_column=7)
    page.sheet.row_dimensions[page.next].height = LINE_POINTS * 1.5 * (1 + len(shown) // 95) + 8.0
    if isinstance(text, Formula):
        for sign, colour in ((">0", RED_FILL), ("=0", GREEN_FILL)):
            rule = FormulaRule(formula=[f"{COUNT}{sign}"], fill=fill(colour))
            page.sheet.conditional_formatting.add(f"A{page.next}:G{page.next}", rule)
    page.next += 1


def _counts(book: Book, page: Page, row: int, told: tuple[dict[str, Any], Sequence[dict[str, Any]]]) -> None:
    """Write how many trains are late or not there, the tolerance, and the least reserve."""
    said, trains = told
    late = [train for train in trains if train["verdict"] in ("infeasible", "not finished")]
    reserves = [train["reserve_left_s"] for train in trains if train["reserve_left_s"] is not None]
    verdicts = "{feasibility_verdicts}"
    count = f'COUNTIF({verdicts},"{tr(INFEASIBLE)}")+COUNTIF({verdicts},"{tr(NOT_FINISHED)}")'
    lines: list[tuple[str, Any, str, str]] = [
        (tr("trains"), Formula(f"ROWS({verdicts})", len(trains)) if trains else 0, "0", ""),
        (tr("late or not there"), Formula(count, len(late)), "0", COUNT),
        (tr("tolerance [s]"), Formula(f"N({{{LIMIT}}})", float(said["tolerance_s"])), "0.0", ""),
    ]
    if reserves:
        least, tolerance = min(reserves), float(said["tolerance_s"])
        lines.append((tr("least reserve left [s]"), Formula("MIN({feasibility_reserves_s})", least), "0.0", RESERVE))
        with_it = Formula(f"{{{RESERVE}}}+N({{{LIMIT}}})", least + tolerance)
        lines.append((tr("least reserve left, tolerance included [s]"), with_it, "0.0", ""))
    for at, (label, value, style, name) in enumerate(lines, row):
        page.put(at, 1, label, "plain")
        page.put(at, 4, value, style)
        if name:
            book.define(name, page, f"D{at}")
        if name == RESERVE:
            page.put(at, 5, _of_reserve(least, tolerance, is_late=bool(late)), "plain")


def _of_reserve(least: float, tolerance: float, *, is_late: bool) -> Formula:
    """Return what a reserve below zero means for the verdict, as a formula."""
    within, missing = tr("negative: missing, but within the tolerance"), tr("negative: so much is missing")
    shown = "" if least >= 0.0 else missing if is_late or least < -tolerance else within
    text = f'IF({{{RESERVE}}}>=0,"",IF(OR({{{COUNT}}}>0,{{{RESERVE}}}<-N({{{LIMIT}}})),"{missing}","{within}"))'
    return Formula(text, shown)


def _tell_acceptance(book: Book, told: dict[str, Any], trains: Sequence[dict[str, Any]]) -> None:
    """Tell the sheet of acceptance how late a train is at most, and how many are not there."""
    late = [float(train["late_s"]) for train in trains if train["late_s"] is not None]
    missing = sum(train["verdict"] == "not finished" for train in trains)
    first = told.get("first") or {}
    place = tr("train {train}", train=first["train"]) if first else ""
    judged = told["verdict"] != "not judged"
    book.acceptance.append(
        Accepted(
            mark("greatest lateness at a timed call"), "tolerance_s", float(told["tolerance_s"]), "s", "at_most",
            Formula(f"MAX({{{LATE_RANGE}}})", max(late)) if late and judged else None, place, "", "user", "study",
        )
    )  # fmt: skip
    formula = Formula(f'COUNTIF({{feasibility_verdicts}},"{tr(NOT_FINISHED)}")', missing)
    book.acceptance.append(
        Accepted(
            mark("trains that do not come to their last timed call"), "unfinished_trains", 0.0, "", "at_most",
            formula if trains else None, "", "", "user", "study", mark("Timetable"),
        )
    )  # fmt: skip


def _ordered(trains: list[dict[str, Any]], book: Book) -> list[dict[str, Any]]:
    """Return the trains, those that fail first, the latest at the top; then by the reserve that is left."""
    names = book.facts.station_names

    def key(train: dict[str, Any]) -> tuple[Any, ...]:
        rank = ("not finished", "infeasible", "feasible", "not judged").index(train["verdict"])
        reserve = train["reserve_left_s"]
        return rank, -(train["late_s"] or 0.0) if rank < 2 else 0.0, float("inf") if reserve is None else reserve, train["train"]

    named = [train | {"worst_station": names.get(train["worst_station"]) or train["worst_station"]} for train in trains]
    return sorted(named, key=key)


def _row(train: dict[str, Any], tolerance_s: float) -> tuple[Any, ...]:
    late = train["late_s"]
    return (
        train["train"],
        _verdict(train, tolerance_s),
        late,
        train["worst_station"] if late else "",
        tr(cause_in_words(train["cause"])),
        recorded(train["why"]),
        train["reserve_left_s"],
        train["reserve_left_at"],
        train["lost_voltage_s"],
        train["lost_area"],
        train["shortest_s"],
        train["running_time_ratio"],
        train["mean_useful_voltage_current_weighted_v"],
        train["mean_useful_voltage_time_mean_v"],
    )


def _verdict(train: dict[str, Any], tolerance_s: float) -> Formula | str:
    """Return the verdict on a train as a formula, where it follows from its lateness alone."""
    late, word = train["late_s"], train["verdict"]
    if late is None or word != (INFEASIBLE if late > tolerance_s else FEASIBLE):
        return tr(word)
    return Formula(f'IF({{late}}>N({{{LIMIT}}}),"{tr(INFEASIBLE)}","{tr(FEASIBLE)}")', tr(word))


def _colour(book: Book, block: Block, tolerance_s: float) -> None:
    """Let verdicts show green and red by their word, delays red, reserves amber when small and red when missing."""
    add_rule = block.sheet.conditional_formatting.add
    for word, colour in ((FEASIBLE, GREEN_FILL), (INFEASIBLE, RED_FILL), (NOT_FINISHED, RED_FILL), (NOT_JUDGED, AMBER_FILL)):
        add_rule(block.cells(VERDICT), CellIsRule(operator="equal", formula=[f'"{tr(word)}"'], fill=fill(colour)))
    first = block.cell("late", block.first)
    word = block.cell("verdict", block.first)
    late = FormulaRule(formula=[f'AND(ISNUMBER({first}),{word}="{tr(INFEASIBLE)}")'], fill=fill(RED_FILL))
    add_rule(block.cells(LATE), late)
    colour_reserve(book, block, LEFT, tolerance_s)


def colour_reserve(book: Book, block: Block, heading: str, tolerance_s: float | None = None) -> None:
    """Let a reserve show red when it is missing, by more than the tolerance if one is given, and amber when it is small."""
    area = block.cells(heading)
    missing, values = ("{cell}<-0.05", {}) if tolerance_s is None else (f"{{cell}}<-N({{{LIMIT}}})-0.05", {LIMIT: tolerance_s})
    book.rules.append(Rule(block.sheet, area, missing, RED_FILL, values))
    book.rules.append(Rule(block.sheet, area, f"{{cell}}<{TIGHT_S:g}", AMBER_FILL))
