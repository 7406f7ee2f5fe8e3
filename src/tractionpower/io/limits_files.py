"""Limits of standards: the shipped table and a user's rows over it."""

from __future__ import annotations

from collections import Counter
from functools import cache
from importlib import resources
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from tractionpower.errors import Problem, raise_errors
from tractionpower.io.csv_files import csv_text, read_csv
from tractionpower.io.problems import Input, problems_of
from tractionpower.io.provenance import Mark
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.text_files import Source
from tractionpower.model.limits import Limit, overlay

_ROWS: TypeAdapter[tuple[Limit, ...]] = TypeAdapter(tuple[Limit, ...])


@cache
def shipped_limits() -> tuple[Limit, ...]:
    """Return the limits that ship with the program, sorted by system and name."""
    file = Path(str(resources.files("tractionpower"))) / "data" / "limits.csv"
    rows, _ = read_limits(Source(file, file.name, "limits"))
    return overlay(rows, ())


def read_limits(source: Source) -> tuple[tuple[Limit, ...], Mark]:
    """Return the rows of a limits table and where they stand.

    Raises
    ------
    InputError
        With all problems of the file.
    """
    table = read_csv(source, shape_of(Limit))
    problems = [*table.problems, *_twice(source, table.rows, table.mark)]
    rows: tuple[Limit, ...] = ()
    try:
        rows = _ROWS.validate_python(table.rows)
    except ValidationError as error:
        problems += _problems(error, source, table.rows, table.mark)
    raise_errors(problems)
    return rows, table.mark


def limits_text(limits: tuple[Limit, ...]) -> str:
    """Return as CSV the rows of `limits` that differ from the shipped ones; empty when none does."""
    changed = set(limits) - set(shipped_limits())
    columns = list(Limit.model_fields)
    rows = [[getattr(limit, name) for name in columns] for limit in limits if limit in changed]
    return csv_text(columns, rows) if rows else ""


def _problems(error: ValidationError, source: Source, rows: list[dict[str, object]], mark: Mark) -> list[Problem]:
    # The table is a list, so it is looked at as the one key of a mapping around it.
    shape = Shape({"items": shape_of(Limit).schema}, shape_of(Limit).definitions)
    return problems_of(error, Input(source.root, rows, mark, shape, source.file))


def _twice(source: Source, rows: list[dict[str, object]], mark: Mark) -> list[Problem]:
    counts = Counter((row.get("system"), row.get("name")) for row in rows)
    return [
        source.problem(
            "duplicate_row", f"the limit {system} {name} {count} times", "once", line=mark.find([f"{system} {name}"]).line
        )
        for (system, name), count in counts.items()
        if count > 1
    ]
