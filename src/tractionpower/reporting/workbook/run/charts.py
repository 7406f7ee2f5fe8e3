"""The sheet of charts: train graph, voltage along the line, load curves and load duration, drawn from the extracts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.labels import CLOCK_STEPS_S
from tractionpower.reporting.workbook.frame.facts import limit_in_words
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, GREY, Line, draw, scatter, show_clock
from tractionpower.reporting.workbook.run.extracts import (
    KM,
    LIMITS,
    LOWEST,
    MEAN,
    PANTOGRAPH,
    SHARE,
    TIME,
    Drawn,
    Stretch,
    km_span,
    limit_heading,
    period_in_words,
    power_heading,
)

MOST_TRACKS = 3
"""Tracks that one chart of voltages shows."""

MOST_TICKS = 12
VOLTAGE_TICK = 200.0
"""The axis of voltages begins and ends at a multiple of this [V]."""


def draw_all(page: Page, drawn: Drawn) -> None:
    """Fill the sheet of charts from the extracts; it says what is shown and what is left out."""
    if "trains" in drawn.blocks:
        _train_graphs(page, drawn)
    if "profile" in drawn.blocks:
        _profiles(page, drawn)
    if "loads" in drawn.blocks:
        _next_page(page)
        page.section("Load curves of the substations")
        page.note(f"Power at the busbars, means of {period_in_words(drawn.period_s)} by the clock.")
        page.chart(_loads(drawn))
        _next_page(page)
        page.section("Load duration of the substations")
        page.note("Power that is reached or exceeded in a share of the time, from the means of the stored steps.")
        page.chart(_duration(drawn))


def _next_page(page: Page) -> None:
    if page.sheet._charts:
        page.new_page()


def _by_line(drawn: Drawn, stretches: Sequence[Stretch]) -> list[tuple[str, list[Stretch]]]:
    """Return the stretches of each line with what stands behind the title of its chart; alone, it has nothing there."""
    numbers = sorted({stretch.line for stretch in stretches})
    words = {number: f", {told(drawn.lines[number])}" if len(numbers) > 1 and number >= 0 else "" for number in numbers}
    return [(words[number], [each for each in stretches if each.line == number]) for number in numbers]


def _train_graphs(page: Page, drawn: Drawn) -> None:
    for words, stretches in _by_line(drawn, drawn.stretches["trains"]):
        _next_page(page)
        page.section(f"Train graph{words}")
        shown = len({stretch.name for stretch in stretches})
        page.note(f"{shown} of {drawn.trains} trains: rising kilometres blue, falling dark and dashed.")
        chart = scatter(f"Train graph{words}", TIME, KM, legend=False)
        for train in stretches:
            colour, dashes = (COLOURS[0], "solid") if train.rising else (COLOURS[-1], "dash")
            draw(chart, drawn.blocks["trains"], Line(train.name, TIME, KM, train.first, train.last, colour, dashes))
        _show_clock(chart, *drawn.spans["trains"])
        page.chart(chart)


def _profiles(page: Page, drawn: Drawn) -> None:
    for words, every in _by_line(drawn, drawn.stretches["profile"]):
        stretches = _of_interest(every)
        _next_page(page)
        page.section(f"Voltage along the line{words}")
        where = "the pantographs of trains" if stretches[0].where == PANTOGRAPH else "cross-sections"
        left_out = len({stretch.name for stretch in every} - {stretch.name for stretch in stretches})
        more = f"; {left_out} more tracks are on sheet Voltage profile" if left_out else ""
        page.note(f"Lowest and mean voltage of the run at {where}, with limits{more}.")
        page.chart(_profile(drawn, stretches, f"Voltage along the line{words}"))


def _of_interest(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Return what one chart of voltages shows: tracks at pantographs, or at cross-sections where no train ran."""
    at_trains = [stretch for stretch in stretches if stretch.where == PANTOGRAPH]
    return (at_trains or list(stretches))[:MOST_TRACKS]


def _profile(drawn: Drawn, stretches: Sequence[Stretch], title: str) -> Any:
    chart, block = scatter(title, KM, "voltage [V]"), drawn.blocks["profile"]
    for stretch, colour in zip(stretches, COLOURS, strict=False):
        for heading, dashes in ((LOWEST, "solid"), (MEAN, "sysDash")):
            name = f"track {stretch.name}, {heading.split()[0]}"
            draw(chart, block, Line(name, KM, heading, stretch.first, stretch.last, colour, dashes))
    longest = max(stretches, key=lambda stretch: stretch.last - stretch.first)
    for name, dashes in zip(LIMITS, DASHES[1:], strict=True):
        if limit_heading(name) in block.headings:
            draw(chart, block, Line(limit_in_words(name), KM, limit_heading(name), longest.first, longest.last, GREY, dashes))
    low, high = drawn.spans["voltage"]
    chart.y_axis.scaling.min = _down(low - 1.0, VOLTAGE_TICK)  # a limit is no border of the chart
    chart.y_axis.scaling.max = -_down(-high - 1.0, VOLTAGE_TICK)
    if km_span(stretches[0].line) in drawn.spans:
        first, last = drawn.spans[km_span(stretches[0].line)]
        chart.x_axis.scaling.min, chart.x_axis.scaling.max = _down(first, 1.0), -_down(-last, 1.0)
    return chart


def _loads(drawn: Drawn) -> Any:
    chart = scatter("Load curves of the substations", TIME, "power [kW]")
    _draw_substations(chart, drawn, "loads", TIME)
    _show_clock(chart, *drawn.spans["loads"])
    return chart


def _duration(drawn: Drawn) -> Any:
    chart = scatter("Load duration of the substations", SHARE, "power [kW]")
    _draw_substations(chart, drawn, "duration", SHARE)
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = 0.0, 100.0
    return chart


def _draw_substations(chart: Any, drawn: Drawn, kind: str, x: str) -> None:
    block = drawn.blocks[kind]
    if drawn.spans["power"][0] >= 0.0:
        chart.y_axis.scaling.min = 0.0
    for number, name in enumerate(drawn.substations):
        dashes, colour = DASHES[number // len(COLOURS) % len(DASHES)], COLOURS[number % len(COLOURS)]
        draw(chart, block, Line(name, x, power_heading(name), block.first, block.last, colour, dashes))


def _show_clock(chart: Any, begin_s: float, end_s: float) -> None:
    width = max(end_s - begin_s, 1.0)
    show_clock(chart.x_axis, begin_s, end_s, next((step for step in CLOCK_STEPS_S if width / step <= MOST_TICKS), 86400))


def _down(value: float, step: float) -> float:
    return value // step * step
