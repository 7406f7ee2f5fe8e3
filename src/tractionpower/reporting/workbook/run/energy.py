"""The sheet of energy and losses: the balance, substations, categories of trains, and the ledgers, with sums as formulas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from openpyxl.utils import get_column_letter

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import bars
from tractionpower.reporting.workbook.run import balance
from tractionpower.reporting.workbook.run.sums import total

WHAT, ENERGY = mark("what"), mark("energy [kWh]")
_COLUMNS = (
    Column(WHAT, widest=64, key="what"),
    Column(ENERGY, "0.00", widest=16, key="energy"),
    Column("side", "beside", key="side"),
)
GIVEN, SPENT = mark("given"), mark("spent")

Part = tuple[str, str, str]

LEDGERS: dict[str, tuple[str, tuple[Part, ...]]] = {
    "electric": (
        mark("Electric: from the no-load voltage of the rectifiers to trains and loads"),
        (
            (GIVEN, "source", mark("sum of E I")),
            (SPENT, "regulation", mark("regulation (E - U) I, mostly commutation drop and no loss")),
            (SPENT, "train", mark("trains, what they take less what they return")),
            (SPENT, "load", mark("fixed loads")),
            (SPENT, "conductor", mark("heat in contact lines, return circuit and feeders")),
        ),
    ),
    "pantograph_to_wheel": (
        mark("Pantograph to wheel: all trains"),
        (
            (GIVEN, "line", mark("from the line, what they take less what they return")),
            (GIVEN, "recovered", mark("from the electric brake")),
            (SPENT, "wheel", mark("work at the wheel")),
            (SPENT, "drive_loss", mark("losses of the drives")),
            (SPENT, "starting_resistors", mark("heat in starting resistors")),
            (SPENT, "auxiliaries", mark("auxiliaries and heating")),
            (SPENT, "coupling", mark("what the constant-voltage coupling leaves out")),
        ),
    ),
    "mechanical": (
        mark("Mechanical: all trains"),
        (
            (GIVEN, "wheel", mark("work at the wheel")),
            (SPENT, "kinetic", mark("kinetic energy, rotating masses included")),
            (SPENT, "potential", mark("potential energy")),
            (SPENT, "resistance", mark("running resistance, curves and tunnels")),
            (SPENT, "brakes", mark("brakes, electric and friction")),
        ),
    ),
}
"""Title and parts of each ledger, as ``run.json`` names them."""


BESIDE_CM = 19.0
"""Width of the chart beside the ledgers."""

GAP_DIGITS = 6
"""Digits of a kWh behind the point that a gap is told with."""

RARE = ("coupling",)
"""Parts that stand there only when they are something."""


def add(book: Book) -> None:
    """Add the sheet of energies, if the run has ledgers."""
    told = book.facts.ledgers
    if not told:
        return
    page = book.page("Energy", "Energy and losses")
    page.note(
        "Sums, differences and shares are formulas. Without the warm-up, where there is one; the ledgers below are those of the"
        " whole run, which the program judges by step and by train: sheet Solver evidence."
    )
    balance.add(page)
    drawn = None
    page.new_page()
    beside = page.next + 1
    for name, (title, parts) in LEDGERS.items():
        if name in told:
            block = _ledger(page, title, parts, told[name])
            drawn = block if name == "electric" else drawn
    if drawn is not None:
        chart = bars(tr("Electric energy"), tr(ENERGY), drawn, WHAT, [ENERGY])
        chart.width = BESIDE_CM
        page.sheet.add_chart(chart, f"{get_column_letter(len(_COLUMNS) + 2)}{beside}")  # beside the ledgers: no page of its own


def _ledger(page: Page, title: str, parts: Sequence[Part], ledger: dict[str, Any]) -> Block:
    page.section(title)
    present = [part for part in parts if ledger.get(f"{part[1]}_kwh") or (part[1] not in RARE and f"{part[1]}_kwh" in ledger)]
    rows = [(tr(words), ledger[f"{name}_kwh"], tr(side)) for side, name, words in present]
    block = page.table(_COLUMNS, rows)
    sides, values = block.cells("side"), block.cells("energy")
    given, spent = (total(ledger[f"{name}_kwh"] for side, name, _ in present if side == which) for which in (GIVEN, SPENT))
    first = block.last + 1
    gap = f"{block.cell('energy', first)}-{block.cell('energy', first + 1)}"
    sums = [
        (mark("sum given"), Formula(f'SUMIF({sides},"{tr(GIVEN)}",{values})', given), "sum 0.00"),
        (mark("sum spent"), Formula(f'SUMIF({sides},"{tr(SPENT)}",{values})', spent), "sum 0.00"),
        # Without the rounding the last digit of the sums would decide, which every program adds up in its own way.
        (mark("gap"), Formula(f"ROUND({gap},{GAP_DIGITS})", round(given - spent, GAP_DIGITS)), "sum exponent"),
    ]
    page.next = first
    for words, formula, style in sums:
        page.put(page.next, 1, tr(words), "sum text")
        page.put(page.next, 2, formula, style)
        page.next += 1
    page.next += 1
    return block
