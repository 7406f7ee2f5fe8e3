"""The sheet of lost time: seconds lost to low voltage by the area of substations and by kilometre, with charts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, Line, bars, draw, scatter

LEAST_S = 0.05
"""Less is not shown [s]."""

KM, LOST, AREA = "place [km]", "lost [s]", "area of"


def add(book: Book) -> None:
    """Add the sheet, if seconds are lost somewhere."""
    frame = book.facts.table("lost_time")
    if frame.empty or not (frame["lost_s"].abs() >= LEAST_S).any():
        return
    page = book.page("Lost time", "Seconds lost to low voltage, by place")
    page.note(
        "Running time of each train alone on the voltages of the run, less that at nominal voltage, both with train current"
        " limits and driven flat out; summed over all trains. Negative: gained, since the voltage is above the nominal one. The"
        " area of a place is that of the nearest substation that feeds there."
    )
    areas = _areas(page, frame)
    if areas is not None:
        page.new_page()
        chart = bars("Seconds lost to low voltage, all trains", LOST, areas, AREA, [LOST])
        chart.y_axis.scaling.min = 0
        page.chart(chart)
    lines = [tracks for tracks in book.facts.lines.lines if frame["track"].astype(str).isin(list(tracks)).any()]
    rows = []
    for _ in lines:  # charts before the long tables that they are drawn from
        page.new_page()
        rows.append(page.room_for_chart())
    page.new_page()
    for tracks, row in zip(lines, rows, strict=True):
        page.chart(_along(tracks, _by_km(page, frame, tracks)), row)


def _areas(page: Page, frame: pd.DataFrame) -> Block | None:
    lost = frame[frame["lost_s"] > 0.0]
    sums = lost.groupby(lost["area"].astype(str))["lost_s"].agg(["sum", "max"])
    trains = lost.groupby(lost["area"].astype(str))["train"].nunique()
    sums = sums[sums["sum"] >= LEAST_S].sort_values("sum", ascending=False, kind="stable")
    if sums.empty:
        return None
    page.section("By area")
    columns = (
        Column(AREA, widest=30),
        Column(LOST, "0.0"),
        Column("trains that lose there", "0"),
        Column("most in a kilometre [s]", "0.0"),
    )
    many = dict(trains.items())
    rows = [(str(area) or "no substation", row["sum"], many[area], row["max"]) for area, row in sums.iterrows()]
    return page.table(columns, rows)


def _by_km(page: Page, frame: pd.DataFrame, tracks: Sequence[str]) -> Block:
    """Write a table of the kilometres of a line of tracks."""
    own = frame[frame["track"].astype(str).isin(list(tracks))]
    km = own["km"].round(6)
    sums = own.groupby(km)["lost_s"].sum()
    area = dict(zip(km, own["area"].astype(str), strict=True))
    many = dict(own[own["lost_s"] >= LEAST_S / 10.0].groupby(km)["train"].nunique().items())
    page.section(f"By kilometre, {told(tracks)}")
    columns = (Column(AREA, widest=30), Column(KM, "0.0"), Column(LOST, "0.00"), Column("trains that lose there", "0"))
    return page.table(columns, [(area[at], at, seconds, many.get(at, 0)) for at, seconds in sums.items()])


def _along(tracks: Sequence[str], block: Block) -> Any:
    chart = scatter(f"Seconds lost to low voltage in each kilometre, {told(tracks)}", KM, LOST, legend=False)
    draw(chart, block, Line("lost", KM, LOST, block.first, block.last, COLOURS[1]))
    return chart
