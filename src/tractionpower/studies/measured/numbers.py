"""Measured cells as numbers: decimal sign, thousands signs, words for a missing value."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.errors import Problem
from tractionpower.io.wording import counted, shown
from tractionpower.studies.measured.cells import Cells

Array = NDArray[Any]

DECIMALS = {"point": ".", "comma": ","}
"""Decimal signs as the map calls them."""

MISSING = frozenset(("", "-", "--", "---", "nan", "n/a", "na", "#n/a", "null", "none", "nil", "missing", "brak"))
"""Cells that say that there is no value."""

MOST_BAD = 0.1
"""Share of cells that are no numbers from which on a column is refused."""

_PLAIN = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WRITTEN = re.compile("[-+\u2212]?[\\d.,\\s\u00a0\u202f']+(?:[eE][-+]?\\d+)?")
_BLANKS = re.compile("[\\s\u00a0\u202f']")


def find_decimal(cells: Cells, headings: Sequence[str]) -> tuple[str, list[Problem]]:
    """Return the decimal sign of some columns, and what is wrong with it.

    The sign that alone stands there is it. Where a cell has both, it is the last of them. Where some cells have one and
    others the other, the one that could separate thousands everywhere does so; else it is an error.
    """
    signs: dict[str, list[tuple[str, int]]] = {".": [], ",": []}
    both: dict[str, tuple[str, int]] = {}
    for heading in headings:
        for row, cell in enumerate(cells.columns[heading]):
            point, comma = "." in cell, "," in cell
            if not (point or comma) or _WRITTEN.fullmatch(cell) is None:
                continue
            if point and comma:
                both.setdefault("." if cell.rfind(".") > cell.rfind(",") else ",", (cell, row))
            else:
                signs["." if point else ","].append((cell, row))
    if len(both) == 2:
        return ".", [_mixed(cells, both["."], both[","])]
    if both:
        return next(iter(both)), []
    if not signs[","] or not signs["."]:
        return ("," if signs[","] else "."), []
    grouping = {sign: all(_groups(cell, sign) for cell, _ in found) for sign, found in signs.items()}
    if grouping["."] == grouping[","]:
        return ".", [_mixed(cells, signs["."][0], signs[","][0])]
    decimal, group = (".", ",") if grouping[","] else (",", ".")
    cell, row = signs[group][0]
    found = f"{shown(cell)} is read as {cell.replace(group, '')}: {group!r} separates thousands, since {decimal!r} has decimals"
    return decimal, [Problem("thousands_sign", "", found, severity="warning", place=cells.place(row))]


def _mixed(cells: Cells, point: tuple[str, int], comma: tuple[str, int]) -> Problem:
    where = [f"{shown(cell)} in line {cells.lines[row]}" for cell, row in (point, comma)]
    found = f"two decimal signs: {', '.join(where)}"
    remedy = "mend the file, or say decimal: in the map; what does not fit is left out then"
    return Problem("mixed_decimals", "", found, "one decimal sign", remedy, place=cells.place(min(point[1], comma[1])))


def _groups(cell: str, sign: str) -> bool:
    """Return whether `sign` can separate thousands in a cell."""
    return re.fullmatch(rf"[-+]?\d{{1,3}}(?:{re.escape(sign)}\d{{3}})+", cell) is not None


def to_numbers(texts: Sequence[str], decimal: str) -> tuple[Array, list[int]]:
    """Return numbers, NaN where there is none, and the rows of cells that are neither a number nor missing.

    >>> numbers, bad = to_numbers(["3312,5", "3.312,5", "", "ERR"], ",")
    >>> numbers.tolist(), bad
    ([3312.5, 3312.5, nan, nan], [3])
    """
    group = "." if decimal == "," else ","
    cells = pd.Series(list(texts), dtype=object)
    is_plain = ~cells.str.contains(group, regex=False)
    pointed = cells.where(is_plain, "").str.replace(decimal, ".", regex=False)
    numbers = np.array(pd.to_numeric(pointed, errors="coerce"), float)
    numbers[~np.isfinite(numbers)] = np.nan
    bad = []
    for row in np.flatnonzero(np.isnan(numbers)).tolist():
        text = texts[row].strip()
        if text.lower() in MISSING:
            continue
        value = _number(text, decimal, group)
        if value is None:
            bad.append(row)
        else:
            numbers[row] = value
    return numbers, bad


def _number(text: str, decimal: str, group: str) -> float | None:
    """Return the value of a cell that is written in an unusual way: thousands signs, blanks, a long minus."""
    text = _BLANKS.sub("", text.replace("\u2212", "-"))
    whole, _, rest = text.partition(decimal)
    if group in whole:
        if not _groups(whole, group):
            return None
        whole = whole.replace(group, "")
    text = f"{whole}.{rest}" if rest else whole
    value = float(text) if _PLAIN.fullmatch(text) else None
    return value if value is not None and np.isfinite(value) else None


def name_of(decimal: str) -> str:
    """Return how the map calls a decimal sign."""
    return next(name for name, sign in DECIMALS.items() if sign == decimal)


def tell_bad(cells: Cells, heading: str, bad: Sequence[int], path: str, decimal: str) -> list[Problem]:
    """Return what is to be said of cells that are no numbers: an error if they are many."""
    if not bad:
        return []
    texts = cells.columns[heading]
    other = "." if decimal == "," else ","
    first = texts[bad[0]]
    remedy = ""
    if other in first and any(character.isdigit() for character in first):
        taken = f"decimals are taken to be written with {decimal!r}"
        remedy = f"{taken}; if they are with {other!r}, say decimal: {name_of(other)} in the map"
    filled = sum(text.lower() not in MISSING for text in texts)
    many = len(bad) > MOST_BAD * filled
    found = f"{counted(len(bad), 'cell')} of {filled} in column {shown(heading)} no number, the first {shown(first)}"
    severity = "error" if many else "warning"
    left = "" if many else "; they are left out"
    return [Problem("no_number", path, found + left, "numbers", remedy, severity, cells.place(bad[0]))]  # type: ignore[arg-type]
