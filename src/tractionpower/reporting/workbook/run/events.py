"""The sheet of events, those that matter first when there are too many."""

from __future__ import annotations

import pandas as pd

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, heading_of

MOST = 2000
"""Rows of the list."""

ROUTINE = ("stop", "departure", "train_entered", "train_left", "regrouped", "switched", "substation_blocked", "current_limited")
"""Kinds that go first when there are too many."""

_COLUMNS = (
    Column("time of day", "time"),
    Column("kind"),
    Column("subject", widest=26),
    Column("track"),
    Column(heading_of("position_km"), "0.000"),
    Column("value", "0.0"),
    Column("limit", "0.0"),
    Column("in words", widest=100),
)
_FIELDS = ("time_s", "kind", "subject", "track", "position_km", "value", "limit", "message")


def add(book: Book) -> None:
    """Add the sheet of events, if there are any."""
    frame = book.facts.table("events")
    if frame.empty:
        return
    page = book.page("Events", "Events")
    kinds = frame["kind"].astype(str)
    counts = kinds.value_counts().sort_index()
    page.note("Number of events: " + ", ".join(f"{str(kind).replace('_', ' ')} {count}" for kind, count in counts.items()) + ".")
    if len(frame) > MOST:
        page.note(f"The list shows {MOST} of {len(frame)} events, routine ones left out first; table events has all of them.")
        frame = _most_telling(frame, kinds)
    rows = ([getattr(event, name) for name in _FIELDS] for event in frame.itertuples(index=False))
    page.table(_COLUMNS, ([row[0], str(row[1]).replace("_", " "), *row[2:]] for row in rows), frozen=True)


def _most_telling(frame: pd.DataFrame, kinds: pd.Series[str]) -> pd.DataFrame:
    """Return as many events as the list takes, in their order; of equal weight the earlier."""
    weight = kinds.isin(ROUTINE).astype(int)
    kept = weight.sort_values(kind="stable").index[:MOST]
    return frame.loc[kept.sort_values()]
