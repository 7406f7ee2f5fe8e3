"""The workbook of a comparison: figures of several folders side by side, verdicts, inputs that differ, charts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.formatting.rule import CellIsRule
from openpyxl.styles import Font

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.input_words import input_in_words, value_in_words
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common import acceptance, assumptions, definitions, evidence, not_covered
from tractionpower.reporting.workbook.common.cover import fill_in
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.reporting.workbook.variants.compare_charts import Sheets, add_charts
from tractionpower.reporting.workbook.variants.compare_cover import colour_verdicts, head, notes, verdicts
from tractionpower.reporting.workbook.variants.compare_verdicts import add_verdicts
from tractionpower.results.results import Results
from tractionpower.studies.sweep.cases import number_of

SHEETS = (
    (mark("Run"), mark("Figures of the runs as a whole"), ""),
    (mark("Substations"), mark("Figures of substations"), "substation "),
    (mark("Trains"), mark("Figures of trains"), "train "),
    (mark("Zones"), mark("Mean useful voltages of zones"), "zone "),
    (mark("Cases"), mark("Figures of cases"), "case "),
    (mark("Other devices"), mark("Figures of feeders, switches, loads and other devices"), None),
)
"""Sheets of figures: name, title, what their places begin with; the last takes all others."""

GREAT_PERCENT = 5.0
"""Differences that are greater than this are bold [%]."""


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book = Book(_facts(results, scenario), report)
    folders = [str(entry["name"]) for entry in results.run["compare"]["folders"]]
    front = book.page("Cover", shorten(tr("{study}: comparison", study=book.facts.study), TITLE_LENGTH))
    add_verdicts(book, folders)
    _inputs(book, folders)
    rows = results.table("compare")
    rows = rows.astype({name: str for name in ("figure", "place", "unit", "folder", "at")})
    sheets = Sheets()
    begins = tuple(prefix for _, _, prefix in SHEETS if prefix)
    for name, title, prefix in SHEETS:
        is_own = ~rows["place"].str.startswith(begins) & (rows["place"] != "") if prefix is None else rows["place"] == ""
        own = rows[rows["place"].str.startswith(prefix) if prefix else is_own]
        if len(own):
            _figures(book, (name, title), along_line(own, prefix, scenario), folders, sheets)
    add_charts(book, folders, sheets)
    for add in (assumptions.add, definitions.add, not_covered.add, evidence.add, acceptance.add):
        add(book)
    fill_in(book, front, (head, verdicts, notes))
    colour_verdicts(book, front)
    book.finish()
    return book


def along_line(rows: pd.DataFrame, prefix: str | None, scenario: Scenario) -> pd.DataFrame:
    """Return rows with the substations, and what belongs to one, in their order along the line."""
    if prefix not in ("substation ", None):
        return rows  # zones are in that order, trains and cases have none
    supply = scenario.supply
    stations = [(one.km, one.id) for one in supply.substations] + [(one.km, one.id) for one in supply.section_cabins]
    order = {name: number for number, (_, name) in enumerate(sorted(stations))}

    kinds: dict[str, int] = {}

    def key(place: str) -> tuple[int, int]:
        kind, _, name = place.partition(" ")
        own = [each for each in order if name == each or name.startswith(f"{each} ")]  # "A" begins "A 1", which may be one, too
        return kinds.setdefault(kind, len(kinds)), order[max(own, key=len)] if own else len(order)

    places = {place: key(place) for place in rows["place"].unique()}
    ranks = {found: number for number, found in enumerate(sorted(set(places.values())))}
    return rows.iloc[np.argsort([ranks[places[place]] for place in rows["place"]], kind="stable")]


def _figures(book: Book, names: tuple[str, str], rows: pd.DataFrame, folders: Sequence[str], sheets: Sheets) -> None:
    """Add a sheet with a row for each figure and place: values side by side, differences, then places and times."""
    page = book.page(*names)
    base = shorten(folders[0], 24)
    page.note(
        tr(
            "Differences are those from {base}, in the unit of the figure and in per cent, by formulas; bold from 5 % on. Where a"
            " figure came about at another place or time in each folder, the columns on the right tell where and when.",
            base=folders[0],
        )
    )
    has_place, has_at = bool((rows["place"] != "").any()), bool((rows["at"] != "").any())
    columns = [Column("figure", widest=34), *([Column("place", widest=24)] if has_place else []), Column("unit", widest=6)]
    columns += [Column(folder, "0.00", key=f"value{k}") for k, folder in enumerate(folders)]
    for k, folder in enumerate(folders[1:], 1):
        short = shorten(folder, 24)
        columns += [
            Column(tr("{folder} less {base}", folder=short, base=base), "0.00", key=f"difference{k}"),
            Column(tr("{folder} less {base} [%]", folder=short, base=base), "0.0", key=f"percent{k}"),
        ]
    if has_at:
        columns += [Column(tr("{folder}: where and when", folder=shorten(folder, 24)), "beside", 26) for folder in folders]
    lines = list(_figure_rows(rows, folders, has_place=has_place, has_at=has_at))
    block = page.table(columns, [line for _, line in lines], frozen=True)
    bold = Font(bold=True)
    for k in range(1, len(folders)):
        area = block.cells(f"percent{k}")
        rule = CellIsRule(operator="notBetween", formula=[f"-{GREAT_PERCENT:g}", f"{GREAT_PERCENT:g}"], font=bold)
        page.sheet.conditional_formatting.add(area, rule)
    sheets.define(book, page, block, [(key, line) for key, line in lines])


def _figure_rows(
    rows: pd.DataFrame, folders: Sequence[str], *, has_place: bool, has_at: bool
) -> Iterator[tuple[tuple[str, str], list[Any]]]:
    """Yield figure and place, and the cells of the row."""
    by_figure: dict[tuple[str, str], dict[str, Mapping[Any, Any]]] = {}
    for row in rows.to_dict("records"):
        by_figure.setdefault((str(row["figure"]), str(row["place"])), {})[str(row["folder"])] = row
    for (name, place), found in by_figure.items():
        values = [float(found[folder]["value"]) if folder in found else None for folder in folders]
        line: list[Any] = [
            heading_of(name).split(" [")[0],
            *([place] if has_place else []),
            next(iter(found.values()))["unit"],
            *values,
        ]
        for k, value in enumerate(values[1:], 1):
            line += _differences(values[0], value, k)
        if has_at:
            line += [recorded(found[folder]["at"]) if folder in found else None for folder in folders]
        yield (name, place), line


def _differences(base: float | None, value: float | None, k: int) -> list[Formula | None]:
    """Return the formulas of difference and per cent; none where a value is missing or has no bounds."""
    if base is None or value is None or not abs(base) < float("inf") or not abs(value) < float("inf"):
        return [None, None]
    difference = Formula(f"{{value{k}}}-{{value0}}", value - base)
    share = f'IF({{value0}}=0,"",100*({{value{k}}}-{{value0}})/ABS({{value0}}))'
    return [difference, Formula(share, 100 * (value - base) / abs(base) if base else "")]


def _inputs(book: Book, folders: Sequence[str]) -> None:
    rows = book.facts.table("compare_inputs")
    if rows.empty:
        return
    page = book.page("Inputs that differ", shorten(tr("Inputs that differ from those of {base}", base=folders[0]), TITLE_LENGTH))
    page.note(
        "Told in words; an empty cell: it is not there. With its path, `run STUDY --set PATH=VALUE` makes a difference again;"
        " table compare_inputs has the values as that takes them."
    )
    columns = (
        Column("folder", widest=18), Column("input", widest=40), Column(folders[0], "any", 48),
        Column("value in the folder", "any", 48), Column("path", "beside", 40),
    )  # fmt: skip
    told = rows[["folder", "path", "base", "value"]].astype(str).itertuples(index=False)
    lines = (
        (folder, input_in_words(path), _value(base), _value(value), path)
        for folder, path, base, value in told
    )  # fmt: skip
    page.table(columns, lines, frozen=True)


def _value(text: str) -> Any:
    """Return what a cell shows for the value of an input: a number as it is, all else in words."""
    number = number_of(text) if text else None
    return recorded(value_in_words(text)) if number is None else number


def _facts(results: Results, scenario: Scenario) -> Facts:
    """Return the facts of a comparison, with what the sheets ask of the run that the base is."""
    facts = Facts(results, scenario)
    base = next(entry for entry in results.run["compare"]["folders"] if entry["name"] == results.run["compare"]["base"])
    told = dict(base.get("run") or {})
    figures = results.table("compare")["figure"].astype(str)
    if figures.str.contains("rail_potential").any():
        told["return_circuit"] = {"touch_voltage": []}
    facts.run = told | results.run
    return facts
