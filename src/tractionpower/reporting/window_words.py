"""Windows and kinds of devices in words."""

from __future__ import annotations

KINDS = {
    "unit": "Rectifier units",
    "substation": "Substations",
    "feeder": "Feeders",
    "return_feeder": "Return cables",
    "cabin_feeder": "Feeders of section cabins",
    "switch": "Switches",
    "contact_line": "Contact-line sections",
    "rails": "Rail sections",
    "supply_point": "Supply points",
}
"""Kinds of devices in words, in the order of sheets and figures."""


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


def kind_order(kind: str) -> int:
    """Return the place of a kind of devices among all kinds."""
    return list(KINDS).index(kind) if kind in KINDS else len(KINDS)
