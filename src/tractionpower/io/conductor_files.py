"""Wires, contact lines, cables and rails: the shipped table and a user's rows over it."""

from __future__ import annotations

from collections.abc import Iterable

from tractionpower.io.overlaid_tables import OverlaidTable
from tractionpower.model.change import apply_changes
from tractionpower.model.conductors import Conductor, overlay_conductors
from tractionpower.model.scenario import Scenario

CONDUCTORS = OverlaidTable(Conductor, "conductors", "conductor", ("kind", "name"), overlay_conductors)


def shipped_conductors() -> tuple[Conductor, ...]:
    """Return the conductors that ship with the program, sorted by kind and name."""
    return CONDUCTORS.shipped


def change(scenario: Scenario, changes: Iterable[str]) -> Scenario:
    """Return `scenario` with all `changes` applied; a type of conductor that they name may be any that ships.

    See `tractionpower.model.change.apply_change` for their form.

    Raises
    ------
    InputError
        With all wrong paths, or else with all complaints of the model.
    """
    return apply_changes(scenario, changes, shipped_conductors())
