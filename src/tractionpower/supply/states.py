"""States of devices: what can be switched, and a supply with some devices in other states.

A supply with its switches moved is a supply again, so that a run that switches equals studies with the states set.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from tractionpower.model.base import Declaration
from tractionpower.model.supply import SectionCabin, Substation, Supply
from tractionpower.model.switchgear import Feeder, SwitchEvent, feeder_id

SWITCHED = {
    "substations": ("in_service", "rectifiers_out", "bypassed", "open"),
    "section_cabins": ("closed", "bypassed", "open"),
    "section_points": ("open", "closed"),
    "switches": ("closed", "open"),
    "voltage_limiting_devices": ("open", "closed"),
    "feeders": ("closed", "open"),
}
"""Lists of a supply whose devices have states, and the states of each."""

Change = tuple[str, str | int]
"""Field and value: ("state", "open"), ("units_in_service", 1)."""


def find_list(supply: Supply, device: str) -> str | None:
    """Return the list of a supply in which a device of this identifier is, or None.

    A feeder needs no row of its own: every track and side of a substation or section cabin has one.
    """
    for name in SWITCHED:
        if any(item.id == device for item in getattr(supply, name)):
            return name
    return "feeders" if _feeder(supply, device) is not None else None


def change_of(event: SwitchEvent) -> Change:
    """Return what an event changes."""
    if event.state is not None:
        return "state", event.state
    assert event.units_in_service is not None  # the model allows no other event
    return "units_in_service", event.units_in_service


def with_states(supply: Supply, changes: Mapping[str, Iterable[Change]]) -> Supply:
    """Return a supply in which devices have other states.

    Parameters
    ----------
    supply
        As declared; it stays as it is.
    changes
        By identifier of the device, each with all that changes.

    Raises
    ------
    LookupError
        If a device does not exist; `supply.checks` reports that before.
    """
    updates: dict[str, dict[str, dict[str, Any]]] = {}
    for device, values in changes.items():
        name = find_list(supply, device)
        if name is None:
            raise LookupError(device)
        updates.setdefault(name, {})[device] = dict(values)
    return supply.model_copy(update={name: _changed(supply, name, items) for name, items in updates.items()})


def normal_value(supply: Supply, device: str, name: str) -> str | int | None:
    """Return the value that a field of a device has as declared; a feeder without a row is closed."""
    found = find_list(supply, device)
    for row in getattr(supply, found) if found is not None else ():
        if row.id == device:
            value: str | int | None = getattr(row, name)
            return row.units if name == "units_in_service" and value is None else value
    return "closed"


def _changed(supply: Supply, name: str, updates: Mapping[str, Mapping[str, Any]]) -> tuple[Declaration, ...]:
    rows = list(getattr(supply, name))
    if name == "feeders":
        rows += [
            row for device in sorted(updates) if all(item.id != device for item in rows) and (row := _feeder(supply, device))
        ]
    return tuple(row.model_copy(update=dict(updates[row.id])) if row.id in updates else row for row in rows)


def _feeder(supply: Supply, device: str) -> Feeder | None:
    """Return a feeder without a row of its own, by its identifier."""
    words = device.rsplit(" ", 2)
    if len(words) != 3 or words[2] not in ("low_km", "high_km"):
        return None
    stations: tuple[Substation | SectionCabin, ...] = (*supply.substations, *supply.section_cabins)
    if not words[1] or all(station.id != words[0] for station in stations):
        return None
    feeder = Feeder.model_validate({"at": words[0], "track": words[1], "side": words[2]})
    assert feeder.id == feeder_id(*words)
    return feeder
