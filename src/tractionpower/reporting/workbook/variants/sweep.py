"""The workbook of a sweep: the cases with what they set, their figures, the differences from the base."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import ColorScaleRule

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.sweep_data import WORDS, SweepData
from tractionpower.reporting.workbook.common import acceptance, definitions, inputs
from tractionpower.reporting.workbook.common.cover import MOST_NOTES, Said, fill_in, verdict_sentence
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Block, Column, heading_of
from tractionpower.results.results import Results
from tractionpower.studies.sweep.cases import number_of
from tractionpower.studies.sweep.differences import FIGURES, HIGHER_IS_BETTER, NOT_JUDGED

COUNTS = ("late_trains", "stuck_trains", "overloaded", "trips", "flagged_steps")
"""Figures that are whole numbers."""

PLACES = {
    "lowest_voltage_v": (("lowest_voltage_track", "beside"), ("lowest_voltage_km", "0.0"), ("lowest_voltage_s", "time")),
    "useful_zone_v": (("useful_zone", "beside"),),
    "useful_train_v": (("useful_train", "beside"),),
    "useful_zone_time_mean_v": (("useful_zone_time_mean", "beside"),),
    "useful_train_time_mean_v": (("useful_train_time_mean", "beside"),),
    "worst_late_s": (("worst_late_train", "beside"),),
    "utilisation_percent": (("utilisation_device", "beside"),),
}
"""What stands beside a figure, with the style of its cells: where it came about, and when."""


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book, data = Book(Facts(results, scenario), report), SweepData(results, scenario)
    front = book.page("Cover", shorten(f"{book.facts.study}: variants", TITLE_LENGTH))
    _cases(book, data)
    _differences(book, data)
    for add in (inputs.add, definitions.add, acceptance.add):
        add(book)
    fill_in(book, front, (lambda _: _head(data), lambda facts: _verdicts(facts, data), lambda facts: _trust(facts, data)))
    book.finish()
    return book


def _shown(data: SweepData) -> list[str]:
    """Return the figures that at least one case has."""
    return [name for name in FIGURES if name in data.measured and data.measured[name].notna().any()]


def _cases(book: Book, data: SweepData) -> None:
    page = book.page("Cases", "Cases: what each sets, and what came of it")
    page.note(
        "The base is the study as it is. A case sets the inputs whose values stand in its row; an empty cell leaves an input as"
        " it is in the base. A case that was refused or failed has no figures; the reason tells why. The darker, the worse."
    )
    paths = list(data.changes.columns)
    shown = _shown(data)
    columns = [Column("case"), *(Column(path, "any", 26) for path in paths), Column("status", widest=12)]
    for name in shown:
        columns.append(Column(heading_of(name), "0" if name in COUNTS else "0.0"))
        columns += [Column(f"{heading_of(beside)} ", style, 24) for beside, style in PLACES.get(name, ())]
    columns.append(Column("reason", widest=60))
    block = page.table(columns, ([*_case_row(data, row, paths, shown)] for row in data.cases.to_dict("records")), frozen=True)
    for name in shown:
        _shade(block, heading_of(name), name)


def _case_row(data: SweepData, row: Mapping[Any, Any], paths: list[str], shown: list[str]) -> Iterator[Any]:
    yield row["case"]
    own = data.changes.loc[row["case"]] if row["case"] in data.changes.index else {}
    for path in paths:
        value = own.get(path)
        number = number_of(value) if isinstance(value, str) else None
        yield number if number is not None else value if isinstance(value, str) else None
    yield row["status"]
    for name in shown:
        yield row[name]
        yield from (row[beside] for beside, _ in PLACES.get(name, ()))
    yield row["reason"]


def _differences(book: Book, data: SweepData) -> None:
    """Add the sheet of differences: those figures that differ in at least one case."""
    if "differences" not in data.results.tables:
        return
    rows = data.results.table("differences").astype({"case": str, "figure": str})
    differing = [name for name in FIGURES if (rows.loc[rows["figure"] == name, "difference"] != 0.0).any()]
    if not differing:
        return
    page = book.page("Differences", "Differences of the figures from those of the base")
    page.note("Value of the case less that of the base, and in per cent of that of the base.")
    columns = [Column("case"), Column("what it sets", widest=60)]
    for name in differing:
        columns.append(Column(heading_of(name), "0" if name in COUNTS else "0.0"))
        columns.append(Column(f"{heading_of(name).split(' [')[0]} [%]", "0.0"))
    subjects = dict(zip(data.cases["case"], data.cases["subject"], strict=True))
    kinds = ("difference", "percent")
    wide = rows.pivot_table(index="case", columns="figure", values=list(kinds), aggfunc="first", sort=False)
    order = [case for case in data.cases["case"] if case in wide.index]
    wide = wide.reindex(columns=pd.MultiIndex.from_tuples([(kind, name) for name in differing for kind in kinds]))
    lines = ((case, subjects[case], *wide.loc[case]) for case in order)
    block = page.table(columns, lines, frozen=True)
    for name in differing:
        _shade(block, heading_of(name), name)


def _shade(block: Block, heading: str, name: str) -> None:
    """Shade a column from good to bad; energy, which is neither, stays as it is."""
    if name in NOT_JUDGED or block.last <= block.first:
        return
    low, high = (RED_FILL, GREEN_FILL) if name in HIGHER_IS_BETTER else (GREEN_FILL, RED_FILL)
    ends = {"start_type": "min", "start_color": low, "end_type": "max", "end_color": high}
    rule = ColorScaleRule(mid_type="percentile", mid_value=50, mid_color=AMBER_FILL, **ends)
    block.sheet.conditional_formatting.add(block.cells(heading), rule)


def _head(data: SweepData) -> Iterator[Said]:
    sweep, counts = data.run["sweep"], data.run["cases"]
    yield "What was computed", f"The base and {counts['all'] - 1} variants of it.", "wrapped"
    for path, values in data.keys.items():
        shown = ", ".join(values[:12]) + (f", ... ({len(values)} values)" if len(values) > 12 else "")
        yield "Varied", f"{path}: {shown}", "wrapped"
    if sweep.get("sample"):
        yield "Sample", f"{sweep['sample']['count']} draws with seed {sweep['sample']['seed']}.", "wrapped"


def _verdicts(facts: Facts, data: SweepData) -> Iterator[Said]:
    subjects = dict(zip(data.cases["case"], data.cases["subject"], strict=True))
    for name, found in data.run["sweep"]["extremes"].items():
        ends = (f"{word} {one['value']:.1f} (case {one['case']}: {subjects[one['case']]})" for word, one in found.items())
        yield WORDS.get(name, heading_of(name)).replace("\n", " "), f"{'; '.join(ends)}.", "wrapped"
    for verdict in facts.verdicts:
        yield "Worst of all cases", verdict_sentence(verdict), {True: "good", False: "bad"}.get(verdict["met"], "doubt")


def _trust(facts: Facts, data: SweepData) -> Iterator[Said]:
    counts = data.cases["status"].value_counts()
    parts = ", ".join(f"{counts[status]} {status}" for status in sorted(counts.index))
    style = "good" if set(counts.index) == {"complete"} else "doubt"
    yield "Status of the cases", f"{len(data.cases)} cases: {parts}.", style
    bare = data.cases[~data.cases["case"].isin(data.measured["case"])]
    for row in bare.head(MOST_NOTES).to_dict("records"):
        yield "Not computed", f"{row['case']} ({row['subject']}): {row['status']}: {row['reason']}", "bad"
    if len(bare) > MOST_NOTES:
        yield "Not computed", f"{len(bare) - MOST_NOTES} more are on sheet Cases.", "bad"
    version = facts.run.get("versions", {}).get("tractionpower", "")
    yield "Written", f"{datetime.now().astimezone():%Y-%m-%d %H:%M} by tractionpower {version}", "wrapped"
    yield "Study, input hash", f"{facts.run.get('study', '')}, {facts.run.get('input_hash', '')}", "wrapped"
