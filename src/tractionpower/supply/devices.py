"""Devices that currents load: rectifier units, substations, feeders and cables, switches, contact lines, rails."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.block_tables import Buffers
from tractionpower.supply.characteristics import dissipative_resistances
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.gauges import Section

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

SECTIONS = ("contact_line", "rails")
"""Kinds of devices that have two ends."""

_LINK_KINDS = {"feeder": "feeder", "return": "return_feeder", "cabin": "cabin_feeder", "switch": "switch"}


@dataclass(frozen=True, slots=True)
class Device:
    """Something that a current loads.

    Attributes
    ----------
    kind
        unit (all units of a substation are equal, and share its current), substation, feeder, return_feeder, cabin_feeder,
        switch, contact_line or rails.
    id
        ``A unit``, ``A``, ``A 1 low_km``, ``A return``, ``track 1 km 0-10.8``, ``rails 1 2 km 0-20``.
    station
        Substation or section cabin that it belongs to; empty for switches and sections.
    track
        Track, or tracks of the rails by blanks; empty for units, substations and their common return feeders.
    from_km, to_km
        Where it is; of sections both ends.
    """

    kind: str
    id: str
    station: str
    track: str
    from_km: float
    to_km: float


def devices_of(tables: SupplyTables) -> tuple[Device, ...]:
    """Return all devices: units, substations, feeders and switches in their order, common return feeders, sections.

    They do not depend on the states of devices.
    """
    stations, commons = tables.substations, {tables.substations[k].id for k in _with_common_return(tables)}
    return (
        *(Device("unit", f"{s.id} unit", s.id, "", s.km, s.km) for s in stations),
        *(Device("substation", s.id, s.id, "", s.km, s.km) for s in stations),
        *(Device(_LINK_KINDS[link.kind], link.id, link.station, link.track, link.km, link.km) for link in tables.links),
        *(Device("return_feeder", f"{s.id} return", s.id, "", s.km, s.km) for s in stations if s.id in commons),
        *_sections(tables.conductor_sections),
    )


def columns_of(devices: Sequence[Device]) -> Numbers:
    """Return the number of the device of each column of currents: sections have two columns, all others one."""
    return np.repeat(np.arange(len(devices)), [2 if device.kind in SECTIONS else 1 for device in devices])


class DeviceCurrents:
    """Finds the currents of all devices in the rows of a run.

    A unit carries its part of the current of its substation, a common return feeder what the return feeders of single tracks
    leave of it. Sections have two columns, the currents into their low and their high end.

    Parameters
    ----------
    tables
        The supply, in any states.

    Attributes
    ----------
    devices
        All devices.
    columns
        Number of the device of each column.
    """

    def __init__(self, tables: SupplyTables) -> None:
        self.devices = devices_of(tables)
        self.columns = columns_of(self.devices)
        self._commons = _with_common_return(tables)
        self._drains = [
            [k for k, link in enumerate(tables.links) if link.kind == "return" and link.station == tables.substations[n].id]
            for n in self._commons
        ]

    def __call__(self, rows: Buffers, supply: SupplyTables) -> Floats:
        """Return the currents with their signs [A], shape (steps, columns); 0 where there is none, as of a unit that is out.

        Parameters
        ----------
        rows
            Rows of some steps.
        supply
            The supply in its states then.
        """
        source_a = rows.source_a
        common_a = source_a[:, self._commons] - sums_of_columns(rows.link_a, self._drains)
        parts = [source_a / units_in_service(supply), source_a, rows.link_a, common_a]
        amps = np.concatenate([*parts, rows.gauge_a], axis=1)
        if not np.isfinite(amps.sum()):  # a step without a solution, which the run flags, must not spoil all sums
            amps[~np.isfinite(amps)] = 0.0
        return amps


def sums_of_columns(values: Floats, groups: Sequence[Sequence[int]]) -> Floats:
    """Return the sums of groups of columns, shape (rows, groups), added in their order: those of a row depend on it alone."""
    sums = np.zeros((len(values), len(groups)))
    for number, group in enumerate(groups):
        for column in group:
            sums[:, number] += values[:, column]
    return sums


def grid_power(rows: Buffers, supply: SupplyTables) -> Floats:
    """Return what substations take from the feeding grid [W], shape (steps, substations); 0 without a busbar.

    U I at the busbar and, where it is known, the heat of transformers and rectifiers in the present states.
    """
    heat_ohm = np.nan_to_num(dissipative_resistances(supply.substations))
    return np.nan_to_num(rows.source_v * rows.source_a + heat_ohm * rows.source_a**2)


def supply_points(supply: SupplyTables) -> dict[str, list[int]]:
    """Return the supply points, sorted, with the numbers of their substations: those of one are one customer."""
    points: dict[str, list[int]] = {}
    for k, station in enumerate(supply.substations):
        points.setdefault(station.supply_point or station.id, []).append(k)
    return dict(sorted(points.items()))


def units_in_service(supply: SupplyTables) -> Floats:
    """Return how many units of each substation share its current in the present states, at least 1."""
    counts = (s.units if s.units_in_service is None else s.units_in_service for s in supply.substations)
    return np.asarray(np.maximum(np.fromiter(counts, float), 1.0))


def _with_common_return(tables: SupplyTables) -> list[int]:
    """Return the substations one of whose tracks has no return feeder of its own."""
    fed, drained = ({(link.station, link.track) for link in tables.links if link.kind == kind} for kind in ("feeder", "return"))
    common = {station for station, _ in fed - drained}
    return [k for k, station in enumerate(tables.substations) if station.id in common]


def _sections(sections: Sequence[Section]) -> Iterator[Device]:
    taken: Counter[str] = Counter()
    for section in sections:
        what = "track" if section.kind == "contact_line" else "rails"
        name = f"{what} {section.tracks} km {section.from_km:g}-{section.to_km:g}"
        taken[name] += 1
        again = f" ({taken[name]})" if taken[name] > 1 else ""  # pieces of some metres, or kilometres that come twice
        yield Device(section.kind, name + again, "", section.tracks, section.from_km, section.to_km)
