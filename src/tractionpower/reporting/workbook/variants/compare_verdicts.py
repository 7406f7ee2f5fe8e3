"""The sheet of verdicts side by side: what each folder found against a limit that can be edited on sheet Acceptance."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from tractionpower.model.limits import Limit, common_limits
from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.common.acceptance import colour_words
from tractionpower.reporting.workbook.common.accepted import (
    BY_LIMIT,
    MET,
    OPEN,
    VIOLATED,
    Accepted,
    accepted_rows,
    cell_names,
    tolerance_name,
)
from tractionpower.reporting.workbook.common.verdicts import Comparison, same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.cells import shorten
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts, limit_in_words
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.variants.compare_cover import verdict_range
from tractionpower.results.spells import TOLERANCE_V
from tractionpower.results.verdicts import sense_of_limit

WORDS = {"yes": MET, "no": VIOLATED, "": OPEN}

Judged = tuple[str, str, float | None]
"""What is judged, name of the limit and its value: a row of the sheet."""


def add_verdicts(book: Book, folders: Sequence[str]) -> None:
    """Add the sheet, and tell the sheet of acceptance its rows: one for each folder."""
    rows = book.facts.table("compare_verdicts")
    if rows.empty:
        return
    page = book.page("Verdicts", "Verdicts side by side: what was found against what is allowed")
    page.note(
        "Verdicts are formulas: change a limit on sheet Acceptance, and they follow. A limit whose status is not 'verified' is an"
        " editable value of the limits table: the runs are checked against that value, which is no statement about a standard."
    )
    by_judged: dict[Judged, dict[str, Mapping[str, Any]]] = {}
    given = known_limits(book.facts)
    for row in rows.to_dict("records"):
        limit = _number(row["limit_value"])
        by_judged.setdefault((str(row["figure"]), str(row["limit"]), limit), {})[str(row["folder"])] = {
            str(key): value for key, value in row.items()
        }
    for number, ((name, limit_name, limit), found) in enumerate(by_judged.items(), 1):
        for folder in (folder for folder in folders if folder in found):
            place = f"INDEX({{verdicts_found_{folders.index(folder) + 1}}},{number})"
            book.acceptance.append(_accepted((name, limit_name, limit), folder, found[folder], place, given))
    limits = {
        (row.limit_name, row.limit_value): cell
        for row, cell in zip(accepted_rows(book), cell_names(accepted_rows(book)), strict=True)
    }
    columns = [
        Column("what is judged", widest=40, key="judged"), Column("limit", widest=16), Column("limit value", "0.0", key="limit"),
        Column("unit"), Column("tolerance", "general", key="tolerance"),
        *_folder_columns(folders), Column("status of the limit", "beside", 24),
    ]  # fmt: skip
    block = page.table(columns, _lines(by_judged, folders, limits, given), frozen=True)
    book.define("verdicts_names", page, block.cells("judged"))
    for k in range(len(folders)):
        book.define(f"verdicts_found_{k + 1}", page, block.cells(f"found{k}"))
        book.define(verdict_range(k), page, block.cells(f"verdict{k}"))
        colour_words(page.sheet, block.cells(f"verdict{k}"))


def _folder_columns(folders: Sequence[str]) -> Iterator[Column]:
    for k, folder in enumerate(folders):
        short = shorten(folder, 24)
        yield Column(tr("{folder}: found", folder=short), "0.0", key=f"found{k}")
        yield Column(tr("{folder}: verdict", folder=short), "beside", 12, f"verdict{k}")
        yield Column(tr("{folder}: where and when", folder=short), "beside", 26)


def _lines(
    by_judged: Mapping[Judged, Mapping[str, Mapping[str, Any]]],
    folders: Sequence[str],
    limits: Mapping[Any, str],
    given: Mapping[str, Limit],
) -> Iterator[list[Any]]:
    for (name, limit_name, limit), found in by_judged.items():
        cell = limits.get((limit_name, limit), "")
        value_cell = None if limit is None else Formula(same_as(f"{{{cell}}}"), limit)
        line: list[Any] = [
            recorded(name),
            limit_in_words(limit_name),
            value_cell,
            unit_of(limit_name, given),
            _tolerance_cell(limit_name, cell),
        ]
        status = next(iter(found.values()))["status"]
        for k, folder in enumerate(folders):
            row = found.get(folder)
            if row is None:
                line += [None, tr(OPEN), None]
                continue
            value, word = _number(row["value"]), WORDS[row["met"]]
            line += [value, _verdict(limit_name, limit, (value, word), k), recorded(str(row["at"]))]
        yield [*line, tr(KNOWN_AS.get(str(status), str(status)))]


def _verdict(limit_name: str, limit: float | None, told: tuple[float | None, str], k: int) -> Formula | str:
    """Return the verdict as a formula; as a word where the program says other than the numbers do."""
    value, word = told
    if value is None or limit is None:
        return tr(word)
    held = Comparison(f"{{found{k}}}", "{limit}", sense_of_limit(limit_name), "{tolerance}")
    if word != (MET if held.holds(value, limit, _tolerance(limit_name)) else VIOLATED):
        return tr(word)
    return Formula(held.verdict(BY_LIMIT), tr(word))


def _accepted(judged: Judged, folder: str, row: Mapping[str, Any], place: str, given: Mapping[str, Limit]) -> Accepted:
    """Return the row of the sheet of acceptance for one folder."""
    name, limit_name, limit = judged
    value, known = _number(row["value"]), given.get(limit_name)
    source = known.source if known is not None and known.status == str(row["status"]) else ""
    return Accepted(
        f"{recorded(name)}: {folder}", limit_name, limit, unit_of(limit_name, given), sense_of_limit(limit_name),
        None if value is None else Formula(place, value), str(row["at"]), "", str(row["status"]), source, folder,
        _tolerance(limit_name), {"yes": True, "no": False}.get(str(row["met"])),
    )  # fmt: skip


def known_limits(facts: Facts) -> dict[str, Limit]:
    """Return the limits of the base by name."""
    return common_limits(facts.scenario.limits, facts.scenario.supply.system, "")


def unit_of(limit_name: str, given: Mapping[str, Limit] = MappingProxyType({})) -> str:
    """Return the unit of what is held against a limit; a limit of the touch voltage tells how long it may last.

    >>> unit_of("u_min2"), unit_of("t_max2"), unit_of("utilisation_percent"), unit_of("touch_300s")
    ('V', 's', '%', 's')
    """
    if limit_name.startswith("u_"):
        return "V"
    if limit_name.startswith(("t_", "touch_")) or limit_name.endswith("_s"):
        return "s"
    if limit_name in given:
        return given[limit_name].unit
    return "%" if limit_name.endswith("_percent") else ""


def _tolerance(limit_name: str) -> float:
    return TOLERANCE_V if limit_name.startswith("u_") else 0.0


def _tolerance_cell(limit_name: str, cell: str) -> Formula | None:
    """Return the tolerance of a row, from the sheet of acceptance."""
    tolerance = _tolerance(limit_name)
    return Formula(same_as(f"{{{tolerance_name(cell)}}}"), tolerance) if cell and tolerance else None


def _number(value: Any) -> float | None:
    return None if value is None or math.isnan(value) else float(value)
