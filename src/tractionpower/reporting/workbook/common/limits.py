"""The sheet of limits: what was found against what is allowed, with source and status of every value."""

from __future__ import annotations

from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, limit_in_words
from tractionpower.reporting.workbook.frame.page import Block, Column

MET, VIOLATED, OPEN = "met", "violated", "not judged"

_VERDICTS = (
    Column("what is judged", widest=36),
    Column("found", "0.0"),
    Column("unit"),
    Column("verdict"),
    Column("limit"),
    Column("limit value", "0.0"),
    Column("place", widest=30),
    Column("time of day"),
    Column("status of the limit", widest=24),
    Column("source of the limit", widest=50),
)


def add(book: Book) -> None:
    """Add the sheet of limits."""
    facts = book.facts
    page = book.page("Limits", "Limits: what was found against what is allowed")
    page.note(
        "A limit whose status is not 'verified' is an editable value of the limits table: the run is checked against that value,"
        " which is no statement about a standard. Sheet Inputs limits has all of them."
    )
    if facts.verdicts:
        colour_verdicts(page.table(_VERDICTS, map(_row, facts.verdicts), frozen=True))
    else:
        page.line("The run has no verdicts.")


def verdict_word(verdict: dict[str, Any]) -> str:
    """Return the verdict in a word."""
    return {True: MET, False: VIOLATED}.get(verdict["met"], OPEN)


def colour_verdicts(block: Block) -> None:
    """Let the verdicts show green, red or amber by their word."""
    area = block.cells("verdict")
    for word, colour in ((MET, GREEN_FILL), (VIOLATED, RED_FILL), (OPEN, AMBER_FILL)):
        rule = CellIsRule(operator="equal", formula=[f'"{word}"'], fill=fill(colour))
        block.sheet.conditional_formatting.add(area, rule)


def _row(verdict: dict[str, Any]) -> tuple[Any, ...]:
    status = verdict["status"]
    return (
        verdict["name"],
        verdict["value"],
        verdict["unit"],
        verdict_word(verdict),
        limit_in_words(verdict["limit"] or ""),
        verdict["limit_value"],
        verdict["place"],
        verdict["time"],
        KNOWN_AS.get(status, status),
        verdict["source"],
    )
