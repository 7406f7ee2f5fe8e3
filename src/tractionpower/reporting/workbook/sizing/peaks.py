"""The sheets of peaks, with the trains that cause them, and of breakers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from tractionpower.reporting.facts.device_words import KINDS
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.sizing.ratings import HOLDS, colour_use, colour_word, places_of

SHARE = "highest of the setting [%]"
OTHERS = "all fixed loads"
NO_SETTING = "no setting"
LEAST_PERCENT = 1.0
"""Parts of a peak that are less than this of it are left out [%]."""

Places = Mapping[str, tuple[int, float]]
"""Kind and place of devices [km]."""

_PEAKS = (
    Column("device", widest=34),
    Column("kind", widest=28),
    Column("highest current [A]", "0"),
    Column("at", "time"),
    Column("train", "beside", 24),
    Column("takes then [A]", "0"),
    Column("on track"),
    Column("at [km]", "0.000"),
    Column("part of the peak [A]", "0"),
    Column("part [%]", "0.0"),
)


def add(book: Book) -> None:
    """Add the sheets, if the run has peaks and breakers."""
    places = places_of(book.facts)
    rows = book.facts.table("peaks")
    if len(rows):
        page = book.page("Peaks", "Peaks: the highest current of every device, and the trains that cause it")
        page.note(
            "Highest mean of a step of the current, in either direction. The part of a train is what falls away from the peak"
            " without it, by superposition: currents of the others held as they are. Trains that give current back have"
            " negative parts; the parts of substations' no-load voltages that differ from each other belong to no train."
            f" Parts below {LEAST_PERCENT:g} % are left out; table peaks has more."
        )
        page.table(_PEAKS, _peaks(rows, places), frozen=True)
    _breakers(book, places)


def _peaks(rows: pd.DataFrame, places: Places) -> Iterator[tuple[Any, ...]]:
    known = [rows["part_a"].abs() >= LEAST_PERCENT / 100.0 * rows["peak_a"], ~rows.duplicated("device")]
    for row in _in_order(rows[known[0] | known[1]], places).to_dict("records"):
        share = 100.0 * row["part_a"] / row["peak_a"] if row["peak_a"] else None
        yield (
            row["device"], KINDS.get(str(row["kind"]), row["kind"]), row["peak_a"], row["peak_s"], str(row["train"]) or OTHERS,
            row["train_current_a"], row["track"], row["position_km"], row["part_a"], share,
        )  # fmt: skip


def _in_order(rows: pd.DataFrame, places: Places) -> pd.DataFrame:
    """Return rows of devices by kind and along the line; the rows of a device stay as they are."""
    order = sorted(set(rows["device"].astype(str)), key=lambda device: (*places.get(device, (99, 0.0)), device))
    number = {device: k for k, device in enumerate(order)}
    return rows.assign(_at=rows["device"].astype(str).map(number)).sort_values("_at", kind="stable").drop(columns="_at")


def _breakers(book: Book, places: Places) -> None:
    rows = book.facts.table("breakers")
    if rows.empty:
        return
    page = book.page("Breakers", "Breakers: currents of the feeders against their settings")
    page.note(
        "How long a current stays above a share of the setting: the longest time without a break, and all in all. What counts"
        " is the mean of a step; within a step, and in a fault, currents are higher."
    )
    levels = sorted(rows["level_percent"].dropna().unique())
    columns = (
        Column("feeder", widest=34),
        Column("setting [A]", "0"),
        Column("highest current [A]", "0"),
        Column("at", "time"),
        Column(SHARE, "0.0"),
        Column(HOLDS, "beside"),
        Column("trips", "0"),
        *(Column(f"longest above {level:g} % [s]", "0.0") for level in levels),
        *(Column(f"in all above {level:g} % [s]", "0.0") for level in levels),
    )
    block = page.table(columns, _breaker_rows(_in_order(rows, places), levels), frozen=True)
    colour_use(block, SHARE, book.facts.scenario.sizing.breaker_percent)
    colour_word(block, HOLDS)


def _breaker_rows(rows: pd.DataFrame, levels: list[float]) -> Iterator[tuple[Any, ...]]:
    for device, own in rows.groupby(rows["device"].astype(str), sort=False):
        first = own.iloc[0]
        by_level = own.drop_duplicates("level_percent").set_index("level_percent")
        times = [by_level[name].get(level) for name in ("longest_s", "total_s") for level in levels]
        met = str(first["met"]) or NO_SETTING
        yield device, first["setting_a"], first["peak_a"], first["peak_s"], first["share_percent"], met, first["trips"], *times
