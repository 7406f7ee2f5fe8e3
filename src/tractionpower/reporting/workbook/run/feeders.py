"""The sheet of feeders and switches: their currents against their settings, trips, heat."""

from __future__ import annotations

import math
from typing import Any

from tractionpower.model.base import parse_time
from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, RED_FILL
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.frame.rules import Rule
from tractionpower.reporting.workbook.run.sums import Told, add_sums, number, room_above, total, write_above

KINDS = {
    "feeder": mark("feeder of a substation"),
    "cabin": mark("feeder of a section cabin"),
    "return": mark("return feeder"),
    "switch": mark("switch"),
}
STATES = {"closed": mark("closed"), "open": mark("open")}

NEAR_SETTING = 90.0
"""A highest current from this share of the setting on shows amber [%]."""

SAME = 1e-14
"""Share by which currents may differ that a workbook takes for the same: of several the first is named."""

_COLUMNS = (
    Column("feeder or switch", widest=34, key="name"),
    Column("kind", widest=26),
    Column("track", widest=10),
    Column("place [km]", "0.000"),
    Column("normal state", "beside", 10),
    Column("highest current [A]", "0", key="highest"),
    Column("time of highest current", "time"),
    Column("RMS current of the run [A]", "0", key="rms"),
    Column("trips above [A]", "0", key="setting"),
    Column("highest of the setting [%]", "0.0", key="share"),
    Column("trips", "0", key="trips"),
    Column("closed [% of the time]", "0.0"),
    Column("resistance [Ω]", "0.0000"),
    Column("heat [kWh]", "0.0", key="heat"),
)


def add(book: Book) -> None:
    """Add the sheet of feeders, if the run tells of some."""
    facts = book.facts
    links = [link for link in facts.run.get("links") or () if link["place"] in facts.places]
    if not links:
        return
    page = book.page("Feeders", "Feeders, return feeders and switches")
    page.note(
        "Currents in either direction, means of a step. A feeder is named by its station, track and side of the line. Heat:"
        " resistance times the square of the current, summed up over the steps."
    )
    rows = [_row(facts, link) for link in links]
    first = room_above(page, 3)
    block = page.table(_COLUMNS, rows, frozen=True)
    heats = any(number(row[13]) is not None for row in rows)
    row = add_sums(page, block, {"trips": "0"} | ({"heat": "0.0"} if heats else {}), rows)
    if heats:
        book.define("feeders_heat", page, block.cell("heat", row))
    highest = [number(each[5]) or 0.0 for each in rows]
    most, area = max(highest), block.cells("highest")
    at = next(k for k, value in enumerate(highest) if math.isclose(value, most, rel_tol=SAME))
    told: list[Told] = [
        (mark("highest current [A]"), Formula(f"MAX({area})", most), "0"),
        (
            mark("where"),
            Formula(f"INDEX({block.cells('name')},MATCH(MAX({area}),{area},0))", rows[at][0]),
            "any",
        ),
    ]
    shares = [share for each in rows if (share := number(each[9])) is not None]
    if shares:
        told.append((mark("highest share of a setting [%]"), Formula(f"MAX({block.cells('share')})", max(shares)), "0.0"))
    write_above(page, first, told)
    for least, colour in ((100.0, RED_FILL), (NEAR_SETTING, AMBER_FILL)):
        book.rules.append(Rule(page.sheet, block.cells("share"), f"{{cell}}>={least:g}", colour))


def heat_of(facts: Facts) -> float:
    """Return the heat in all feeders that have a resistance [kWh]."""
    links = facts.run.get("links") or ()
    return total(facts.value(link["place"], "feeder_heat_kwh") for link in links)


def _row(facts: Facts, link: dict[str, Any]) -> list[Any]:
    place = link["place"]
    highest, setting = facts.value(place, "highest_current_a"), link["trip_current_a"]
    known = highest is not None and setting
    return [
        device_told(place.partition(" ")[2]),
        tr(KINDS.get(link["kind"], link["kind"])),
        link["track"],
        link["km"],
        tr(STATES.get(link["normal_state"], link["normal_state"])),
        highest,
        parse_time(facts.when(place, "highest_current_a")),
        facts.value(place, "rms_current_a"),
        setting,
        Formula("100*{highest}/{setting}", 100.0 * (highest or 0.0) / setting) if known else None,
        facts.value(place, "trips"),
        facts.value(place, "time_closed_percent"),
        link.get("resistance_ohm") or None,
        facts.value(place, "feeder_heat_kwh"),
    ]
