"""What the sheets of a case of stations tell, gathered: the run, its case, its trains with their times."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import CaseFacts
from tractionpower.results.results import Results

KINDS = {
    "entered": mark("entered the line"),
    "track_given": mark("got a track"),
    "arrival": mark("arrival"),
    "departure": mark("departure"),
    "passing": mark("passing"),
    "left": mark("left the line"),
    "still_there": mark("still on the line at the end"),
}
"""Kinds of events in words."""


@dataclass(frozen=True, slots=True)
class StationTrain:
    """A train and its times.

    Attributes
    ----------
    name, kind
        The train, and the kind of trains that it is of.
    entered_s, left_s
        When it came onto the line and left it [s]; not a number where it has not.
    waited_entry_s, waited_track_s, waited_line_s
        How long it waited to enter the line, before stations for a free track, and in them for the line ahead [s].
    stood_s
        Time from its arrivals to its departures [s].
    greatest_kmh
        Its highest recorded speed.
    tracks
        Tracks that it got, with their stations, in their order.
    """

    name: str
    kind: str
    entered_s: float
    left_s: float
    waited_entry_s: float
    waited_track_s: float
    waited_line_s: float
    stood_s: float
    greatest_kmh: float
    tracks: str

    @property
    def waited_s(self) -> float:
        """All its waiting [s]."""
        return self.waited_entry_s + self.waited_track_s + self.waited_line_s

    @property
    def running_s(self) -> float:
        """Time from entering to leaving [s]; not a number where it has not left."""
        return self.left_s - self.entered_s


class StationFacts(CaseFacts):
    """A run of a case of stations, as the sheets ask for it."""

    def __init__(self, results: Results, scenario: StationsCase) -> None:
        super().__init__(results, scenario)
        self.scenario = scenario

    @property
    def about(self) -> str:
        """What the document is about."""
        return tr("Simulation of trains as point masses on a line with stations")

    @cached_property
    def events(self) -> pd.DataFrame:
        """All events in the order of time, their words as texts; without any an empty table."""
        rows = self.table("station_events")
        texts = ("train", "kind", "station", "station_track")
        return rows.astype(dict.fromkeys(texts, str)).sort_values("time_s", kind="stable") if len(rows) else rows

    @cached_property
    def trains(self) -> list[StationTrain]:
        """The trains that came, in the order in which they did."""
        if not len(self.events):
            return []
        rows = self.table("point_masses", ("train", "kind", "speed_kmh"))
        by_train = rows.astype({"train": str, "kind": str}).groupby("train", sort=False) if len(rows) else None
        told = {} if by_train is None else by_train.agg({"kind": "first", "speed_kmh": "max"}).to_dict("index")
        return [_train(str(name), own, told.get(str(name), {})) for name, own in self.events.groupby("train", sort=False)]


def _train(name: str, events: pd.DataFrame, told: dict[Any, Any]) -> StationTrain:
    def when(kind: str) -> float:
        own = events.loc[events["kind"] == kind, "time_s"]
        return float(own.iloc[0]) if len(own) else math.nan

    def waited(*kinds: str) -> float:
        return float(events.loc[events["kind"].isin(kinds), "waited_s"].sum())

    given = events[events["kind"] == "track_given"]
    arrivals, departures = (events[events["kind"] == kind].set_index("station")["time_s"] for kind in ("arrival", "departure"))
    return StationTrain(
        name, str(told.get("kind", "")), when("entered"), when("left"), waited("entered"), waited("track_given"),
        waited("departure", "passing"), float((departures - arrivals).sum()), float(told.get("speed_kmh", math.nan)),
        ", ".join(given["station_track"]),
    )  # fmt: skip


def facts_of(book: Book) -> StationFacts:
    """Return the facts of a book on a case of stations."""
    if not isinstance(book.subject, StationFacts):
        raise TypeError("this workbook is not about a line with stations")
    return book.subject
