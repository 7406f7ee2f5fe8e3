"""The common style of all figures, and how a figure gets into a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from tractionpower.io.file_names import ENDING, file_names

# Okabe and Ito's colours stay apart for colour-blind eyes.
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
# Lines of several tracks often lie on each other: dashes let the lower one show through.
DASHES: tuple[Any, ...] = ("-", (0, (4, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2)))
INK, GREY, PALE = "#333333", "#777777", "#dddddd"
STYLE: Any = {
    "font.size": 9.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": PALE,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "figure.dpi": 150.0,
    "text.parse_math": False,  # a dollar sign in a user's name is no formula
}


def new_figure(width: float, height: float, between: float = 0.02) -> Figure:
    """Return an empty figure [inches] that needs no display; to be called inside ``mpl.rc_context(STYLE)``.

    `between` is the space between columns of panels as a share of their width.
    """
    figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(wspace=between))
    FigureCanvasAgg(figure)
    return figure


def png_names(identifiers: Iterable[str]) -> dict[str, str]:
    """Return the name of a PNG for each identifier; no two are the same on any system.

    >>> png_names(["EC 1/2"])
    {'EC 1/2': 'EC 1%2F2.png'}
    """
    return {identifier: name.removesuffix(ENDING) + ".png" for identifier, name in file_names(identifiers).items()}


def save_all(drawn: Mapping[str, Figure], folder: Path, names: Iterable[str]) -> list[Path]:
    """Write figures as PNG by their names and return their paths; of `names`, those that are not drawn this time go."""
    paths = [save(figure, folder / f"{name}.png") for name, figure in drawn.items()]
    for name in {*names} - {*drawn}:
        with suppress(OSError):
            (folder / f"{name}.png").unlink()
    return paths


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as PNG; the file gets its name when it is complete."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    try:
        with mpl.rc_context(STYLE):
            figure.savefig(temporary, format="png")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path
