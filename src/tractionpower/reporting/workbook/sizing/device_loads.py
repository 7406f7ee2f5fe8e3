"""The sheets of how long which load lasts, of the demand of supply points, and of how substations share the load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.formatting.rule import FormulaRule
from openpyxl.utils import absolute_coordinate

from tractionpower.model.base import format_time
from tractionpower.reporting.facts.device_words import device_told, supply_points_along_line, zones_along_line
from tractionpower.reporting.figures.base.labels import CLOCK_STEPS_S
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.accepted import Accepted
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL, fill
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, Line, draw, scatter, show_clock
from tractionpower.reporting.workbook.sizing.judging import HOLDS, NO, YES, colour_red, colour_word, judged
from tractionpower.studies.cases.judgement import DEMAND

MOST_CURVES = 12
SHARE, TIME = mark("share of the run [%]"), mark("quarter begins")
NO_CONTRACT = mark("no contract")
MOST_BARE = 200
"""Supply points without a contract that a formula can name."""

GROUPS = (
    (mark("Rectifier units"), ("unit",)),
    (mark("Substations"), ("substation",)),
    (mark("Feeders and cabin feeders"), ("feeder", "cabin_feeder")),
    (mark("Sections of contact line"), ("contact_line",)),
    (mark("Return feeders and rails"), ("return_feeder", "rails")),
)

_POINTS = (
    Column("supply point", widest=34),
    Column("highest demand [kW]", "0", key="most"),
    Column("quarter begins", "time"),
    Column("contracted [kW]", "0", key="contract"),
    Column("highest, of the contract [%]", "0.0", key="share"),
    Column("quarters beyond it", "0", key="beyond"),
    Column("mean [kW]", "0"),
    Column(HOLDS, "beside"),
)


def add(book: Book) -> None:
    """Add the sheets, if the run has their tables."""
    _durations(book)
    _demand(book)
    _sharing(book)


def _durations(book: Book) -> None:
    rows = book.facts.table("load_duration")
    rows = rows[rows["current_a"].notna()] if len(rows) else rows
    groups = [(words, own) for words, kinds in GROUPS if len(rows) and len(own := rows[rows["kind"].isin(kinds)])]
    if not groups:
        return
    page = book.page("Current duration", "Load duration: for how much of the run a current is reached or passed")
    page.note(
        tr(
            "Means of steps. Of each kind of devices the {most} with the highest currents; table load_duration has all.",
            most=MOST_CURVES,
        )
    )
    kept = [page.room_for_chart() for _ in groups]
    for (words, own), row in zip(groups, kept, strict=True):
        page.new_page()
        page.section(words)
        names, table = _pivot(own)
        columns = (Column(SHARE, "0.00"), *(Column(f"{name} [A]", "0") for name in names))
        block = page.table(columns, table)
        chart = scatter(tr("{devices}: load duration", devices=tr(words)), tr(SHARE), tr("current at least [A]"))
        for number, name in enumerate(names):
            colour, dashes = COLOURS[number % len(COLOURS)], DASHES[number // len(COLOURS) % len(DASHES)]
            draw(chart, block, Line(name, SHARE, f"{name} [A]", block.first, block.last, colour, dashes))
        chart.x_axis.scaling.min, chart.x_axis.scaling.max = 0.0, 100.0
        chart.y_axis.scaling.min = 0.0
        page.chart(chart, row)


def _pivot(rows: pd.DataFrame) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """Return the devices with the highest currents, and a row for each share with their currents."""
    rows = rows.assign(device=rows["device"].map(device_told).astype(str))
    highest = rows.groupby("device")["current_a"].max().sort_values(ascending=False, kind="stable")
    names = [str(name) for name in highest.head(MOST_CURVES).index]
    wide = rows[rows["device"].isin(names)].pivot_table(index="share_percent", columns="device", values="current_a")[names]
    return names, ((share, *values) for share, values in zip(wide.index, wide.to_numpy(float), strict=True))


def _demand(book: Book) -> None:
    rows = book.facts.table("demand")
    if rows.empty:
        return
    rows = rows.assign(name=rows["supply_point"].astype(str))
    page = book.page("Demand", "Demand of the supply points: mean power of every quarter of an hour by the clock")
    page.note(
        "Power taken from the feeding grid: that at the busbars and the heat of the rectifiers where the study tells it. Red:"
        " beyond the contracted power, which can be edited; verdicts follow."
    )
    names = supply_points_along_line(book.facts.scenario, rows["name"])
    summary = page.table(_POINTS, (_summary(number, rows[rows["name"] == name]) for number, name in enumerate(names, 1)))
    colour_word(summary, HOLDS)
    for number, row in enumerate(range(summary.first, summary.last + 1), 1):
        page.edit(summary.cell("contract", row), "0", 0.0)
        book.define(f"contract_{number}", page, summary.cell("contract", row))
        book.define(f"contract_share_{number}", page, summary.cell("share", row))
    page.new_page()
    chart_row = page.room_for_chart()
    page.new_page()
    page.section("All quarters")
    wide = rows.pivot_table(index="from_s", columns="name", values="power_kw", dropna=False).reindex(columns=names)
    columns = (
        Column(TIME, "time", key="time"),
        *(Column(f"{name} [kW]", "0", key=f"point_{number}") for number, name in enumerate(names, 1)),
    )
    block = page.table(columns, ((at, *values) for at, values in zip(wide.index, wide.to_numpy(float), strict=True)))
    book.define("demand_times", page, block.cells("time"))
    for number, row in enumerate(range(summary.first, summary.last + 1), 1):
        book.define(f"demand_{number}", page, block.cells(f"point_{number}"))
        contract = absolute_coordinate(summary.cell("contract", row))
        rule = f"AND(ISNUMBER({contract}),{block.cell(f'point_{number}', block.first)}>{contract})"
        area = block.cells(f"point_{number}")
        block.sheet.conditional_formatting.add(area, FormulaRule(formula=[rule], fill=fill(RED_FILL)))
    shown = [name for name in wide.max().sort_values(ascending=False, kind="stable").index][:MOST_CURVES]
    page.chart(_demand_chart(block, [name for name in names if name in shown], len(names), wide.index), chart_row)
    book.acceptance += _accepted(page, rows, names)


def _summary(number: int, rows: pd.DataFrame) -> tuple[Any, ...]:
    """Return what a supply point takes, by formulas on its quarters."""
    own, name = f"{{demand_{number}}}", rows["name"].iloc[0]
    contract = float(rows["contract_power_kw"].max())
    has_one = math.isfinite(contract)
    power = rows["power_kw"].to_numpy(float)
    beyond = int((power > contract).sum()) if has_one else 0
    count = Formula(f'IF(ISNUMBER({{contract}}),COUNTIF({own},">"&{{contract}}),"")', beyond if has_one else "")
    text = f'IF(ISNUMBER({{contract}}),IF({{beyond}}>0,"{tr(NO)}","{tr(YES)}"),"{tr(NO_CONTRACT)}")'
    verdict: Formula | str = Formula(text, tr(NO_CONTRACT))
    if has_one:
        verdict = judged(text, NO if beyond else YES, NO if (rows["met"].astype(str) == "no").any() else YES)
    if not np.isfinite(power).any():
        return name, None, None, contract if has_one else None, None, count, None, verdict
    most = int(np.nanargmax(power))
    begin = Formula(f"INDEX({{demand_times}},MATCH({{most}},{own},0))", rows["from_s"].iloc[most])
    mean = Formula(f"AVERAGE({own})", float(np.nanmean(power)))
    highest = Formula(f"MAX({own})", float(power[most]))
    limited = has_one and contract > 0.0
    share = Formula('IF(N({contract})>0,100*{most}/{contract},"")', 100.0 * power[most] / contract if limited else "")
    return name, highest, begin, contract if has_one else None, share, count, mean, verdict


def _accepted(page: Page, rows: pd.DataFrame, names: Sequence[str]) -> Iterator[Accepted]:
    """Yield for each supply point with a contract the quarter in which it takes most; and a row for those without one.

    Contracts of the latter can be filled in on the sheet: what they take most of these is judged then.
    """
    bare = []
    for number, name in enumerate(names, 1):
        own = rows[(rows["name"] == name) & rows["power_kw"].notna() & rows["contract_power_kw"].notna()]
        if own.empty:
            bare.append(number)
        else:
            worst = own.iloc[int(own["power_kw"].argmax())]
            yield Accepted(
                "highest demand of a quarter of an hour", "contract_power_kw",
                Formula(f"{{contract_{number}}}", float(worst["contract_power_kw"])), "kW", "at_most",
                Formula(f"MAX({{demand_{number}}})", float(worst["power_kw"])), f"supply point {name}",
                format_time(worst["from_s"]), "user", "contract of the inputs",
            )  # fmt: skip
    if bare:
        shares = ",".join(f"{{contract_share_{number}}}" for number in bare[:MOST_BARE])
        found = Formula(f'IF(COUNT({shares})=0,"",MAX({shares}))', "")
        yield Accepted(
            DEMAND, "contract_power_kw", Formula("100", 100.0), "%", "at_most", found,
            tr("see sheet {sheet}", sheet=page.sheet.title), "", "user", "contracts of the inputs", bare=NO_CONTRACT,
        )  # fmt: skip


def _demand_chart(block: Block, names: Sequence[str], every: int, starts: Any) -> Any:
    title = tr("Demand of the supply points")
    if len(names) < every:
        title = tr("Demand of the supply points, the {shown} highest of {every}", shown=len(names), every=every)
    chart = scatter(title, tr(TIME), tr("mean of 15 min [kW]"))
    for number, name in enumerate(names):
        colour, dashes = COLOURS[number % len(COLOURS)], DASHES[number // len(COLOURS) % len(DASHES)]
        draw(chart, block, Line(name, TIME, f"{name} [kW]", block.first, block.last, colour, dashes))
    begin, end = float(min(starts)), float(max(starts)) + 900.0
    show_clock(chart.x_axis, begin, end, next((step for step in CLOCK_STEPS_S if (end - begin) / step <= 12), 86400))
    chart.y_axis.scaling.min = 0.0
    return chart


def _sharing(book: Book) -> None:
    rows = book.facts.table("sharing")
    if rows.empty:
        return
    page = book.page("Sharing", "Sharing: how neighbouring substations feed the zone between them")
    page.note(
        "Mean currents over the run that the substations feed towards the zone, and their parts of it. Negative: on the mean"
        " current comes through the substation from its other side. Unequal parts tell of unequal no-load voltages or"
        " resistances, or of loads that stand near one of the two."
    )
    both = rows.groupby(rows["zone"].astype(str), sort=False)["substation"].agg(list)
    pairs = {str(zone): two for zone, two in both.items()}
    order = {zone: number for number, zone in enumerate(zones_along_line(book.facts.scenario, pairs))}
    rows = rows.assign(_at=rows["zone"].astype(str).map(order)).sort_values("_at", kind="stable")
    block = page.table(_SHARING, _shares(rows, page.next + 1), frozen=True)
    colour_red(block, block.cells("mean"), "<0")


def _shares(rows: pd.DataFrame, first: int) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of sharing; the part of a substation is a formula on the currents of its zone, from row `first` on."""
    for _, own in rows.groupby("_at", sort=False):
        total = float(own["mean_current_a"].astype(float).sum())
        area = f"$C${first}:$C${first + len(own) - 1}"
        for row in own.to_dict("records"):
            mean = float(row["mean_current_a"])
            is_known = math.isfinite(row["share_percent"]) and total > 0.0
            share = Formula(f"100*{{mean}}/SUM({area})", 100.0 * mean / total) if is_known else None
            yield row["zone"], row["substation"], mean, share, row["highest_current_a"]
        first += len(own)


_SHARING = (
    Column("zone", widest=40),
    Column("substation", widest=28),
    Column("mean current [A]", "0.0", key="mean"),
    Column("share [%]", "0.0"),
    Column("highest current [A]", "0"),
)
