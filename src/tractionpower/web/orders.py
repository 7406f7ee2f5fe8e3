"""What the page may ask for: read strictly, for anything may come through a socket."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass

from tractionpower.web.pacing import FACTORS

LONGEST = 300
"""Longest order that is read [characters]."""

CONTROLS = ("drive", "brake", "electric")
"""Controls that have levels."""

ACTIONS = ("emergency", "full_service", "charge", "pause", "start", "slower", "faster", "finish")
HIGHEST_LEVEL = 1000
HIGHEST_BAR = 15.0


@dataclass(frozen=True, slots=True)
class SetLevel:
    """Set a control to a level."""

    control: str
    level: int


@dataclass(frozen=True, slots=True)
class StepLevel:
    """Move a control by some levels."""

    control: str
    by: int


@dataclass(frozen=True, slots=True)
class SetPressure:
    """Set the independent brake to a cylinder pressure [bar]."""

    bar: float


@dataclass(frozen=True, slots=True)
class SetFactor:
    """Let so many simulated seconds pass in a second."""

    factor: int


@dataclass(frozen=True, slots=True)
class Action:
    """Do one of `ACTIONS`."""

    name: str


Order = SetLevel | StepLevel | SetPressure | SetFactor | Action


def read_order(text: str) -> Order | None:
    """Return the order that a message of the page holds, or None if it holds none.

    >>> read_order('{"set": "brake", "level": 3}')
    SetLevel(control='brake', level=3)
    >>> read_order('{"set": "horn", "level": 3}') is None
    True
    """
    if len(text) > LONGEST:
        return None
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(found, dict):
        return None
    match found:
        case {"set": str(control), "level": int(level)} if control in CONTROLS and _is_whole(level, HIGHEST_LEVEL):
            return SetLevel(control, level)
        case {"step": str(control), "by": int(by)} if control in CONTROLS and by in {-1, 1} and _is_whole(abs(by), 1):
            return StepLevel(control, by)
        case {"set": "independent", "bar": int(bar) | float(bar)} if _is_pressure(bar):
            return SetPressure(float(bar))
        case {"factor": int(factor)} if factor in FACTORS and _is_whole(factor, FACTORS[-1]):
            return SetFactor(factor)
        case {"do": str(name)} if name in ACTIONS:
            return Action(name)
    return None


def _is_whole(value: int, highest: int) -> bool:
    return not isinstance(value, bool) and 0 <= value <= highest


def _is_pressure(value: float) -> bool:
    return not isinstance(value, bool) and math.isfinite(value) and 0.0 <= value <= HIGHEST_BAR
