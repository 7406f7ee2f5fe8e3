"""The workbook of a comparison: figures of several folders side by side, verdicts, inputs that differ."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import Any

import pandas as pd

from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.workbook.common.acceptance import MET, OPEN, VIOLATED, colour_verdicts
from tractionpower.reporting.workbook.common.cover import Said, fill_in
from tractionpower.reporting.workbook.frame.book import TITLE_LENGTH, Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts, limit_in_words
from tractionpower.reporting.workbook.frame.page import Column, heading_of
from tractionpower.results.results import Results

SHEETS = (
    ("Run", "Figures of the runs as a whole", ""),
    ("Substations", "Figures of substations", "substation "),
    ("Trains", "Figures of trains", "train "),
    ("Zones", "Mean useful voltages of zones", "zone "),
    ("Cases", "Figures of cases", "case "),
    ("Other devices", "Figures of feeders, switches, loads and other devices", None),
)
"""Sheets of figures: name, title, what their places begin with; the last takes all others."""

WORDS = {"yes": MET, "no": VIOLATED, "": OPEN}


def build(results: Results, scenario: Scenario, report: Report) -> Book:
    """Return the workbook; a sheet that would be empty is left out."""
    book = Book(Facts(results, scenario), report)
    folders = [entry["name"] for entry in results.run["compare"]["folders"]]
    front = book.page("Cover", shorten(f"{book.facts.study}: comparison", TITLE_LENGTH))
    rows = results.table("compare")
    rows = rows.astype({name: str for name in ("figure", "place", "unit", "folder", "at")})
    begins = tuple(prefix for _, _, prefix in SHEETS if prefix)
    for name, title, prefix in SHEETS:
        is_own = ~rows["place"].str.startswith(begins) & (rows["place"] != "") if prefix is None else rows["place"] == ""
        own = rows[rows["place"].str.startswith(prefix) if prefix else is_own]
        if len(own):
            _figures(book, (name, title), own, folders)
    _verdicts(book)
    _inputs(book, folders)
    fill_in(book, front, (_head, _trust))
    book.finish()
    return book


def _figures(book: Book, names: tuple[str, str], rows: pd.DataFrame, folders: Sequence[str]) -> None:
    """Add a sheet with a row for each figure and place: values side by side, then differences, then places and times."""
    page = book.page(*names)
    base = folders[0]
    page.note(
        f"Differences are those from {base}, in the unit of the figure and in per cent. Where a figure came about at another"
        " place or time in each folder, the columns on the right tell where and when."
    )
    has_place = bool((rows["place"] != "").any())
    columns = [Column("figure", widest=40), *([Column("place", widest=34)] if has_place else []), Column("unit")]
    columns += [Column(folder, "0.00") for folder in folders]
    for folder in folders[1:]:
        columns += [Column(f"{folder} less {base}", "0.00"), Column(f"{folder} less {base} [%]", "0.0")]
    columns += [Column(f"{folder}: where and when", "beside", 36) for folder in folders]
    page.table(columns, _figure_rows(rows, folders, has_place=has_place), frozen=True)


def _figure_rows(rows: pd.DataFrame, folders: Sequence[str], *, has_place: bool) -> Iterator[list[Any]]:
    for (name, place), own in rows.groupby(["figure", "place"], sort=False):
        found: Mapping[str, Any] = {row["folder"]: row for row in own.to_dict("records")}
        line = [heading_of(str(name)).split(" [")[0], *([place] if has_place else []), own["unit"].iloc[0]]
        line += [found[folder]["value"] if folder in found else None for folder in folders]
        for folder in folders[1:]:
            line += [found[folder][key] if folder in found else None for key in ("difference", "percent")]
        yield [*line, *(found[folder]["at"] if folder in found else None for folder in folders)]


def _verdicts(book: Book) -> None:
    rows = book.facts.table("compare_verdicts")
    if rows.empty:
        return
    page = book.page("Verdicts", "Verdicts side by side: what was found against what is allowed")
    page.note(
        "A limit whose status is not 'verified' is an editable value of the limits table: the runs are checked against that"
        " value, which is no statement about a standard."
    )
    columns = (
        Column("what is judged", widest=44), Column("folder", widest=30), Column("found", "0.00"), Column("verdict"),
        Column("limit"), Column("limit value", "0.00"), Column("where and when", "beside", 44),
        Column("status of the limit", widest=30),
    )  # fmt: skip
    lines = (
        (
            row["figure"], row["folder"], row["value"], WORDS[row["met"]], limit_in_words(row["limit"]), row["limit_value"],
            row["at"], KNOWN_AS.get(row["status"], row["status"]),
        )
        for row in rows.to_dict("records")
    )  # fmt: skip
    colour_verdicts(page.table(columns, lines, frozen=True))


def _inputs(book: Book, folders: Sequence[str]) -> None:
    rows = book.facts.table("compare_inputs")
    if rows.empty:
        return
    page = book.page("Inputs that differ", f"Inputs that differ from those of {folders[0]}")
    page.note("Paths are those of --set: `run STUDY --set PATH=VALUE` makes the difference. An empty cell: it is not there.")
    columns = (Column("folder", widest=30), Column("path", widest=70), Column(folders[0], "any", 50), Column("value", "any", 50))
    page.table(columns, rows[["folder", "path", "base", "value"]].itertuples(index=False), frozen=True)


def _head(facts: Facts) -> Iterator[Said]:
    told = facts.run["compare"]
    for entry in told["folders"]:
        is_base = " (the base)" if entry["name"] == told["base"] else ""
        kind = {"contingency": "outages", "sweep": "variants", "size": "ratings"}.get(entry["kind"], "run")
        yield f"{entry['name']}{is_base}", f"{entry['folder']}: {kind} of study {entry['study']}, {entry['status']}", "wrapped"
        if entry["inputs"]:
            more = entry["inputs_that_differ"] - len(entry["inputs"])
            shown = [*entry["inputs"], *([f"and {more} more, see sheet Inputs that differ"] if more else [])]
            yield "inputs that differ", "\n".join(shown), "neutral"


def _trust(facts: Facts) -> Iterator[Said]:
    rows = facts.table("compare_verdicts")
    for folder, own in rows.groupby("folder", sort=False, observed=True) if len(rows) else ():
        violated = own[own["met"] == "no"]
        names = ", ".join(violated["figure"].astype(str))
        met = f"All {len(own)} limits are met or open"
        text = f"{len(violated)} of {len(own)} limits violated: {names}" if len(violated) else met
        yield f"Verdict, {folder}", text, "bad" if len(violated) else "good"
    for note in facts.run["compare"]["notes"]:
        yield "Note", str(note), "doubt"
    version = facts.run.get("versions", {}).get("tractionpower", "")
    yield "Written", f"{datetime.now().astimezone():%Y-%m-%d %H:%M} by tractionpower {version}", "wrapped"
