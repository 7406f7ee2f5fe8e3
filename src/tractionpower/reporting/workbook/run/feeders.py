"""The sheet of feeders and switches: their currents, trips and settings."""

from __future__ import annotations

from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Column, heading_of

_KINDS = {
    "feeder": "feeder of a substation",
    "cabin": "feeder of a section cabin",
    "return": "return feeder",
    "switch": "switch",
}
_COLUMNS = (
    Column("feeder or switch", widest=34),
    Column("kind", widest=26),
    Column("track"),
    Column(heading_of("km"), "0.000"),
    Column("normal state"),
    Column(heading_of("highest_current_a"), "0"),
    Column("time of highest current", "time"),
    Column(heading_of("rms_current_a"), "0"),
    Column("trips above [A]", "0"),
    Column("trips", "0"),
    Column("closed [% of the time]", "0.0"),
)


def add(book: Book) -> None:
    """Add the sheet of feeders, if the run tells of some."""
    facts = book.facts
    links = [link for link in facts.run.get("links") or () if link["place"] in facts.places]
    if not links:
        return
    page = book.page("Feeders", "Feeders, return feeders and switches")
    page.note("Currents in either direction, means of a step. A feeder is named by its station, track and side of the line.")
    page.table(_COLUMNS, [_row(facts, link) for link in links], frozen=True)


def _row(facts: Facts, link: dict[str, Any]) -> list[Any]:
    place = link["place"]
    return [
        place.partition(" ")[2],
        _KINDS.get(link["kind"], link["kind"]),
        link["track"],
        link["km"],
        link["normal_state"],
        facts.value(place, "highest_current_a"),
        parse_time(facts.when(place, "highest_current_a")),
        facts.value(place, "rms_current_a"),
        link["trip_current_a"],
        facts.value(place, "trips"),
        facts.value(place, "time_closed_percent"),
    ]
