"""The sheet of trains on a line with stations: running and waiting times, speeds, tracks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.stations.station_facts import StationTrain, facts_of

_COLUMNS = (
    Column("train", widest=26),
    Column("kind", "beside", widest=22),
    Column("entered at [s]", "0.0", key="entered"),
    Column("left at [s]", "0.0", key="left"),
    Column("running time [s]", "0.0", key="running"),
    Column("waited to enter [s]", "0.0", key="to_enter"),
    Column("waited for a track [s]", "0.0", key="for_track"),
    Column("waited for the line ahead [s]", "0.0", key="for_line"),
    Column("waited [s]", "0.0", key="waited"),
    Column("time in stations [s]", "0.0", key="stood"),
    Column("mean speed [km/h]", "0.0", key="mean"),
    Column("highest speed [km/h]", "0.0"),
    Column("tracks of the stations", "beside", widest=24),
)


def add(book: Book) -> None:
    """Add the sheet, if trains have come."""
    facts = facts_of(book)
    if not facts.trains:
        return
    page = book.page("Trains", "Trains: running and waiting times")
    page.note(
        "Running time: from entering the line to leaving it, stops and waiting on the way included; the mean speed is that of"
        " the whole line in this time. Trains wait to enter, before a station for a free track, and in it for the line ahead."
        " Running times, sums and mean speeds are formulas."
    )
    block = page.table(_COLUMNS, list(_rows(facts.trains, facts.scenario.length_m)), frozen=True)
    _sums(page, block, facts.trains)


def _rows(trains: Sequence[StationTrain], length_m: float) -> Iterator[tuple[Any, ...]]:
    for train in trains:
        has_left = math.isfinite(train.running_s)
        mean = 3.6 * length_m / train.running_s if has_left and train.running_s > 0.0 else ""
        yield (
            train.name, train.kind, train.entered_s, train.left_s,
            Formula('IF(ISNUMBER({left}),{left}-{entered},"")', train.running_s if has_left else ""),
            train.waited_entry_s, train.waited_track_s, train.waited_line_s,
            Formula("{to_enter}+{for_track}+{for_line}", train.waited_s), train.stood_s,
            Formula(f'IF(ISNUMBER({{running}}),IF({{running}}>0,{3.6 * length_m:.10g}/{{running}},""),"")', mean),
            train.greatest_kmh, train.tracks,
        )  # fmt: skip


def _sums(page: Page, block: Block, trains: Sequence[StationTrain]) -> None:
    """Write sums of the waiting times and the mean running time below the table."""
    row, running = block.last + 1, [train.running_s for train in trains if math.isfinite(train.running_s)]
    for column in range(1, len(block.headings) + 1):
        page.put(row, column, tr("sums, and the mean running time") if column == 1 else None, "sum text")
    for key, values in (
        ("to_enter", [train.waited_entry_s for train in trains]),
        ("for_track", [train.waited_track_s for train in trains]),
        ("for_line", [train.waited_line_s for train in trains]),
        ("waited", [train.waited_s for train in trains]),
        ("stood", [train.stood_s for train in trains]),
    ):
        page.put(row, block.column(key), Formula(f"SUM({block.cells(key)})", math.fsum(values)), "sum 0.0")
    mean = math.fsum(running) / len(running) if running else ""
    cells = block.cells("running")
    page.put(row, block.column("running"), Formula(f'IF(COUNT({cells})>0,AVERAGE({cells}),"")', mean), "sum 0.0")
    page.next = row + 2
