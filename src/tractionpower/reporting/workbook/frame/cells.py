"""Cells: their styles, and values that are safe in them. What a user names is text, never a formula."""

from __future__ import annotations

import math
import re
from copy import copy
from numbers import Integral, Real
from typing import Any

import numpy as np
from openpyxl.cell.cell import Cell
from openpyxl.styles import Alignment, Border, Font, PatternFill, Side

from tractionpower.model.base import format_time
from tractionpower.reporting.facts.characters import TURNS

BLUE, INK, GREY, PALE = "1F4E79", "333333", "777777", "D9D9D9"
EDITABLE_FILL = "FFF9C4"
"""Cells that are made to be edited."""

GREEN_FILL, RED_FILL, AMBER_FILL, PLAIN_FILL = "C6EFCE", "FFC7CE", "FFEB9C", "F2F2F2"

SECONDS_PER_DAY = 86400.0
"""Excel counts times in days."""

LONGEST = 16_000
"""Characters that a cell takes; Excel's limit is 32 767, and it counts some characters twice."""

FORMATS = {
    "general": "General",
    "0": "0",
    "0.0": "0.0",
    "0.00": "0.00",
    "0.000": "0.000",
    "0.0000": "0.0000",
    "0.00000": "0.00000",
    "percent": "0.0%",
    "exponent": "0.0E+00",
    "time": "[hh]:mm:ss",
}
"""Number formats by the name of the style."""

_FORBIDDEN = re.compile(f"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff{TURNS}]")
_FORMULA_SIGNS = ("=", "+", "-", "@", "\t", "'")
_LINE = Side(style="thin", color=PALE)
_BORDER = Border(bottom=_LINE)
_EDGE = Side(style="thin", color=GREY)
_BOX = Border(left=_EDGE, right=_EDGE, top=_EDGE, bottom=_EDGE)


class Styles:
    """The styles of a workbook by name, each made once.

    The public setters of a cell hash five objects each time, which takes most of the time of a big workbook; here a
    style is made on one cell and its number is given to all others.
    """

    def __init__(self, workbook: Any) -> None:
        self._workbook = workbook
        self._known: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._known:
            cell = Cell(self._workbook.worksheets[0], row=1, column=1)
            for attribute, value in _look(name).items():
                setattr(cell, attribute, value)
            self._known[name] = cell._style
        return self._known[name]


def put(sheet: Any, row: int, column: int, value: Any, style: Any) -> Any:
    """Write a value into a cell, a text as text whatever it begins with, and return the cell."""
    cell = sheet.cell(row, column)
    cell._style = style
    shown = plain(value)
    if shown is None:
        return cell
    cell.value = shown
    if isinstance(shown, str):
        cell.data_type = "s"  # a leading = would make a formula of it, a name such as #N/A an error
        if shown.startswith(_FORMULA_SIGNS):
            cell._style = copy(style)
            cell.quotePrefix = 1  # it stays text when someone edits the cell
    return cell


def plain(value: Any) -> float | int | str | None:
    """Return a value as what a cell can hold; None where there is none.

    >>> plain(float("nan")), plain(True)
    (None, 'yes')
    """
    if value is None or isinstance(value, str):
        return None if value is None else clean(value)
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        number = float(value)
        return number if math.isfinite(number) else None if math.isnan(number) else "infinite"
    text = str(value)
    return None if text in ("<NA>", "NaT") else clean(text)


def clean(text: str) -> str:
    """Return a text without what XML forbids or what turns texts round, and no longer than a cell takes."""
    text = _FORBIDDEN.sub("\ufffd", text.replace("\r\n", "\n").replace("\r", "\n"))
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


def shorten(text: str, most: int) -> str:
    """Return a text of at most `most` characters.

    >>> shorten("Wloszczowa", 6)
    'Wlosz…'
    """
    text = " ".join(clean(text).split())
    return text if len(text) <= most else text[: most - 1] + "…"


def days(seconds: Any) -> Any:
    """Return seconds as the days that Excel counts times in; None and NaN stay.

    Excel shows no times before midnight, as trains of the day before have them: they become texts.
    """
    if seconds is None:
        return None
    return format_time(float(seconds)) if seconds < 0.0 else seconds / SECONDS_PER_DAY


def fill(colour: str) -> Any:
    """Return a plain fill of a colour."""
    return PatternFill("solid", start_color=colour, end_color=colour)


def _font(**look: Any) -> Font:
    """Return a font of the family of all cells; one without a name is shown in that of the viewer."""
    return Font(name="Calibri", **look)


def _look(name: str) -> dict[str, Any]:
    """Return font, fill, alignment, border and number format of a style by name."""
    if name in FORMATS:
        look = {"alignment": Alignment(horizontal="right", vertical="top"), "border": _BORDER, "number_format": FORMATS[name]}
        return look
    if name.startswith("editable "):
        return _look(name[9:]) | {"fill": fill(EDITABLE_FILL), "border": _BOX}
    if name.startswith("sum "):
        return _look(name[4:]) | {"font": _font(bold=True), "border": Border(top=Side(style="thin", color=INK))}
    wrapped = Alignment(wrap_text=True, vertical="top")
    looks: dict[str, dict[str, Any]] = {
        "text": {"alignment": wrapped, "border": _BORDER},
        "beside": {"alignment": Alignment(wrap_text=True, vertical="top", horizontal="left", indent=1), "border": _BORDER},
        "any": {"alignment": Alignment(wrap_text=True, vertical="top", horizontal="left"), "border": _BORDER},
        "head": {
            "font": _font(bold=True, color="FFFFFF"),
            "fill": fill(BLUE),
            "alignment": Alignment(wrap_text=True, vertical="center", horizontal="center"),
        },
        "title": {"font": _font(bold=True, size=16, color=BLUE)},
        "section": {"font": _font(bold=True, size=12, color=BLUE)},
        "note": {"font": _font(italic=True, size=9, color=GREY)},
        "label": {"font": _font(bold=True, color=INK), "alignment": wrapped},
        "plain": {},
        "wrapped": {"alignment": wrapped},
        "subtitle": {"font": _font(size=11, color=GREY)},
        "company": {"font": _font(bold=True, size=14, color=BLUE), "alignment": Alignment(horizontal="right")},
        "rule": {"border": Border(bottom=Side(style="medium", color=BLUE))},
        "box": {"alignment": Alignment(wrap_text=True, vertical="center", horizontal="left", indent=1), "border": _BOX},
        "box label": {
            "font": _font(bold=True, color=INK),
            "fill": fill(PLAIN_FILL),
            "alignment": Alignment(vertical="center"),
            "border": _BOX,
        },
        "small head": {"font": _font(bold=True, color=BLUE), "border": Border(bottom=Side(style="thin", color=BLUE))},
        "link": {"font": _font(color="0563C1", underline="single")},
        "good": {"fill": fill(GREEN_FILL), "alignment": wrapped},
        "bad": {"fill": fill(RED_FILL), "alignment": wrapped},
        "doubt": {"fill": fill(AMBER_FILL), "alignment": wrapped},
        "neutral": {"fill": fill(PLAIN_FILL), "alignment": wrapped},
    }
    if name.startswith("big "):
        return looks[name[4:]] | {
            "font": _font(bold=True, size=14, color=INK),
            "alignment": Alignment(wrap_text=True, vertical="center"),
        }
    return looks[name]
