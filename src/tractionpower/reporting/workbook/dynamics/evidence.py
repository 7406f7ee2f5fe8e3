"""The sheet of evidence of a run of train dynamics: method, steps, closing of the energy ledger, files."""

from __future__ import annotations

from typing import Any

from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.common.evidence import CLOSES, OPEN, add_origin
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column

_WHAT = (Column("what", widest=68), Column("value", "general"), Column("unit", "beside"))

STATUSES = {
    "complete": mark("Complete: all steps were computed."),
    "flagged": mark("Flagged: the run is complete, but its energy ledger does not close."),
    "interrupted": mark("Interrupted: the run was stopped before its end; all sheets tell of the part that was computed."),
}


def add(book: Book) -> None:
    """Add the sheet."""
    facts = facts_of(book)
    run = facts.run
    page = book.page("Solver evidence", "Solver evidence: how far these figures can be trusted")
    status = str(run.get("status", ""))
    page.line(tr(STATUSES[status]) if status in STATUSES else status)
    if run.get("end_s") is not None:
        page.line(tr("Computed: {seconds} s of the train's time.", seconds=number(float(run["end_s"]), 3)))
    page.next += 1
    page.section("Integration")
    ledger = (run.get("ledgers") or {}).get("energy") or {}
    rows: list[tuple[str, Any, str, str]] = [
        (tr("method"), recorded(str(run.get("method", facts.scenario.case.run.method))), "", "any"),
        (tr("step, the longest one of a variable method"), run.get("step_s", facts.scenario.case.run.step_s), "s", "general"),
        (tr("steps computed"), run.get("steps"), "", "0"),
        (tr("steps cut where a vehicle came to a stand"), run.get("cut_steps"), "", "0"),
        (tr("steps of a variable method that were rejected"), run.get("rejected_steps"), "", "0"),
        (tr("recorded rows"), run.get("recorded_rows"), "", "0"),
        (tr("gap of the energy ledger"), ledger.get("gap_kwh"), "kWh", "exponent"),
        (tr("gap by the energy that was put in"), ledger.get("gap_share"), "", "exponent"),
        (tr("largest gap by the energy put in that closes"), ledger.get("limit_share"), "", "exponent"),
        (tr("judged by the program"), None if not ledger else tr(CLOSES) if ledger.get("closes") else tr(OPEN), "", "any"),
    ]
    known = [row for row in rows if row[1] is not None]
    block = page.table(_WHAT, [row[:3] for row in known])
    for k, (_, value, _, style) in enumerate(known):
        page.put(block.first + k, 2, value, style)
    page.note(
        "The ledger compares works that the kernel sums up with the kinetic energy of the states. Its gap falls with the"
        " step by the"
        " order of the method."
    )
    page.next += 1
    warnings = run.get("warnings") or []
    if warnings:
        page.section("Warnings")
        for warning in warnings:
            page.wrapped(recorded(str(warning)))
        page.next += 1
    add_origin(page, facts)
