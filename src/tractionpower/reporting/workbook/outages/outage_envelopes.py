"""The sheets of envelopes: the worst of all outages for every device, and along the line, with the outage that causes it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from tractionpower.reporting.facts.device_words import KINDS, kind_order
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.frame.plots import COLOURS, GREY, Line, draw, scatter
from tractionpower.reporting.workbook.sizing.ratings import HOLDS, UNRATED, banner, colour_use, colour_word
from tractionpower.studies.ratings.words import window_words

BASE, WORST, KM = "nothing out [V]", "worst of all cases [V]", "place [km]"
LIMIT = "U_min2 [V]"
USE, BASE_USE = "utilisation in the worst case [%]", "with nothing out [%]"

_DEVICES = (
    Column("device", widest=34),
    Column("kind", widest=28),
    Column(BASE_USE, "0.0"),
    Column(USE, "0.0"),
    Column(HOLDS, "beside"),
    Column("worst case", widest=64),
    Column("window that rules", "beside"),
    Column("load in it [A]", "0"),
    Column("permitted in it [A]", "0"),
    Column("highest current [A]", "0"),
    Column("case of the highest current", "beside", 64),
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
    over = rated[rated["met"].astype(str) == "no"]
    permitted = outages.scenario.sizing.utilisation_percent
    if rated.empty:
        banner(page, f"None of {len(rows)} devices has a rating", "doubt")
    elif len(over):
        banner(page, f"{len(over)} of {len(rated)} rated devices are beyond {permitted:g} % in some outage", "bad")
    else:
        banner(page, f"All {len(rated)} rated devices stay within {permitted:g} % in every case", "good")
    page.note(
        "Utilisation: the highest root mean square of the current over the window that rules, of what the rating permits for it."
        " The worst case may be that with nothing out. Where ratings come from: workbook of `tractionpower size`, sheet Ratings."
    )
    kinds = rows["kind"].astype(str).map(kind_order).astype(int)
    ordered = rows.assign(_kind=kinds).sort_values(["_kind", "utilisation_percent"], ascending=[True, False], kind="stable")
    block = page.table(_DEVICES, (_device_row(outages, row) for row in ordered.to_dict("records")), frozen=True)
    for heading in (USE, BASE_USE):
        colour_use(block, heading, permitted)
    colour_word(block, HOLDS)


def _device_row(outages: Outages, row: dict[Any, Any]) -> tuple[Any, ...]:
    rated = bool(np.isfinite(row["utilisation_percent"]))
    return (
        row["device"], KINDS.get(str(row["kind"]), row["kind"]), row["base_percent"], row["utilisation_percent"],
        str(row["met"]) or UNRATED, outages.told(row["case"]) if rated else "",
        window_words(row["window_s"]) if np.isfinite(row["window_s"]) and rated else "", row["load_a"], row["permitted_a"],
        row["peak_a"], outages.told(row["peak_case"]),
    )  # fmt: skip


def _along(book: Book, outages: Outages) -> None:
    rows = outages.table("envelope")
    rows = rows[rows["worst_v"].notna()] if len(rows) else rows
    if not len(rows):
        return
    page = book.page("Envelope", "Envelope along the line: the worst voltage and rail potential of all outages")
    page.note(
        "Nothing out: at normal grid voltage. Voltage: the lowest of trains within 0.25 km and of fixed places. Rail potential:"
        " the greatest of either sign, against remote earth. The last column tells the case that is worst there."
    )
    groups = list(_groups(outages, rows))
    kept = []
    for number in range(len(groups)):
        if number:
            page.new_page()
        kept.append(page.room_for_chart())
    for (words, quantity, own), row in zip(groups, kept, strict=True):
        page.new_page()
        page.section(words)
        block = page.table(*_places(outages, quantity, own))
        page.chart(_chart(words, quantity, block, own), row)


def _groups(outages: Outages, rows: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    """Yield what is drawn together: title, quantity, rows of a track or of the rails of tracks along the line."""
    for quantity, words in (("voltage", "Lowest voltage"), ("rail_potential", "Greatest rail potential")):
        own = rows[rows["quantity"] == quantity]
        for line in outages.places.by_line(own["track"].astype(str).unique()):
            for track in line:
                mine = own[own["track"] == track].sort_values("km", kind="stable")
                yield f"{words}, {told(track.split() if ' ' in track else [track])}", quantity, mine


def _places(outages: Outages, quantity: str, rows: pd.DataFrame) -> tuple[list[Column], Iterator[tuple[Any, ...]]]:
    limit = outages.limit("u_min2") if quantity == "voltage" else None
    number = "0" if quantity == "voltage" else "0.0"
    columns = [Column(KM, "0.000"), Column(BASE, number), Column(WORST, number), *([Column(LIMIT, "0")] if limit else [])]
    columns.append(Column("worst case", "beside", 60))
    more = () if limit is None else (limit.value,)
    cells = ((row["km"], row["base_v"], row["worst_v"], *more, outages.told(row["case"])) for row in rows.to_dict("records"))
    return columns, cells


def _chart(words: str, quantity: str, block: Block, rows: pd.DataFrame) -> Any:
    chart = scatter(words, KM, "voltage [V]" if quantity == "voltage" else "rail potential [V]")
    for name, heading, colour in (("nothing out", BASE, COLOURS[0]), ("worst of all cases", WORST, COLOURS[1])):
        draw(chart, block, Line(name, KM, heading, block.first, block.last, colour))
    if LIMIT in block.headings:
        draw(chart, block, Line("U_min2", KM, LIMIT, block.first, block.last, GREY, "dash"))
        chart.y_axis.scaling.min = (float(rows["worst_v"].min()) - 100.0) // 200.0 * 200.0
    low, high = float(rows["km"].min()), float(rows["km"].max())
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = low // 10.0 * 10.0, -(-high // 10.0) * 10.0
    return chart
