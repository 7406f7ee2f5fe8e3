"""The sheets of how long which load lasts, of the demand of supply points, and of how substations share the load."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.formatting.rule import FormulaRule

from tractionpower.reporting.facts.device_words import supply_points_along_line, zones_along_line
from tractionpower.reporting.figures.base.labels import CLOCK_STEPS_S
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import RED_FILL, fill
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, Line, draw, scatter, show_clock

MOST_CURVES = 12
SHARE, TIME = "share of the run [%]", "quarter begins"
GROUPS = (
    ("Rectifier units", ("unit",)),
    ("Substations", ("substation",)),
    ("Feeders and cabin feeders", ("feeder", "cabin_feeder")),
    ("Contact-line sections", ("contact_line",)),
)


def add(book: Book) -> None:
    """Add the sheets, if the run has their tables."""
    _durations(book)
    _demand(book)
    _sharing(book)


def _durations(book: Book) -> None:
    rows = book.facts.table("load_duration")
    groups = [(words, own) for words, kinds in GROUPS if len(rows) and len(own := rows[rows["kind"].isin(kinds)])]
    if not groups:
        return
    page = book.page("Current duration", "Load duration: for how much of the run a current is reached or passed")
    page.note(
        f"Means of steps. Of each kind of devices the {MOST_CURVES} with the highest currents; table load_duration has all."
    )
    kept = [page.room_for_chart() for _ in groups]
    for (words, own), row in zip(groups, kept, strict=True):
        page.new_page()
        page.section(words)
        names, table = _pivot(own)
        columns = (Column(SHARE, "0.00"), *(Column(f"{name} [A]", "0") for name in names))
        block = page.table(columns, table)
        chart = scatter(f"{words}: load duration", SHARE, "current at least [A]")
        for number, name in enumerate(names):
            colour, dashes = COLOURS[number % len(COLOURS)], DASHES[number // len(COLOURS) % len(DASHES)]
            draw(chart, block, Line(name, SHARE, f"{name} [A]", block.first, block.last, colour, dashes))
        chart.x_axis.scaling.min, chart.x_axis.scaling.max = 0.0, 100.0
        chart.y_axis.scaling.min = 0.0
        page.chart(chart, row)


def _pivot(rows: pd.DataFrame) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
    """Return the devices with the highest currents, and a row for each share with their currents."""
    rows = rows.assign(device=rows["device"].astype(str))
    highest = rows.groupby("device")["current_a"].max().sort_values(ascending=False, kind="stable")
    names = [str(name) for name in highest.head(MOST_CURVES).index]
    wide = rows[rows["device"].isin(names)].pivot_table(index="share_percent", columns="device", values="current_a")[names]
    return names, ((share, *values) for share, values in zip(wide.index, wide.to_numpy(float), strict=True))


def _demand(book: Book) -> None:
    rows = book.facts.table("demand")
    if rows.empty:
        return
    page = book.page("Demand", "Demand of the supply points: mean power of every quarter of an hour by the clock")
    page.note(
        "Power taken from the feeding grid: that at the busbars and the heat of the rectifiers where the study tells it. Red:"
        " beyond the contracted power."
    )
    names = supply_points_along_line(book.facts.scenario, rows["supply_point"].astype(str))
    summary = (
        Column("supply point", widest=34),
        Column("highest demand [kW]", "0"),
        Column("quarter begins", "time"),
        Column("contracted [kW]", "0"),
        Column("quarters beyond it", "0"),
        Column("mean [kW]", "0"),
    )
    page.table(summary, (_summary(name, rows[rows["supply_point"] == name]) for name in names))
    page.new_page()
    chart_row = page.room_for_chart()
    page.new_page()
    page.section("All quarters")
    wide = rows.assign(name=rows["supply_point"].astype(str)).pivot_table(index="from_s", columns="name", values="power_kw")
    wide = wide.reindex(columns=names)
    columns = (Column(TIME, "time"), *(Column(f"{name} [kW]", "0") for name in names))
    block = page.table(columns, ((at, *values) for at, values in zip(wide.index, wide.to_numpy(float), strict=True)))
    contracts = rows.groupby(rows["supply_point"].astype(str))["contract_power_kw"].max()
    _colour_beyond(block, names, contracts)
    shown = [name for name in wide.max().sort_values(ascending=False, kind="stable").index][:MOST_CURVES]
    page.chart(_demand_chart(block, [name for name in names if name in shown], len(names), wide.index), chart_row)


def _summary(name: str, rows: pd.DataFrame) -> tuple[Any, ...]:
    if rows["power_kw"].isna().all():
        return name, None, None, rows["contract_power_kw"].max(), 0, None
    most = rows.iloc[int(rows["power_kw"].fillna(-np.inf).argmax())]
    beyond = int((rows["met"].astype(str) == "no").sum())
    return name, most["power_kw"], most["from_s"], most["contract_power_kw"], beyond, rows["power_kw"].mean()


def _colour_beyond(block: Block, names: Sequence[str], contracts: Any) -> None:
    for name in names:
        contract = contracts.get(name)
        if contract is not None and contract > 0.0:
            area = block.cells(f"{name} [kW]")
            first = area.split(":")[0]
            rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{first}>{contract!r})"], fill=fill(RED_FILL))
            block.sheet.conditional_formatting.add(area, rule)


def _demand_chart(block: Block, names: Sequence[str], every: int, starts: Any) -> Any:
    more = f", the {len(names)} highest of {every}" if len(names) < every else ""
    chart = scatter(f"Demand of the supply points{more}", TIME, "mean of 15 min [kW]")
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
    columns = (
        Column("zone", widest=40),
        Column("substation", widest=28),
        Column("mean current [A]", "0.0"),
        Column("share [%]", "0.0"),
        Column("highest current [A]", "0"),
    )
    names = ("zone", "substation", "mean_current_a", "share_percent", "highest_current_a")
    both = rows.groupby(rows["zone"].astype(str), sort=False)["substation"].agg(list)
    pairs = {str(zone): two for zone, two in both.items()}
    order = {zone: number for number, zone in enumerate(zones_along_line(book.facts.scenario, pairs))}
    rows = rows.assign(_at=rows["zone"].astype(str).map(order)).sort_values("_at", kind="stable")
    page.table(columns, (tuple(row[name] for name in names) for row in rows.to_dict("records")), frozen=True)
