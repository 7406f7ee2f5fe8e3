"""The sheets of definitions: what figures and columns mean, what the model leaves out, how well the solver did."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of
from tractionpower.results.columns import TABLES

NOT_COVERED = (
    "Harmonics, electromagnetic compatibility, and the stability of input filters: voltages and currents are means of a step.",
    "Electric transients: a step is a steady state of the network; surges, arcs and breaker actions within it are not seen.",
    "Signals and other trains: trains do not see each other, are held by no signal and may overlap; overlaps are counted.",
    "The feeding grid: the no-load voltage of a substation does not depend on its own or another's load.",
    "Temperatures of conductors and of equipment, and what follows from them for resistances and ratings.",
    "Earthing, stray currents and rail potentials, where the study gives no leakage.",
    "Forces between vehicles, slip beyond the adhesion limit, wind, and the higher resistance at the moment of starting.",
)
"""What a reader must not take from the figures."""

_EVIDENCE = {
    "steps": "time steps computed",
    "flagged_steps": "flagged steps, in which some node does not balance",
    "worst_residual_a": "largest current that does not balance at a node [A]",
    "residual_limit_a": "largest that is accepted without a flag [A]",
    "mean_iterations": "mean number of iterations in a step",
    "wall_seconds": "wall time of the run [s]",
    "compile_seconds": "time to compile the kernels [s]",
    "seed": "seed of everything that is drawn",
}


def add(book: Book) -> None:
    """Add the sheets of the model and of the definitions."""
    page = book.page("Model", "The model: evidence of the solver, and what is not covered")
    page.section("Evidence")
    run = book.facts.run
    rows: list[tuple[Any, ...]] = [(words, run[name]) for name, words in _EVIDENCE.items() if run.get(name) is not None]
    page.table((Column("what", widest=60), Column("value", "general")), rows)
    page.section("What the model does not cover")
    for text in NOT_COVERED:
        page.wrapped(f"• {text}")
    page.section("Versions")
    page.table((Column("package", widest=60), Column("version")), sorted(run.get("versions", {}).items()))
    _definitions(book)


def _definitions(book: Book) -> None:
    page: Page = book.page("Definitions", "Definitions of key figures and columns")
    columns = (
        Column("where", widest=24),
        Column("quantity", widest=44),
        Column("unit"),
        Column("meaning", widest=90),
        Column("name in files", widest=44),
    )
    page.table(columns, (*_figures(book), *_columns()), frozen=True)


def _figures(book: Book) -> Iterator[tuple[str, ...]]:
    """Yield every key figure once for each definition that it has."""
    seen = set()
    for figure in book.facts.results.key_figures:
        key = (figure["name"], figure.get("definition", ""))
        if key not in seen:
            seen.add(key)
            yield "key figures", heading_of(key[0]).split(" [")[0], figure.get("unit", ""), key[1], key[0]


def _columns() -> Iterator[tuple[str, ...]]:
    for table, columns in TABLES.items():
        for column in columns:
            quantity = column.quantity
            yield f"table {table}", heading_of(quantity.name).split(" [")[0], quantity.unit, quantity.meaning, quantity.name
