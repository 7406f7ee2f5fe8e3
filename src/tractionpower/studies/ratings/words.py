"""Kinds of devices and windows in words, for verdicts and summaries."""

from __future__ import annotations

KINDS = {
    "unit": "rectifier units",
    "substation": "substations",
    "feeder": "feeders",
    "return_feeder": "return feeders",
    "cabin_feeder": "feeders of section cabins",
    "switch": "switches",
    "contact_line": "sections of contact line",
    "rails": "sections of rails",
}
"""Kinds of devices in words, in the order in which they are told."""

_ONE = {
    "unit": "rectifier unit",
    "substation": "substation",
    "feeder": "feeder",
    "return_feeder": "return feeder",
    "cabin_feeder": "feeder of section cabins",
    "switch": "switch",
    "contact_line": "section of contact line",
    "rails": "section of rails",
}


def counted(count: int, kind: str) -> str:
    """Return how many devices of a kind there are, in words.

    >>> counted(1, "rails"), counted(1, "cabin_feeder"), counted(2, "switch")
    ('1 section of rails', '1 feeder of section cabins', '2 switches')
    """
    return f"{count} {_ONE[kind] if count == 1 else KINDS[kind]}"


def window_words(seconds: float) -> str:
    """Return the length of a window in words; 0 is the whole run.

    >>> window_words(900.0), window_words(0.0), window_words(7200.0), window_words(10.0)
    ('15 min', 'whole run', '2 h', '10 s')
    """
    if not seconds > 0.0:
        return "whole run"
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= size and seconds % size == 0.0:
            return f"{seconds / size:g} {unit}"
    return f"{seconds:g} s"
