"""What the page may ask for: read strictly, for anything may come through a socket."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

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
    order: Order | None = None
    match _loaded(text):
        case {"set": str(control), "level": int(level)} if control in CONTROLS and _is_whole(level, HIGHEST_LEVEL):
            order = SetLevel(control, level)
        case {"step": str(control), "by": int(by)} if control in CONTROLS and type(by) is int and by in {-1, 1}:
            order = StepLevel(control, by)
        case {"set": "independent", "bar": int(bar) | float(bar)} if _is_pressure(bar):
            order = SetPressure(float(bar))
        case {"factor": int(factor)} if factor in FACTORS and not isinstance(factor, bool):
            order = SetFactor(factor)
        case {"do": str(name)} if name in ACTIONS:
            order = Action(name)
    return order


def _loaded(text: str) -> Any:
    if len(text) > LONGEST:
        return None
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def _is_whole(value: int, highest: int) -> bool:
    return type(value) is int and 0 <= value <= highest  # True would be an int, too


def _is_pressure(value: float) -> bool:
    return not isinstance(value, bool) and math.isfinite(value) and 0.0 <= value <= HIGHEST_BAR
