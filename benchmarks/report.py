"""Markdown tables, the machine they were made on, and the place in the documentation where they stand."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "docs" / "performance.md"
START, END = "<!-- benchmark -->", "<!-- /benchmark -->"
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "pandapower", "power-grid-model", "lightsim2grid")


def table(headings: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a markdown table; all columns but the first are set to the right."""
    cells = [[str(cell) for cell in row] for row in [headings, *rows]]
    widths = [max(len(row[k]) for row in cells) for k in range(len(headings))]
    rule = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]
    lines = [[row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
             for row in cells]  # fmt: skip
    lines.insert(1, rule)
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def goal(value: float, limit: float, at_least: bool = False) -> str:
    """Return ``reached`` or ``missed``."""
    return "reached" if (value >= limit if at_least else value <= limit) else "missed"


def machine() -> str:
    """Return processor, Python and libraries, without a date."""
    libraries = ", ".join(f"{name} {_version(name)}" for name in LIBRARIES)
    return f"{_processor()}, {platform.system()}; Python {platform.python_version()}; {libraries}."


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "(not installed)"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    name = models[0] if models else platform.processor() or platform.machine()
    return f"{len(models)} cores of {name}" if models else name


def write_page(text: str, page: Path = PAGE) -> None:
    """Put `text` between the markers of the page.

    Raises
    ------
    ValueError
        If the page has not exactly one pair of markers.
    """
    whole = page.read_text(encoding="utf-8")
    if whole.count(START) != 1 or whole.count(END) != 1:
        raise ValueError(f"{page.name} needs one line {START} and one line {END}")
    before, rest = whole.split(START)
    page.write_text(f"{before}{START}\n{text}\n{END}{rest.split(END)[1]}", encoding="utf-8")
