"""How a workbook gets into its file: whole or not at all, and with the values of its formulas."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.results.disk import BESIDE

_FORMULA_CELL = re.compile(rb'<c r="([A-Z]+[0-9]+)"([^>]*)><f>(.*?)</f><v ?(?:/>|></v>)</c>', re.DOTALL)


def save_as(book: Book, path: Path) -> Path:
    """Save a finished workbook under a name that it gets when it is complete; return the name."""
    path.parent.mkdir(parents=True, exist_ok=True)
    bare, temporary = path.with_suffix(".bare.tmp"), path.with_suffix(".tmp")
    try:
        book.workbook.save(bare)
        _with_values(bare, temporary, {f"xl{sheet.path[3:]}": book.cached.get(sheet.title, {}) for sheet in book.workbook})
        try:
            temporary.replace(path)
        except PermissionError:  # Windows: another program holds the file that would be replaced
            path = path.with_name(f"{path.stem}{BESIDE}{path.suffix}")
            temporary.replace(path)
    finally:
        bare.unlink(missing_ok=True)
        temporary.unlink(missing_ok=True)
    return path


def _with_values(source: Path, target: Path, values: Mapping[str, Mapping[str, Any]]) -> None:
    """Copy a workbook, and put the values of its formulas beside them, which openpyxl does not write.

    A viewer that does not calculate shows these values; one that does may calculate again.
    """
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new:
        for entry in old.infolist():
            content = old.read(entry)
            own = values.get(entry.filename)
            if own:
                content = _FORMULA_CELL.sub(partial(_cell, own), content)
            new.writestr(entry, content)


def _cell(values: Mapping[str, Any], match: re.Match[bytes]) -> bytes:
    place, attributes, formula = match.groups()
    value = values.get(place.decode())
    if value is None:
        kind, shown = b' t="str"', b""
    elif isinstance(value, str):
        kind, shown = b' t="str"', escape(value).encode()
    else:
        kind, shown = b"", repr(value).encode()
    return b'<c r="%s"%s%s><f>%s</f><v>%s</v></c>' % (place, attributes, kind, formula, shown)
