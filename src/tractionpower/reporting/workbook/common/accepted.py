"""What is accepted: what was found, its limit, the verdict on it; as rows that the sheet of acceptance and the cover show."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.verdicts import Comparison, Words
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import Sense, sense_of

MET, VIOLATED, OPEN = mark("met"), mark("violated"), mark("not judged")

GROUPS = {
    "u_useful": mark("Mean useful voltage"),
    "u_": mark("Voltage"),
    "t_max2": mark("Voltage"),
    "touch_": mark("Return circuit"),
    "stray_": mark("Return circuit"),
    "utilisation": mark("Ratings"),
    "breaker": mark("Breakers"),
    "trips": mark("Breakers"),
    "contract": mark("Contracts"),
    "tolerance_s": mark("Timetable"),
}
"""Groups by how the name of a limit begins, the more special first."""

SERVED = mark("Service")
"""Group of what has no limit but must not be: trains that stand, loads without a voltage."""

LEAST_TOLERANCE = 1e-4
"""A smaller tolerance is one of rounding: it stands in the formula and in no cell."""

BY_LIMIT = Words(MET, VIOLATED, OPEN)
"""The words of verdicts on limits."""

SMALL_LIMIT = 10.0
"""A limit below this is shown with two digits."""

MOST_OF_NAME = 200
"""Characters of the name of a limit in the name of its cell; Excel takes 255."""


@dataclass(frozen=True, slots=True)
class Accepted:
    """A row of the sheet: something that was found, and its limit.

    Attributes
    ----------
    name
        What is judged, as the verdict of ``run.json`` on the same is called, if there is one: this row takes its place.
    limit_name, limit_value, unit
        Name of the limit and its value, in the unit of what was found. A number can be edited in the workbook, in a cell that is
        named ``limit_<name>``; rows with the same limit and value share it. A formula says that the value stands on another
        sheet.
    sense
        ``at_least``: the found value must not be below the limit; ``at_most``: not above.
    found
        What was found: a number, or a formula on data of the workbook; None if it could not be judged.
    place, time
        Where and when the worst was found.
    status, source
        How the limit is known, by the words of the limits table, and where it comes from.
    group
        What it belongs to, English; rows of a group stand together. Empty: by the limit.
    tolerance
        By how much it may be beyond the limit, in the same unit.
    met
        What the program says where that is no matter of a number: None lets the formula decide.
    bare
        The word, English, where nothing was found since the inputs give nothing to hold it against, such as a contract that can
        be filled in on its sheet. Such a row counts as no limit until then.
    """

    name: str
    limit_name: str
    limit_value: float | Formula | None
    unit: str
    sense: Sense
    found: float | Formula | None
    place: str = ""
    time: str = ""
    status: str = ""
    source: str = ""
    group: str = ""
    tolerance: float = 0.0
    met: bool | None = None
    bare: str = ""


def accepted_rows(book: Book) -> list[Accepted]:
    """Return the rows: verdicts of the run, a sheet's row in the place of each that it tells, then those of sheets alone."""
    own = list(book.acceptance)
    rows = [_taken(own, row) for row in map(accepted_of, book.computed.verdicts)]
    rows += own
    order = {name: number for number, name in enumerate(dict.fromkeys(map(group_of, rows)))}
    return sorted(rows, key=lambda row: order[group_of(row)])


def _taken(own: list[Accepted], said: Accepted) -> Accepted:
    """Return what a sheet tells in the place of a verdict, and take it off the list; of several that of the same place."""
    same = [row for row in own if (row.name, row.limit_name) == (said.name, said.limit_name)]
    if not same:
        return said
    found = next((row for row in same if row.place == said.place), same[0])
    own.remove(found)
    return found


def group_of(row: Accepted) -> str:
    """Return the group of a row."""
    return row.group or next((name for begin, name in GROUPS.items() if row.limit_name.startswith(begin)), SERVED)


def verdict_word(verdict: dict[str, Any]) -> str:
    """Return a verdict of ``run.json`` in a word, in the language of the report."""
    return tr({True: MET, False: VIOLATED}.get(verdict["met"], OPEN))


def accepted_of(verdict: dict[str, Any]) -> Accepted:
    """Return the row of a verdict of ``run.json``."""
    limit, unit = str(verdict["limit"] or ""), str(verdict["unit"] or "")
    place, time, status, source = (str(verdict[key] or "") for key in ("place", "time", "status", "source"))
    return Accepted(
        str(verdict["name"]), limit, verdict["limit_value"], unit, sense_of(verdict), verdict["value"],
        place, time, status, source, tolerance=TOLERANCE_V if unit == "V" and limit.startswith("u_") else 0.0, met=verdict["met"],
    )  # fmt: skip


def cell_names(rows: Iterable[Accepted]) -> list[str]:
    """Return for each row the name of the cell that holds its limit; equal limits of a name share one, others are numbered."""
    names: list[str] = []
    taken: dict[str, Any] = {}
    for row in rows:
        lasts = "_s" if row.limit_name.startswith("touch_") and row.unit == "s" else ""  # the limit of that name is a voltage
        base = name = "limit_" + re.sub(r"[^A-Za-z0-9_]", "_", row.limit_name[:MOST_OF_NAME]) + lasts
        count = 1
        while taken.setdefault(name, (row.limit_value, row.unit)) != (row.limit_value, row.unit):
            count += 1
            name = f"{base}_{count}"
        names.append(name)
    return names


def tolerance_name(cell: str) -> str:
    """Return the name of the cell with the tolerance of a limit, by the name of the cell with the limit.

    >>> tolerance_name("limit_u_min2")
    'tolerance_u_min2'
    """
    return f"tolerance_{cell.removeprefix('limit_')}"


def has_tolerance_cell(row: Accepted) -> bool:
    """Return whether the tolerance of a row stands in a cell."""
    return row.tolerance >= LEAST_TOLERANCE and row.limit_value is not None


def comparison_of(row: Accepted) -> Comparison:
    """Return what the cells of a row are held against."""
    return Comparison("{found}", "{limit}", row.sense, "{tolerance}" if has_tolerance_cell(row) else f"{row.tolerance:g}".upper())


def word_of(row: Accepted) -> str:
    """Return the verdict on a row in a word, English."""
    return word_by_numbers(row) if row.met is None else MET if row.met else VIOLATED


def word_by_numbers(row: Accepted) -> str:
    """Return the verdict that the numbers of a row give, English."""
    found, limit = number_in(row.found), number_in(row.limit_value)
    if found is None or limit is None:
        return row.bare or OPEN
    return MET if comparison_of(row).holds(found, limit, row.tolerance) else VIOLATED


def digits_of(rows: Sequence[Accepted]) -> list[str]:
    """Return the number format of each row: two digits for limits below 10, and for all of the same group and unit."""
    small = {
        (group_of(row), row.unit)
        for row in rows
        if (limit := number_in(row.limit_value)) is not None and 0.0 < abs(limit) < SMALL_LIMIT
    }
    return ["0.00" if (group_of(row), row.unit) in small else "0.0" for row in rows]


def place_in_words(row: Accepted) -> str:
    """Return where the worst was found; of a time above a limit that was never reached, that it was nowhere."""
    never = row.unit == "s" and row.limit_name.startswith("touch_") and not row.place and number_in(row.found) == 0.0
    return tr("nowhere") if never else device_told(row.place)


def number_in(value: float | Formula | None) -> float | None:
    """Return what a cell comes to, None where that is no number."""
    known = value.value if isinstance(value, Formula) else value
    return None if known is None or isinstance(known, str) or math.isnan(known) else float(known)
