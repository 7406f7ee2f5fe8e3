"""The sheet of what would save a timetable: changes that were searched and verified, and sensitivities of the lost seconds."""

from __future__ import annotations

from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.texts import mark, recorded, tr, trn
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page

KINDS = {
    "departure_shift": mark("departure shift"), "current_cap": mark("current cap"), "power_cap": mark("power cap"),
    "headway": mark("headway"), "reserve": mark("later planned times"), "driving": mark("driving"),
    "no_load_voltage": mark("no-load voltage"), "internal_resistance": mark("internal resistance"), "units": mark("units"),
    "section_cabin": mark("section cabin"),
}  # fmt: skip
"""Kinds of changes in words; others as they are called."""

YES, NO = mark("yes"), mark("no")

_COLUMNS = (
    Column("kind", widest=18),
    Column("subject", widest=18),
    Column("size", widest=10),
    Column("what", widest=44),
    Column("saves it", widest=6),
    Column("verified by a run", widest=8),
    Column("late after it, at worst [s]", "0.0"),
    Column("lost before, all trains [s]", "0.0", key="before"),
    Column("lost after [s]", "0.0", key="after"),
    Column("saved [s]", "0.0"),
    Column("cost [points]", "0.0"),
    Column("as options of the command line", "beside", 50),
)
_SENSITIVITIES = (
    Column("what is changed", widest=18),
    Column("subject", widest=18),
    Column("by how much", widest=10),
    Column("as options of the command line", widest=44),
    Column("change of loss, all trains [s]", "0.00"),
)


def add(book: Book) -> None:
    """Add the sheet, if a search was made."""
    told = book.facts.feasibility
    if told is None or "search" not in told:
        return
    page = book.page("What would save it", "What would save the timetable")
    search, found = told["search"], told.get("remedies") or []
    savers = [remedy for remedy in found if remedy["feasible"]]
    words = tr("Nothing within the bounds makes it feasible")
    if savers:
        words = trn("{count} change makes it feasible", "{count} changes make it feasible, the cheapest first", len(savers))
    page.wrapped(tr("{words}; {runs} runs with the network.", words=words, runs=search["tried"]))
    for note in search["notes"]:
        page.note(recorded(note))
    if found:
        page.section("Changes")
        block = page.table(_COLUMNS, map(_row, found))
        for heading in ("saves it", "verified by a run"):
            for word, colour in ((YES, GREEN_FILL), (NO, RED_FILL)):
                rule = CellIsRule(operator="equal", formula=[f'"{tr(word)}"'], fill=fill(colour))
                block.sheet.conditional_formatting.add(block.cells(heading), rule)
    _sensitivities(page, told.get("sensitivities") or [])


def _row(remedy: dict[str, Any]) -> tuple[Any, ...]:
    before, after = remedy["lost_before_s"], remedy["lost_after_s"]
    sign = "+" if remedy["kind"] == "departure_shift" else ""
    return (
        kind_in_words(remedy["kind"]),
        remedy["subject"],
        f"{remedy['size']:{sign}g} {remedy['unit']}",
        recorded(remedy["words"]),
        tr(YES if remedy["feasible"] else NO),
        tr(YES if remedy["verified"] else NO),
        remedy["lateness_after_s"],
        before,
        after,
        None if before is None or after is None else Formula("{before}-{after}", before - after),
        remedy["cost"],
        " ".join(f"--set '{change}'" for change in remedy["changes"]),
    )


def kind_in_words(kind: str) -> str:
    """Return the kind of a change in words.

    >>> kind_in_words("departure_shift")
    'departure shift'
    """
    return " + ".join(tr(KINDS[part]) if part in KINDS else part.replace("_", " ") for part in map(str.strip, kind.split("+")))


def _sensitivities(page: Page, rows: list[dict[str, Any]]) -> None:
    if not rows:
        return
    page.section("Sensitivities: how the seconds lost to low voltage change with small changes")
    page.note("Negative: less is lost. From runs with the network, one for each row.")
    page.table(_SENSITIVITIES, map(_sensitivity, rows))


def _sensitivity(row: dict[str, Any]) -> tuple[Any, ...]:
    change = " ".join(f"--set '{text}'" for text in row.get("change") or ())
    return kind_in_words(row["kind"]), row["subject"], row["per"], change, row["lost_s_change"]
