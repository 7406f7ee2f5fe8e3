"""The cover of a comparison: the folders, how their inputs differ, and a verdict on each that follows the limits."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import PurePath, PureWindowsPath
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import FormulaRule

from tractionpower.reporting.facts.input_words import input_in_words, part_of, value_in_words
from tractionpower.reporting.texts import mark, recorded, tr, trn
from tractionpower.reporting.workbook.common.accepted import MET, VIOLATED
from tractionpower.reporting.workbook.common.cover import Said
from tractionpower.reporting.workbook.feasibility.sentences import live
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill, shorten
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula, Names
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.frame.rules import Rule

KINDS = {
    "contingency": mark("outages"), "sweep": mark("variants"), "size": mark("ratings"), "feasibility": mark("timetable judged"),
}  # fmt: skip

MOST_INPUTS = 8
"""Inputs that differ which the cover tells one by one; of more it counts them by what they belong to."""

MOST_PARTS = 14

MOST_NAMED = 40
"""Limits whose names a verdict can tell; a formula has at most 8192 characters."""

LONGEST_VALUE = 60
"""Characters of a value on the cover."""

SHORT_HASH = 12

_MANY = re.compile(r", (\d+) differences$")
"""How a list is told of which too much differs."""

_VIOLATED = mark("{n} of {all} limits violated: {names}")
_UNNAMED = mark("{n} of {all} limits violated")
_OPEN = mark("{met} of {all} limits met, the others not judged")


@dataclass(frozen=True, slots=True)
class WordRule(Rule):
    """A condition on named cells under which cells of any content show a colour; none where the names are left out."""

    def write(self, names: Names) -> None:
        """Give the sheet the conditional format."""
        if set(self.values) <= set(names):
            test = self.test.format(**{name: name for name in self.values})
            self.sheet.conditional_formatting.add(self.area, FormulaRule(formula=[test], stopIfTrue=True, fill=fill(self.colour)))


def verdict_range(k: int) -> str:
    """Return the name of the range of the verdicts on a folder, by its number from 0."""
    return f"verdicts_words_{k + 1}"


def head(facts: Facts) -> Iterator[Said]:
    """Tell what is compared, and how inputs differ from those of the base."""
    told = facts.run["compare"]
    for entry in told["folders"]:
        name = tr("{folder} (the base)", folder=entry["name"]) if entry["name"] == told["base"] else str(entry["name"])
        kind, status = tr(KINDS.get(entry["kind"] or "", "run")), tr(entry["status"])
        words = tr(
            "{folder}: {kind} of study {study}, {status}",
            folder=folder_name(str(entry["folder"])), kind=kind, study=entry["study"], status=status,
        )  # fmt: skip
        if entry.get("input_hash"):
            words += tr(", inputs {hash}", hash=str(entry["input_hash"])[:SHORT_HASH])
        yield name, words, "wrapped"
        if entry["inputs"]:
            rows = facts.table("compare_inputs")
            yield tr("inputs that differ"), inputs_in_words(rows[rows["folder"].astype(str) == str(entry["name"])]), "neutral"


def folder_name(folder: str) -> str:
    r"""Return the last part of a path, as either system writes it; where it lay is told with the evidence.

    >>> folder_name("/a/b/cmk"), folder_name("results\\weak grid"), folder_name(".")
    ('cmk', 'weak grid', '.')
    """
    kind = PureWindowsPath if "\\" in folder else PurePath
    return kind(folder).name or folder


def inputs_in_words(rows: pd.DataFrame) -> str:
    """Return the inputs that differ: one in each line, or of many how many in which part."""
    if len(rows) <= MOST_INPUTS:
        return "\n".join(
            f"{input_in_words(path)}: {_short(base)} → {_short(value)}"
            for path, base, value in rows[["path", "base", "value"]].astype(str).itertuples(index=False)
        )
    counts: dict[str, int] = {}
    for path, value in rows[["path", "value"]].astype(str).itertuples(index=False):
        many = _MANY.search(value)
        counts[part_of(path)] = counts.get(part_of(path), 0) + (int(many[1]) if many else 1)
    parts = [f"{part} ({count})" if count > 1 else part for part, count in counts.items()]
    if len(parts) > MOST_PARTS:
        parts = [*parts[:MOST_PARTS], tr("and {more} more", more=len(parts) - MOST_PARTS)]
    return trn(
        "{count} difference, on sheet {sheet}: {parts}", "{count} differences, on sheet {sheet}: {parts}",
        sum(counts.values()), sheet=tr("Inputs that differ"), parts=", ".join(parts),
    )  # fmt: skip


def _short(value: str) -> str:
    return shorten(recorded(value_in_words(value)), LONGEST_VALUE) or tr("not there")


def verdicts(facts: Facts) -> Iterator[Said]:
    """Tell for each folder which of its limits it violates, by formulas on the sheet of verdicts."""
    rows = facts.table("compare_verdicts")
    if rows.empty:
        return
    folders = [str(entry["name"]) for entry in facts.run["compare"]["folders"]]
    keys = list(dict.fromkeys(_key(row) for row in rows.to_dict("records")))
    for k, folder in enumerate(folders):
        own = [row for row in rows.to_dict("records") if str(row["folder"]) == folder]
        if own:
            text, style = _verdict(own, [keys.index(_key(row)) + 1 for row in own], k)
            yield tr("Verdict, {folder}", folder=folder), text, style


def _key(row: Any) -> tuple[str, str, str]:
    """Return what tells rows of the sheet of verdicts apart."""
    return str(row["figure"]), str(row["limit"]), str(row["limit_value"])


def _verdict(own: Sequence[Any], places: Sequence[int], k: int) -> tuple[Formula, str]:
    """Return the verdict on a folder whose limits stand in some rows of the sheet of verdicts."""
    area = f"{{{verdict_range(k)}}}"
    count = {word: f'COUNTIF({area},"{tr(word)}")' for word in (MET, VIOLATED)}
    violated = [str(row["figure"]) for row in own if row["met"] == "no"]
    met = sum(row["met"] == "yes" for row in own)
    each = (
        f'IF(INDEX({area},{place})="{tr(VIOLATED)}","; "&INDEX({{verdicts_names}},{place}),"")' for place in places[:MOST_NAMED]
    )
    cells = {"n": count[VIOLATED]} | ({"names": f"MID({'&'.join(each)},3,2000)"} if len(own) <= MOST_NAMED else {})
    bad = _VIOLATED if len(own) <= MOST_NAMED else _UNNAMED
    good = trn("The only limit is met", "All {count} limits are met", len(own))
    open_words = live(_OPEN, {"met": count[MET]}, all=len(own))
    text = f'IF({count[VIOLATED]}>0,{live(bad, cells, all=len(own))},IF({count[MET]}={len(own)},"{good}",{open_words}))'
    if violated:
        return Formula(text, tr(bad, n=len(violated), all=len(own), names="; ".join(map(recorded, violated)))), "bad"
    return (Formula(text, good), "good") if met == len(own) else (Formula(text, tr(_OPEN, met=met, all=len(own))), "doubt")


def colour_verdicts(book: Book, page: Page) -> None:
    """Let the verdicts on the cover show the colour that the sheet of verdicts asks for."""
    folders = [str(entry["name"]) for entry in book.facts.run["compare"]["folders"]]
    rows = {str(cell.value): cell.row for (cell,) in page.sheet.iter_rows(max_col=1) if cell.value}
    for k, folder in enumerate(folders):
        row = rows.get(tr("Verdict, {folder}", folder=folder))
        if row is None:
            continue
        name = verdict_range(k)
        area, values = f"B{row}:H{row}", {name: 0.0}
        own = sum(book.facts.table("compare_verdicts")["folder"].astype(str) == folder)
        for test, colour in (
            (f'COUNTIF({{{name}}},"{tr(VIOLATED)}")>0', RED_FILL), (f'COUNTIF({{{name}}},"{tr(MET)}")={own}', GREEN_FILL),
            ("TRUE", AMBER_FILL),
        ):  # fmt: skip
            book.rules.append(WordRule(page.sheet, area, test, colour, values))


def notes(facts: Facts) -> Iterator[Said]:
    """Tell what is to be said of the folders."""
    for note in facts.run["compare"]["notes"]:
        yield tr("Note"), recorded(str(note)), "doubt"
