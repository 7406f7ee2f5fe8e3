"""The sheet of acceptance: what was found against what is allowed, with limits that can be edited and verdicts that follow."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from openpyxl.formatting.rule import CellIsRule

from tractionpower.reporting.facts.device_words import device_told
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.verdicts import Comparison, Words, same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import AMBER_FILL, GREEN_FILL, RED_FILL, fill
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, limit_in_words
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, Page
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import AT_LEAST, Sense, sense_of

MET, VIOLATED, OPEN = mark("met"), mark("violated"), mark("not judged")

COUNTS = {"acceptance_met": MET, "acceptance_violated": VIOLATED, "acceptance_open": OPEN}
"""Names of the cells that count the verdicts, with the word that they count."""

ALL = "acceptance_all"
"""Name of the cell that counts all rows."""

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

_SENSES = {"at_least": mark("not below"), "at_most": mark("not above")}

TIME = mark("time of day")

_COLUMNS = (
    Column("no.", "0"),
    Column("what is judged", "beside", 34),
    Column("found", "0.0", key="found"),
    Column("must be", "beside", 10),
    Column("limit value", "0.0", key="limit"),
    Column("unit", "beside", 8),
    Column("tolerance", "general", key="tolerance"),
    Column("margin", "0.0", key="margin"),
    Column("verdict", "beside", 12, key="verdict"),
    Column("group", widest=16),
    Column("place of the worst", widest=30),
    Column(TIME),
    Column("limit", widest=18),
    Column("status of the limit", widest=22),
    Column("source of the limit", widest=46),
)


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


def add(book: Book) -> None:
    """Add the sheet, as the second of the book, when all sheets that judge have told their rows; none without any rows."""
    rows = accepted_rows(book)
    if not rows:
        return
    page = book.page("Acceptance", "Acceptance: what was found against what is allowed")
    book.pages.insert(1, book.pages.pop())
    page.note(
        "Yellow cells can be edited: margins, verdicts and the cover follow. A limit whose status is not 'verified' is an"
        " editable value of the limits table: the check is against that value, which is no statement about a standard."
    )
    counts_row = _room_for_counts(page)
    columns = [replace(column, heading=book.computed.time_heading) if column.heading == TIME else column for column in _COLUMNS]
    block = page.table(columns, _lines(rows), frozen=True)
    _name_limits(book, page, block, rows)
    colour_words(block.sheet, block.cells("verdict"))
    book.define("acceptance_verdicts", page, block.cells("verdict"))
    for name, key in (("names", "what is judged"), ("found", "found"), ("limits", "limit")):
        book.define(f"acceptance_{name}", page, block.cells(key))
    _count(book, page, counts_row, [word_of(row) for row in rows])


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


def colour_words(sheet: Any, area: str) -> None:
    """Let cells that hold a verdict show green, red or amber by their word."""
    for word, colour in ((MET, GREEN_FILL), (VIOLATED, RED_FILL), (OPEN, AMBER_FILL)):
        sheet.conditional_formatting.add(area, CellIsRule(operator="equal", formula=[f'"{tr(word)}"'], fill=fill(colour)))


def accepted_of(verdict: dict[str, Any]) -> Accepted:
    """Return the row of a verdict of ``run.json``."""
    limit, unit = str(verdict["limit"] or ""), str(verdict["unit"] or "")
    place, time, status, source = (str(verdict[key] or "") for key in ("place", "time", "status", "source"))
    return Accepted(
        str(verdict["name"]), limit, verdict["limit_value"], unit, sense_of(verdict), verdict["value"],
        place, time, status, source, tolerance=TOLERANCE_V if unit == "V" and limit.startswith("u_") else 0.0, met=verdict["met"],
    )  # fmt: skip


def _lines(rows: Sequence[Accepted]) -> Iterator[tuple[Any, ...]]:
    cells = cell_names(rows)
    known: set[str] = set()
    for number, (row, cell, tolerance) in enumerate(zip(rows, cells, _tolerances(rows), strict=True), 1):
        limit = Formula(same_as(f"{{{cell}}}"), row.limit_value) if cell in known else row.limit_value
        known.add(cell)
        yield (
            number, recorded(row.name), row.found, tr(_SENSES[row.sense]), limit, row.unit, tolerance,
            _margin(row), _verdict(row), tr(group_of(row)), place_in_words(row), row.time,
            limit_in_words(row.limit_name), tr(KNOWN_AS.get(row.status, row.status)), recorded(row.source),
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


def _is_editable(row: Accepted) -> bool:
    """Return whether the tolerance of a row stands in a cell."""
    return row.tolerance >= LEAST_TOLERANCE and row.limit_value is not None


def _tolerances(rows: Sequence[Accepted]) -> list[float | Formula | None]:
    """Return what stands in the column of tolerances: a number that can be edited, or the same as of an earlier row."""
    found: list[float | Formula | None] = []
    first: dict[str, float] = {}
    for row, cell in zip(rows, cell_names(rows), strict=True):
        is_same = first.get(cell) == row.tolerance
        if _is_editable(row):
            first.setdefault(cell, row.tolerance)
            found.append(Formula(same_as(f"{{{tolerance_name(cell)}}}"), row.tolerance) if is_same else row.tolerance)
        else:
            found.append(None)
    return found


def _margin(row: Accepted) -> Formula | None:
    """Return how far the found value is from the limit, negative beyond it."""
    found, limit = number_in(row.found), number_in(row.limit_value)
    if limit is None:
        return None
    value = "" if found is None else found - limit if row.sense == AT_LEAST else limit - found
    return Formula(_comparison(row).margin, value)


def _comparison(row: Accepted) -> Comparison:
    """Return what the cells of a row are held against."""
    return Comparison("{found}", "{limit}", row.sense, "{tolerance}" if _is_editable(row) else f"{row.tolerance:g}".upper())


def _verdict(row: Accepted) -> Formula | str:
    """Return the verdict as a formula; as a word where the program says other than the numbers do."""
    word = word_of(row)
    if row.limit_value is None or (row.met is not None and word != _by_numbers(row)):
        return tr(word)
    words = replace(BY_LIMIT, not_judged=row.bare or OPEN)
    return Formula(_comparison(row).verdict_by("{margin}", words), tr(word))


def word_of(row: Accepted) -> str:
    """Return the verdict on a row in a word, English."""
    return _by_numbers(row) if row.met is None else MET if row.met else VIOLATED


def _by_numbers(row: Accepted) -> str:
    found, limit = number_in(row.found), number_in(row.limit_value)
    if found is None or limit is None:
        return row.bare or OPEN
    return MET if _comparison(row).holds(found, limit, row.tolerance) else VIOLATED


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


def _name_limits(book: Book, page: Page, block: Block, rows: Sequence[Accepted]) -> None:
    """Name the first cell of each limit, and show those that can be edited so; small numbers get more digits."""
    known: set[str] = set()
    lines = zip(rows, cell_names(rows), digits_of(rows), _tolerances(rows), range(block.first, block.last + 1), strict=True)
    for row, cell, style, tolerance, at in lines:
        limit = number_in(row.limit_value)
        for key in ("found", "margin"):
            page.sheet[block.cell(key, at)]._style = page.styles[style]
        is_first = cell not in known and limit is not None
        editable = is_first and not isinstance(row.limit_value, Formula)
        if editable:
            page.edit(block.cell("limit", at), style)
        else:
            page.sheet[block.cell("limit", at)]._style = page.styles[style]
        if is_first:
            known.add(cell)
            book.define(cell, page, block.cell("limit", at))
        if tolerance is not None:
            place, is_own = block.cell("tolerance", at), not isinstance(tolerance, Formula)
            if is_own:
                page.edit(place, "general", 0.0)
            if is_own and tolerance_name(cell) not in book.names:
                book.define(tolerance_name(cell), page, place)


def _room_for_counts(page: Page) -> int:
    """Keep rows free for the counts, and return the first of them."""
    page.next += len(COUNTS) + 2
    return page.next - len(COUNTS) - 2


def _count(book: Book, page: Page, row: int, words: Sequence[str]) -> None:
    """Write how many limits are met, violated, and not judged."""
    for name, word in COUNTS.items():
        page.put(row, 1, "", "plain")
        page.put(row, 2, tr(word), "label")
        page.put(row, 3, Formula(f'COUNTIF({{acceptance_verdicts}},"{tr(word)}")', words.count(word)), "0")
        book.define(name, page, f"C{row}")
        row += 1
    page.put(row, 2, tr("all"), "label")
    page.put(row, 3, Formula("+".join(f"{{{name}}}" for name in COUNTS), sum(map(words.count, COUNTS.values()))), "sum 0")
    book.define(ALL, page, f"C{row}")
