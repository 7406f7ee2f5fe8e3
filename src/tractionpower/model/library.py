"""Tables of equipment from which a scenario takes what it uses: conductors, duty classes, rectifier units."""

from __future__ import annotations

from dataclasses import dataclass

from tractionpower.model.conductors import Conductor
from tractionpower.model.ratings import DutyRow, RectifierUnit

KEYS = {"conductors": ("kind", "name"), "duty_classes": ("duty_class",), "rectifier_units": ("unit",)}
"""What tells the rows of each table apart; all rows of a duty class belong together."""


@dataclass(frozen=True, slots=True)
class Library:
    """Whole tables; changes of a scenario may name any of their rows."""

    conductors: tuple[Conductor, ...] = ()
    duty_classes: tuple[DutyRow, ...] = ()
    rectifier_units: tuple[RectifierUnit, ...] = ()
