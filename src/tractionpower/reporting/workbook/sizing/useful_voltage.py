"""The sheets of the mean useful voltage by both definitions, and of how long which voltage lasts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd
from openpyxl.formatting.rule import FormulaRule

from tractionpower.model.limits import Limit
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL, fill
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.sizing.ratings import HOLDS, UNRATED, colour_word

WEIGHTED, MEAN = "weighted by current [V]", "mean over time [V]"
MOST_ROWS = 3000
"""Rows of a table of single trains; with more, the lowest are shown."""

_VALUES = (
    Column(WEIGHTED, "0"),
    Column(MEAN, "0"),
    Column("limit [V]", "0"),
    Column(HOLDS, "beside"),
    Column("trains that count", "0"),
    Column("trains left out", "0"),
)
_SPAN = (Column("from", "time"), Column("to", "time"))


def add(book: Book) -> None:
    """Add the sheets, if the run has their tables."""
    rows = book.facts.table("useful_voltage")
    if len(rows):
        _useful(book, rows)
    _durations(book)


def limit_note(limit: Limit | None) -> str:
    """Return in words what the mean useful voltage is held against, and how that is known."""
    if limit is None:
        return "The limits table has no lowest mean useful voltage for this system, so nothing is judged."
    known = KNOWN_AS.get(limit.status, limit.status)
    checked = (
        "" if limit.status == "verified" else " Checked against this editable value, which is no statement about a standard."
    )
    return f"Limit: {limit.value:g} {limit.unit}, {limit.meaning}; {known} ({limit.source}).{checked}"


def useful_limit(facts: Facts) -> Limit | None:
    """Return the lowest mean useful voltage of the class of the line."""
    high_speed = facts.scenario.sizing.useful_voltage.line_class == "high_speed"
    return (facts.limit("u_useful_high_speed") if high_speed else None) or facts.limit("u_useful")


def _useful(book: Book, rows: pd.DataFrame) -> None:
    page = book.page("Useful voltage", "Mean useful voltage of zones and trains, by both definitions")
    study = book.facts.scenario.sizing.useful_voltage
    page.note(
        "Weighted by current: of each train the voltage weighted by its current, with the time that it is there; mean over time:"
        " the mean of the voltages at the pantographs of the trains. A train that is in a zone for less than"
        f" {study.shortest_stay_s:g} s within a window is left out there; no source gives a value for that, so it is one of the"
        " study. The two definitions are secondary: read from works that use them, not from the standard."
    )
    page.note(limit_note(useful_limit(book.facts)))
    zones, trains = rows[rows["kind"] == "zone"], rows[rows["kind"] == "train"]
    whole = zones[zones["window"] == "run"]
    if len(whole):
        page.section("Zones, whole run")
        _table(page, (Column("zone", widest=40),), whole, spans=False)
    _hourly(page, zones[zones["window"] == "hour"], "current_weighted_v", "weighted by current")
    _hourly(page, zones[zones["window"] == "hour"], "time_mean_v", "mean over time")
    given = rows[rows["window"] == "given"]
    if len(given):
        page.section("Windows of the study")
        _table(page, (Column("zone or train", widest=40),), given, spans=True)
    own = trains[trains["window"] == "run"]
    if len(own):
        page.new_page()
        page.section("Trains, whole run, the lowest first")
        if len(own) > MOST_ROWS:
            page.note(f"The lowest {MOST_ROWS} of {len(own)} trains; table useful_voltage has all.")
        lowest = own.sort_values("current_weighted_v", kind="stable").head(MOST_ROWS)
        _table(page, (Column("train", widest=40),), lowest, spans=False)


def _table(page: Page, first: tuple[Column, ...], rows: pd.DataFrame, *, spans: bool) -> Block:
    names = ("current_weighted_v", "time_mean_v", "limit_v", "met", "trains", "left_out")
    cells = (
        (row["subject"], *((row["from_s"], row["to_s"]) if spans else ()), *(_shown(row, name) for name in names))
        for row in rows.to_dict("records")
    )
    block = page.table((*first, *(_SPAN if spans else ()), *_VALUES), cells)
    colour_word(block, HOLDS)
    return block


def _shown(row: dict[Any, Any], name: str) -> Any:
    return (str(row[name]) or UNRATED) if name == "met" else row[name]


def _hourly(page: Page, rows: pd.DataFrame, name: str, words: str) -> None:
    """Write a row for each hour and a column for each zone; values below the limit show red."""
    if rows.empty:
        return
    zones = list(dict.fromkeys(rows["subject"].astype(str)))
    wide = rows.assign(zone=rows["subject"].astype(str)).pivot_table(index="from_s", columns="zone", values=name, dropna=False)
    wide = wide.reindex(columns=zones).sort_index()
    page.new_page()
    page.section(f"Zones by the hour, {words} [V]")
    columns = (Column("hour begins", "time"), *(Column(zone, "0") for zone in zones))
    block = page.table(columns, ((at, *values) for at, values in zip(wide.index, wide.to_numpy(float), strict=True)))
    limit = rows["limit_v"].max()
    if limit > 0.0 and zones:
        area = f"{block.cells(zones[0]).split(':')[0]}:{block.cells(zones[-1]).split(':')[1]}"
        first = area.split(":", maxsplit=1)[0]
        rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}<{float(limit)!r})"], fill=fill(RED_FILL))
        block.sheet.conditional_formatting.add(area, rule)


def _durations(book: Book) -> None:
    rows = book.facts.table("voltage_durations")
    if rows.empty:
        return
    page = book.page("Voltage durations", "How long which voltage lasts at the pantographs")
    page.note(
        "Bands between the limits of the voltage of this system (quantities as in EN 50163). Longest: without a break, in the"
        " band or beyond it. Permitted: the longest permitted time there; 0 s: none, empty: any. Sheet Inputs limits has source"
        " and status of each limit; those that are not 'verified' are editable values."
    )
    every = rows[rows["train"].astype(str) == ""]
    if len(every):
        page.section("All trains")
        colour_word(page.table(_BANDS, (("all trains", *cells[1:]) for cells in _band_rows(every))), HOLDS)
    trains = rows[(rows["train"].astype(str) != "") & (rows["total_s"] > 0.0)]
    page.section("Each train, bands that it was in, where something is limited")
    trains = trains[trains["permitted_s"].notna()]
    if trains.empty:
        page.line("No train was in a band whose time is limited.")
        return
    if len(trains) > MOST_ROWS:
        page.note(f"The longest {MOST_ROWS} of {len(trains)}; table voltage_durations has all.")
    longest = trains.sort_values("longest_s", ascending=False, kind="stable").head(MOST_ROWS)
    colour_word(page.table(_BANDS, _band_rows(longest)), HOLDS)


_BANDS = (
    Column("train", widest=28),
    Column("band", widest=34),
    Column("from [V]", "0"),
    Column("to [V]", "0"),
    Column("in all [s]", "0.0"),
    Column("share of the time [%]", "0.00"),
    Column("longest [s]", "0.0"),
    Column("it begins", "time"),
    Column("permitted [s]", "0"),
    Column(HOLDS, "beside"),
)


def _band_rows(rows: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    names = ("from_v", "to_v", "total_s", "share_percent", "longest_s", "longest_from_s", "permitted_s")
    for row in rows.to_dict("records"):
        yield row["train"], row["band"], *(row[name] for name in names), str(row["met"]) or "not limited"
