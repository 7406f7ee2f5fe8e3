"""The sheet of calls: planned and computed times of day at every station."""

from __future__ import annotations

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.run.trains import colour_late

LATE = "late [s]"

_COLUMNS = (
    Column("train", widest=24),
    Column("station", widest=28),
    Column("name", widest=28),
    Column("kind"),
    Column("planned", "time"),
    Column("computed", "time"),
    Column(LATE, "0"),
    Column("dwell [s]", "0"),
)


def add(book: Book) -> None:
    """Add the sheet of calls, if there are any."""
    frame = book.facts.table("calls")
    if frame.empty:
        return
    page = book.page("Calls", "Calls at stations")
    page.note("Late is computed less planned time: amber from 1 s on, red from 60 s on; negative is early.")
    names = book.facts.station_names
    rows = (
        (
            call.train,
            call.station,
            names.get(str(call.station), ""),
            call.kind,
            call.planned_s,
            call.actual_s,
            call.late_s,
            call.dwell_s,
        )
        for call in frame.itertuples(index=False)
    )
    colour_late(page.table(_COLUMNS, rows, frozen=True), LATE)
