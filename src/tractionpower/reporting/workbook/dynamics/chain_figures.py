"""The sheet of key figures of train dynamics, each with its definition."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.reporting.facts.measures import METRIC, Measure
from tractionpower.reporting.texts import decimal, recorded, tr
from tractionpower.reporting.workbook.dynamics.chain_facts import ChainFacts
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, heading_of

_VALUE = (Column("figure", widest=34), Column("value", "0.0000", key="value"), Column("unit", "beside"))
_OWN = (Column("in the units of the case", "0.0000", key="own"), Column("unit of the case", "beside", key="own_unit"))
_WHERE = (
    Column("place", "beside", widest=24),
    Column("time since the start", "beside", widest=14),
    Column("definition", "beside", widest=50),
)

QUANTITIES = {"km/h": "speed", "kN": "force", "m/s²": "acceleration", "m": "distance", "mm": "deflection", "bar": "pressure"}
"""Quantities by their units in the tables."""


def add(book: Book) -> None:
    """Add the sheet, if the run has key figures."""
    figures = book.computed.results.key_figures
    if not figures:
        return
    page = book.page("Key figures", "Key figures")
    page.note(
        "A figure without a place is that of the whole run. Values of the file key_figures.json, which has all digits; its names"
        " are on sheet Definitions."
    )
    units = book.subject.data.units if isinstance(book.subject, ChainFacts) else METRIC
    both = units is not METRIC
    columns = (*_VALUE, *(_OWN if both else ()), *_WHERE)
    page.table(columns, [_row(figure, units if both else None) for figure in figures], frozen=True)


def _row(figure: dict[str, Any], units: Mapping[str, Measure] | None) -> tuple[Any, ...]:
    """Return the row of a figure; `units`: those of a case that has others than the tables."""
    unit = str(figure.get("unit", ""))
    own: tuple[Any, ...] = () if units is None else (None, "")
    measure = (units or {}).get(QUANTITIES.get(unit, ""))
    if measure is not None and measure.unit != unit and figure["value"] is not None:
        own = Formula(f"{{value}}*{measure.per:.12g}", figure["value"] * measure.per), measure.unit
    return (
        heading_of(str(figure["name"])).split(" [")[0],
        figure["value"],
        unit,
        *own,
        recorded(str(figure.get("place") or "")) or tr("whole run"),
        decimal(str(figure.get("time") or "")),
        recorded(figure.get("definition", "")),
    )
