"""Which way a verdict goes: whether what was found must not be below its limit, or not above it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

Sense = Literal["at_least", "at_most"]

AT_LEAST: Sense = "at_least"
AT_MOST: Sense = "at_most"

_FLOORS = ("u_min", "u_useful")
"""How the names of limits begin that must not be gone below."""


def sense_of_limit(name: str) -> Sense:
    """Return the sense of a limit by its name.

    >>> sense_of_limit("u_min2"), sense_of_limit("u_max2")
    ('at_least', 'at_most')
    """
    return AT_LEAST if name.startswith(_FLOORS) else AT_MOST


def sense_of(verdict: Mapping[str, Any]) -> Sense:
    """Return the sense of a verdict of ``run.json``; of one that does not say it, as those of earlier versions, by its limit."""
    said: Sense | None = verdict.get("sense")
    return said or sense_of_limit(str(verdict.get("limit") or ""))
