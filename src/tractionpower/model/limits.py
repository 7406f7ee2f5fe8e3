"""Limits of standards as data: every value with its source and how far it was verified."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal

from pydantic import Field

from tractionpower.model.base import Declaration, Identifier, Real, Text

Status = Literal["verified", "secondary", "recalled", "user"]

ALL_SYSTEMS = "dc"
"""System of the rows that hold for every DC system that has none of its own: touch voltages, stray currents."""

VOLTAGE_NAMES = ("u_min2", "u_min1", "u_n", "u_max1", "u_max2")


class Limit(Declaration):
    """One row of a limits table.

    `status` says how the value is known: *verified* against the standard's text, *secondary* from a source that quotes
    it, *recalled* from memory, *user* given by the user.
    """

    system: Identifier = Field(description="System that it holds for, for example dc3000.")
    name: Identifier = Field(description="Name by which the program finds it.")
    value: Real = Field(description="The value, in its unit.")
    unit: Text = Field(default="", description="Unit, for people.")
    meaning: Text = Field(default="", description="The limit in words.")
    source: Text = Field(default="", description="Where it comes from.")
    status: Status = Field(default="user", description="How the value is known.")


class SystemVoltages(Declaration):
    """Voltage limits of a supply system [V] (EN 50163, clause 4; values as in the limits table)."""

    u_min2: Real
    u_min1: Real
    u_n: Real
    u_max1: Real
    u_max2: Real


def overlay(base: Sequence[Limit], rows: Sequence[Limit]) -> tuple[Limit, ...]:
    """Return `base` with each row replaced or added by `rows`, matched by system and name."""
    merged = {(limit.system, limit.name): limit for limit in base}
    merged.update({(limit.system, limit.name): limit for limit in rows})
    return tuple(merged[key] for key in sorted(merged))


def find_limit(limits: Sequence[Limit], system: str, name: str) -> Limit | None:
    """Return the row of `limits` for a system and a name, or None."""
    return next((limit for limit in limits if limit.system == system and limit.name == name), None)


USEFUL_NAMES = {"conventional": "u_useful", "high_speed": "u_useful_high_speed"}
"""Names of the limits of the mean useful voltage by class of the line."""


def useful_limit(limits: Sequence[Limit], system: str, line_class: str) -> Limit | None:
    """Return the row of the lowest mean useful voltage of a class of lines, or None."""
    return find_limit(limits, system, USEFUL_NAMES[line_class])


def known_systems(limits: Iterable[Limit]) -> list[str]:
    """Return the supply systems that have rows of their own, sorted."""
    return sorted({limit.system for limit in limits} - {ALL_SYSTEMS})


def common_limits(limits: Iterable[Limit], system: str, prefix: str) -> dict[str, Limit]:
    """Return the limits whose names begin with `prefix`, by name: those of all DC systems, and over them those of `system`."""
    named = [limit for limit in limits if limit.name.startswith(prefix)]
    found = {limit.name: limit for limit in named if limit.system == ALL_SYSTEMS}
    return found | {limit.name: limit for limit in named if limit.system == system}


def system_voltages(limits: Sequence[Limit], system: str) -> SystemVoltages:
    """Return the five voltage limits of `system`.

    Raises
    ------
    KeyError
        If a voltage of the system is not in the table; `supply.checks` reports that before.
    """
    values = {}
    for name in VOLTAGE_NAMES:
        limit = find_limit(limits, system, name)
        if limit is None:
            raise KeyError(f"{system} {name}")
        values[name] = limit.value
    return SystemVoltages(**values)
