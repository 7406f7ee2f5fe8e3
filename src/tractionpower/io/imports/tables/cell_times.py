"""Times of day as they stand in timetables: texts, time cells, numbers, and the signs for passing without a stop."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Literal

from tractionpower.io.excel import Cell
from tractionpower.model.base import parse_time

ALLOWED = "HH:MM or HH:MM:SS, a time cell, or | for passing"
LATEST_S = 48 * 3600.0
"""No time of a timetable is later [s]: a train of the day before would be a run of its own."""

PASS_SIGNS = frozenset(("|", "││", "│", "-", "–", "—", "--", "->", "→", "↓", "↑", "⇣", "⇡", "x|", "‖", "||"))
_DOTTED = re.compile(r"(\d{1,2})\.([0-5]\d)(?:\.([0-5]\d))?")
_PASSING = re.compile(r"\((?P<a>[^)]+)\)|[|│](?P<b>[^|│]+)[|│]?|(?P<c>[^|│]+)[|│]")

Way = Literal["text", "dots", "number", "date", "bad"]


@dataclass(frozen=True, slots=True)
class CellTime:
    """What a cell says of a time.

    Attributes
    ----------
    seconds
        Seconds after midnight [s]; None where only the passing is marked.
    passes
        Whether it is marked as passing.
    way
        How it was written, where that needs a word; ``bad`` if it is no time, which is told elsewhere.
    """

    seconds: float | None
    passes: bool = False
    way: Way = "text"


def read_time(cell: Cell) -> CellTime | None:
    """Return what a cell says of a time, or None if it is empty.

    Raises
    ------
    ValueError
        If it is no time.
    """
    if cell is None:
        return None
    if isinstance(cell, timedelta):
        return CellTime(_checked(cell.total_seconds()))
    if isinstance(cell, datetime):
        return CellTime(_checked((cell - datetime(cell.year, cell.month, cell.day)).total_seconds()), way="date")
    if isinstance(cell, bool):
        raise ValueError(str(cell).lower())
    if isinstance(cell, float):  # days, as spreadsheets count times whose cell lost its format
        if cell.is_integer() or not 0.0 < cell < 2.0:
            raise ValueError(f"the number {cell:g}")
        return CellTime(_checked(cell * 86400.0), way="number")
    return _of_text(cell.strip())


def _of_text(text: str) -> CellTime | None:
    if not text:
        return None
    if text in PASS_SIGNS:
        return CellTime(None, passes=True)
    marked = _PASSING.fullmatch(text)
    inner = next(part for part in marked.groups() if part) if marked else text
    seconds, way = parse_time(inner), "text"
    dotted = _DOTTED.fullmatch(inner.strip())
    if seconds is None and dotted is not None:
        seconds, way = parse_time(":".join(part for part in dotted.groups() if part)), "dots"
    if seconds is None:
        raise ValueError(repr(text))
    return CellTime(_checked(seconds), marked is not None, "dots" if way == "dots" else "text")


def _checked(seconds: float) -> float:
    if not 0.0 <= seconds <= LATEST_S:
        raise ValueError(f"{seconds / 3600.0:.2f} hours after midnight")
    # Days as binary fractions miss the second by a little.
    return float(round(seconds)) if abs(seconds - round(seconds)) < 1e-3 else round(seconds, 3)
