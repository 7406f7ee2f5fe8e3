"""The sheet of events on a line with stations."""

from __future__ import annotations

from typing import Any

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.stations.station_facts import KINDS, facts_of

MOST = 5000
"""Rows of the list."""

_COLUMNS = (
    Column("time since the start [s]", "0.0"),
    Column("train", "beside", widest=26),
    Column("event", "beside", widest=28),
    Column("station", "beside", widest=26),
    Column("track", "beside", widest=16),
    Column("place [m]", "0.0"),
    Column("waited [s]", "0.0"),
)


def add(book: Book) -> None:
    """Add the sheet, if there are events."""
    facts = facts_of(book)
    rows = facts.events
    if not len(rows):
        return
    page = book.page("Events", "Events")
    if len(rows) > MOST:
        page.note(tr("The first {shown} of {all} events; table station_events has all.", shown=MOST, all=len(rows)))
    names = {station.id: station.name or station.id for station in facts.scenario.stations}
    columns = ("time_s", "train", "kind", "station", "station_track", "position_m", "waited_s")
    told: list[tuple[Any, ...]] = []
    for time_s, train, kind, station, track, place, waited in rows.head(MOST)[list(columns)].itertuples(index=False, name=None):
        told.append((time_s, train, tr(KINDS.get(kind, kind)), names.get(station, station), track, place, waited or None))
    page.table(_COLUMNS, told, frozen=True)
