"""The workbook of a comparison: figures of several folders side by side, verdicts, inputs that differ, charts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import CellIsRule
from openpyxl.styles import Font

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.texts import mark, recorded, tr, trn
from tractionpower.reporting.workbook.common import acceptance
from tractionpower.reporting.workbook.common.cover import Said, fill_in
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.reporting.workbook.variants.compare_charts import Sheets, add_charts
from tractionpower.reporting.workbook.variants.compare_verdicts import add_verdicts
from tractionpower.results.results import Results

SHEETS = (
    (mark("Run"), mark("Figures of the runs as a whole"), ""),
    (mark("Substations"), mark("Figures of substations"), "substation "),
    (mark("Trains"), mark("Figures of trains"), "train "),
    (mark("Zones"), mark("Mean useful voltages of zones"), "zone "),
    (mark("Cases"), mark("Figures of cases"), "case "),
    (mark("Other devices"), mark("Figures of feeders, switches, loads and other devices"), None),
)
"""Sheets of figures: name, title, what their places begin with; the last takes all others."""

KINDS = {
    "contingency": mark("outages"), "sweep": mark("variants"), "size": mark("ratings"), "feasibility": mark("timetable judged"),
}  # fmt: skip

GREAT_PERCENT = 5.0
"""Differences that are greater than this are bold [%]."""


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book = Book(Facts(results, scenario), report)
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
            _figures(book, (name, title), own, folders, sheets)
    add_charts(book, folders, sheets)
    acceptance.add(book)
    fill_in(book, front, (_head, _trust))
    book.finish()
    return book


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
    page.note("Paths are those of --set: `run STUDY --set PATH=VALUE` makes the difference. An empty cell: it is not there.")
    columns = (Column("folder", widest=24), Column("path", widest=64), Column(folders[0], "any", 36), Column("value", "any", 36))
    page.table(columns, rows[["folder", "path", "base", "value"]].itertuples(index=False), frozen=True)


def _head(facts: Facts) -> Iterator[Said]:
    told = facts.run["compare"]
    for entry in told["folders"]:
        name = tr("{folder} (the base)", folder=entry["name"]) if entry["name"] == told["base"] else str(entry["name"])
        kind, status = tr(KINDS.get(entry["kind"] or "", "run")), tr(entry["status"])
        words = tr(
            "{folder}: {kind} of study {study}, {status}", folder=entry["folder"], kind=kind, study=entry["study"], status=status
        )
        yield name, words, "wrapped"
        if entry["inputs"]:
            more = entry["inputs_that_differ"] - len(entry["inputs"])
            shown = [*entry["inputs"]]
            if more > 0:
                shown.append(tr("and {count} more, see sheet {sheet}", count=more, sheet=tr("Inputs that differ")))
            yield tr("inputs that differ"), "\n".join(shown), "neutral"


def _trust(facts: Facts) -> Iterator[Said]:
    rows = facts.table("compare_verdicts")
    for folder, own in rows.groupby("folder", sort=False, observed=True) if len(rows) else ():
        violated = own[own["met"] == "no"]
        label = tr("Verdict, {folder}", folder=folder)
        if len(violated):
            names = ", ".join(recorded(str(name)) for name in violated["figure"])
            yield label, tr("{n} of {all} limits violated: {names}", n=len(violated), all=len(own), names=names), "bad"
        else:
            yield label, trn("{count} limit is met or open", "All {count} limits are met or open", len(own)), "good"
    for note in facts.run["compare"]["notes"]:
        yield tr("Note"), recorded(str(note)), "doubt"
