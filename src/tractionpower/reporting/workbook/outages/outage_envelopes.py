"""The sheets of envelopes: the worst of all outages for every device, and along the line, with the outage that causes it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from openpyxl.utils import absolute_coordinate

from tractionpower.model.limits import Limit
from tractionpower.reporting.facts.device_words import KINDS, device_told, kind_order
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, GREY, Line, draw, scatter
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    UNRATED,
    YES,
    at_most,
    banner,
    bound_line,
    colour_red,
    colour_use,
    colour_word,
    judged,
    known,
    limit_line,
    sentence,
    window_in_words,
)
from tractionpower.reporting.workbook.sizing.rated_cells import use_of
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.studies.ratings.use import MOST_PERCENT

BASE, WORST, KM = mark("nothing out"), mark("worst of all cases"), mark("place [km]")
LIMIT = mark("limit [V]")
USE, BASE_USE = mark("utilisation in the worst case [%]"), mark("with nothing out [%]")

MOST_PRINTED = 300
"""Rows along the line that are printed with their charts."""

CHART_ROWS, CHART_CM = 26, 12.8
"""Rows and height of a chart that leaves room on its page for the title and the notes."""

PRINTED_TO = "L"
"""Last column of the charts."""

_DEVICES = (
    Column("device", widest=34),
    Column("kind", widest=28),
    Column(BASE_USE, "0.0", key="base"),
    Column(USE, "0.0", key="use"),
    Column("change", "0.0"),
    Column(HOLDS, "beside", key="holds"),
    Column("worst case", widest=60),
    Column("window that rules", "beside"),
    Column("load in it [A]", "0", key="load"),
    Column("permitted in it [A]", "0", key="permitted"),
    Column("highest current [A]", "0"),
    Column("case of the highest current", "beside", 60),
)


def add(book: Book, outages: Outages) -> None:
    """Add the sheets of both envelopes."""
    _devices(book, outages)
    _along(book, outages)


def _devices(book: Book, outages: Outages) -> None:
    rows = outages.table("device_envelope")
    if rows.empty:
        return
    page = book.page("Device envelope", "Device envelope: the worst of all outages for every device")
    rated = rows[rows["utilisation_percent"].notna()]
    permitted = outages.scenario.sizing.utilisation_percent
    head = page.next
    page.next += 1  # for the banner
    limit = limit_line(page, tr("Permitted utilisation"), "utilisation_percent", permitted, "%")
    page.note(
        "Utilisation: the highest root mean square of the current over the window that rules, of what the rating permits for it."
        " The worst case may be that with nothing out. Where ratings come from: workbook of `tractionpower size`, sheet Ratings."
    )
    kinds = rows["kind"].astype(str).map(kind_order).astype(int)
    ordered = rows.assign(_kind=kinds).sort_values(["_kind", "utilisation_percent"], ascending=[True, False], kind="stable")
    cells = (_device_row(outages, row, limit) for row in ordered.to_dict("records"))
    block = page.table(_DEVICES, cells, frozen=True)
    for key in ("use", "base"):
        colour_use(block, key, limit)
    colour_word(block, HOLDS)
    end, page.next = page.next, head
    _banner(page, block, rated, len(rows))
    page.next = end


def _banner(page: Page, block: Block, rated: pd.DataFrame, devices: int) -> None:
    """Say how many devices are overloaded in some outage."""
    if rated.empty:
        banner(page, tr("None of {devices} devices has a rating", devices=devices), "doubt")
        return
    over = int((rated["met"].astype(str) == "no").sum())
    area = absolute_coordinate(block.cells("holds"))
    count = f'COUNTIF({area},"{tr(NO)}")'
    all_of = f"COUNT({absolute_coordinate(block.cells('use'))})"
    text = sentence(
        tr("{over} of {rated} rated devices are beyond what is permitted in some outage"),
        over=(count, over),
        rated=(all_of, len(rated)),
    )
    banner(page, text, "good", f"{count}>0")


def _device_row(outages: Outages, row: dict[Any, Any], limit: str) -> tuple[Any, ...]:
    rated = bool(np.isfinite(row["utilisation_percent"]))
    kind, load, permitted = str(row["kind"]), float(row["load_a"]), float(row["permitted_a"])
    use: Any = None
    change: Any = None
    holds: Any = tr(UNRATED)
    if rated:
        value = use_of(load, permitted)
        use = Formula("100*{load}/{permitted}", value) if permitted > 0.0 and value < MOST_PERCENT else value
        change = Formula("{use}-{base}", value - row["base_percent"]) if known(row["base_percent"]) else None
        word = NO if value > outages.scenario.sizing.utilisation_percent * (1.0 + 1e-9) else YES
        holds = judged(at_most("use", limit), word, str(row["met"]))
    return (
        device_told(row["device"]), tr(KINDS.get(kind, kind)), row["base_percent"], use, change, holds,
        outages.told(row["case"]) if rated else "",
        window_in_words(row["window_s"]) if np.isfinite(row["window_s"]) and rated else "", load, permitted,
        row["peak_a"], outages.told(row["peak_case"]),
    )  # fmt: skip


def _along(book: Book, outages: Outages) -> None:
    rows = outages.table("envelope")
    rows = rows[rows["worst_v"].notna()] if len(rows) else rows
    if not len(rows):
        return
    page = book.page("Envelope", "Envelope along the line: the worst voltage and rail potential of all outages")
    limit = outages.limit("u_min2") if (rows["quantity"] == "voltage").any() else None
    bound = None if limit is None else bound_line(page, "U_min2", ("u_min2", limit.value, limit.unit), TOLERANCE_V)
    page.note(
        "Nothing out: at normal grid voltage. Voltage: the lowest of trains within 0.25 km and of fixed places. Rail potential:"
        " the greatest of either sign, against remote earth. The last column tells the case that is worst there."
    )
    groups = list(_groups(outages, rows))
    kept = []
    for number in range(len(groups)):
        if number:
            page.new_page()
        kept.append(page.room_for_chart(CHART_ROWS))
    if len(rows) > MOST_PRINTED:
        page.note(tr("The charts are printed; the {rows} rows that they are drawn from stand below.", rows=len(rows)))
        page.sheet.print_area = f"A1:{PRINTED_TO}{page.next - 1}"
    for (words, quantity, own), row in zip(groups, kept, strict=True):
        page.new_page()
        page.section(words)
        block = page.table(*_places(outages, quantity, own, ("" if bound is None else bound.limit, limit)))
        if bound is not None and "limit" in block.keys:
            colour_red(block, block.cells("worst"), bound.beyond(is_floor=True))
        page.chart(_chart(words, quantity, block, own), row)


def _groups(outages: Outages, rows: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    """Yield what is drawn together: title, quantity, rows of a track or of the rails of tracks along the line."""
    for quantity, words in (("voltage", tr("Lowest voltage")), ("rail_potential", tr("Greatest rail potential"))):
        own = rows[rows["quantity"] == quantity]
        for line in outages.places.by_line(own["track"].astype(str).unique()):
            for track in line:
                mine = own[own["track"] == track].sort_values("km", kind="stable")
                yield f"{words}, {told(track.split() if ' ' in track else [track])}", quantity, mine


def _places(
    outages: Outages, quantity: str, rows: pd.DataFrame, limit: tuple[str, Limit | None]
) -> tuple[list[Column], Iterator[tuple[Any, ...]]]:
    """Return columns and rows of a track; `limit`: the address of the lowest voltage, and what it is."""
    cell, least = limit if quantity == "voltage" else ("", None)
    style = "0" if quantity == "voltage" else "0.0"
    columns = [
        Column(KM, "0.000", key="km"),
        Column(tr("nothing out [V]"), style, key="base"),
        Column(tr("worst of all cases [V]"), style, key="worst"),
        Column(tr("change [V]"), style, key="change"),
        *([Column(LIMIT, "0", key="limit")] if least else []),
        Column("worst case", "beside", 60, key="case"),
    ]
    more = () if least is None else (Formula(cell, least.value),)
    return columns, (
        (row["km"], row["base_v"], row["worst_v"], _change(row), *more, outages.told(row["case"]))
        for row in rows.to_dict("records")
    )


def _change(row: dict[Any, Any]) -> Formula | None:
    base, worst = float(row["base_v"]), float(row["worst_v"])
    return Formula("{worst}-{base}", worst - base) if np.isfinite(base) else None


def _chart(words: str, quantity: str, block: Block, rows: pd.DataFrame) -> Any:
    chart = scatter(words, tr(KM), tr("voltage [V]") if quantity == "voltage" else tr("rail potential [V]"))
    for name, key, colour in ((tr(BASE), "base", COLOURS[0]), (tr(WORST), "worst", COLOURS[1])):
        draw(chart, block, Line(name, "km", key, block.first, block.last, colour))
    if "limit" in block.keys:
        draw(chart, block, Line("U_min2", "km", "limit", block.first, block.last, GREY, "dash"))
        chart.y_axis.scaling.min = (float(rows["worst_v"].min()) - 100.0) // 200.0 * 200.0
    chart.height = CHART_CM
    low, high = float(rows["km"].min()), float(rows["km"].max())
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = low // 10.0 * 10.0, -(-high // 10.0) * 10.0
    return chart
