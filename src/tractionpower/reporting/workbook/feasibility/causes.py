"""The sheet of delays by cause: late trains where they are latest, stacked by where the seconds first arose."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from tractionpower.reporting.figures.delays.delay_styles import CAUSES, ORIGINS, cause_in_words, main_origin
from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.feasibility.delays import delay_cell, shown_delays
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import bars
from tractionpower.reporting.workbook.variants.axes import name_series, stack

FEW = 6
"""Trains whose bars fit on a page below the sums."""

MOST_BARS = 30
"""Trains that bars are legible for."""


def add(book: Book) -> None:
    """Add the sheet, if a train is late."""
    told = book.facts.feasibility
    if told is None or book.facts.table("delays").empty:
        return
    worst = latest_calls(shown_delays(book), float(told["tolerance_s"]))
    if worst.empty:
        return
    page = book.page("Delays by cause", "Delays of late trains by where their seconds first arose")
    page.note("Of each late train the timed call where it is latest; formulas on sheet Delays.")
    page.widen(24.0, 26.0)
    top = page.next + 1
    page.next += len(ORIGINS) + 4
    if len(worst) > FEW:
        page.new_page()
        page.next += 1
    room = page.room_for_chart()
    if len(worst) > FEW:
        page.new_page()
    else:
        page.next -= 12  # its bars are few, the chart is low
    names = book.facts.station_names
    columns = [
        Column("train", widest=24),
        Column("station", widest=28),
        Column("delay [s]", "0.0", key="delay"),
        *(Column(f"{tr(cause_in_words(name))} [s]", "0.0", key=name) for name in ORIGINS),
        Column("first arose mostly from", "beside", 24, "main"),
    ]
    page.section("Late trains, the latest first")
    block = page.table(
        columns,
        (
            _row(row, number + 1, names)
            for number, (_, row) in zip(worst.index.to_numpy(int).tolist(), worst.iterrows(), strict=True)
        ),
    )
    for name in ("delay", *ORIGINS):
        book.define(f"late_trains_{name}_s", page, block.cells(name))
    _sums(page, top, worst)
    page.chart(_chart(block, worst), room)


def latest_calls(frame: pd.DataFrame, tolerance_s: float) -> pd.DataFrame:
    """Return of each late train the row of the call where it is latest, the latest train first."""
    late = frame[frame["delay_s"] > tolerance_s]
    if late.empty:
        return late
    worst = late.loc[late.groupby("train", observed=True)["delay_s"].idxmax()]
    return worst.sort_values(["delay_s", "train"], ascending=[False, True], kind="stable")


def _row(row: Any, number: int, names: dict[str, str]) -> list[Any]:
    delay = delay_cell(row)
    value = delay.value if isinstance(delay, Formula) else delay
    line: list[Any] = [
        row["train"],
        names.get(str(row["station"])) or row["station"],
        Formula(f"INDEX({{delays_s}},{number})", value),
    ]
    for name in ORIGINS:
        seconds = _seconds(row, name)
        line.append(Formula(f"INDEX({{delays_origin_{name}_s}},{number})", seconds) if seconds else 0.0)
    return [*line, tr(cause_in_words(main_origin(row)))]


def _seconds(row: Any, name: str) -> float:
    """Return the seconds of a cause; what sheet Delays leaves out is nothing here, too."""
    seconds = float(row[f"origin_{name}_s"])
    return seconds if abs(seconds) >= 0.05 else 0.0


def _sums(page: Page, row: int, worst: pd.DataFrame) -> None:
    """Write the seconds of all late trains by cause, with their share."""
    for column, words in enumerate((tr("cause"), tr("seconds, all late trains"), tr("share [%]")), 1):
        page.put(row, column, words, "head")
    sums = {name: math.fsum(_seconds(each, name) for _, each in worst.iterrows()) for name in ORIGINS}
    total = math.fsum(sums.values())
    for at, name in enumerate(ORIGINS, row + 1):
        page.put(at, 1, tr(cause_in_words(name)), "text")
        page.put(at, 2, Formula(f"SUM({{late_trains_{name}_s}})", sums[name]), "0.0")
        share = Formula(f"100*B{at}/B{row + 1 + len(ORIGINS)}", 100.0 * sums[name] / total) if total else None
        page.put(at, 3, share, "0.0")
    page.put(row + 1 + len(ORIGINS), 1, tr("all"), "label")
    page.put(row + 1 + len(ORIGINS), 2, Formula(f"SUM(B{row + 1}:B{row + len(ORIGINS)})", total), "sum 0.0")


def _chart(block: Block, worst: pd.DataFrame) -> Any:
    """Return lying bars, one for each train, of many the latest."""
    last = min(block.last, block.first + MOST_BARS - 1)
    some = Block(block.sheet, block.first, last, block.headings, block.keys)
    kept = [name for name in ORIGINS if any(_seconds(row, name) for _, row in worst.iterrows())]
    title = tr("Delay where the train is latest, by where the seconds first arose")
    if last < block.last:
        title = tr("{title}: the {n} latest of {all} late trains", title=title, n=MOST_BARS, all=len(worst))
    chart = bars(title, tr("delay [s]"), some, "train", kept)
    name_series(chart, [tr(cause_in_words(name)) for name in kept])
    stack(chart, [CAUSES[name].colour.lstrip("#") for name in kept], lying=True)
    if chart.legend is None:
        chart.title = f"{title}: {tr(cause_in_words(kept[0]))}" if kept else title
        chart.title.overlay = False
    chart.height = min(chart.height, 5.5 + 0.75 * (last - block.first + 1))
    chart.y_axis.scaling.min, chart.y_axis.crosses = 0, "max"  # the first train stands above, seconds below
    return chart
