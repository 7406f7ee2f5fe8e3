"""Zones of which the mean useful voltage is told: given ones, or the feeding sections between neighbouring substations.

Zones follow from what is declared and not from states, so that the zones of an outage are those of normal operation.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import TrackAxis, compile_axes
from tractionpower.alignment.lines import tracks_by_line
from tractionpower.cosimulation.places import Placed
from tractionpower.model.scenario import Scenario
from tractionpower.supply.site import survey

Numbers = NDArray[np.int64]
Floats = NDArray[np.float64]

Stretch = tuple[str, float, float]
"""Track, from and to along it [m]."""


@dataclass(frozen=True, slots=True)
class FeedingZone:
    """A zone.

    Attributes
    ----------
    id
        ``A–B`` between two substations, ``A low_km`` or ``A high_km`` beyond the last one, or as the user calls it.
    stretches
        Where it lies.
    """

    id: str
    stretches: tuple[Stretch, ...]

    @property
    def tracks(self) -> tuple[str, ...]:
        """Its tracks, sorted."""
        return tuple(sorted({track for track, _, _ in self.stretches}))


def lay_zones(scenario: Scenario) -> tuple[FeedingZone, ...]:
    """Return the zones that the study names, or else the feeding sections of every line, each of all its tracks."""
    given = scenario.sizing.useful_voltage.zones
    if not given:
        return tuple(_feeding_sections(scenario))
    axes, zones = compile_axes(scenario.line), []
    for zone in given:
        tracks = [track for track in sorted(axes) if zone.tracks is None or track in zone.tracks]
        parts = ((track, axes[track].stretch_m(zone.from_km, zone.to_km)) for track in tracks)
        zones.append(FeedingZone(zone.id, tuple((track, *part) for track, part in parts if part is not None)))
    return tuple(zones)


def _feeding_sections(scenario: Scenario) -> Iterator[FeedingZone]:
    site = survey(scenario.supply, scenario.line)
    feeds: dict[str, list[tuple[float, str]]] = {track: [] for track in site.axes}
    for station in scenario.supply.substations:
        for track, (_, metre) in site.fed[station.id].items():
            feeds[track].append((metre, station.id))
    found: dict[tuple[int, str], list[Stretch]] = {}
    for number, tracks in enumerate(tracks_by_line(scenario.line, scenario.supply)):
        at_km = {(site.axes[track].km(metre), name) for track in tracks for metre, name in feeds[track]}
        for track in tracks:
            axis = site.axes[track]
            # A track that nothing feeds by itself, a siding or a loop, is cut where its line is.
            ends = feeds[track] or [(axis.metre(min(max(km, axis.from_km), axis.to_km)), name) for km, name in at_km]
            for name, start, end in _between(sorted(ends), axis, f"track{'s'[: len(tracks) > 1]} {' '.join(tracks)}"):
                found.setdefault((number, name), []).append((track, start, end))
    names = [name for _, name in found]
    for (_, name), stretches in found.items():
        also = f" ({' '.join(sorted({track for track, _, _ in stretches}))})" if names.count(name) > 1 else ""
        yield FeedingZone(name + also, tuple(stretches))


def _between(ends: list[tuple[float, str]], axis: TrackAxis, whole: str) -> Iterator[tuple[str, float, float]]:
    """Yield name, from and to [m] of what lies before, between and behind substations on a track."""
    if not ends:
        yield whole, 0.0, axis.length_m
        return
    stops = [(0.0, ""), *ends, (axis.length_m, "")]
    for (start, low), (end, high) in pairwise(stops):
        if end - start > 1e-6:
            yield f"{low}–{high}" if low and high else f"{high} low_km" if high else f"{low} high_km", start, end


class ZoneMap:
    """Finds the part of a zone that a row lies in.

    Zones may overlap; so every track is cut at all their ends, and a zone is the set of its parts.

    Parameters
    ----------
    zones
        The zones.
    tracks
        All tracks by their numbers in `Placed`.
    axes
        Their axes.

    Attributes
    ----------
    parts
        How many parts there are.
    members
        Of each zone the numbers of its parts.
    """

    def __init__(self, zones: Sequence[FeedingZone], tracks: Sequence[str], axes: Mapping[str, TrackAxis]) -> None:
        self.zones = tuple(zones)
        self._tracks, self._axes = tracks, axes
        sets: dict[tuple[int, ...], int] = {}  # which zones a part lies in: equal ones are one part
        self._cuts: list[tuple[Floats, Numbers]] = [self._cut(track, sets) for track in tracks]
        self.parts = len(sets)
        self.members = tuple(
            np.array([part for inside, part in sets.items() if zone in inside], np.int64) for zone in range(len(self.zones))
        )

    def _cut(self, track: str, sets: dict[tuple[int, ...], int]) -> tuple[Floats, Numbers]:
        mine = [
            (number, start, end) for number, zone in enumerate(self.zones) for on, start, end in zone.stretches if on == track
        ]
        cuts = np.unique([0.0, self._axes[track].length_m, *(end for _, *ends in mine for end in ends)])
        numbers = []
        for low, high in pairwise(cuts.tolist()):
            inside = tuple(number for number, start, end in mine if start <= 0.5 * (low + high) < end)
            numbers.append(sets.setdefault(inside, len(sets)) if inside else -1)
        return cuts, np.array(numbers, np.int64)

    def part(self, placed: Placed) -> Numbers:
        """Return the part that each row lies in, -1 outside all zones."""
        found = np.full(len(placed.km), -1, np.int64)
        for number, (cuts, parts) in enumerate(self._cuts):
            here = placed.track == number
            if (parts >= 0).any() and here.any():
                metre = self._axes[self._tracks[number]].metre(placed.km[here])
                found[here] = parts[np.clip(np.searchsorted(cuts, metre, side="right") - 1, 0, len(parts) - 1)]
        return found
