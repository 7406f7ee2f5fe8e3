"""Which figures are drawn and into which kinds of files: what the template says, known to every writer of figures."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from tractionpower.model.report import FigureFormat, ReportFigures

FORMATS: tuple[FigureFormat, ...] = get_args(FigureFormat)
"""All kinds of files that a figure can be written as."""

GROUPS = ("curves", "outages_by_km")
"""Names that stand for all figures whose names go on behind them with ``_``."""

_PAGE = re.compile(r"_\d+")


@dataclass(frozen=True, slots=True)
class Drawing:
    """What is drawn.

    Attributes
    ----------
    formats
        Kinds of files of each figure.
    names
        Names of the figures to draw; None: all.
    source
        Line at the foot of each figure that tells where it comes from; empty: none.
    """

    formats: tuple[FigureFormat, ...] = ("png",)
    names: tuple[str, ...] | None = None
    source: str = ""


ALL = Drawing()
"""Without a template: all figures, as PNG."""

_drawing: ContextVar[Drawing] = ContextVar("drawing", default=ALL)


@contextmanager
def drawing(figures: ReportFigures, source: str = "") -> Iterator[None]:
    """Let all figures inside be drawn as a template says, with `source` at their feet."""
    token = _drawing.set(Drawing(tuple(dict.fromkeys(figures.formats)), figures.names, source))
    try:
        with warnings.catch_warnings():
            ignore_missing_glyphs()  # texts are also measured while figures are made, before one is written
            yield
    finally:
        _drawing.reset(token)


def ignore_missing_glyphs() -> None:
    """Let no warning tell that a letter of a name, such as an emoji, is drawn as a box."""
    warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from")


def current_drawing() -> Drawing:
    """Return what is drawn now; without a template all figures, as PNG."""
    return _drawing.get()


def wanted(name: str) -> bool:
    """Return whether the figure of that name is to be drawn.

    >>> wanted("train_graph")
    True
    """
    chosen = _drawing.get().names
    return chosen is None or any(stands_for(each, name) for each in chosen)


def stands_for(chosen: str, name: str) -> bool:
    """Return whether a name of the template stands for a figure: itself, its pages, what is in its folder or its group.

    >>> [stands_for("trains", "trains/IC 1"), stands_for("demand", "demand_2"), stands_for("train_graph", "train_graph_fine")]
    [True, True, False]
    """
    if not name.startswith(chosen):
        return False
    rest = name[len(chosen) :]
    return not rest or rest.startswith("/") or bool(_PAGE.fullmatch(rest)) or (chosen in GROUPS and rest.startswith("_"))


def files_of(folder: Path, names: Iterable[str]) -> set[Path]:
    """Return the files there are of figures in a folder, of all kinds: those with these names and those they stand for."""
    present = [path for path in folder.glob("*.*") if path.suffix[1:] in FORMATS]
    known = tuple(names)
    return {path for path in present if any(stands_for(name, path.name.removesuffix(path.suffix)) for name in known)}


def remove_files(stale: Iterable[Path]) -> None:
    """Remove files; one that cannot be removed stays."""
    for path in stale:
        with suppress(OSError):
            path.unlink()
