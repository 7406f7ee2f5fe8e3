"""The sheet of energies: the three ledgers with their sums as formulas."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import bars

WHAT, ENERGY = "what", "energy [kWh]"
_COLUMNS = (Column("side"), Column(WHAT, widest=60), Column(ENERGY, "0.00", widest=16))
GIVEN, SPENT = "given", "spent"

Part = tuple[str, str, str]

LEDGERS: dict[str, tuple[str, tuple[Part, ...]]] = {
    "electric": (
        "Electric: from the no-load voltage of the rectifiers to trains and loads",
        (
            (GIVEN, "source", "sum of E I"),
            (SPENT, "regulation", "regulation (E - U) I, mostly commutation drop and no loss"),
            (SPENT, "train", "trains, what they take less what they return"),
            (SPENT, "load", "fixed loads"),
            (SPENT, "conductor", "heat in contact lines, return circuit and feeders"),
        ),
    ),
    "pantograph_to_wheel": (
        "Pantograph to wheel: all trains",
        (
            (GIVEN, "line", "from the line, what they take less what they return"),
            (GIVEN, "recovered", "from the electric brake"),
            (SPENT, "wheel", "work at the wheel"),
            (SPENT, "drive_loss", "losses of the drives"),
            (SPENT, "starting_resistors", "heat in starting resistors"),
            (SPENT, "auxiliaries", "auxiliaries and heating"),
            (SPENT, "coupling", "what the constant-voltage coupling leaves out"),
        ),
    ),
    "mechanical": (
        "Mechanical: all trains",
        (
            (GIVEN, "wheel", "work at the wheel"),
            (SPENT, "kinetic", "kinetic energy, rotating masses included"),
            (SPENT, "potential", "potential energy"),
            (SPENT, "resistance", "running resistance, curves and tunnels"),
            (SPENT, "brakes", "brakes, electric and friction"),
        ),
    ),
}
"""Title and parts of each ledger, as ``run.json`` names them."""


RARE = ("coupling",)
"""Parts that stand there only when they are something."""


def add(book: Book) -> None:
    """Add the sheet of energies, if the run has ledgers."""
    told = book.facts.ledgers
    if not told:
        return
    page = book.page("Energy", "Energy: what goes in comes out")
    page.note("Sums and gaps are formulas. The program judges the ledgers by step and by train; see the cover.")
    drawn = None
    for name, (title, parts) in LEDGERS.items():
        if name in told:
            block = _ledger(page, title, parts, told[name])
            drawn = block if name == "electric" else drawn
    if drawn is not None:
        page.new_page()
        page.chart(bars("Electric energy", ENERGY, drawn, WHAT, [ENERGY]))


def _ledger(page: Page, title: str, parts: Sequence[Part], ledger: dict[str, Any]) -> Block:
    page.section(title)
    present = [part for part in parts if ledger.get(f"{part[1]}_kwh") or (part[1] not in RARE and f"{part[1]}_kwh" in ledger)]
    block = page.table(_COLUMNS, [(tr(side), tr(words), ledger[f"{name}_kwh"]) for side, name, words in present])
    sides, values = (f"{letter}{block.first}:{letter}{block.last}" for letter in "AC")
    given, spent = (sum(ledger[f"{name}_kwh"] for side, name, _ in present if side == which) for which in (GIVEN, SPENT))
    sums = [
        ("sum given", Formula(f'SUMIF({sides},"{tr(GIVEN)}",{values})', given), "sum 0.00"),
        ("sum spent", Formula(f'SUMIF({sides},"{tr(SPENT)}",{values})', spent), "sum 0.00"),
        ("gap", Formula(f"C{block.last + 1}-C{block.last + 2}", given - spent), "sum exponent"),
    ]
    page.next = block.last + 1
    for words, formula, style in sums:
        page.put(page.next, 2, tr(words), "sum text")
        page.put(page.next, 3, formula, style)
        page.next += 1
    page.next += 1
    return block
