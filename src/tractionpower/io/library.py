"""The tables of equipment that ship, as one library; and changes of a scenario that may name any of it."""

from __future__ import annotations

from collections.abc import Iterable

from tractionpower.io.conductor_files import CONDUCTORS
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.model.change import Changed, apply_changes
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario


def shipped_library() -> Library:
    """Return the tables that ship with the program."""
    return Library(CONDUCTORS.shipped, DUTY_CLASSES.shipped, RECTIFIER_UNITS.shipped)


def change(scenario: Changed, changes: Iterable[str]) -> Changed:
    """Return a scenario, or a case of train dynamics, with all `changes` applied; equipment that they name may be any that ships.

    See `tractionpower.model.change.apply_change` for their form.

    Raises
    ------
    InputError
        With all wrong paths, or else with all complaints of the model.
    """
    return apply_changes(scenario, changes, shipped_library() if isinstance(scenario, Scenario) else None)
