"""The sheet of how long which voltage lasts at the pantographs, in bands between the limits of the voltage."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.model.base import format_time
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.accepted import Accepted
from tractionpower.reporting.workbook.common.verdicts import Comparison, same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.sizing.judging import BY_RATING, HOLDS, NO, YES, colour_word, judged, known
from tractionpower.results.verdicts import AT_MOST

NOT_LIMITED = mark("not limited")
MOST_ROWS = 3000
"""Rows of single trains; with more, those with the longest times are shown."""

_SLACK = "1E-6"
"""By which a time may be longer than permitted, as `results.voltage_bands` has it [s]."""

_LIMITS = {"U_min2 to U_min1": "t_min2", "U_max1 to U_max2": "t_max2"}
"""Limits of times by their bands; in others any time is permitted, or none."""

_BANDS = (
    Column("train", widest=28),
    Column("band", widest=34),
    Column("from [V]", "0"),
    Column("to [V]", "0"),
    Column("time in the band [s]", "0.0", key="total"),
    Column("share of the time [%]", "0.00"),
    Column("time in it or beyond [s]", "0.0", key="beyond"),
    Column("longest of these without a break [s]", "0.0", key="longest"),
    Column("that begins", "time"),
    Column("permitted [s]", "0", key="permitted"),
    Column(HOLDS, "beside", key="holds"),
)


def add(book: Book) -> None:
    """Add the sheet, if the run has the table."""
    rows = book.facts.table("voltage_durations")
    if rows.empty:
        return
    rows = rows.assign(train=rows["train"].astype(str), band=rows["band"].astype(str), beyond_s=_beyond(rows))
    page = book.page("Voltage durations", "How long which voltage lasts at the pantographs")
    page.note(
        "Bands between the limits of the voltage of this system (quantities as in EN 50163). A time counts as 'in it or beyond'"
        " while the voltage is in the band or further away from the nominal one: so limits of times are meant, and so the longest"
        " of them can be longer than the time in the band alone. Permitted 0 s: none; empty: any. Sheet Inputs limits has source"
        " and status of each limit; those that are not 'verified' are editable values."
    )
    every = rows[rows["train"] == ""]
    limits: dict[str, str] = {}
    if len(every):
        page.section("All trains")
        block = page.table(_BANDS, _every(every, page.next + 1))
        colour_word(block, HOLDS)
        for row, told in enumerate(every.to_dict("records"), block.first):
            if known(told["permitted_s"]):
                page.edit(block.cell("permitted", row), "0", 0.0)
                limits[told["band"]] = block.cell("permitted", row)
        book.define("duration_longest", page, block.cells("longest"))
        book.acceptance += _accepted(book.facts, every, rows)
    trains = rows[(rows["train"] != "") & (rows["total_s"] > 0.0)]
    page.section("Each train, bands that it was in, where something is limited")
    trains = trains[trains["permitted_s"].notna()]
    if trains.empty:
        page.line("No train was in a band whose time is limited.")
        return
    if len(trains) > MOST_ROWS:
        page.note(tr("The longest {shown} of {all}; table voltage_durations has all.", shown=MOST_ROWS, all=len(trains)))
    longest = trains.sort_values("longest_s", ascending=False, kind="stable").head(MOST_ROWS)
    colour_word(page.table(_BANDS, _single(longest, limits)), HOLDS)


def _beyond(rows: pd.DataFrame) -> Any:
    """Return of each row the time in the band or further away from the nominal voltage [s]."""
    order = rows.reset_index(drop=True)
    found = np.zeros(len(order))
    for _, own in order.groupby("train", observed=True, sort=False):
        low = _is_low(own["band"].astype(str).tolist())
        for k, at in enumerate(own.index):
            outer = slice(None, k + 1) if low[k] else slice(k, None)
            found[at] = own["total_s"].iloc[outer].sum()
    return np.round(found, 6)


def _is_low(bands: list[str]) -> list[bool]:
    """Return for bands by rising voltage whether each is below the nominal voltage."""
    nominal = next((k for k, band in enumerate(bands) if band.endswith("U_n")), -1)
    return [k <= nominal or band.startswith("below") for k, band in enumerate(bands)]


def _every(rows: pd.DataFrame, first: int) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of all trains together: shares and times beyond are sums of their table, from row `first` on."""
    count, total = len(rows), float(rows["total_s"].sum())
    low = _is_low(rows["band"].tolist())
    for k, row in enumerate(rows.to_dict("records")):
        begin, end = (first, first + k) if low[k] else (first + k, first + count - 1)
        every = f"SUM($E${first}:$E${first + count - 1})"
        share = Formula(f"100*{{total}}/{every}", 100.0 * row["total_s"] / total) if total else None
        inside = float(rows["total_s"].iloc[begin - first : end - first + 1].sum())
        beyond = Formula(f"SUM(E{begin}:E{end})", inside)
        permitted = row["permitted_s"]
        name = _LIMITS.get(row["band"])
        limit = Formula(same_as(f"{{limit_{name}}}"), permitted) if name and known(permitted) else permitted
        yield _row(row, tr("all trains"), (share, beyond, limit))


def _single(rows: pd.DataFrame, limits: dict[str, str]) -> Iterator[tuple[Any, ...]]:
    for row in rows.to_dict("records"):
        cell = limits.get(row["band"])
        permitted = row["permitted_s"] if cell is None else Formula(same_as(cell), row["permitted_s"])
        yield _row(row, row["train"], (row["share_percent"], row["beyond_s"], permitted))


def _row(row: dict[Any, Any], train: str, cells: tuple[Any, Any, Any]) -> tuple[Any, ...]:
    """Return a row; `cells`: share of the time, time in the band or beyond, what is permitted."""
    share, beyond, permitted = cells
    holds: Formula | str = tr(NOT_LIMITED)
    if known(row["permitted_s"]):
        word = NO if row["longest_s"] > row["permitted_s"] + float(_SLACK) else YES
        holds = judged(Comparison("{longest}", "{permitted}", AT_MOST, _SLACK).verdict(BY_RATING), word, str(row["met"]))
    return (
        train, recorded(row["band"]), row["from_v"], row["to_v"], row["total_s"], share, beyond, row["longest_s"],
        row["longest_from_s"], permitted, holds,
    )  # fmt: skip


def _accepted(facts: Facts, every: pd.DataFrame, rows: pd.DataFrame) -> Iterator[Accepted]:
    """Yield the longest times in bands whose time is limited by the limits table."""
    for number, row in enumerate(every.to_dict("records"), 1):
        limit = facts.limit(_LIMITS.get(row["band"], ""))
        if limit is None or not known(row["permitted_s"]):
            continue
        name = "longest spell above U_max1" if limit.name == "t_max2" else "longest spell below U_min1"
        own = rows[(rows["train"] != "") & (rows["band"] == row["band"]) & (rows["longest_s"] == row["longest_s"])]
        place = f"train {own['train'].iloc[0]}" if len(own) and row["longest_s"] > 0.0 else ""
        when = format_time(row["longest_from_s"]) if known(row["longest_from_s"]) else ""
        yield Accepted(
            name, limit.name, limit.value, "s", "at_most", Formula(f"INDEX({{duration_longest}},{number})", row["longest_s"]),
            place, when, limit.status, limit.source, tolerance=float(_SLACK),
        )  # fmt: skip
