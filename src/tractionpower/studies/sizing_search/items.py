"""What may be built more or less of: rectifier units, cables of feeders, types of contact line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import SectionCabin, Substation

Design = Mapping[str, int]
"""Rung of each item, by its name; items that are left out are as declared."""


@dataclass(frozen=True, slots=True)
class Rung:
    """One way of building an item.

    Attributes
    ----------
    words
        What it is, for people.
    changes
        Changes by path that make it so.
    cost
        Its cost, in points.
    """

    words: str
    changes: tuple[str, ...]
    cost: float


@dataclass(frozen=True, slots=True)
class Item:
    """Equipment of which there may be more or less.

    Attributes
    ----------
    name
        What it is, for people: ``units of A``.
    kind
        units, cables or contact_line.
    station
        Substation of units, substation or section cabin of cables.
    tracks
        Tracks of a contact line; none: all.
    from_km, to_km
        Where it is.
    rungs
        Ways of building it, by rising cost.
    declared
        The rung that the scenario has.
    """

    name: str
    kind: str
    station: str
    tracks: tuple[str, ...]
    from_km: float
    to_km: float
    rungs: tuple[Rung, ...]
    declared: int

    def at(self, design: Design) -> Rung:
        """Return the rung that a design has."""
        return self.rungs[design.get(self.name, self.declared)]


def changes_of(items: Mapping[str, Item], design: Design) -> tuple[str, ...]:
    """Return the changes by path that make a design of what is declared."""
    moved = [name for name in sorted(design) if design[name] != items[name].declared]
    return tuple(change for name in moved for change in items[name].at(design).changes)


def cost_of(items: Mapping[str, Item], design: Design) -> float:
    """Return the cost of all items of a design, in points."""
    return sum(item.at(design).cost for item in items.values())


def items_of(scenario: Scenario) -> dict[str, Item]:
    """Return what the bounds of the search let vary, by name."""
    found = [*_units(scenario), *_cables(scenario), *_contact_lines(scenario)]
    return {item.name: item for item in found if len(item.rungs) > 1}


def _units(scenario: Scenario) -> Iterator[Item]:
    bounds = scenario.sizing.search
    for station in scenario.supply.substations:
        if not station.feeds or station.units_in_service is not None:
            continue
        counts = sorted({*range(bounds.fewest_units, bounds.most_units + 1), station.units})
        rungs = tuple(
            Rung(f"{n} rectifier unit{'s' * (n > 1)}", _unit_changes(station, n), bounds.unit_points * n) for n in counts
        )
        declared = counts.index(station.units)
        yield Item(f"units of {station.id}", "units", station.id, (), station.km, station.km, rungs, declared)


def _unit_changes(station: Substation, units: int) -> tuple[str, ...]:
    """Return the changes that give a substation other units: R_unit/n + R_grid, where only the whole is declared, too."""
    path = f"supply.substations[{station.id}]"
    changes = [f"{path}.units={units}"]
    if station.unit_resistance_ohm is None:
        part = station.units / units
        shared = (station.plant_resistance_ohm - station.grid_resistance_ohm) * part
        changes.append(f"{path}.internal_resistance_ohm={station.grid_resistance_ohm + shared:.12g}")
        if station.dissipative_resistance_ohm is not None:
            changes.append(f"{path}.dissipative_resistance_ohm={station.dissipative_resistance_ohm * part:.12g}")
    return tuple(changes)


def _cables(scenario: Scenario) -> Iterator[Item]:
    bounds = scenario.sizing.search
    stations: tuple[Substation | SectionCabin, ...] = (*scenario.supply.substations, *scenario.supply.section_cabins)
    places = {station.id: station.km for station in stations}
    for index, row in enumerate(scenario.supply.feeders):
        if row.cable is None or row.rated_current_a is not None or row.at not in places:
            continue
        counts = range(row.cables, max(row.cables, bounds.most_cables) + 1)
        rungs = tuple(
            Rung(f"{n} x {row.cable}", (f"supply.feeders[{index}].cables={n}",), bounds.cable_points * n) for n in counts
        )
        km = places[row.at] if row.km is None else row.km
        yield Item(f"cables of {row.id}", "cables", row.at, (row.track,), km, km, rungs, 0)


def _contact_lines(scenario: Scenario) -> Iterator[Item]:
    bounds = scenario.sizing.search
    for index, row in enumerate(scenario.supply.contact_lines):
        if row.type is None or not bounds.contact_lines:
            continue
        types = tuple(dict.fromkeys((*(() if row.type in bounds.contact_lines else (row.type,)), *bounds.contact_lines)))
        declared = types.index(row.type)
        tracks = row.tracks or tuple(track.id for track in scenario.line.tracks)
        km = (row.to_km - row.from_km) * len(tracks)
        rungs = tuple(
            Rung(name, (f"supply.contact_lines[{index}].type={name}",), bounds.contact_line_points * km * k)
            for k, name in enumerate(types)
        )
        name = f"contact line {index} of track{'s' * (len(tracks) > 1)} {' '.join(tracks)}"
        yield Item(name, "contact_line", "", tracks, row.from_km, row.to_km, rungs[declared:], 0)
