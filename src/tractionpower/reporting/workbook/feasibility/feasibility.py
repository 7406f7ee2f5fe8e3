"""The sheet of feasibility: the verdict on the timetable, and on each train."""

from __future__ import annotations

from typing import Any

from openpyxl.formatting.rule import CellIsRule, FormulaRule

from tractionpower.reporting.figures.delays.delay_styles import cause_in_words
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill, put
from tractionpower.reporting.workbook.frame.page import LINE_POINTS, Block, Column, Page

VERDICT, LEFT, LATE = "verdict", "reserve left [s]", "late at worst [s]"

_COLUMNS = (
    Column("train", widest=24),
    Column(VERDICT),
    Column(LATE, "0.0"),
    Column("where it is latest", "beside", 22),
    Column("main cause", widest=18),
    Column("why", widest=46),
    Column(LEFT, "0.0"),
    Column("where the reserve is least", "beside", 24),
    Column("lost to low voltage [s]", "0.0"),
    Column("most of it in the area of", "beside", 20),
    Column("shortest running time [h:min:s]", "time"),
    Column("quality index (running-time ratio)", "0.000"),
    Column("mean useful voltage, weighted by current [V]", "0"),
    Column("mean useful voltage, mean over time [V]", "0"),
)

TIGHT_S = 10.0
"""A reserve that is smaller shows amber [s]."""


def add(book: Book) -> None:
    """Add the sheet, if the run was judged."""
    told = book.facts.feasibility
    if told is None:
        return
    page = book.page("Feasibility", "Is the timetable feasible on this supply?")
    sentence, style = verdict_in_words(told)
    _banner(page, sentence, style)
    page.note(
        f"A train is late if a timed arrival, departure or passing is more than {told['tolerance_s']:g} s after its planned time."
        " Reserve left: by how much a train could come earlier than planned, driven flat out on the voltages of the run;"
        " negative: so much is missing. Quality index: running time on the voltages of the run by that at nominal voltage."
        " Trains do not see each other; what one loses does not hold up another."
    )
    block = page.table(_COLUMNS, map(_row, _ordered(told["trains"], book)), frozen=True)
    _colour(block, float(told["tolerance_s"]))


def verdict_in_words(told: dict[str, Any]) -> tuple[str, str]:
    """Return the verdict on a timetable in a sentence, and the style that suits it."""
    trains, late = len(told["trains"]), told["late_trains"]
    if told["verdict"] == "not judged":
        return f"Not judged: none of {trains} trains comes to a call with a planned time within the time that counts", "doubt"
    if told["verdict"] == "feasible":
        reserve = told.get("reserve_left_s")
        words = "no reserve is known" if reserve is None else f"{reserve:.0f} s of reserve left at the tightest place"
        if reserve is not None and reserve < 0.0:
            words = (
                f"{-reserve:.1f} s are missing at the tightest place, which is within the tolerance of {told['tolerance_s']:g} s"
            )
        return f"Feasible: none of {trains} trains is late; {words}", "good"
    first = told.get("first")
    worst = f". Worst: train {first['train']}, {first['why']}" if first else ""
    return f"Infeasible: {late} of {trains} trains late or not there{worst}", "bad"


def _banner(page: Page, text: str, style: str) -> None:
    put(page.sheet, page.next, 1, text, page.styles[f"big {style}"])
    page.sheet.merge_cells(start_row=page.next, start_column=1, end_row=page.next, end_column=7)
    page.sheet.row_dimensions[page.next].height = LINE_POINTS * 1.5 * (1 + len(text) // 95) + 8.0
    page.next += 1


def _ordered(trains: list[dict[str, Any]], book: Book) -> list[dict[str, Any]]:
    """Return the trains, those that fail first, the latest at the top; then by the reserve that is left."""
    names = book.facts.station_names

    def key(train: dict[str, Any]) -> tuple[Any, ...]:
        rank = ("not finished", "infeasible", "feasible", "not judged").index(train["verdict"])
        reserve = train["reserve_left_s"]
        return rank, -(train["late_s"] or 0.0) if rank < 2 else 0.0, float("inf") if reserve is None else reserve, train["train"]

    named = [train | {"worst_station": names.get(train["worst_station"]) or train["worst_station"]} for train in trains]
    return sorted(named, key=key)


def _row(train: dict[str, Any]) -> tuple[Any, ...]:
    late = train["late_s"]
    return (
        train["train"],
        train["verdict"],
        late,
        train["worst_station"] if late else "",
        cause_in_words(train["cause"]),
        train["why"],
        train["reserve_left_s"],
        train["reserve_left_at"],
        train["lost_voltage_s"],
        train["lost_area"],
        train["shortest_s"],
        train["running_time_ratio"],
        train["mean_useful_voltage_current_weighted_v"],
        train["mean_useful_voltage_time_mean_v"],
    )


def _colour(block: Block, tolerance_s: float) -> None:
    """Let verdicts show green and red by their word, delays red, reserves amber when small and red when missing."""
    add_rule = block.sheet.conditional_formatting.add
    for word, colour in (
        ("feasible", GREEN_FILL),
        ("infeasible", RED_FILL),
        ("not finished", RED_FILL),
        ("not judged", AMBER_FILL),
    ):
        add_rule(block.cells(VERDICT), CellIsRule(operator="equal", formula=[f'"{word}"'], fill=fill(colour)))
    late = CellIsRule(operator="greaterThan", formula=[f"{tolerance_s:g}"], fill=fill(RED_FILL))
    add_rule(block.cells(LATE), late)
    colour_reserve(block, LEFT)


def colour_reserve(block: Block, heading: str) -> None:
    """Let a reserve show red when it is missing, amber when it is small."""
    area = block.cells(heading)
    first = area.split(":")[0]
    for limit, colour in (("-0.05", RED_FILL), (f"{TIGHT_S:g}", AMBER_FILL)):
        rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}<{limit})"], stopIfTrue=True, fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)
