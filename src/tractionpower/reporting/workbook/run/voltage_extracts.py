"""Extract of table profile: voltages along the line, with limits that follow the sheet of acceptance."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.figures.base.labels import fitting
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.verdicts import same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import limit_in_words
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.run.drawn import KM, Drawn, Stretch

LOWEST, MEAN, HIGHEST = mark("lowest voltage [V]"), mark("mean voltage [V]"), mark("highest voltage [V]")
PANTOGRAPH = "pantograph"
WHERE = {PANTOGRAPH: mark("pantograph"), "cross_section": mark("cross-section")}

LIMITS = ("u_min2", "u_n", "u_max1", "u_max2")
"""Limits of the voltage that are drawn."""

MOST_NAMES = 40
"""Names along a line that have room, read from below."""

VOLTAGE_TICK = 200.0
"""The axis of voltages begins and ends at a multiple of this [V]."""

PRINTED = 22
"""Rows that are printed: the chart shows them all."""


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, and what the chart needs beside its rows: limits, and substations on the upper edge."""
    frame = book.facts.table("profile")
    if frame.empty:
        return
    frame = frame.copy()
    for name in ("where", "track"):
        frame[name] = frame[name].astype(str)
    frame = frame.sort_values(["where", "track", "km"], kind="stable")
    page = book.page("Voltage profile", "Voltages along the line")
    page.note(
        "A cross-section is a fixed place, of which every step counts; a pantograph is a stretch of the line, of which the trains"
        " in it count. The count is that of the values."
    )
    columns = [Column("where"), Column("track"), Column(KM, "0.000", key="km")]
    columns += [Column(LOWEST, "0", key="lowest"), Column(MEAN, "0", key="mean"), Column(HIGHEST, "0", key="highest")]
    columns.append(Column("count", "0"))
    fields = ["where", "track", "km", "lowest_voltage_v", "mean_voltage_v", "highest_voltage_v", "count"]
    rows = ([tr(WHERE.get(row[0], row[0])), *row[1:]] for row in frame[fields].itertuples(index=False))
    drawn.blocks["profile"] = block = page.table(columns, rows, frozen=True, printed=PRINTED)
    drawn.stretches["profile"] = _stretches(frame, block, book.facts.lines)
    for number, tracks in enumerate(drawn.lines):
        if frame["track"].isin(tracks).any():
            drawn.spans[km_span(number)] = book.facts.lines.span(frame, tracks)
    limits = [limit.value for name in LIMITS if (limit := book.facts.limit(name))]
    voltages = [*limits, float(frame["lowest_voltage_v"].min()), float(frame["highest_voltage_v"].max())]
    drawn.spans["voltage"] = _down(min(voltages) - 1.0), -_down(-max(voltages) - 1.0)  # a limit is no border of the chart
    _limits(book, page, drawn)
    _substations(book, page, drawn)


def km_span(line: int) -> str:
    """Return the name of the span of kilometres of a line."""
    return f"km of line {line}"


def limit_key(name: str) -> str:
    """Return the key of the column of a limit."""
    return f"limit {name}"


def _limits(book: Book, page: Page, drawn: Drawn) -> None:
    """Add the two ends of each line's limits: the cells refer to those that can be edited."""
    known = {name: limit.value for name in LIMITS if (limit := book.facts.limit(name))}
    lines = [number for number in range(len(drawn.lines)) if km_span(number) in drawn.spans]
    if not known or not lines:
        return
    page.section("Limits, as the chart shows them")
    columns = [Column(KM, "0.000", key="km")]
    columns += [Column(f"{limit_in_words(name)} [V]", "0", key=limit_key(name)) for name in known]
    values = [Formula(same_as(f"{{limit_{name}}}"), value) for name, value in known.items()]
    block = page.table(columns, [(km, *values) for number in lines for km in drawn.spans[km_span(number)]])
    drawn.blocks["limits"] = block
    drawn.stretches["limits"] = [
        Stretch("", block.first + 2 * k, block.first + 2 * k + 1, line=number) for k, number in enumerate(lines)
    ]


def _substations(book: Book, page: Page, drawn: Drawn) -> None:
    """Add substations and section cabins that have room for their names, as points on the upper edge of the chart."""
    found = list(_devices(book, drawn))
    if not found:
        return
    page.section("Substations and section cabins, as the chart shows them")
    high = drawn.spans["voltage"][1]
    columns = [Column("name", widest=30), Column("kind"), Column(KM, "0.000", key="km"), Column("drawn at [V]", "0", key="high")]
    rows = [(name, tr("substation") if feeds else tr("section cabin"), km, high) for name, km, feeds, _ in found]
    drawn.blocks["devices"] = block = page.table(columns, rows)
    drawn.stretches["devices"] = [
        Stretch(name, block.first + k, block.first + k, feeds, line=line) for k, (name, _, feeds, line) in enumerate(found)
    ]


def _devices(book: Book, drawn: Drawn) -> Iterator[tuple[str, float, bool, int]]:
    for line, tracks in enumerate(drawn.lines):
        if km_span(line) in drawn.spans:
            devices = book.facts.lines.devices(tracks)
            begin, end = drawn.spans[km_span(line)]
            for k in fitting([km for km, *_ in devices], [feeds for *_, feeds in devices], (end - begin) / MOST_NAMES):
                km, name, feeds = devices[k]
                if begin <= km <= end:
                    yield name, km, feeds, line


def _stretches(frame: pd.DataFrame, block: Block, lines: LinePlaces) -> list[Stretch]:
    keys = list(zip(frame["where"], frame["track"], strict=True))
    starts = [k for k in range(len(keys)) if k == 0 or keys[k] != keys[k - 1]]
    ends = [*starts[1:], len(keys)]
    return [
        Stretch(keys[a][1], block.first + a, block.first + b - 1, where=keys[a][0], line=lines.number_of(keys[a][1]))
        for a, b in zip(starts, ends, strict=True)
    ]


def _down(value: float) -> float:
    return value // VOLTAGE_TICK * VOLTAGE_TICK
