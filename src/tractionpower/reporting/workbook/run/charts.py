"""The sheet of charts, drawn from the extracts: train graph, voltages along the line and how often, loads of substations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.labels import CLOCK_STEPS_S
from tractionpower.reporting.texts import mark, number, tr
from tractionpower.reporting.workbook.frame.facts import limit_in_words
from tractionpower.reporting.workbook.frame.page import Page
from tractionpower.reporting.workbook.frame.plots import (
    BOLD,
    COLOURS,
    DASHES,
    GRID,
    INK,
    NORMAL,
    THIN,
    Line,
    bars,
    draw,
    hide_from_legend,
    mark_point,
    name_end,
    room_above,
    room_on_the_right,
    scatter,
    second_axis,
    show_clock,
)
from tractionpower.reporting.workbook.run.drawn import KM, SHARE, SPEED, TIME, VOLTAGE, Drawn, Stretch, period_in_words
from tractionpower.reporting.workbook.run.load_extracts import POWER, mean_key, power_key
from tractionpower.reporting.workbook.run.voltage_extracts import LIMITS, PANTOGRAPH, km_span, limit_key

TRACKS_OF_A_CHART, MOST_PROFILES = 2, 4
"""Tracks that one chart of voltages shows, and charts of a line."""

MOST_SUBSTATIONS = 2 * len(COLOURS)
"""Substations that a chart of loads shows: the most loaded."""

MOST_TICKS = 12
ROUND_V = 200.0

LIMIT_LOOKS = {"u_min2": ("dash", BOLD), "u_n": ("sysDot", NORMAL), "u_max1": ("dashDot", NORMAL), "u_max2": ("dash", NORMAL)}
"""Dashes and width of the lines of limits."""

CURVES = (("lowest", mark("track {track}, lowest"), "solid", NORMAL), ("mean", mark("track {track}, mean"), "sysDash", NORMAL),
          ("highest", mark("track {track}, highest"), "sysDot", THIN))  # fmt: skip


def draw_all(page: Page, drawn: Drawn) -> None:
    """Fill the sheet of charts; it says what is shown and what is left out."""
    kinds: dict[str, Callable[[Page, Drawn], None]] = {
        "trains": _train_graphs, "profile": _profiles, "histogram": _histogram, "worst": _worst_train, "loads": _loads,
        "substation": _sliding, "duration": _duration,
    }  # fmt: skip
    for kind, add in kinds.items():
        if kind in drawn.blocks:
            add(page, drawn)


def _begin(page: Page, title: str, note: str) -> None:
    """Begin a page with its heading and what there is to say of the chart."""
    if page.sheet._charts:
        page.new_page()
    page.section(title)
    page.note(note)


def _by_line(drawn: Drawn, stretches: Sequence[Stretch]) -> list[tuple[str, int, list[Stretch]]]:
    """Return what stands behind the title of each line's chart, its number and its stretches; alone, nothing stands there."""
    numbers = sorted({stretch.line for stretch in stretches})
    words = {number: f", {told(drawn.lines[number])}" if len(numbers) > 1 and number >= 0 else "" for number in numbers}
    return [(words[number], number, [each for each in stretches if each.line == number]) for number in numbers]


def _train_graphs(page: Page, drawn: Drawn) -> None:
    for words, line_number, stretches in _by_line(drawn, drawn.stretches["trains"]):
        title = tr("Train graph{which}", which=words)
        shown = len({stretch.name for stretch in stretches})
        _begin(page, title, tr("{shown} of {all} trains: rising kilometres blue, falling dark and dashed.",
                               shown=shown, all=drawn.trains))  # fmt: skip
        chart = scatter(title, tr(TIME), tr(KM), legend=False)
        for station in drawn.stretches["stations"]:
            if station.line == line_number:
                series = draw(chart, drawn.blocks["stations"], _line(station.name, "time", "km", station, GRID, width=THIN))
                name_end(series, 2)
        for train in stretches:
            colour, dashes = (COLOURS[0], "solid") if train.rising else (INK, "dash")
            draw(chart, drawn.blocks["trains"], _line(train.name, "time", "km", train, colour, dashes))
        _show_clock(chart, *drawn.spans["trains"])
        low, high = drawn.spans[f"graph {line_number}"]
        chart.y_axis.scaling.min, chart.y_axis.scaling.max = low // 5.0 * 5.0, -(-high // 5.0) * 5.0
        room_on_the_right(chart)
        page.chart(chart)


def _line(name: str, x: str, y: str, rows: Stretch, colour: str, dashes: str = "solid", width: int = NORMAL) -> Line:
    return Line(name, x, y, rows.first, rows.last, colour, dashes, width)


def _profiles(page: Page, drawn: Drawn) -> None:
    for words, line_number, every in _by_line(drawn, drawn.stretches["profile"]):
        at_trains = [stretch for stretch in every if stretch.where == PANTOGRAPH]
        shown = at_trains or every
        groups = [shown[k : k + TRACKS_OF_A_CHART] for k in range(0, len(shown), TRACKS_OF_A_CHART)]
        for stretches in groups[:MOST_PROFILES]:
            which = f", {told([each.name for each in stretches])}" if len(groups) > 1 else words
            title = tr("Voltage along the line{which}", which=which)
            where = tr("the pantographs of trains") if at_trains else tr("cross-sections")
            note = tr("Lowest, mean and highest voltage of the run at {where}. The limits follow sheet Acceptance.", where=where)
            left_out = sum(map(len, groups[MOST_PROFILES:]))
            if left_out and stretches == groups[0]:
                note += " " + tr("{count} more tracks are on sheet Voltage profile.", count=left_out)
            _begin(page, title, note)
            page.chart(_profile(drawn, stretches, line_number, title))


def _profile(drawn: Drawn, stretches: Sequence[Stretch], line_number: int, title: str) -> Any:
    chart = scatter(title, tr(KM), tr(VOLTAGE))
    for stretch, colour in zip(stretches, COLOURS, strict=False):
        for key, words, dashes, width in CURVES:
            name = tr(words, track=stretch.name)
            draw(chart, drawn.blocks["profile"], _line(name, "km", key, stretch, colour, dashes, width))
    for ends in drawn.stretches.get("limits", ()):
        known = (name for name in LIMITS if limit_key(name) in drawn.blocks["limits"].keys)
        for name in known:
            if ends.line == line_number:
                dashes, width = LIMIT_LOOKS[name]
                line = _line(limit_in_words(name), "km", limit_key(name), ends, INK, dashes, width)
                draw(chart, drawn.blocks["limits"], line)
    entries = len(chart.series)
    for device in drawn.stretches.get("devices", ()):
        if device.line == line_number:
            colour = INK if device.rising else "AAAAAA"
            mark_point(chart, drawn.blocks["devices"], _line(device.name, "km", "high", device, colour))
    if len(chart.series) > entries:
        hide_from_legend(chart, range(entries, len(chart.series)))
        room_above(chart)
    chart.y_axis.scaling.min, chart.y_axis.scaling.max = drawn.spans["voltage"]
    chart.y_axis.majorUnit = ROUND_V
    if km_span(line_number) in drawn.spans:
        first, last = drawn.spans[km_span(line_number)]
        chart.x_axis.scaling.min, chart.x_axis.scaling.max = first // 1.0, -(-last // 1.0)
    return chart


def _histogram(page: Page, drawn: Drawn) -> None:
    title = tr("Voltages at the pantographs")
    _begin(page, title, "Share of the time of all trains in classes of voltage. The limits follow sheet Acceptance.")
    block = drawn.blocks["histogram"]
    keys = ("within", "low", "high")
    width = block.sheet.cell(block.first, block.column("to")).value - block.sheet.cell(block.first, block.column("from")).value
    words = tr("voltage at the pantograph, classes of {width} V by their lower end [V]", width=number(width))
    page.chart(bars(title, tr(SHARE), block, "from", keys, x_title=words, stacked=True))


def _worst_train(page: Page, drawn: Drawn) -> None:
    title = tr("Train {train}: voltage and speed", train=drawn.train)
    _begin(page, title, "The train with the lowest voltage at its pantograph.")
    chart = scatter(title, tr(TIME), tr(VOLTAGE))
    block = drawn.blocks["worst"]
    draw(chart, block, Line(tr("voltage"), "time", "voltage", block.first, block.last, COLOURS[0]))
    limit = drawn.blocks.get("worst limit")
    if limit is not None:
        draw(chart, limit, Line(limit_in_words("u_min2"), "time", "limit", limit.first, limit.last, INK, "dash", BOLD))
    low, high = drawn.spans["worst voltage"]
    chart.y_axis.scaling.min, chart.y_axis.scaling.max = (low - 1.0) // ROUND_V * ROUND_V, -(-(high + 1.0) // ROUND_V) * ROUND_V
    _show_clock(chart, *drawn.spans["worst"])
    speed = scatter("", "", tr(SPEED))
    draw(speed, block, Line(tr("speed"), "time", "speed", block.first, block.last, COLOURS[1]))
    speed.y_axis.scaling.min = 0.0
    second_axis(chart, speed)
    page.chart(chart)


def _loads(page: Page, drawn: Drawn) -> None:
    title = tr("Load curves of the substations")
    note = tr("Power at the busbars, means of {period} by the clock.", period=period_in_words(drawn.period_s))
    shown = _most_loaded(drawn)
    groups = [shown[k : k + len(COLOURS)] for k in range(0, len(shown), len(COLOURS))]
    for group in groups:
        which = tr(": {first} to {last}", first=group[0], last=group[-1]) if len(groups) > 1 else ""
        _begin(page, f"{title}{which}", f"{note}{_left_out(drawn)}")
        chart = scatter(f"{title}{which}", tr(TIME), tr(POWER))
        _draw_substations(chart, drawn, group, "loads", "time")
        _show_clock(chart, *drawn.spans["loads"])
        page.chart(chart)


def _sliding(page: Page, drawn: Drawn) -> None:
    title = tr("Substation {name}: load with sliding means", name=drawn.substation)
    _begin(page, title, "The most loaded substation. A sliding mean is that of the window that ends at the time.")
    block = drawn.blocks["substation"]
    chart = scatter(title, tr(TIME), tr(POWER))
    draw(chart, block, Line(tr("power"), "time", "power", block.first, block.last, "A6C8E0", width=THIN))
    for window, colour in zip(drawn.windows, (COLOURS[1], COLOURS[2], INK), strict=False):
        name = tr("mean of {period}", period=period_in_words(window))
        draw(chart, block, Line(name, "time", mean_key(window), block.first, block.last, colour, width=BOLD))
    if "contract" in block.keys:
        draw(chart, block, Line(tr("contract power"), "time", "contract", block.first, block.last, COLOURS[3], "dash"))
    _from_nothing(chart, drawn)
    _show_clock(chart, *drawn.spans["substation"])
    page.chart(chart)


def _duration(page: Page, drawn: Drawn) -> None:
    title = tr("Load duration of the substations")
    note = tr("Power that is reached or exceeded in a share of the time, from the means of the stored steps.")
    _begin(page, title, f"{note}{_left_out(drawn)}")
    chart = scatter(title, tr(SHARE), tr(POWER))
    _draw_substations(chart, drawn, _most_loaded(drawn), "duration", "share")
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = 0.0, 100.0
    page.chart(chart)


def _left_out(drawn: Drawn) -> str:
    count = len(drawn.substations)
    if count <= MOST_SUBSTATIONS:
        return ""
    return " " + tr("The {shown} most loaded of {all} substations.", shown=MOST_SUBSTATIONS, all=count)


def _most_loaded(drawn: Drawn) -> list[str]:
    """Return the most loaded substations in the order of the line."""
    return sorted(drawn.substations[:MOST_SUBSTATIONS], key=drawn.numbers.__getitem__)


def _from_nothing(chart: Any, drawn: Drawn) -> None:
    """Let the axis of power begin at nothing where no substation feeds back."""
    low, high = drawn.spans["power"]
    if low >= -0.005 * high:
        chart.y_axis.scaling.min = 0.0


def _draw_substations(chart: Any, drawn: Drawn, names: Sequence[str], kind: str, x: str) -> None:
    block = drawn.blocks[kind]
    _from_nothing(chart, drawn)
    for k, name in enumerate(names):
        dashes, colour = DASHES[k // len(COLOURS) % len(DASHES)], COLOURS[k % len(COLOURS)]
        draw(chart, block, Line(name, x, power_key(drawn.numbers[name]), block.first, block.last, colour, dashes))


def _show_clock(chart: Any, begin_s: float, end_s: float) -> None:
    width = max(end_s - begin_s, 1.0)
    show_clock(chart.x_axis, begin_s, end_s, next((step for step in CLOCK_STEPS_S if width / step <= MOST_TICKS), 86400))
