"""The sheet of coupling forces: extremes of each coupling, the greatest of each kind by formulas, shares of what is endured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from openpyxl.utils import get_column_letter

from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.reporting.facts.measures import METRIC
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.accepted import accepted_of, cell_names
from tractionpower.reporting.workbook.common.verdicts import same_as
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import SIDES, ChainFacts, facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.rules import Rule

GROUP = mark("Couplings")
"""Group of the rows of the sheet of acceptance."""

_KINDS = (
    Column("kind of coupling", widest=18, key="kind"),
    Column("how many", "0", key="count"),
    Column("greatest tension [kN]", "0.0", key="tension"),
    Column("tension at coupling", "beside", key="tension_at"),
    Column("endurable tension [kN]", "0.0", key="tension_limit"),
    Column("used of endurable tension [%]", "0.0", key="tension_used"),
    Column("greatest compression [kN]", "0.0", key="compression"),
    Column("compression at coupling", "beside", key="compression_at"),
    Column("endurable compression [kN]", "0.0", key="compression_limit"),
    Column("used of endurable compression [%]", "0.0", key="compression_used"),
    Column("work taken in [kJ]", "0.0", key="absorbed"),
)
_COUPLINGS = (
    Column("vehicles", widest=18, key="name"),
    Column("no.", "0", key="number"),
    Column("greatest tension [kN]", "0.0", key="tension"),
    Column("tension at [s]", "0.00"),
    Column("used of endurable tension [%]", "0.0", key="tension_used"),
    Column("greatest compression [kN]", "0.0", key="compression"),
    Column("compression at [s]", "0.00"),
    Column("used of endurable compression [%]", "0.0", key="compression_used"),
    Column("work taken in [kJ]", "0.00", key="absorbed"),
    Column("of it by the damper [kJ]", "0.00"),
    Column("damage, relative", "0.0000"),
)
_WHICH = (Column("kind of coupling", "beside", widest=18, key="kind"), Column("between", "beside", widest=24))

FULL_PERCENT = 100.0


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if the run has extremes of couplings; it tells the sheet of acceptance what it found."""
    facts = facts_of(book)
    if not len(facts.data.extremes):
        return
    page = book.page("Coupling forces", "Greatest forces of the couplings")
    page.note(
        "Extremes of all steps, not of the recorded rows alone. Tension and compression are positive numbers here. What a"
        " coupling"
        " endures is on sheet Acceptance, where it can be edited. Damage: rainflow ranges to the power of 3, over the"
        " greatest such"
        " sum of all couplings; an index of the program, no life."
    )
    page.section("Kinds of couplings")
    kinds = facts.kinds
    top = page.next
    page.next = top + len(kinds) + 2
    page.section("Couplings from the front of the train")
    rows = list(_rows(facts, top + 1))
    block = page.table((*_COUPLINGS, *_own_columns(facts), *_WHICH), rows)
    after, page.next = page.next, top
    whole = page.table(_KINDS, list(_kind_rows(facts, kinds, block, rows)))
    page.next = after
    page.sheet.freeze_panes = None
    for found in (block, whole):
        for side in SIDES:
            book.rules.append(Rule(page.sheet, found.cells(f"{side}_used"), f"{{cell}}>{FULL_PERCENT:g}", RED_FILL))
    _judge(book, facts, whole, kinds)
    drawn.blocks["extremes"] = block


def _rows(facts: ChainFacts, first_kind: int) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of the couplings; `first_kind` is the row of the first kind in the table above."""
    data = facts.data
    order = {kind.id: number for number, kind in enumerate(facts.kinds)}
    limit_columns = {side: get_column_letter(_number_of(_KINDS, f"{side}_limit")) for side in SIDES}
    for k, row in enumerate(data.extremes.to_dict("records")):
        kind = data.coupling_of(k)
        used: dict[str, Formula | None] = {}
        for side in SIDES:
            limit = None if kind is None else getattr(kind, f"endurable_{side}_kn")
            cell = f"{limit_columns[side]}{first_kind + order[kind.id]}" if kind is not None else ""
            used[side] = None if not cell else _used(f"{{{side}}}", cell, float(row[f"greatest_{side}_kn"]), limit)
        between = tr("{front} and {rear}", front=_vehicle(facts, k), rear=_vehicle(facts, k + 1))
        yield (
            str(row["coupling"]), k + 1, row["greatest_tension_kn"], row["tension_at_s"], used["tension"],
            row["greatest_compression_kn"], row["compression_at_s"], used["compression"], row["absorbed_kj"],
            row.get("damper_kj"), row["damage"], *_own_units(facts, row), None if kind is None else kind.id, between,
        )  # fmt: skip


def _own_columns(facts: ChainFacts) -> tuple[Column, ...]:
    """Return columns of the forces in the unit of the case, where that is another than that of the tables."""
    unit = facts.data.units["force"].unit
    if unit == METRIC["force"].unit:
        return ()
    words = {"tension": mark("tension [{unit}]"), "compression": mark("compression [{unit}]")}
    return tuple(Column(tr(words[side], unit=unit), "0.0", key=f"own_{side}") for side in SIDES)


def _own_units(facts: ChainFacts, row: Mapping[Any, Any]) -> tuple[Formula, ...]:
    """Return what stands there."""
    per = facts.data.units["force"].per
    sides = SIDES if _own_columns(facts) else ()
    return tuple(Formula(f"{{{side}}}*{per:.12g}", float(row[f"greatest_{side}_kn"]) * per) for side in sides)


def _used(found: str, limit: str, value: float, known: float | None) -> Formula:
    share = "" if known is None else FULL_PERCENT * value / known
    return Formula(f'IF(ISNUMBER({limit}),100*{found}/{limit},"")', share)


def _vehicle(facts: ChainFacts, number: int) -> str:
    names = facts.data.vehicles if facts.data.has("vehicles") else [part.id for part in facts.data.parts]
    return names[number] if number < len(names) else ""


def _number_of(columns: Sequence[Column], key: str) -> int:
    return next(number for number, column in enumerate(columns, 1) if column.key == key)


def _kind_rows(
    facts: ChainFacts, kinds: Sequence[Coupling], block: Block, rows: Sequence[Sequence[Any]]
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of the kinds: the greatest of their couplings, and which it is, by formulas."""
    keys = [str(verdict["limit"]) for verdict in facts.verdicts]
    cells = dict(zip(keys, cell_names(map(accepted_of, facts.verdicts)), strict=True))
    names = [row[0] for row in rows]
    is_of = block.cells("kind")
    for kind in kinds:
        own = np.array([row[-2] == kind.id for row in rows])
        told: dict[str, tuple[Any, ...]] = {}
        for side in SIDES:
            values = np.array([row[block.column(side) - 1] for row in rows], float)
            best = float(np.where(own, values, 0.0).max(initial=0.0))
            first = int(np.where(own & (values == best), -np.arange(len(values)), -len(values)).argmax())
            told[side] = (
                Formula(f"SUMPRODUCT(MAX(({is_of}={{kind}})*{block.cells(side)}))", best),
                Formula(_place(block, side, len(rows)), names[first] if best > 0.0 else ""),
                _limit(facts, kind, side, cells),
                _used(f"{{{side}}}", f"{{{side}_limit}}", best, getattr(kind, f"endurable_{side}_kn")),
            )
        work = float(sum(row[block.column("absorbed") - 1] for row, is_own in zip(rows, own, strict=True) if is_own))
        yield (
            kind.id, Formula(f"SUMPRODUCT(({is_of}={{kind}})*1)", int(own.sum())), *told["tension"], *told["compression"],
            Formula(f"SUMPRODUCT(({is_of}={{kind}})*{block.cells('absorbed')})", work),
        )  # fmt: skip


def _place(block: Block, side: str, count: int) -> str:
    """Return the formula of the first coupling of a kind that has its greatest force."""
    here = f"({block.cells('kind')}={{kind}})*({block.cells(side)}={{{side}}})"
    number = f"{count + 1}-SUMPRODUCT(MAX({here}*({count + 1}-{block.cells('number')})))"
    return f'IF({{{side}}}>0,INDEX({block.cells("name")},{number}),"")'


def _limit(facts: ChainFacts, kind: Coupling, side: str, cells: Mapping[str, str]) -> Any:
    """Return what a kind endures: the same as on the sheet of acceptance, where that judges it."""
    value = getattr(kind, f"endurable_{side}_kn")
    verdict = facts.verdict_of(kind.id, side)
    if verdict is None or value is None:
        return value
    return Formula(same_as(f"{{{cells[str(verdict['limit'])]}}}"), value)


def _judge(book: Book, facts: ChainFacts, whole: Block, kinds: Sequence[Coupling]) -> None:
    """Tell the sheet of acceptance what was found, each by a named cell of the table of kinds."""
    page = next(page for page in book.pages if page.sheet is whole.sheet)
    for k, kind in enumerate(kinds):
        for side in SIDES:
            name = book.define(f"coupling_{side}_{k + 1}", page, whole.cell(side, whole.first + k))
            verdict = facts.verdict_of(kind.id, side)
            if verdict is not None:
                found = _found(page, whole, side, k)
                row = replace(accepted_of(verdict), found=Formula(f"{{{name}}}", found), group=GROUP)
                book.acceptance.append(row)


def _found(page: Page, whole: Block, side: str, number: int) -> float:
    """Return what the formula of a kind comes to."""
    return float(page.sheet[whole.cell(side, whole.first + number)].value or 0.0)
