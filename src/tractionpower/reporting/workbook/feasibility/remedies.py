"""The sheet of what would save a timetable: changes that were searched and verified, and sensitivities of the lost seconds."""

from __future__ import annotations

from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.page import Column, Page

_COLUMNS = (
    Column("kind", widest=24),
    Column("subject", widest=28),
    Column("size"),
    Column("what", widest=50),
    Column("saves it"),
    Column("verified by a run"),
    Column("late after it, at worst [s]", "0.0"),
    Column("lost before, all trains [s]", "0.0"),
    Column("lost after [s]", "0.0"),
    Column("cost [points]", "0.0"),
    Column("as options of the command line", "beside", 56),
)
_SENSITIVITIES = (
    Column("what is changed", widest=24),
    Column("subject", widest=28),
    Column("by"),
    Column("as options of the command line", widest=52),
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
    words = (
        f"{len(savers)} changes make it feasible, the cheapest first" if savers else "Nothing within the bounds makes it feasible"
    )
    page.wrapped(f"{words}; {search['tried']} runs with the network.")
    for note in search["notes"]:
        page.note(note)
    if found:
        page.section("Changes")
        block = page.table(_COLUMNS, map(_row, found))
        for heading in ("saves it", "verified by a run"):
            for word, colour in (("yes", GREEN_FILL), ("no", RED_FILL)):
                rule = CellIsRule(operator="equal", formula=[f'"{word}"'], fill=fill(colour))
                block.sheet.conditional_formatting.add(block.cells(heading), rule)
    _sensitivities(page, told.get("sensitivities") or [])


def _row(remedy: dict[str, Any]) -> tuple[Any, ...]:
    return (
        remedy["kind"].replace("_", " "),
        remedy["subject"],
        f"{remedy['size']:+g} {remedy['unit']}"
        if remedy["kind"] == "departure_shift"
        else f"{remedy['size']:g} {remedy['unit']}",
        remedy["words"],
        remedy["feasible"],
        remedy["verified"],
        remedy["lateness_after_s"],
        remedy["lost_before_s"],
        remedy["lost_after_s"],
        remedy["cost"],
        " ".join(f"--set '{change}'" for change in remedy["changes"]),
    )


def _sensitivities(page: Page, rows: list[dict[str, Any]]) -> None:
    if not rows:
        return
    page.section("Sensitivities: how the seconds lost to low voltage change with small changes")
    page.note("Negative: less is lost. From runs with the network, one for each row.")
    page.table(_SENSITIVITIES, map(_sensitivity, rows))


def _sensitivity(row: dict[str, Any]) -> tuple[Any, ...]:
    change = " ".join(f"--set '{text}'" for text in row.get("change") or ())
    return row["kind"].replace("_", " "), row["subject"], row["per"], change, row["lost_s_change"]
