"""The sheet of rainflow cycles: what each coupling has had, and how many cycles there were by range."""

from __future__ import annotations

from typing import Any

import numpy as np

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page

CLASSES = 20
"""Classes of the range."""

_COUPLINGS = (
    Column("vehicles", widest=26),
    Column("cycles", "0.0", key="cycles"),
    Column("greatest range [kN]", "0.0", key="range"),
    Column("mean of that cycle [kN]", "0.0"),
    Column("damage, relative", "0.0000"),
)


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if cycles were counted."""
    data = facts_of(book).data
    if not data.has("rainflow"):
        return
    page = book.page("Rainflow", "Cycles of the forces of couplings, by rainflow counting")
    page.note(
        "Counting after ASTM E1049; half cycles count 0.5. Cycles stand in classes of range and mean; a class is told by"
        " its upper"
        " end and its middle. The relative damage is an index of the program from the cycles before they are classed:"
        " ranges to the"
        " power of 3, over the greatest sum of all couplings."
    )
    page.section("Couplings from the front of the train")
    _couplings(page, data)
    page.section(tr("Cycles by range: the first, the most loaded and the last coupling"))
    _classes(page, data)


def _couplings(page: Page, data: ChainData) -> None:
    rows = data.table("rainflow")
    by_coupling = dict(list(rows.groupby(rows["coupling"].astype(str), sort=False)))
    damage = dict(zip(data.couplings, data.extremes["damage"], strict=True)) if len(data.extremes) else {}
    told: list[tuple[Any, ...]] = []
    for name in data.couplings:
        own = by_coupling.get(name)
        if own is None or own.empty:
            told.append((name, 0.0, None, None, damage.get(name)))
            continue
        most = int(own["range_kn"].to_numpy(float).argmax())
        told.append((name, own["cycles"].sum(), own["range_kn"].iloc[most], own["mean_kn"].iloc[most], damage.get(name)))
    page.table(_COUPLINGS, told)


def _classes(page: Page, data: ChainData) -> None:
    rows = data.table("rainflow")
    names = rows["coupling"].astype(str)
    shown = data.chosen_couplings()
    edges = np.linspace(0.0, _rounded(float(rows["range_kn"].max())), CLASSES + 1)
    columns = [Column(mark("range from [kN]"), "0.0", key="from"), Column(mark("to [kN]"), "0.0", key="to")]
    columns += [Column(tr("cycles of {coupling}", coupling=data.couplings[k]), "0.0", key=f"cycles{k}") for k in shown]
    counts = []
    for k in shown:
        own = rows[names == data.couplings[k]]
        counts.append(np.histogram(own["range_kn"].to_numpy(float), edges, weights=own["cycles"].to_numpy(float))[0])
    block = page.table(columns, zip(edges[:-1], edges[1:], *counts, strict=True))
    page.put(block.last + 1, 1, tr("sum"), "sum text")
    page.put(block.last + 1, 2, None, "sum text")
    for k, values in zip(shown, counts, strict=True):
        key = f"cycles{k}"
        page.put(block.last + 1, block.column(key), Formula(f"SUM({block.cells(key)})", float(values.sum())), "sum 0.0")
    page.next = block.last + 3


def _rounded(value: float) -> float:
    """Return a round number that is not below a value.

    >>> _rounded(613.2), _rounded(0.0)
    (700.0, 1.0)
    """
    if value <= 0.0:
        return 1.0
    size = 10.0 ** np.floor(np.log10(value))
    return float(np.ceil(value / size) * size)
