"""The sheet of energies: what was put in, where it went, by how much the ledger does not close."""

from __future__ import annotations

from typing import Any

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import bars
from tractionpower.reporting.workbook.run.sums import total

WHAT, ENERGY = mark("what"), mark("energy [kWh]")
_COLUMNS = (
    Column(WHAT, widest=64, key="what"),
    Column(ENERGY, "0.0000", widest=16, key="energy"),
    Column("side", "beside", key="side"),
    Column("of what was put in [%]", "0.00", key="share"),
)
PUT_IN, TAKEN = mark("put in"), mark("taken")

PARTS = (
    ("traction", PUT_IN, mark("work of the tractive effort")),
    ("kinetic_start", PUT_IN, mark("kinetic energy at the start, with rotating parts")),
    ("resistance", TAKEN, mark("running, curve and tunnel resistance")),
    ("brake", TAKEN, mark("air brakes")),
    ("electric", TAKEN, mark("electric brakes")),
    ("gravity", TAKEN, mark("gravity; negative downhill")),
    ("coupling", TAKEN, mark("couplings, with what their springs hold at the end")),
    ("kinetic_end", TAKEN, mark("kinetic energy at the end, with rotating parts")),
)
"""Parts of the ledger by their names in ``run.json``."""

GAP_DIGITS = 9
"""Digits of a kWh behind the point that a gap is told with."""

PUT_IN_CELL = "energy_put_in"


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if the run has its ledger."""
    ledger: dict[str, Any] | None = (facts_of(book).run.get("ledgers") or {}).get("energy")
    if not ledger:
        return
    page = book.page("Energy", "Energies of the train")
    page.note(
        "Works are sums over the steps of force times speed, with the weights of the method. Sums, shares and the closing"
        " error are"
        " formulas. What was put in: traction, kinetic energy at the start, and what a descent gives."
    )
    block = _ledger(page, ledger)
    page.new_page_for_chart()
    page.chart(bars(tr("Energies"), tr(ENERGY), block, WHAT, [ENERGY]))


def _ledger(page: Page, ledger: dict[str, Any]) -> Block:
    present = [(name, side, words, float(ledger[f"{name}_kwh"])) for name, side, words in PARTS if f"{name}_kwh" in ledger]
    put_in = max(_of(present, "traction"), 0.0) + _of(present, "kinetic_start") + max(-_of(present, "gravity"), 0.0)
    first = page.next + 1
    rows = []
    for _, side, words, value in present:
        share = 100.0 * value / put_in if put_in > 0.0 else ""
        rows.append((tr(words), value, tr(side), Formula(f'IF({{{PUT_IN_CELL}}}>0,100*{{energy}}/{{{PUT_IN_CELL}}},"")', share)))
    block = page.table(_COLUMNS, rows)
    at = {name: block.cell("energy", first + number) for number, (name, *_) in enumerate(present)}
    sides, values = block.cells("side"), block.cells("energy")
    sums = {side: total(value for _, own, _, value in present if own == side) for side in (PUT_IN, TAKEN)}
    row = block.last + 1
    gap = f"{block.cell('energy', row)}-{block.cell('energy', row + 1)}"
    whole = f"MAX({at['traction']},0)+{at['kinetic_start']}+MAX(-{at['gravity']},0)"
    error = abs(sums[PUT_IN] - sums[TAKEN]) / put_in * 100.0 if put_in > 0.0 else 0.0
    lines = (
        (mark("sum put in"), Formula(f'SUMIF({sides},"{tr(PUT_IN)}",{values})', sums[PUT_IN]), "sum 0.0000"),
        (mark("sum taken"), Formula(f'SUMIF({sides},"{tr(TAKEN)}",{values})', sums[TAKEN]), "sum 0.0000"),
        (mark("gap [kWh]"), Formula(f"ROUND({gap},{GAP_DIGITS})", round(sums[PUT_IN] - sums[TAKEN], GAP_DIGITS)), "sum exponent"),
        (mark("put in, with what a descent gives [kWh]"), Formula(whole, put_in), "sum 0.0000"),
        (
            mark("closing error of the ledger [%]"),
            Formula(f"IF({{{PUT_IN_CELL}}}>0,ROUND(100*ABS({gap})/{{{PUT_IN_CELL}}},{GAP_DIGITS}),0)", round(error, GAP_DIGITS)),
            "sum exponent",
        ),
    )
    for words, formula, style in lines:
        page.put(row, 1, tr(words), "sum text")
        page.put(row, 2, formula, style)
        row += 1
    page.book.define(PUT_IN_CELL, page, f"B{row - 2}")
    page.next = row + 1
    return block


def _of(parts: list[tuple[str, str, str, float]], name: str) -> float:
    return next((value for own, _, _, value in parts if own == name), 0.0)
