"""What stands along the tracks of one line: stations, substations and section cabins, each at its kilometre there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from tractionpower.alignment.axis import tracks_at
from tractionpower.alignment.lines import tracks_by_line
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Substation
from tractionpower.reporting.texts import trn
from tractionpower.supply.site import Site, survey

Device = tuple[float, str, bool]
"""Place on an axis [km], name, and whether it is a substation, else a section cabin."""


@dataclass(frozen=True)
class LinePlaces:
    """Places of a scenario by track.

    Attributes
    ----------
    scenario
        The scenario.
    from_km, to_km
        What is looked at [km]; places beyond it are left out.
    """

    scenario: Scenario
    from_km: float = -math.inf
    to_km: float = math.inf

    @cached_property
    def site(self) -> Site:
        """The supply with its places."""
        return survey(self.scenario.supply, self.scenario.line)

    @cached_property
    def lines(self) -> tuple[tuple[str, ...], ...]:
        """The tracks of each line with a kilometre axis of its own."""
        return tracks_by_line(self.scenario.line, self.scenario.supply)

    def number_of(self, tracks: str) -> int:
        """Return the number of the line of a track, or of a return conductor of several tracks; -1 if there is none."""
        first = tracks if any(tracks in line for line in self.lines) else tracks.split(maxsplit=1)[0]
        return next((number for number, line in enumerate(self.lines) if first in line), -1)

    def by_line(self, tracks: Iterable[str]) -> list[list[str]]:
        """Return tracks or return conductors, those of a line together, in the order of lines and names."""
        found: dict[int, list[str]] = {}
        for track in sorted(tracks):
            found.setdefault(self.number_of(track), []).append(track)
        return [found[number] for number in sorted(found)]

    def ends(self, track: str) -> tuple[float, float]:
        """Return the first and the last kilometre of a track [km]."""
        axis = self.site.axes[track]
        return max(axis.from_km, self.from_km), min(axis.to_km, self.to_km)

    @property
    def is_part(self) -> bool:
        """Whether a part of the kilometres is looked at."""
        return math.isfinite(self.from_km) or math.isfinite(self.to_km)

    def holds(self, km: float) -> bool:
        """Return whether a kilometre is looked at [km]."""
        return self.from_km <= km <= self.to_km

    def span(self, rows: pd.DataFrame, tracks: Iterable[str]) -> tuple[float, float]:
        """Return the first and the last kilometre of rows of a table on one of the tracks [km]."""
        km = rows.loc[rows["track"].isin(list(tracks)), "km"]
        return float(km.min()), float(km.max())

    def devices(self, tracks: Iterable[str]) -> list[Device]:
        """Return kilometre and name of the substations and cabins that feed or tie one of the tracks, at the place there.

        One that meets several of them at different kilometres stands at that on the first.
        """
        own, found = sorted(tracks), []
        for station in self.site.stations:
            fed = self.site.fed[station.id]
            track = next((track for track in own if track in fed), None)
            if track is not None:
                km = self.site.axes[track].km(fed[track][1])
                found.append((round(km, 6), station.id, isinstance(station, Substation)))
        return sorted(device for device in found if self.holds(device[0]))

    def stations(self, tracks: Iterable[str]) -> list[tuple[float, str]]:
        """Return kilometre and name of the stations on one of the tracks."""
        own, axes = set(tracks), self.site.axes
        found = [each for each in self.scenario.line.stations if own.intersection(tracks_at(axes, each.km, each.tracks))]
        return sorted((each.km, each.name or each.id) for each in found if self.holds(each.km))


def told(tracks: Sequence[str]) -> str:
    """Return tracks in words.

    >>> told(["1", "2"])
    'tracks 1, 2'
    """
    return trn("track {tracks}", "tracks {tracks}", len(tracks), tracks=", ".join(tracks))
