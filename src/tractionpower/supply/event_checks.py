"""Checks of switching by time of day, and the states that it brings about."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.wording import did_you_mean
from tractionpower.model.base import format_time
from tractionpower.model.supply import Substation, Supply
from tractionpower.model.switchgear import SwitchEvent
from tractionpower.supply.site import Site
from tractionpower.supply.states import SWITCHED, Change, change_of, with_states

Timed = tuple[int, SwitchEvent]
"""An event and its index."""

_MOST_SHOWN = 12


class Switchgear:
    """All that can be switched, by its identifier.

    Attributes
    ----------
    lists
        Lists of the supply in which each identifier is; a feeder needs no row of its own.
    feeders
        Feeders of each station.
    items
        What is declared of each device; feeders without a row are missing.
    """

    def __init__(self, site: Site) -> None:
        self.lists: dict[str, list[str]] = {}
        self.items: dict[str, Any] = {}
        self.feeders = {station.id: site.feeder_ids(station) for station in site.stations}
        for name in SWITCHED:
            for item in getattr(site.supply, name):
                self.lists.setdefault(item.id, []).append(name)
                self.items[item.id] = item
        for device in (device for feeders in self.feeders.values() for device in feeders):
            lists = self.lists.setdefault(device, [])
            if "feeders" not in lists:
                lists.append("feeders")

    def normal(self, device: str, field: str) -> str | int:
        """Return the normal state of a device, or the number of its units in service."""
        item = self.items.get(device)
        if field == "state":
            return "closed" if item is None else str(item.state)
        assert isinstance(item, Substation)  # events of others have no units
        return item.units if item.units_in_service is None else item.units_in_service


def check_events(site: Site) -> list[Problem]:
    """Return events that name no device or state, contradict each other, or change nothing."""
    gear = Switchgear(site)
    problems, valid = _sifted(site, gear)
    return problems + _check_contradictions(valid) + _check_changes(gear, valid, _moving_by_themselves(site.supply))


def _sifted(site: Site, gear: Switchgear) -> tuple[list[Problem], list[Timed]]:
    """Return what is wrong with single events, and those that can happen, by time; of one time in their order."""
    problems, valid = [], []
    for index, event in enumerate(site.supply.switch_events):
        wrong = _check_device(gear, index, event) or _check_state(gear, index, event)
        problems += wrong
        if not wrong:
            valid.append((index, event))
    return problems, sorted(valid, key=lambda pair: pair[1].time)


def states_of(site: Site) -> Iterator[tuple[list[Timed], Site]]:
    """Yield the normal state, then the state from each time on at which something of the contact lines is switched.

    With each come the events that bring it about. Equal states are the same object, so that what is found out about one
    need not be found out again.
    """
    yield [], site
    gear = Switchgear(site)
    now: dict[tuple[str, str], Change] = {}
    known: dict[frozenset[tuple[tuple[str, str], Change]], Site] = {frozenset(): site}
    times: dict[float, list[Timed]] = {}
    for item in _sifted(site, gear)[1]:
        times.setdefault(item[1].time, []).append(item)
    for events in times.values():
        before = dict(now)
        for _, event in events:
            change = change_of(event)
            if gear.lists[event.device] == ["voltage_limiting_devices"]:
                continue
            key = event.device, change[0]
            if change[1] == gear.normal(event.device, change[0]):
                now.pop(key, None)
            else:
                now[key] = change
        if now != before:
            state = frozenset(now.items())
            if state not in known:
                changes: dict[str, list[Change]] = {}
                for (device, _), change in now.items():
                    changes.setdefault(device, []).append(change)
                known[state] = replace(site, supply=with_states(site.supply, changes))
            yield events, known[state]


def _check_device(gear: Switchgear, index: int, event: SwitchEvent) -> list[Problem]:
    path, device = f"supply.switch_events[{index}].device", event.device
    named = gear.lists.get(device, [])
    if len(named) > 1:
        found = f"{device!r} names {len(named)} devices (in {', '.join(dict.fromkeys(named))})"
        remedy = "give each its own id; an event names one device"
        return [Problem("ambiguous_device", path, found, "", remedy)]
    if named:
        return []
    station = device.rsplit(" ", 2)[0]
    if device.endswith((" low_km", " high_km", " return")) and station in gear.feeders:
        own = ", ".join(gear.feeders[station][:_MOST_SHOWN])
        is_return = device.endswith(" return")
        remedy = "a return feeder that is switched needs a row in feeders" if is_return else "correct the track or the side"
        return [Problem("unknown_device", path, f"{station} has no feeder {device!r}", own, remedy)]
    allowed = "a substation, section cabin, section point, switch, voltage-limiting device, or feeder ('A 1 low_km')"
    remedy = did_you_mean(device, gear.lists) or "correct the name, or describe the device"
    return [Problem("unknown_device", path, f"there is no device {device!r} that can be switched", allowed, remedy)]


def _check_state(gear: Switchgear, index: int, event: SwitchEvent) -> list[Problem]:
    path, states = f"supply.switch_events[{index}]", SWITCHED[gear.lists[event.device][0]]
    if event.state is not None:
        if event.state in states:
            return []
        remedy = did_you_mean(event.state, states)
        found = f"{event.device} cannot be {event.state!r}"
        return [Problem("unknown_state", f"{path}.state", found, " | ".join(states), remedy)]
    path = f"{path}.units_in_service"
    station = gear.items.get(event.device)
    if not isinstance(station, Substation):
        found = f"{event.device} is no substation and has no rectifier units"
        return [Problem("unknown_state", path, found, f"state: {' | '.join(states)}", "give the state that it takes")]
    if event.units_in_service is not None and event.units_in_service > station.units:
        found = f"{event.units_in_service} units of substation {station.id}, which has {station.units}"
        return [Problem("too_many_units", path, found, f"0 to {station.units}", "correct the number, or units")]
    return []


def _check_contradictions(events: list[Timed]) -> list[Problem]:
    """Return a problem for each two events or more that set one thing at one time, at the last of them."""
    same: dict[tuple[float, str, str], list[Timed]] = {}
    for item in events:
        same.setdefault((item[1].time, item[1].device, change_of(item[1])[0]), []).append(item)
    problems = []
    for (time, device, _), items in same.items():
        if len(items) > 1:
            wanted = ", ".join(dict.fromkeys(str(change_of(event)[1]) for _, event in items))
            found = f"{len(items)} events of {device} at {format_time(time)} ({wanted})"
            remedy = "they contradict each other or say the same twice; leave one, or set them apart in time"
            problems.append(Problem("events_contradict", f"supply.switch_events[{items[-1][0]}]", found, "one", remedy))
    return problems


def _moving_by_themselves(supply: Supply) -> set[str]:
    """Return the breakers that trip and the devices that close, whose states nobody knows beforehand."""
    trips = {row.id for row in supply.feeders if row.trip_current_a is not None}
    stations = {station.id: station.trip_current_a for station in supply.substations}
    stations |= {cabin.id: cabin.trip_current_a for cabin in supply.section_cabins}
    for name in (name for name, trip_a in stations.items() if trip_a is not None):
        trips |= {event.device for event in supply.switch_events if event.device.startswith(f"{name} ")}
    return trips | {device.id for device in supply.voltage_limiting_devices}


def _check_changes(gear: Switchgear, events: list[Timed], moving: set[str]) -> list[Problem]:
    """Return a warning for each event that sets what the device has already."""
    now: dict[tuple[str, str], str | int] = {}
    problems = []
    for index, event in events:
        field, value = change_of(event)
        key = event.device, field
        if now.setdefault(key, gear.normal(*key)) == value and event.device not in moving:
            what = f"{value!r}" if field == "state" else f"with {value} units in service"
            found = f"{event.device} is {what} already at {format_time(event.time)}"
            remedy = "the event changes nothing; leave it out, or correct it"
            problems.append(Problem("no_change", f"supply.switch_events[{index}]", found, "", remedy, "warning"))
        now[key] = value
    return problems
