"""What part of a run a report is of, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.reporting.texts import number, tr

MOST_NAMES = 4
"""Trains or tracks that are named; of more, how many there are."""


def selection_words(run: Mapping[str, Any]) -> str:
    """Return what is selected of a run as ``run.json`` tells it; nothing of a whole run.

    >>> selection_words({"selection": {"trains": ["7"], "from": "06:30:00", "from_km": 10.0}})
    'train 7, from 06:30:00, from km 10'
    """
    told = run.get("selection") or {}
    parts = []
    for key, one, many in (("trains", tr("train"), tr("trains")), ("tracks", tr("track"), tr("tracks"))):
        names = [str(name) for name in told.get(key, ())]
        shown = ", ".join(names) if len(names) <= MOST_NAMES else str(len(names))
        if names:
            parts.append(f"{shown} {many}" if len(names) > MOST_NAMES else f"{one if len(names) == 1 else many} {shown}")
    parts += _range(told.get("from"), told.get("to"), tr("from {begin}"), tr("to {end}"), tr("{begin} to {end}"))
    low, high = (None if told.get(key) is None else number(told[key], 3) for key in ("from_km", "to_km"))
    parts += _range(low, high, tr("from km {begin}"), tr("to km {end}"), tr("km {begin} to {end}"))
    return ", ".join(parts)


def _range(begin: str | None, end: str | None, first: str, last: str, both: str) -> list[str]:
    if begin is None and end is None:
        return []
    pattern = first if end is None else last if begin is None else both
    return [pattern.format(begin=begin, end=end)]
