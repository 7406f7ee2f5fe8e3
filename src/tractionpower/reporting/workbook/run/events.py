"""The sheet of events, those that matter first when there are too many."""

from __future__ import annotations

import pandas as pd

from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column

MOST = 2000
"""Rows of the list."""

ROUTINE = ("stop", "departure", "train_entered", "train_left", "regrouped", "switched", "substation_blocked", "current_limited")
"""Kinds that go first when there are too many."""

_COLUMNS = (
    Column("time of day", "time"),
    Column("event", widest=24),
    Column("train or device", widest=26),
    Column("track", widest=10),
    Column("place [km]", "0.000"),
    Column("value", "0.0"),
    Column("limit", "0.0"),
    Column("in words", widest=90),
)
_COUNTS = (Column("event", widest=24), Column("how many", "0"), Column("of them in the list", "0"))
_FIELDS = ("time_s", "kind", "subject", "track", "position_km", "value", "limit", "message")


def add(book: Book) -> None:
    """Add the sheet of events, if there are any."""
    frame = book.facts.table("events")
    if frame.empty:
        return
    page = book.page("Events", "Events")
    kinds = frame["kind"].astype(str)
    shown = frame if len(frame) <= MOST else _most_telling(frame, kinds)
    if len(shown) < len(frame):
        page.note(
            tr(
                "The list shows {shown} of {all} events, routine ones left out first; table events has all of them.",
                shown=len(shown),
                all=len(frame),
            )
        )
    listed = shown["kind"].astype(str).value_counts()
    page.section("How many of each kind")
    page.table(
        _COUNTS, ((_kind(kind), count, int(listed.get(kind, 0))) for kind, count in kinds.value_counts().sort_index().items())
    )
    page.section("List")
    rows = ([getattr(event, name) for name in _FIELDS] for event in shown.itertuples(index=False))
    page.table(_COLUMNS, ([row[0], _kind(row[1]), *row[2:7], recorded(str(row[7] or ""))] for row in rows), frozen=True)


def _kind(kind: object) -> str:
    return recorded(str(kind).replace("_", " "))


def _most_telling(frame: pd.DataFrame, kinds: pd.Series[str]) -> pd.DataFrame:
    """Return as many events as the list takes, in their order; of equal weight the earlier."""
    weight = kinds.isin(ROUTINE).astype(int)
    kept = weight.sort_values(kind="stable").index[:MOST]
    return frame.loc[kept.sort_values()]
