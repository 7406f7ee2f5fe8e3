"""The sheets of peaks, with the trains that cause them, and of breakers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd
from openpyxl.utils import absolute_coordinate

from tractionpower.model.base import format_time
from tractionpower.reporting.facts.device_words import KINDS, device_told
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.reporting.workbook.common.accepted import Accepted
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    YES,
    at_most,
    banner,
    colour_use,
    colour_word,
    judged,
    known,
    limit_line,
    sentence,
)
from tractionpower.reporting.workbook.sizing.ratings import places_of
from tractionpower.studies.cases.judgement import PEAK

SHARE = mark("highest of the setting [%]")
OTHERS = mark("all fixed loads")
NO_SETTING = mark("no setting")
LEAST_PERCENT = 1.0
"""Parts of a peak that are less than this of it are left out [%]."""

MOST_PRINTED = 400
"""Rows of peaks that are printed whole."""

Places = Mapping[str, tuple[int, float]]
"""Kind and place of devices [km]."""

_PEAKS = (
    Column("device", widest=34),
    Column("kind", widest=28),
    Column("highest current [A]", "0", key="peak"),
    Column("at", "time"),
    Column("train", "beside", 24),
    Column("takes then [A]", "0"),
    Column("on track"),
    Column("at [km]", "0.000"),
    Column("part of the peak [A]", "0", key="part"),
    Column("part [%]", "0.0"),
)


def add(book: Book) -> None:
    """Add the sheets, if the run has peaks and breakers."""
    places = places_of(book.facts)
    rows = book.facts.table("peaks")
    if len(rows):
        page = book.page("Peaks", "Peaks: the highest current of every device, and the trains that cause it")
        page.note(
            tr(
                "Highest mean of a step of the current, in either direction. The part of a train is what falls away from the"
                " peak without it, by superposition: currents of the others held as they are. Trains that give current back"
                " have negative parts; the parts of substations' no-load voltages that differ from each other belong to no"
                " train. Parts below {least} % are left out; table peaks has more.",
                least=number(LEAST_PERCENT),
            )
        )
        page.table(_PEAKS, _peaks(rows, places), frozen=True, printed=MOST_PRINTED)
    _breakers(book, places)


def _peaks(rows: pd.DataFrame, places: Places) -> Iterator[tuple[Any, ...]]:
    kept = [rows["part_a"].abs() >= LEAST_PERCENT / 100.0 * rows["peak_a"], ~rows.duplicated("device")]
    for row in _in_order(rows[kept[0] | kept[1]], places).to_dict("records"):
        is_known = bool(row["peak_a"]) and known(row["part_a"])
        share = Formula("100*{part}/{peak}", 100.0 * row["part_a"] / row["peak_a"]) if is_known else None
        kind = str(row["kind"])
        yield (
            device_told(row["device"]), tr(KINDS.get(kind, kind)), row["peak_a"], row["peak_s"], str(row["train"]) or tr(OTHERS),
            row["train_current_a"], row["track"], row["position_km"], row["part_a"], share,
        )  # fmt: skip


def _in_order(rows: pd.DataFrame, places: Places) -> pd.DataFrame:
    """Return rows of devices by kind and along the line; the rows of a device stay as they are."""
    order = sorted(set(rows["device"].astype(str)), key=lambda device: (*places.get(device, (99, 0.0)), device))
    number_of = {device: k for k, device in enumerate(order)}
    return rows.assign(_at=rows["device"].astype(str).map(number_of)).sort_values("_at", kind="stable").drop(columns="_at")


def _breakers(book: Book, places: Places) -> None:
    rows = book.facts.table("breakers")
    if rows.empty:
        return
    permitted = book.facts.scenario.sizing.breaker_percent
    page = book.page("Breakers", "Breakers: currents of the feeders against their settings")
    head = page.next
    page.next += 1  # for the banner
    limit = limit_line(page, tr("Permitted, of the setting"), "breaker_percent", permitted, "%")
    page.note(
        "How long a current stays above a share of the setting: the longest time without a break, and all in all. What counts"
        " is the mean of a step; within a step, and in a fault, currents are higher. Settings can be edited: shares and verdicts"
        " follow, durations do not."
    )
    levels = sorted(rows["level_percent"].dropna().unique())
    columns = (
        Column("feeder", widest=34),
        Column("setting [A]", "0", key="setting"),
        Column("highest current [A]", "0", key="peak"),
        Column("at", "time"),
        Column(SHARE, "0.0", key="share"),
        Column(HOLDS, "beside", key="holds"),
        Column("trips", "0"),
        *(Column(tr("longest above {level} % [s]", level=number(level)), "0.0") for level in levels),
        *(Column(tr("in all above {level} % [s]", level=number(level)), "0.0") for level in levels),
    )
    ordered = _in_order(rows, places)
    block = page.table(columns, _breaker_rows(ordered, levels, (limit, permitted)), frozen=True)
    for row in range(block.first, block.last + 1):
        page.edit(block.cell("setting", row), "0", 0.0)
    colour_use(block, SHARE, limit)
    colour_word(block, HOLDS)
    book.define("breaker_shares", page, block.cells("share"))
    end, page.next = page.next, head
    _breaker_banner(page, ordered, block.cells("holds"))
    page.next = end
    book.acceptance.append(_accepted(page, ordered, permitted))


def _breaker_banner(page: Any, rows: pd.DataFrame, verdicts: str) -> None:
    """Say how many feeders pass their settings."""
    first = rows.drop_duplicates("device")
    many, bad = int((first["met"].astype(str) != "").sum()), int((first["met"].astype(str) == "no").sum())
    verdicts = absolute_coordinate(verdicts)
    count = f'COUNTIF({verdicts},"{tr(NO)}")'
    all_of = f'({count}+COUNTIF({verdicts},"{tr(YES)}"))'
    told = sentence(tr("{bad} of {many} feeders beyond the setting of their breakers"), bad=(count, bad), many=(all_of, many))
    none = sentence(tr("No feeder has a breaker with a setting"))
    text = Formula(f"IF({all_of}=0,{none.text},{told.text})", (told if many else none).value)
    banner(page, text, "good", f"{count}>0", doubt=f"{all_of}=0")


def _breaker_rows(rows: pd.DataFrame, levels: list[float], limit: tuple[str, float]) -> Iterator[tuple[Any, ...]]:
    for device, own in rows.groupby(rows["device"].astype(str), sort=False):
        first = own.iloc[0]
        by_level = own.drop_duplicates("level_percent").set_index("level_percent")
        times = [by_level[name].get(level) for name in ("longest_s", "total_s") for level in levels]
        setting, peak = float(first["setting_a"]), float(first["peak_a"])
        has_one = math.isfinite(setting) and setting > 0.0
        value = 100.0 * peak / setting if has_one else ""
        share = Formula('IF(ISNUMBER({setting}),100*{peak}/{setting},"")', value)
        verdict = f'IF(ISNUMBER({{share}}),{at_most("share", limit[0])},"{tr(NO_SETTING)}")'
        holds: Formula | str = Formula(verdict, tr(NO_SETTING))
        if isinstance(value, float):
            holds = judged(verdict, NO if value > limit[1] * (1.0 + 1e-9) else YES, str(first["met"]))
        yield device_told(device), setting, peak, first["peak_s"], share, holds, first["trips"], *times


def _accepted(page: Page, rows: pd.DataFrame, permitted: float) -> Accepted:
    """Return the feeder with the highest share of its setting; without settings a row for those that are filled in."""
    rated = rows[rows["share_percent"].notna()]
    share: float | str = ""
    place, when = tr("see sheet {sheet}", sheet=page.sheet.title), ""
    if len(rated):
        worst = rated.iloc[int(rated["share_percent"].argmax())]
        share = 100.0 * float(worst["peak_a"]) / float(worst["setting_a"])
        place, when = str(worst["device"]), format_time(worst["peak_s"]) if known(worst["peak_s"]) else ""
    found = Formula('IF(COUNT({breaker_shares})=0,"",MAX({breaker_shares}))', share)
    return Accepted(
        PEAK, "breaker_percent", permitted, "%", "at_most", found, place, when, "user", "settings of the inputs", bare=NO_SETTING,
    )  # fmt: skip
