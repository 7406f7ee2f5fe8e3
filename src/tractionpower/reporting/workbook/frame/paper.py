"""What fits on a printed page, as far as widths of columns and heights of rows tell before it is printed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from openpyxl.worksheet.pagebreak import Break

EMPTY_WIDTH = 12.0
"""Width of an empty column that gives room to a line of text [characters]."""

LETTER_WIDTHS = {"title": 1.7, "section": 1.25, "note": 0.85}
"""Width of a letter of a line of text by its style; 1 is that of the characters that widths of columns are counted in."""

PAGE_POINTS = {"a4": (770.0, 487.0), "a3": (1118.0, 734.0)}
"""Width and height within the margins of a page, landscape [pt]."""

CHARACTER_POINTS = 5.6
"""Width of a character of a column [pt]."""


def break_before_charts(sheet: Any, rows: Iterable[int], chart_rows: int, line_points: float, page: tuple[str, float]) -> None:
    """Let charts begin on pages of their own where what stands before them leaves no room.

    Parameters
    ----------
    sheet
        With its hard breaks.
    rows
        First rows of the charts, rising.
    chart_rows
        Rows that a chart covers.
    line_points
        Height of a row that none is given for [pt].
    page
        Paper, and the width that is to fit on a page [characters].
    """
    paper, width = page
    wide, high = PAGE_POINTS[paper]
    room = high * max(1.0, width * CHARACTER_POINTS / wide)  # a wide sheet is printed smaller
    heights = sheet.row_dimensions
    for row in rows:
        first = max((each.id for each in sheet.row_breaks.brk if each.id < row), default=0) + 1
        above = sum((heights[k].height if k in heights else None) or line_points for k in range(first, row))
        if above + chart_rows * line_points > room:
            sheet.row_breaks.append(Break(id=row - 1))
