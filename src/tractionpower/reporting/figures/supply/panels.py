"""What figures of the supply have in common: their size on a page, panels over the time of day, one legend for all panels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path
from numpy.typing import NDArray

from tractionpower.reporting.figures.base.axes import clock_label, set_clock
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import PAGE, SMALLEST, TITLE, new_figure

LETTER_7 = 0.054
"""Mean width of a letter of the smallest text [inches]."""

LEGEND_LETTERS = 96
"""Letters of a text of a legend."""

MOST_PANELS = 20
"""Panels of one figure."""


def fitted(text: str, inches: float) -> str:
    """Return a text that is not wider than so much in the smallest size; of a longer one the beginning."""
    font = FontProperties(size=SMALLEST)

    def wide(letters: int) -> float:
        return float(text_to_path.get_text_width_height_descent(text[:letters], font, ismath=False)[0]) / 72.0

    if wide(len(text)) <= inches:
        return text
    low, high = 0, len(text)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if wide(middle) <= inches - SMALLEST / 72.0 else (low, middle)
    return f"{text[:low].rstrip()}…"


def head(figure: Figure, title: str) -> None:
    """Write a title over a figure; the writer of figures breaks lines that are too long. A name of hundreds of letters is cut."""
    figure.suptitle(shortened_title(title), x=0.01, ha="left", fontsize=TITLE)


def legend_below(figure: Figure, handles: Sequence[Any], labels: Sequence[str], most: int = 4) -> None:
    """Write one legend below a figure, in as many columns as fit beside each other."""
    columns = next((n for n in range(min(most, len(labels)), 1, -1) if _legend_inches(labels, n) <= PAGE), 1)
    figure.legend(
        handles, [shortened(label, LEGEND_LETTERS) for label in labels], loc="outside lower center", ncols=columns,
        fontsize=SMALLEST, columnspacing=1.2, handlelength=2.8,
    )  # fmt: skip


def _legend_inches(labels: Sequence[str], columns: int) -> float:
    """Return how wide a legend is that is filled column by column [inches]."""
    rows, more = divmod(len(labels), columns)
    ends = np.cumsum([rows + (k < more) for k in range(columns)])
    longest = [max(map(len, part), default=0) for part in np.split(np.array(labels, object), ends[:-1])]
    return sum(LETTER_7 * min(letters, LEGEND_LETTERS) + 0.55 for letters in longest)


def shortened_title(title: str, most: int = 180) -> str:
    """Return a title of at most some `most` letters, cut in the middle: a name comes first, and what is drawn last.

    >>> shortened_title("a long name: loads", 14)
    'a long…: loads'
    """
    if len(title) <= most:
        return title
    end = title[title.rfind(":") :] if ":" in title else ""
    end = end if len(end) < most // 2 else title[-(most // 2) :]
    return f"{title[: most - len(end) - 1].rstrip()}…{end}"


def in_lines(text: str, most: int) -> list[str]:
    """Return a text in lines of at most so many letters, broken at blanks where there are some.

    >>> in_lines("heat in the contact line", 12)
    ['heat in the', 'contact line']
    """
    lines = []
    for part in text.split("\n"):
        rest = part
        while len(rest) > most:
            at = rest.rfind(" ", 0, most + 1)
            at = at if at > 0 else most
            lines.append(rest[:at].rstrip())
            rest = rest[at:].lstrip()
        lines.append(rest)
    return lines


def once(panels: Iterable[Axes]) -> tuple[list[Any], list[str]]:
    """Return handles and labels of all panels, each once."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    return list(found.values()), list(found)


def columns_for(count: int) -> int:
    """Return into how many columns panels over time are laid."""
    return 1 if count <= 3 else 2


def time_panels(count: int, begin: float, end: float) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure with panels over the time of day from `begin` to `end` [s], one column after the other."""
    columns = columns_for(count)
    lines = -(-count // columns)
    figure = new_figure(PAGE, max(3.6, 1.5 + (1.7 if columns == 1 else 0.95) * lines), 0.03)
    grid: NDArray[Any] = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    panels = list(grid.T.ravel())
    for axes in panels:
        axes.tick_params(labelsize=SMALLEST)
    for axes in panels[count:]:  # nothing but their clocks, so that all columns end alike
        axes.set_frame_on(False)
        axes.grid(visible=False)
        axes.tick_params(left=False, labelleft=False)
    set_clock(panels[0], begin, end, 7 if columns == 1 else 6)
    panels[0].set_xlim(begin, end)
    for axes in grid[-1]:
        axes.set_xlabel(clock_label(panels[0]), fontsize=SMALLEST)
    return figure, panels


def most_loaded(loads: Sequence[float], most: int = MOST_PANELS) -> list[int]:
    """Return the indices of those with the greatest loads, in their order.

    >>> most_loaded([1.0, 5.0, float("nan"), 3.0], 2)
    [1, 3]
    """
    ranked = sorted(range(len(loads)), key=lambda k: -np.nan_to_num(loads[k]))
    return sorted(ranked[:most])
