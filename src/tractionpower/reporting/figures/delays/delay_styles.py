"""Causes of delays: words, colours, and what tells them apart without colour."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILION
from tractionpower.reporting.texts import mark, tr


@dataclass(frozen=True, slots=True)
class CauseStyle:
    """How a cause is drawn: its words, the colour, dashes of lines, hatches of areas."""

    words: str
    colour: str
    dashes: Any
    hatch: str


CAUSES: dict[str, CauseStyle] = {
    "voltage": CauseStyle(mark("low voltage"), VERMILION, "-", ""),
    "current_limit": CauseStyle(mark("train current limit"), ORANGE, (0, (5, 1.2)), "////"),
    "timetable": CauseStyle(mark("timetable too tight"), PURPLE, (0, (1, 1)), "...."),
    "driving": CauseStyle(mark("driving plan"), GREEN, (0, (6, 1.2, 1, 1.2)), "\\\\\\\\"),
    "dwell": CauseStyle(mark("dwell at stops"), BLUE, (0, (2.5, 1.2)), "xxxx"),
    "knock_on": CauseStyle(mark("delay from before"), GREY, "-", "----"),
    "not_reached": CauseStyle(mark("not there"), INK, "-", "++++"),
}
"""Causes by name, in the order in which they are shown."""

ORIGINS = ("voltage", "current_limit", "timetable", "driving", "dwell")
"""Where seconds of a delay can first arise."""


def cause_in_words(name: str | None) -> str:
    """Return a cause in words; an unknown one as it is.

    >>> cause_in_words("current_limit"), cause_in_words(None)
    ('train current limit', '')
    """
    return tr(CAUSES[name].words) if name in CAUSES else (name or "")


def main_origin(row: Mapping[str, Any] | Any) -> str:
    """Return the largest origin of the delay in a row of table ``delays``; empty where there is none."""
    seconds = [float(np.nan_to_num(row[f"origin_{name}_s"])) for name in ORIGINS]
    return ORIGINS[int(np.argmax(seconds))] if max(seconds) > 0.0 else ""
