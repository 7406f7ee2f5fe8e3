"""The charts of a comparison: main figures as bars side by side, lowest voltages along the line laid over each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column, Page, heading_of
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, Line, bars, draw, scatter
from tractionpower.reporting.workbook.variants.axes import fit_axis, name_series, rooms_for_charts

Key = tuple[str, str]
"""Figure and place."""

GROUPS: tuple[tuple[str, str, tuple[str, ...], str | None], ...] = (
    (mark("Voltages"), "V", ("lowest_voltage_v", "highest_voltage_v"), ""),
    (mark("Mean useful voltage"), "V", ("mean_useful_voltage_current_weighted_v",), "zone "),
    (mark("Energy"), "kWh", ("source_energy_kwh", "train_energy_kwh", "regulation_energy_kwh", "line_loss_kwh"), ""),
    (mark("Energy of the substations"), "kWh", ("energy_kwh",), "substation "),
    (
        mark("Highest mean power of the substations over a quarter of an hour"),
        "kW",
        ("highest_mean_power_15_min_kw",),
        "substation ",
    ),
    (mark("Highest power of the substations in a step"), "kW", ("highest_power_kw",), "substation "),
    (mark("Highest current of the substations"), "A", ("highest_current_a",), "substation "),
    (mark("Utilisation of devices"), "%", ("utilisation_percent",), None),
)
"""Charts: title, unit, figures, and how places begin; of a figure by place each chart has one."""

MOST_BARS = 24
PROFILE_ROWS = 4000
"""Rows of the profile of a line; of more every n-th stands there."""


@dataclass
class Sheets:
    """Where the figures stand: for each of them the name of a sheet's ranges, its row, and the values."""

    rows: dict[Key, tuple[str, int, list[Any]]] = field(default_factory=dict)

    def define(self, book: Book, page: Page, block: Any, lines: Sequence[tuple[Key, list[Any]]]) -> None:
        """Name the columns of the folders on a sheet."""
        sheet = "compare_" + "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in page.name.lower())
        count = sum(key.startswith("value") for key in block.keys)
        first = block.column("value0") - 1
        for k in range(count):
            book.define(f"{sheet}_{k + 1}", page, block.cells(f"value{k}"))
        for number, (key, line) in enumerate(lines, 1):
            self.rows[key] = sheet, number, line[first : first + count]


def add_charts(book: Book, folders: Sequence[str], sheets: Sheets) -> None:
    """Add the sheet of charts, behind the verdicts and the inputs."""
    groups = [(title, unit, keys) for title, unit, keys in _groups(sheets) if keys]
    lines = _profiles(book)
    if not groups and not lines:
        return
    page = book.page("Charts", "Charts: main figures side by side")
    rooms = rooms_for_charts(page, len(groups) + len(lines))
    for (title, unit, keys), room in zip(groups, rooms, strict=False):
        page.section(title)
        columns = [
            Column("what", widest=40, key="what"),
            *(Column(folder, "0.0", key=f"value{k}") for k, folder in enumerate(folders)),
        ]
        block = page.table(columns, [_row(key, sheets) for key in keys])
        chart = bars(f"{tr(title)} [{unit}]", f"[{unit}]", block, "what", [f"value{k}" for k in range(len(folders))])
        name_series(chart, folders)
        known = [value for key in keys for value in sheets.rows[key][2] if value is not None]
        fit_axis(chart.y_axis, known, from_zero=unit != "V")
        page.chart(chart, room)
    for (tracks, rows), room in zip(lines, rooms[len(groups) :], strict=True):
        page.chart(_along(page, (tracks, rows), folders), room)
    book.pages.insert(1, book.pages.pop())


def _groups(sheets: Sheets) -> list[tuple[str, str, list[Key]]]:
    found = []
    for title, unit, figures, begin in GROUPS:
        own = [(name, place) for name, place in sheets.rows if name in figures and (begin is None or place.startswith(begin))]
        if begin == "":
            own = [key for key in own if not key[1]]
        kept = [key for key in own if any(isinstance(value, float) for value in sheets.rows[key][2])]
        found.append((title, unit, kept[:MOST_BARS]))
    return found


def _row(key: Key, sheets: Sheets) -> list[Any]:
    sheet, number, values = sheets.rows[key]
    name, place = key
    words = place.partition(" ")[2] if place.startswith(("substation ", "zone ")) else place or heading_of(name).split(" [")[0]
    cells = [None if value is None else Formula(f"INDEX({{{sheet}_{k}}},{number})", value) for k, value in enumerate(values, 1)]
    return [words, *cells]


def _profiles(book: Book) -> list[tuple[Sequence[str], Any]]:
    """Return the lowest voltages of each line of tracks, by folder."""
    rows = book.facts.table("compare_profile")
    if rows.empty:
        return []
    rows = rows[rows["lowest_voltage_v"].notna()].astype({"track": str, "folder": str})
    lines = [tracks for tracks in book.facts.lines.lines if rows["track"].isin(list(tracks)).any()]
    return [(tracks, rows[rows["track"].isin(list(tracks))]) for tracks in lines]


def _along(page: Page, line: tuple[Sequence[str], Any], folders: Sequence[str]) -> Any:
    """Write the lowest voltages of a line of tracks, the lowest of its tracks at a place, and return their chart."""
    tracks, rows = line
    wide = rows.assign(km=rows["km"].round(3)).pivot_table(index="km", columns="folder", values="lowest_voltage_v", aggfunc="min")
    wide = wide.reindex(columns=list(folders)).iloc[:: -(-len(wide) // PROFILE_ROWS) or 1]
    title = tr("Lowest voltage along the line, {tracks}", tracks=told(tracks))
    page.section(title)
    columns = [Column("place [km]", "0.000", key="km"), *(Column(folder, "0.0", key=f"v{k}") for k, folder in enumerate(folders))]
    block = page.table(columns, ([km, *values] for km, values in zip(wide.index, wide.to_numpy(float), strict=True)))
    chart = scatter(title, tr("place [km]"), tr("lowest voltage [V]"))
    for k, folder in enumerate(folders):
        dashes = DASHES[k // len(COLOURS) % len(DASHES)] if k >= len(COLOURS) else DASHES[k % 2]
        draw(chart, block, Line(folder, "km", f"v{k}", block.first, block.last, COLOURS[k % len(COLOURS)], dashes))
    chart.dispBlanksAs = "span"  # folders have other cross-sections
    fit_axis(chart.x_axis, [float(km) for km in wide.index], ticks=10)
    fit_axis(chart.y_axis, wide.to_numpy(float).ravel().tolist())
    return chart
