"""The sheet of ratings: how the devices of each kind stand, the duty classes, the sources; before a sheet for each kind."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd
from openpyxl.utils import absolute_coordinate

from tractionpower.model.base import format_time
from tractionpower.model.ratings import DutyRow
from tractionpower.reporting.facts.device_words import KINDS, device_told, kind_order
from tractionpower.reporting.figures.supply.ratings_figures import TIGHT_PERCENT
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.common.accepted import OPEN, Accepted
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.sizing import rated_devices, rating_windows
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    UNRATED,
    YES,
    banner,
    colour_use,
    colour_word,
    known,
    limit_line,
    rounded,
    sentence,
    window_in_words,
)
from tractionpower.reporting.workbook.sizing.rated_cells import Judge, permitted_of, several_windows, sources_of, use_of
from tractionpower.reporting.workbook.sizing.rated_devices import name_of
from tractionpower.studies.ratings.words import KINDS as VERDICT_KINDS
from tractionpower.studies.ratings.words import window_words

LIMIT = "utilisation_percent"
PERMITTED = "permitted_utilisation"
"""Name of the cell that says how much of a rating may be used."""

BANNER = "ratings_banner"
"""Name of the cell that says it all in a sentence."""

MOST = mark("highest utilisation [%]")

_KINDS = (
    Column("kind", widest=34),
    Column("devices", "0"),
    Column("with a rating", "0", key="rated"),
    Column("beyond what is permitted", "0", key="beyond"),
    Column(MOST, "0.0", key="most"),
    Column("of which device", "beside", 34),
    Column("in the window", "beside"),
    Column("left there [A]", "0"),
    Column(HOLDS, "beside", key="holds"),
    Column("sheet", "beside", 24),
)
_DUTIES = (
    Column("duty class", widest=34),
    Column("window", "beside"),
    Column("multiple", "0.00", key="multiple"),
    Column("status", "beside"),
)


def add(book: Book) -> None:
    """Add the sheets, if the run has ratings."""
    rows = book.facts.table("ratings")
    if rows.empty:
        return
    rows = in_order(rows)
    ruling = one_for_each(rows)
    permitted = book.facts.scenario.sizing.utilisation_percent
    page = book.page("Ratings", "Ratings: what every device carries, and what it may")
    head = page.next
    page.next += 1
    cell = limit_line(page, tr("Permitted utilisation"), LIMIT, permitted, "%")
    book.define(PERMITTED, page, cell.replace("$", ""))
    page.note(
        tr(
            "The load of a device is the highest sliding root mean square of its current over a window; permitted is the rated"
            " current times the multiple that its duty class permits for this window; the window with the highest utilisation"
            " rules. Amber from {tight} % of the permitted utilisation on. The limit is edited on sheet Acceptance; verdicts"
            " follow. A device without a rating shows its load over the whole run and is not judged. Ratings whose status is not"
            " 'verified' are editable values: devices are checked against those values, which is no statement about a standard.",
            tight=number(TIGHT_PERCENT),
        )
    )
    sheets = rated_devices.add(book, ruling, several_windows(rows))
    kinds = _write_kinds(page, ruling, sheets, cell)
    end, page.next = page.next, head
    _write_banner(page, ruling, permitted, (kinds, cell))
    page.next = end
    _duties(book, page)
    _sources(page, ruling)
    rating_windows.add(book, rows)
    book.acceptance += _accepted(ruling, permitted)


def in_order(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows of devices by kind and along the line."""
    kinds = rows["kind"].astype(str).map(kind_order).astype(int)
    return rows.assign(_kind=kinds).sort_values(["_kind", "from_km", "device"], kind="stable").drop(columns="_kind")


def places_of(facts: Facts) -> dict[str, tuple[int, float]]:
    """Return kind and place of every device, by which others than the ratings are ordered."""
    rows = facts.table("ratings")
    if rows.empty:
        return {}
    found = rows.drop_duplicates("device")
    places = zip(found["device"].astype(str), found["kind"].astype(str), found["from_km"], strict=True)
    return {device: (kind_order(kind), float(km)) for device, kind, km in places}


def one_for_each(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the ruling row of each device; of one without a rating that of the longest time."""
    rated = rows["ruling"] & rows["utilisation_percent"].notna()
    unrated = ~rows["device"].isin(rows.loc[rated, "device"])
    length = rows["window_s"].where(rows["window_s"] > 0.0, float("inf"))
    longest = length[unrated].groupby(rows.loc[unrated, "device"].astype(str)).idxmax()
    return rows[rated | rows.index.isin(longest)].drop_duplicates("device")


def ratings_in_words(ruling: pd.DataFrame, permitted: float) -> tuple[str, str]:
    """Return what the ratings say in a sentence, and the style that suits it."""
    found, style = _said(ruling, permitted)
    return str(found.value), style


def _said(ruling: pd.DataFrame, permitted: float, cell: str = "") -> tuple[Formula, str]:
    """Return the sentence as a formula on the table of kinds, and its style."""
    rated = ruling[ruling["utilisation_percent"].notna()]
    devices, bare = len(ruling), len(ruling) - len(rated)
    if rated.empty:
        return sentence(tr("None of {devices} devices has a rating"), devices=(str(devices), devices)), "doubt"
    worst = rated.iloc[int(rated["utilisation_percent"].argmax())]
    beyond = int((rated["met"].astype(str) == "no").sum())
    row, some = "MATCH(MAX({kinds_most}),{kinds_most},0)", "SUM({kinds_rated})>0"
    parts: dict[str, tuple[str, object]] = {
        "rated": ("SUM({kinds_rated})", len(rated)),
        "beyond": ("SUM({kinds_beyond})", beyond),
        "permitted": (cell, number(permitted, 6)),
        "device": (f"INDEX({{kinds_device}},{row})", device_told(worst["device"])),
        "use": ("ROUND(MAX({kinds_most}),0)", rounded(worst["utilisation_percent"])),
        "window": (f"INDEX({{kinds_window}},{row})", window_in_words(worst["window_s"])),
    }
    good = sentence(tr("All {rated} rated devices within {permitted} %"), **parts)
    bad = sentence(tr("{beyond} of {rated} rated devices beyond {permitted} %"), **parts)
    most = sentence(tr(". Most: {device}, {use} % in window: {window}"), **parts)
    more = sentence(tr("; {bare} more have no rating and are not judged") if bare else "", bare=(str(bare), bare))
    none = sentence(tr("Nothing is judged: a limit or a multiple is missing"))
    first = f"IF(AND({some},ISNUMBER({cell})),IF(SUM({{kinds_beyond}})=0,{good.text},{bad.text}),{none.text})"
    text = "&".join(part for part in (first, f'IF({some},{most.text},"")', more.text) if part)
    value = f"{(bad if beyond else good).value}{most.value}{more.value}"
    return Formula(text, value), "bad" if beyond else "neutral" if bare else "good"


def _write_banner(page: Page, ruling: pd.DataFrame, permitted: float, on: tuple[Block, str]) -> None:
    """Write the verdict above the table of kinds; `on`: this table, and the address of the permitted utilisation."""
    kinds, cell = on
    found, style = _said(ruling, permitted, cell)
    is_judged = bool(ruling["utilisation_percent"].notna().any())
    beyond, rated = (absolute_coordinate(kinds.cells(key)) for key in ("beyond", "rated"))
    is_open = f"NOT(AND(SUM({rated})>0,ISNUMBER({cell})))"
    banner(page, found, style, f"SUM({beyond})>0" if is_judged else "", BANNER, doubt=is_open)


def _write_kinds(page: Page, ruling: pd.DataFrame, sheets: dict[str, str], cell: str) -> Block:
    """Write how each kind of devices stands, by formulas on the sheets of the kinds."""
    page.section("Kinds of devices")
    kinds = list(dict.fromkeys(ruling["kind"].astype(str)))
    cells = (_kind_row(kind, ruling[ruling["kind"].astype(str) == kind], sheets[kind]) for kind in kinds)
    block = page.table(_KINDS, cells)
    colour_use(block, MOST, cell)
    colour_word(block, HOLDS)
    for name, heading in (("rated", "rated"), ("beyond", "beyond"), ("most", "most"), ("device", "of which device"),
                          ("window", "in the window")):  # fmt: skip
        page.book.define(f"kinds_{name}", page, block.cells(heading))
    return block


def _kind_row(kind: str, own: pd.DataFrame, sheet: str) -> tuple[Any, ...]:
    use = own["utilisation_percent"]
    name = name_of(kind)
    rated, beyond = int(use.notna().sum()), int((own["met"].astype(str) == "no").sum())
    first = (
        tr(KINDS.get(kind, kind)), len(own), Formula(f"COUNT({{{name}_use}})", rated),
        Formula(f'COUNTIF({{{name}_holds}},"{tr(NO)}")', beyond),
    )  # fmt: skip
    if not rated:
        return *first, None, None, None, None, tr(UNRATED), sheet
    worst = own.iloc[int(use.fillna(-1.0).argmax())]
    area = f"{{{name}_use}}"
    load, permitted = float(worst["load_a"]), permitted_of(worst)
    most = use_of(load, permitted)
    holds = f'IF({{beyond}}>0,"{tr(NO)}",IF(COUNTIF({{{name}_holds}},"{tr(YES)}")>0,"{tr(YES)}","{tr(OPEN)}"))'
    told = (
        Formula(f'IF(ISNUMBER({{most}}),INDEX({{{name}_{key}}},MATCH({{most}},{area},0)),"")', value)
        for key, value in (
            ("device", device_told(worst["device"])), ("window", window_in_words(worst["window_s"])), ("left", permitted - load),
        )
    )  # fmt: skip
    return *first, Formula(_highest(name), most), *told, Formula(holds, tr(NO if beyond else YES)), sheet


def _highest(name: str) -> str:
    """Return the formula of the highest utilisation of a kind; nothing where none is known."""
    return f'IF(COUNT({{{name}_use}})=0,"",MAX({{{name}_use}}))'


def _duties(book: Book, page: Page) -> None:
    """Write the duty classes that are in use; loads are held against their multiples by formulas."""
    judge = Judge.of(book)
    rows = judge.duties
    if not rows:
        return
    page.section("Duty classes")
    cells = ((_duty(row), window_in_words(row.window_s), row.multiple, recorded(row.status)) for row in judge.duties)
    block = page.table(_DUTIES, cells)
    for at, row in enumerate(rows, block.first):
        cell = block.cell("multiple", at)
        page.edit(cell, "0.00", 0.0)
        book.define(judge.duty_cell(row.duty_class, row.window_s), page, cell)


def _duty(row: DutyRow) -> str:
    return f"{row.duty_class}: {recorded(row.meaning)}" if row.meaning else row.duty_class


def _sources(page: Page, ruling: pd.DataFrame) -> None:
    """Write below where the ratings come from."""
    sources, _ = sources_of(ruling)
    if not sources:
        return
    page.section("Sources of the ratings")
    for count, (status, source) in enumerate(sources, 1):
        page.wrapped(f"{count}: {tr(KNOWN_AS.get(status, status))}. {recorded(source)}")


def _accepted(ruling: pd.DataFrame, permitted: float) -> Iterator[Accepted]:
    """Yield for each kind of devices that with the highest utilisation."""
    for kind, own in ruling.groupby(ruling["kind"].astype(str), sort=False):
        use = own["utilisation_percent"]
        if kind not in VERDICT_KINDS or not use.notna().any():
            continue
        worst = own.iloc[int(use.fillna(-1.0).argmax())]
        most = use_of(float(worst["load_a"]), permitted_of(worst))
        when = format_time(worst["from_s"]) if worst["window_s"] > 0.0 and known(worst["from_s"]) else ""
        yield Accepted(
            f"utilisation of {VERDICT_KINDS[str(kind)]}", LIMIT, permitted, "%", "at_most",
            Formula(_highest(name_of(str(kind))), most), f"{worst['device']}, {window_words(worst['window_s'])}", when,
            str(worst["status"]), str(worst["source"]), "Ratings",
        )  # fmt: skip
