"""What an outage moves, and the changes by path that do it, so that ``run STUDY --set ...`` repeats each."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tractionpower.model.base import format_time
from tractionpower.model.scenario import Scenario
from tractionpower.supply.states import find_list

Setting = tuple[float | None, str, str | int]
"""From when [s after midnight], None: from the start of the run; field; value."""


@dataclass(frozen=True, slots=True)
class Move:
    """What becomes of one device.

    Attributes
    ----------
    device
        Its identifier, by which switch events name it.
    settings
        What it takes, one after the other.
    """

    device: str
    settings: tuple[Setting, ...]


def changes_of(scenario: Scenario, moves: Iterable[Move]) -> tuple[str, ...]:
    """Return the changes by path that make all moves.

    What holds from the start is a state, what begins later a switch event. The study's own switch events of the devices that
    are moved are left out: an outage lasts whatever would be switched otherwise.
    """
    chosen = {move.device: move for move in moves}
    states = [_state_change(scenario, move.device, setting) for move in chosen.values() for setting in move.settings
              if setting[0] is None]  # fmt: skip
    events = [
        {"time": format_time(time_s), "device": move.device, field: value}
        for move in chosen.values()
        for time_s, field, value in move.settings
        if time_s is not None
    ]
    return (*states, *_event_changes(scenario, chosen, events))


def _event_changes(scenario: Scenario, moved: Iterable[str], events: list[dict[str, str | int]]) -> Iterator[str]:
    own, devices = scenario.supply.switch_events, {*moved}
    if any(event.device in devices for event in own):
        kept = [event.model_dump(mode="json", exclude_none=True) for event in own if event.device not in devices]
        yield f"supply.switch_events={_json([*kept, *events])}"
        return
    for event in events:
        yield f"supply.switch_events[+]={_json(event)}"


def _state_change(scenario: Scenario, device: str, setting: Setting) -> str:
    supply, (_, field, value) = scenario.supply, setting
    name = find_list(supply, device)
    if name != "feeders":
        return f"supply.{name}[{device}].{field}={value}"
    index = next((k for k, row in enumerate(supply.feeders) if row.id == device), None)
    if index is not None:
        return f"supply.feeders[{index}].{field}={value}"
    at, track, side = device.rsplit(" ", 2)
    return f"supply.feeders[+]={_json({'at': at, 'track': track, 'side': side, field: value})}"


def grid_changes(scenario: Scenario, factor: float) -> tuple[str, ...]:
    """Return the changes that multiply the voltage of the feeding grid of all substations."""
    declared = {station.id: round(station.grid_voltage_pu * factor, 12) for station in scenario.supply.substations}
    if len({*declared.values()}) == 1:
        return (f"supply.substations[*].grid_voltage_pu={next(iter(declared.values()))!r}",)
    return tuple(f"supply.substations[{name}].grid_voltage_pu={value!r}" for name, value in sorted(declared.items()))


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
