"""The sheet of stops: distance, time and deceleration of each, from the first brake command to standstill."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from tractionpower.reporting.facts.chain_stops import Stop, stops_of
from tractionpower.reporting.workbook.dynamics.chain_charts import Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column

_COLUMNS = (
    Column("stop", "0"),
    Column("brake command at [s]", "0.00", key="from_s"),
    Column("place then [m]", "0.00", key="from_m"),
    Column("speed then [km/h]", "0.00", key="speed"),
    Column("whole train stands at [s]", "0.00", key="to_s"),
    Column("place of the stand [m]", "0.00", key="to_m"),
    Column("stopping distance [m]", "0.00", key="distance"),
    Column("stopping time [s]", "0.00", key="time"),
    Column("mean deceleration over the distance, v²/2s [m/s²]", "0.000", key="by_distance"),
    Column("mean deceleration over the time, v/t [m/s²]", "0.000", key="by_time"),
)


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheet, if the train was braked to a stop."""
    stops = stops_of(facts_of(book).results)
    if not stops:
        return
    page = book.page("Stops", "Stops: from the first brake command to standstill")
    page.note(
        "Places and speeds are those of the first vehicle; the stop ends when the whole train stands, to the step."
        " A brake"
        " command is that of any brake: train, independent or electric. Distances, times and decelerations are formulas."
    )
    page.table(_COLUMNS, list(_rows(stops)), frozen=True)


def _rows(stops: Sequence[Stop]) -> Iterator[tuple[Any, ...]]:
    for number, stop in enumerate(stops, 1):
        over_time = stop.speed_kmh / 3.6 / stop.time_s if stop.time_s > 0.0 else ""
        rate = stop.deceleration_mps2
        has_rate = math.isfinite(rate)  # else the train stood at the command, or has rolled back since
        yield (
            number, stop.from_s, stop.from_m, stop.speed_kmh, stop.to_s, stop.to_m,
            Formula("ABS({to_m}-{from_m})", stop.distance_m),
            Formula("{to_s}-{from_s}", stop.time_s),
            Formula('IF({distance}>0,({speed}/3.6)^2/(2*{distance}),"")', rate) if has_rate else None,
            Formula('IF({time}>0,{speed}/3.6/{time},"")', over_time),
        )  # fmt: skip
