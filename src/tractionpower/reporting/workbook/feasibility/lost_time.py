"""The sheet of lost time: seconds lost to low voltage by the area of substations and by kilometre, with charts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pandas as pd

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, Line, bars, draw, scatter
from tractionpower.reporting.workbook.variants.axes import fit_axis, rooms_for_charts

LEAST_S = 0.05
"""Less is not shown [s]."""

MOST_AREAS = 24
"""Areas that bars are legible for."""

KM, LOST, AREA, NET = "place [km]", "lost [s]", "area of", "lost less gained [s]"


def add(book: Book) -> None:
    """Add the sheet, if seconds are lost somewhere."""
    frame = book.facts.table("lost_time")
    if frame.empty or not (frame["lost_s"].abs() >= LEAST_S).any():
        return
    page = book.page("Lost time", "Seconds lost to low voltage, by place")
    page.note(
        "Running time of each train alone on the voltages of the run, less that at nominal voltage, both with train current"
        " limits and driven flat out; summed over all trains. Gained: the voltage is above the nominal one; seconds that are"
        " gained are not set against losses elsewhere. The area of a place is that of the nearest substation that feeds there."
    )
    frame = frame.assign(area=frame["area"].astype(str), track=frame["track"].astype(str), km=frame["km"].round(6))
    lines = [tracks for tracks in book.facts.lines.lines if frame["track"].isin(list(tracks)).any()]
    kept = [_by_km(frame[frame["track"].isin(list(tracks))]) for tracks in lines]
    areas = _areas(page, frame, kept)
    if areas is not None:
        page.new_page()
        some = Block(areas.sheet, areas.first, min(areas.last, areas.first + MOST_AREAS - 1), areas.headings, areas.keys)
        chart = bars(tr("Seconds lost to low voltage, all trains"), tr(LOST), some, AREA, [LOST])
        chart.y_axis.scaling.min = 0
        page.next += 1
        page.chart(chart)
        page.new_page()
        page.next += 1
    rooms = rooms_for_charts(page, len(lines))
    for number, (tracks, rows, row) in enumerate(zip(lines, kept, rooms, strict=True), 1):
        page.section(tr("By kilometre, {tracks}", tracks=told(tracks)))
        columns = (
            Column(AREA, widest=26), Column(KM, "0.0"), Column(LOST, "0.00", key="lost"),
            Column("gained [s]", "0.00", key="gained"), Column(NET, "0.00"), Column("trains that lose there", "0"),
        )  # fmt: skip
        block = page.table(columns, ([*line[:4], _net(line), line[4]] for line in rows))
        book.define(f"lost_areas_{number}", page, block.cells(AREA))
        book.define(f"lost_by_km_{number}", page, block.cells("lost"))
        page.chart(_along(tracks, block, rows), row)


Kilometre = tuple[str, float, float, float, int]
"""Area, place [km], what is lost and gained there [s], and trains that lose there."""


def _by_km(own: pd.DataFrame) -> list[Kilometre]:
    """Return the kilometres of a line of tracks, in their order."""
    rows = []
    for _, some in own.groupby(["km", "area"], sort=True):
        km, area = float(some["km"].iloc[0]), str(some["area"].iloc[0])
        lost = some["lost_s"].to_numpy(float)
        trains = some.loc[some["lost_s"] >= LEAST_S / 10.0, "train"].nunique()
        rows.append((area, km, float(lost[lost > 0.0].sum()), float(-lost[lost < 0.0].sum()), int(trains)))
    return rows


def _net(line: Kilometre) -> Formula:
    return Formula("{lost}-{gained}", line[2] - line[3])


def _areas(page: Page, frame: pd.DataFrame, kept: Sequence[Sequence[Kilometre]]) -> Block | None:
    """Write what is lost in the area of each substation: sums over the kilometres below, by formulas."""
    lost = frame[frame["lost_s"] > 0.0]
    sums = {area: math.fsum(row[2] for rows in kept for row in rows if row[0] == area) for area in lost["area"].unique()}
    order = sorted((area for area in sums if sums[area] >= LEAST_S), key=lambda area: (-sums[area], area))
    if not order:
        return None
    page.section("By area")
    columns = (
        Column(AREA, widest=30, key="area"),
        Column(LOST, "0.0", key="lost"),
        Column("trains that lose there", "0"),
        Column("most of a train in a kilometre [s]", "0.0"),
    )
    own = lost.groupby("area")
    trains, most = own["train"].nunique(), own["lost_s"].max()
    parts = "+".join(f"SUMPRODUCT(({{lost_areas_{k}}}={{area}})*{{lost_by_km_{k}}})" for k in range(1, len(kept) + 1))
    rows = [(area, Formula(parts, sums[area]) if area else sums[area], trains[area], most[area]) for area in order]
    block = page.table(columns, [(area or tr("no substation"), *rest) for area, *rest in rows])
    page.next -= 1
    page.put(page.next, 1, tr("all"), "label")
    page.put(page.next, 2, Formula(f"SUM({block.cells('lost')})", math.fsum(sums[area] for area in order)), "sum 0.0")
    page.next += 2
    return block


def _along(tracks: Sequence[str], block: Block, rows: Sequence[Kilometre]) -> Any:
    title = tr("Seconds lost to low voltage in each kilometre, {tracks}", tracks=told(tracks))
    chart = scatter(title, tr(KM), tr(NET), legend=False)
    draw(chart, block, Line(tr(LOST), KM, NET, block.first, block.last, COLOURS[1]))
    fit_axis(chart.x_axis, [row[1] for row in rows], ticks=10)
    fit_axis(chart.y_axis, [0.0, *(net for row in rows if (net := row[2] - row[3]) >= LEAST_S or net <= -LEAST_S)])
    return chart
