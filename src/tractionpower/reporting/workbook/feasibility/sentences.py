"""Sentences that follow the numbers of the workbook: formulas that join words and cells."""

from __future__ import annotations

import re

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.cells import clean

LONGEST = 240
"""Characters of a text in a formula; Excel's limit is 255."""

_FIRST = 0xE000
"""First of the characters that stand for cells while a sentence is translated; no text uses them."""


def sentence(words: str, cells: dict[str, str]) -> str:
    """Return a part of a formula that tells a sentence, with cells where single marks stand.

    >>> sentence("late: " + chr(57344) + " of 3", {chr(57344): "{late}"})
    '"late: "&{late}&" of 3"'
    """
    parts = re.split(f"([{''.join(cells)}])", clean(words)) if cells else [clean(words)]
    shown = [cells[part] if part in cells else _quoted(part) for part in parts if part]
    return "&".join(shown) or '""'


def live(text: str, cells: dict[str, str], **values: object) -> str:
    """Return a part of a formula that tells a text of the catalogue, with cells in some of its places.

    Parameters
    ----------
    text
        The text, as for `texts.tr`; the catalogue gets it by `texts.mark`.
    cells
        Parts of a formula by the names of places.
    values
        What stands in the other places.
    """
    marks = {name: chr(_FIRST + number) for number, name in enumerate(cells)}
    return sentence(tr(text, **marks, **values), {marks[name]: part for name, part in cells.items()})


def _quoted(text: str) -> str:
    """Return a text as formulas have it, in pieces that are not too long and hold no braces that would be a place."""
    pieces = [text[k : k + LONGEST] for k in range(0, len(text), LONGEST)]
    joined = "&".join('"' + piece.replace('"', '""') + '"' for piece in pieces)
    return re.sub(r"\{(?=\w+\})", '{"&"', joined)
