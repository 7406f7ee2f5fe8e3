"""Inputs as tables: a list of devices with the fields that differ from their defaults, settings with their meaning."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from pydantic import BaseModel

from tractionpower.model.base import Declaration
from tractionpower.reporting.texts import recorded, tr
from tractionpower.reporting.workbook.common.declared import Declared, declared, flat, in_words, readable, words_of
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS
from tractionpower.reporting.workbook.frame.page import Block, Column, Page, heading_of

MOST_ROWS = 2000
"""Rows of a list that a sheet shows."""

SETTINGS = (
    Column("quantity", widest=50),
    Column("value", "any", widest=40),
    Column("given / default", widest=16),
    Column("meaning", "beside", widest=80),
)

_WIDE = {"source": 80, "status": 40, "meaning": 60}
_FIRST = (
    "id", "kind", "at", "time", "device", "unit", "duty_class", "name", "meaning", "status", "source", "track", "side", "km",
    "from_km", "to_km",
)  # fmt: skip
"""Fields that stand first in a table, in this order: who is meant, how it is known, and where it is."""

_LAST = ("tracks", "state")
_NOT_TOLD = ("name", "source", "system")


def title_of(name: str) -> str:
    """Return the name of a list or part as a heading."""
    words = words_of(name)
    return f"{words[:1].upper()}{words[1:]}"


def lists_of(page: Page, whole: Declaration, leave_out: Sequence[str] = ()) -> None:
    """Write every list of `whole` that is not empty as a table with its fields; a single part as well."""
    for field in declared(whole):
        value = field.value
        if field.name in (*_NOT_TOLD, *leave_out):
            continue
        if isinstance(value, BaseModel):
            listed(page, title_of(field.name), (value,))
        elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            listed(page, title_of(field.name), value)


def listed(page: Page, title: str, rows: Sequence[Any], before: tuple[str, Sequence[str]] | None = None) -> None:
    """Write declarations of one kind as a table under a title; what they all leave to its default stands below in a line.

    Parameters
    ----------
    page, title
        Where it goes, and what stands above; already in the language of the report.
    rows
        The declarations; of a long list the first.
    before
        Heading and values of a column before theirs: whom they belong to.
    """
    page.section(title)
    _say_what_is_missing(page, len(rows))
    shown = rows[:MOST_ROWS]
    fields = [declared(row) for row in shown]
    told = [k for k in range(len(fields[0])) if any(row[k].name == "id" or not row[k].is_default for row in fields)]
    told.sort(key=lambda k: _place_of(fields[0][k].name))
    columns, values = _columns(shown, fields, told)
    if before is not None:
        columns, values = [Column(before[0], widest=30), *columns], [list(before[1][:MOST_ROWS]), *values]
    page.table(columns, [list(row) for row in zip(*values, strict=True)])
    _say_defaults(page, [fields[0][k] for k in range(len(fields[0])) if k not in told])


def settings(page: Page, title: str, *parts: BaseModel, leave_out: str = "") -> Block:
    """Write all fields of declarations, those of inner parts as well, each with its meaning and whether it was given.

    Inner parts whose fields begin with `leave_out` are left out.
    """
    page.section(title)
    rows = [row for part in parts for row in setting_rows(part, leave_out)]
    return page.table(SETTINGS, rows)


def setting_rows(part: BaseModel, leave_out: str = "") -> Iterable[tuple[Any, ...]]:
    """Yield the rows of `SETTINGS` for the fields of a declaration."""
    for heading, field in flat(part):
        if not (leave_out and heading.startswith(leave_out)):
            yield heading, shown(field), tr(field.known), recorded(field.meaning)


def shown(field: Declared) -> Any:
    """Return what stands in the cell of a setting; a dash where there is nothing."""
    return "–" if field.value is None or field.value in ((), "") else field.shown


def _columns(
    rows: Sequence[Any], fields: Sequence[Sequence[Declared]], told: Sequence[int]
) -> tuple[list[Column], list[list[Any]]]:
    """Return columns and their values; times of day are numbers there."""
    columns: list[Column] = []
    values: list[list[Any]] = []
    for k in told:
        name, given = fields[0][k].name, [row[k].value for row in fields]
        attribute = next(each for each, info in type(rows[0]).model_fields.items() if (info.alias or each) == name)
        plain = [getattr(row, attribute) for row in rows]
        if name == "status":
            columns.append(Column(tr("status"), "beside" if columns else "text", widest=_WIDE[name]))
            values.append([recorded(KNOWN_AS.get(value, value)) for value in given])
        elif any(isinstance(value, float) and isinstance(text, str) for value, text in zip(plain, given, strict=True)):
            columns.append(Column(heading_of(name), "time"))
            values.append(plain)
        elif all(value is None or (isinstance(value, float | int) and not isinstance(value, bool)) for value in given):
            columns.append(Column(heading_of(name), "general"))
            values.append([readable(name, value) for value in given])
        else:
            columns.append(Column(heading_of(name), "beside" if columns else "text", _WIDE.get(name, 40)))
            values.append([row[k].shown for row in fields])
    return columns, values


def _place_of(name: str) -> int:
    """Return where a field stands among the columns."""
    if name in _FIRST:
        return _FIRST.index(name) - len(_FIRST)
    return _LAST.index(name) + 1 if name in _LAST else 0


def _say_what_is_missing(page: Page, count: int) -> None:
    if count > MOST_ROWS:
        page.note(tr("The first {most} of {count} rows; file scenario.json has all of them.", most=MOST_ROWS, count=count))


def _say_defaults(page: Page, fields: Iterable[Declared]) -> None:
    """Tell which fields no row gives: with their defaults, or that they are left out."""
    kept = [field for field in fields if field.value not in ((), "", {})]
    usual = [f"{heading_of(field.name)} {in_words(field.value, field.words)}" for field in kept if field.value is not None]
    none = [heading_of(field.name) for field in kept if field.value is None]
    page.next -= 1  # the line belongs to the table above
    if usual:
        page.note(tr("Default in every row: {values}.", values="; ".join(usual)))
    if none:
        page.note(tr("Left out in every row: {names}.", names=", ".join(none)))
    page.next += 1
