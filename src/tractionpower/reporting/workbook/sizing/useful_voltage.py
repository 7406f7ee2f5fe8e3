"""The sheets of the mean useful voltage by both definitions: zones and trains, over the run and by the hour."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.base import format_time
from tractionpower.model.limits import USEFUL_NAMES, Limit
from tractionpower.reporting.texts import mark, number, recorded, tr
from tractionpower.reporting.workbook.common.accepted import OPEN, Accepted
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.sizing import voltage_durations
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    UNRATED,
    YES,
    Bound,
    bound_line,
    colour_red,
    colour_word,
    judged,
    known,
)
from tractionpower.reporting.workbook.sizing.rated_cells import keyed
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.studies.ratings.useful import DEFINITIONS
from tractionpower.studies.ratings.verdicts import ZONES

WEIGHTED, MEAN = mark("weighted by current [V]"), mark("mean over time [V]")
MOST_ROWS = 3000
"""Rows of a table of single trains; with more, the lowest are shown."""

_SUMS = {
    "weighted": ("power", "current", "1000*{power}/{current}", 1000.0),
    "mean": ("voltage_time", "time", "{voltage_time}/{time}", 1.0),
}
"""Of each mean the columns of its two sums, its formula, and the factor in it."""

_COLUMNS = {"weighted": "current_weighted_v", "mean": "time_mean_v"}
_OF_SUMS = {"power": "power_sum_kw", "current": "current_sum_a", "voltage_time": "voltage_time_vs", "time": "counted_s"}

_VALUES = (
    Column(WEIGHTED, "0", key="weighted"),
    Column(MEAN, "0", key="mean"),
    Column(HOLDS, "beside", key="holds"),
    Column("trains that count", "0", key="trains"),
    Column("trains left out", "0", key="left_out"),
    Column("sum of mean U |I| [kW]", "0.0", key="power"),
    Column("sum of mean |I| [A]", "0.0", key="current"),
    Column("sum of U dt [V s]", "0", key="voltage_time"),
    Column("sum of dt [s]", "0.0", key="time"),
)
_SPAN = (Column("from", "time", key="from"), Column("to", "time", key="to"))


def add(book: Book) -> None:
    """Add the sheets, if the run has their tables."""
    rows = book.facts.table("useful_voltage")
    if len(rows):
        limit = useful_limit(book.facts)
        _useful(book, rows, limit)
        _hours(book, rows[rows["kind"] == "zone"], limit)
    voltage_durations.add(book)


def limit_note(limit: Limit | None) -> str:
    """Return in words what the mean useful voltage is held against, and how that is known."""
    if limit is None:
        return tr("The limits table has no lowest mean useful voltage for this system, so nothing is judged.")
    known_as = tr(KNOWN_AS.get(limit.status, limit.status))
    told = {"value": f"{number(limit.value)} {limit.unit}", "known": known_as, "source": recorded(limit.source)}
    if limit.status == "verified":
        return tr("Limit: {value}, {meaning}; {known} ({source}).", meaning=recorded(limit.meaning), **told)
    return tr(
        "Limit: {value}, {meaning}; {known} ({source}). Checked against this editable value, which is no statement about a"
        " standard.",
        meaning=recorded(limit.meaning),
        **told,
    )


def useful_limit(facts: Facts) -> Limit | None:
    """Return the lowest mean useful voltage of the class of the line."""
    line_class = facts.scenario.sizing.useful_voltage.line_class
    return facts.limit(USEFUL_NAMES[line_class]) or facts.limit("u_useful")


def _useful(book: Book, rows: pd.DataFrame, limit: Limit | None) -> None:
    page = book.page("Useful voltage", "Mean useful voltage of zones and trains, by both definitions")
    bound = _limit_line(page, limit)
    stay_s = book.facts.scenario.sizing.useful_voltage.shortest_stay_s
    page.note(
        tr(
            "Weighted by current: of each train the means of U |I| and of |I| over the time that it is there; the sum of the"
            " former over the sum of the latter. Mean over time: the sum of U dt over the time, at the pantographs of all trains"
            " of a zone, or of a train while it exerts traction effort. A train that is in a zone for less than {stay} s within a"
            " window is left out there; no source gives a value for that, so it is one of the study. The two definitions are"
            " secondary: read from works that use them, not from the standard.",
            stay=number(stay_s),
        )
    )
    page.note(limit_note(limit))
    zones, trains = rows[rows["kind"] == "zone"], rows[rows["kind"] == "train"]
    judge = _Judge(limit, bound)
    whole = zones[zones["window"] == "run"]
    if len(whole):
        page.section("Zones, whole run")
        block = judge.table(page, Column("zone", widest=40, key="subject"), whole)
        _accept(book, page, (block, "run"), whole, limit)
    given = rows[rows["window"] == "given"]
    if len(given):
        page.section("Windows of the study")
        judge.table(page, Column("zone or train", widest=40, key="subject"), given, spans=_SPAN)
        _accept_plain(book, given[given["kind"] == "zone"], "given", limit)
    own = trains[trains["window"] == "run"]
    if len(own):
        page.new_page()
        page.section("Trains, whole run, the lowest first")
        if len(own) > MOST_ROWS:
            page.note(tr("The lowest {shown} of {all} trains; table useful_voltage has all.", shown=MOST_ROWS, all=len(own)))
        lowest = own.sort_values("current_weighted_v", kind="stable").head(MOST_ROWS)
        judge.table(page, Column("train", widest=40, key="subject"), lowest)


def _limit_line(page: Page, limit: Limit | None) -> Bound | None:
    """Write the limit above the tables and return where it stands; None without one."""
    if limit is None:
        return None
    return bound_line(page, tr("Lowest permitted"), (limit.name, limit.value, limit.unit), TOLERANCE_V)


class _Judge:
    """Means held against a limit: its value, the address of its cell, and the test that a mean is below it."""

    def __init__(self, limit: Limit | None, bound: Bound | None) -> None:
        self.limit, self.limit_cell = limit, "" if bound is None else bound.limit
        self.below = "" if bound is None else bound.beyond(is_floor=True)

    def table(self, page: Page, first: Column, rows: pd.DataFrame, spans: tuple[Column, ...] = ()) -> Block:
        """Write a table of means; those below the limit show red."""
        columns = tuple(column for column in (first, *spans, *_VALUES) if _has(column, rows))
        block = page.table(columns, (keyed(columns, self.cells(row)) for row in rows.to_dict("records")))
        colour_word(block, HOLDS)
        self.colour(block, (block.cells("weighted"), block.cells("mean")))
        return block

    def colour(self, block: Block, areas: tuple[str, ...]) -> None:
        """Let means below the limit show red."""
        if self.below:
            for area in areas:
                colour_red(block, area, self.below)

    def cells(self, row: Mapping[Any, Any]) -> dict[str, Any]:
        """Return the cells of a row of table ``useful_voltage``."""
        means = {name: mean_cell(row, name) for name in _SUMS}
        sums = {key: row.get(name) for key, name in _OF_SUMS.items()}
        told = {"from": row["from_s"], "to": row["to_s"], "trains": row["trains"], "left_out": row["left_out"]}
        return {"subject": row["subject"], **told, **means, **sums, "holds": self._verdict(row, means)}

    def _verdict(self, row: Mapping[Any, Any], means: Mapping[str, Any]) -> Formula | str:
        values = [value for value in map(_value, means.values()) if known(value)]
        if self.limit is None or not values:
            return tr(UNRATED)
        word = NO if min(values) < self.limit.value - TOLERANCE_V else YES
        numbers = f"ISNUMBER({self.limit_cell}),COUNT({{weighted}},{{mean}})>0"
        held = f'IF(MIN({{weighted}},{{mean}}){self.below},"{tr(NO)}","{tr(YES)}")'
        text = f'IF(AND({numbers}),{held},"{tr(OPEN)}")'
        return judged(text, word, str(row["met"]))


def mean_cell(row: Mapping[Any, Any], name: str) -> Any:
    """Return a mean as a formula on its sums where the table has them, else the value; None without one."""
    above, below, text, factor = _SUMS[name]
    value = row[_COLUMNS[name]]
    if not known(value):
        return None
    total, divisor = (float(row.get(_OF_SUMS[each], np.nan)) for each in (above, below))
    return Formula(text, factor * total / divisor) if np.isfinite(total) and divisor > 0.0 else float(value)


def _has(column: Column, rows: pd.DataFrame) -> bool:
    """Return whether a column can be filled: results of earlier versions have no sums."""
    return _OF_SUMS.get(column.key, "subject") in rows.columns


def _value(cell: Any) -> Any:
    return cell.value if isinstance(cell, Formula) else cell


def _hours(book: Book, rows: pd.DataFrame, limit: Limit | None) -> None:
    """Add zones by the hour: a row for each hour and a column for each zone, and below all of them with their sums.

    Zones stand in the order of table ``useful_voltage``, along the line, from whichever hour on they have trains; one without
    a mean in any hour, as beyond the last substation, is left out.
    """
    along = list(dict.fromkeys(rows["subject"].astype(str)))
    rows = rows[rows["window"] == "hour"]
    means = rows[list(_COLUMNS.values())].notna().any(axis=1).groupby(rows["subject"].astype(str)).any()
    zones = [zone for zone in along if means.get(zone, False)]
    rows = rows[rows["subject"].astype(str).isin(zones)]
    if rows.empty:
        return
    page = book.page("Useful voltage by hour", "Mean useful voltage of the zones in every hour, by both definitions")
    judge = _Judge(limit, _limit_line(page, limit))
    page.note("Red: below the lowest permitted. The list of all hours below holds the sums that the means come from.")
    ordered = rows.assign(zone=rows["subject"].astype(str)).sort_values(["from_s"], kind="stable")
    numbers = {(row["from_s"], row["zone"]): k for k, row in enumerate(ordered.to_dict("records"), 1)}
    cells = [judge.cells(row) for row in ordered.to_dict("records")]
    columns = (Column("hour begins", "time"), *(Column(zone, "0", key=f"zone_{k}") for k, zone in enumerate(zones)))
    for name, words in (("weighted", mark("Weighted by current [V]")), ("mean", mark("Mean over time [V]"))):
        page.section(words)
        block = page.table(columns, _matrix(zones, numbers, cells, name))
        judge.colour(block, (f"{block.cell('zone_0', block.first)}:{block.cell(f'zone_{len(zones) - 1}', block.last)}",))
    page.new_page()
    page.section("All hours")
    block = judge.table(page, Column("zone", widest=40, key="subject"), ordered, spans=_SPAN[:1])
    for name in _SUMS:
        book.define(f"hourly_{name}", page, block.cells(name))
    _accept(book, page, (block, "hour"), ordered, limit)


def _matrix(
    zones: list[str], numbers: Mapping[tuple[float, str], int], cells: list[dict[str, Any]], name: str
) -> Iterator[list[Any]]:
    """Yield rows of hours, by formulas on the list of all hours."""
    for hour in dict.fromkeys(hour for hour, _ in numbers):
        row: list[Any] = [hour]
        for zone in zones:
            at = numbers.get((hour, zone))
            value = None if at is None else _value(cells[at - 1][name])
            row.append(Formula(f"INDEX({{hourly_{name}}},{at})", value) if known(value) else None)
        yield row


_WINDOWS = {"run": "", "hour": ", worst hour", "given": ", worst given part of the day"}


def _accept(book: Book, page: Page, at: tuple[Block, str], rows: pd.DataFrame, limit: Limit | None) -> None:
    """Tell the sheet of acceptance the lowest means of zones, by formulas on a table of them."""
    block, window = at
    for name in _SUMS:
        area = f"useful_{window}_{name}"
        book.define(area, page, block.cells(name))
        book.acceptance += _accepted(book.facts, rows, (window, name), limit, f"MIN({{{area}}})")


def _accept_plain(book: Book, rows: pd.DataFrame, window: str, limit: Limit | None) -> None:
    """Tell it without formulas where other rows stand between."""
    for name in _SUMS:
        book.acceptance += _accepted(book.facts, rows, (window, name), limit, "")


def _accepted(facts: Facts, rows: pd.DataFrame, what: tuple[str, str], limit: Limit | None, text: str) -> Iterator[Accepted]:
    (window, name), told = what, rows[rows[_COLUMNS[what[1]]].notna()]
    if limit is None or told.empty:
        return
    worst = told.iloc[int(told[_COLUMNS[name]].argmin())]
    lowest = min(_value(mean_cell(row, name)) for row in told.to_dict("records"))
    stay = f"(of trains there for {facts.scenario.sizing.useful_voltage.shortest_stay_s:g} s or more)"
    yield Accepted(
        f"{ZONES}, {DEFINITIONS[_COLUMNS[name]]}{_WINDOWS[window]} {stay}", limit.name, limit.value, "V", "at_least",
        Formula(text, lowest) if text else lowest, f"zone {worst['subject']}",
        "" if window == "run" else format_time(worst["from_s"]), limit.status, limit.source, tolerance=TOLERANCE_V,
    )  # fmt: skip
