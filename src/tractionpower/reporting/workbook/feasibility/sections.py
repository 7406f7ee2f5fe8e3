"""The sheet of sections: running times between timed calls, what reserve is left, where seconds are lost."""

from __future__ import annotations

from typing import Any

from openpyxl.formatting.rule import DataBarRule

from tractionpower.reporting.workbook.feasibility.feasibility import colour_reserve
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL
from tractionpower.reporting.workbook.frame.page import Column

LEFT, LOST = "reserve left [s]", "lost to low voltage [s]"

_COLUMNS = (
    Column("train", widest=24),
    Column("from", widest=24),
    Column("to", widest=24),
    Column("from [km]", "0.000"),
    Column("to [km]", "0.000"),
    Column("planned [s]", "0.0"),
    Column("shortest, at nominal voltage [s]", "0.0"),
    Column("with train current limits [s]", "0.0"),
    Column("on the voltages of the run [s]", "0.0"),
    Column("computed [s]", "0.0"),
    Column("reserve [s]", "0.0"),
    Column(LEFT, "0.0"),
    Column(LOST, "0.0"),
    Column("lost to current limits [s]", "0.0"),
    Column("most lost at [km]", "0.0"),
    Column("track", "beside"),
    Column("area of", "beside", 20),
    Column("lowest voltage [V]", "0"),
)
_VALUES = (
    "from_km", "to_km", "planned_s", "shortest_s", "limited_s", "recorded_s", "actual_s", "reserve_s", "reserve_left_s",
    "lost_voltage_s", "lost_current_s", "worst_km", "worst_track", "area", "lowest_voltage_v",
)  # fmt: skip


def add(book: Book) -> None:
    """Add the sheet, if the run has sections."""
    frame = book.facts.table("sections")
    if frame.empty:
        return
    page = book.page("Sections", "Sections between timed calls: reserve left and seconds lost")
    page.note(
        "Running times of the train alone, driven flat out: at nominal voltage without current limits, then with them, then on"
        " the voltages that the run recorded. Reserve left is planned less the last of these: red where it is missing, amber"
        " below 10 s. Computed is the run itself, with its driving plan."
    )
    names = book.facts.station_names
    rows = (_row(row, names) for row in frame.to_dict("records"))
    block = page.table(_COLUMNS, rows, frozen=True)
    colour_reserve(block, LEFT)
    bar = DataBarRule(start_type="num", start_value=0, end_type="max", color=AMBER_FILL)
    block.sheet.conditional_formatting.add(block.cells(LOST), bar)


def _row(row: dict[Any, Any], names: dict[str, str]) -> tuple[Any, ...]:
    begin, end = str(row["from_station"]), str(row["to_station"])
    stations = (names.get(begin) or begin or "start of the run", names.get(end) or end)
    return row["train"], *stations, *(row[name] for name in _VALUES)
