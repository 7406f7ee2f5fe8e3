"""What is watched while a run lasts: overcurrent trips of breakers, closing of voltage-limiting devices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import OVERCURRENT, RAIL_POTENTIAL, TRIGGER
from tractionpower.model.supply import Supply
from tractionpower.model.switchgear import Protection
from tractionpower.supply.rail_places import RailPlace
from tractionpower.supply.topology import Link, Topology


@dataclass(frozen=True, slots=True)
class Trigger:
    """A threshold on a current or on a rail potential.

    Attributes
    ----------
    kind
        overcurrent or rail_potential.
    device
        Feeder or voltage-limiting device that acts.
    number
        Number of the feeder's link; -1 for a rail potential.
    above
        Threshold [A] or [V].
    delay_s
        Time that it must be passed [s].
    """

    kind: str
    device: str
    number: int
    above: float
    delay_s: float


def find_triggers(supply: Supply, links: Sequence[Link]) -> tuple[Trigger, ...]:
    """Return all that is watched, trips in the order of the links, then devices by identifier."""
    trips = protections(supply, links)
    found = []
    for number, link in enumerate(links):
        if link.id in trips:
            limit = trips[link.id].trip_current_a
            assert limit is not None  # others are left out
            found.append(Trigger("overcurrent", link.id, number, limit, trips[link.id].trip_delay_s))
    for device in sorted(supply.voltage_limiting_devices, key=lambda device: device.id):
        found += [Trigger("rail_potential", device.id, -1, point.above_v, point.after_s) for point in device.closes]
    return tuple(found)


def trigger_table(topology: Topology, places: Sequence[RailPlace], watched: Sequence[Trigger]) -> NDArray[np.void]:
    """Return what the triggers watch, record array of `TRIGGER`; where breaker or device has done its work: nothing."""
    earth = {item.id: item for item in topology.earth_links}
    place_of = {topology.find(place.node): k for k, place in reversed([*enumerate(places)]) if place.span < 0}
    rows: list[tuple[int, int, float, float]] = []
    for trigger in watched:
        if trigger.kind == "overcurrent":
            kind, index, rests = OVERCURRENT, trigger.number, not topology.links[trigger.number].closed
        else:
            device = earth[trigger.device]
            kind, index, rests = RAIL_POTENTIAL, place_of[topology.find(device.node)], device.closed
        rows.append((kind, index, np.inf if rests else trigger.above, trigger.delay_s))
    return np.array(rows, TRIGGER)


def protections(supply: Supply, links: Sequence[Link]) -> dict[str, Protection]:
    """Return the breakers that trip, by feeder: its own settings, or else those of its station."""
    return dict(_protections(supply, links))


def _protections(supply: Supply, links: Sequence[Link]) -> Iterator[tuple[str, Protection]]:
    rows = {row.id: row for row in supply.feeders}
    stations: dict[str, Protection] = {s.id: s for s in supply.substations}
    stations |= {cabin.id: cabin for cabin in supply.section_cabins}
    for link in links:
        if link.kind in ("feeder", "cabin"):
            settings = breaker_of(rows.get(link.id), stations[link.station])
            if settings is not None:
                yield link.id, settings


def breaker_of(row: Protection | None, station: Protection) -> Protection | None:
    """Return the settings of a feeder's breaker: those of its own row, or else of its station; None where none trips."""
    return next((item for item in (row, station) if item is not None and item.trip_current_a is not None), None)
