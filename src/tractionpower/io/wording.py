"""How found values, names and choices are told: short, on one line, without control characters."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any

LONGEST = 60
"""Characters of a found value that a message shows."""


def printable(text: str) -> str:
    r"""Return `text` with control characters and other unprintable ones escaped.

    >>> printable("a\x1b[31m")
    'a\\x1b[31m'
    """
    return "".join(letter if letter.isprintable() else letter.encode("unicode_escape").decode() for letter in text)


def shorten(text: str, longest: int = LONGEST) -> str:
    """Return `text` printable and cut in the middle when it is longer than `longest`."""
    if len(text) > longest:
        half = (longest - 3) // 2
        text = f"{text[:half]}...{text[-half:]}"
    return printable(text)


def shown(value: Any) -> str:
    """Return a found value as a message shows it.

    >>> shown("abc"), shown(None), shown(True), shown([1, 2])
    ("'abc'", 'nothing', 'true', 'a list of 2')
    """
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f"'{shorten(value)}'"
    if isinstance(value, dict):
        return f"a mapping with the keys {shorten(', '.join(map(str, value)))}" if value else "an empty mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    return shorten(str(value))


def counted(number: int, word: str) -> str:
    """Return a number with its word, which takes an s for all numbers but one.

    >>> counted(1, "train"), counted(0, "train")
    ('1 train', '0 trains')
    """
    return f"{number} {word}{'' if number == 1 else 's'}"


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the word of `known` that is most like `word`, or an empty string."""
    by_lower = {name.lower(): name for name in known}
    matches = difflib.get_close_matches(word.lower()[:200], by_lower, n=1, cutoff=0.6)
    return by_lower[matches[0]] if matches else ""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the remedy for an unknown word: the nearest known one, or an empty string."""
    match = nearest(word, known)
    return f"did you mean {match}?" if match else ""
