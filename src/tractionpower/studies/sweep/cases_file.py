"""Cases from a CSV file: a column for each path, a row for each case; an empty cell leaves the input as it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tractionpower.errors import InputError, Problem
from tractionpower.io.csv_files import read_plain
from tractionpower.io.text_files import Source
from tractionpower.studies.sweep.cases import BASE
from tractionpower.studies.sweep.keys import text_of

NAME = "case"
"""Column with the names of the cases."""

LONGEST = 120
"""Characters of a name."""


def read_cases(file: Path) -> tuple[list[dict[str, str]], list[str]]:
    """Return what each case sets, and the names of the cases; no names where the file has no column ``case``.

    Raises
    ------
    InputError
        With all that is wrong with the file.
    """
    source = Source(file, str(file), "")
    header, rows = read_plain(source)
    paths = [name for name in header if name != NAME]
    problems = [] if paths and all(paths) else [source.problem("no_path", "a column without a path", "paths of inputs", line=1)]
    problems += [] if rows else [source.problem("no_cases", "no rows", "a row for each case")]
    names = [row.get(NAME, "") for _, row in rows] if NAME in header else []
    problems += [source.problem("bad_name", found, allowed, line=rows[k][0]) for k, found, allowed in _wrong_names(names)]
    for line, row in rows:
        if not any(name in row for name in paths):
            remedy = "the base case is run in any case; leave the row out"
            problems.append(source.problem("no_change", "a case that changes nothing", "a value", remedy, line))
    if problems:
        raise InputError(problems)
    return [{path: row[path] for path in paths if path in row} for _, row in rows], names


def given_cases(cases: Sequence[Mapping[str, Any]]) -> tuple[list[dict[str, str]], list[str]]:
    """Return what cases of Python set and how they are called: mappings from paths to values, ``case`` for the name."""
    names = [str(case.get(NAME, "")) for case in cases] if any(NAME in case for case in cases) else []
    problems = [Problem("bad_name", f"cases[{k}]", found, allowed) for k, found, allowed in _wrong_names(names)]
    values = [{path: text_of(value) for path, value in case.items() if path != NAME} for case in cases]
    problems += [
        Problem("no_change", f"cases[{k}]", "a case that changes nothing", "a value", "leave it out")
        for k, case in enumerate(values)
        if not case
    ]
    if problems:
        raise InputError(problems)
    return values, names


def _wrong_names(names: Sequence[str]) -> list[tuple[int, str, str]]:
    """Return which names are not allowed, what is wrong with them, and what is allowed."""
    wrong, seen = [], {BASE}
    for k, name in enumerate(names):
        if not name or len(name) > LONGEST or not name.isprintable():
            wrong.append((k, f"the name {name!r}", f"1 to {LONGEST} characters"))
        elif name in seen:
            wrong.append((k, f"the name {name!r}{' of the base case' if name == BASE else ' twice'}", "each name once"))
        seen.add(name)
    return wrong
