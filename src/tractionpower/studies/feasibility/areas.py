"""Areas of substations: every place of the line belongs to the nearest of those that feed there."""

from __future__ import annotations

from tractionpower.model.line import Connection, Track
from tractionpower.model.scenario import Scenario

Places = list[tuple[float, float, str]]
"""Where a track is fed: kilometre, way from there to the substation on other tracks [km], substation."""


class Areas:
    """Finds the substation whose area a place lies in: the nearest one that feeds at the start of the clock.

    A track without a substation is fed through its connections. Ways are differences of kilometres.
    """

    def __init__(self, scenario: Scenario) -> None:
        tracks, supply = scenario.line.tracks, scenario.supply
        self._fed: dict[str, Places] = {track.id: [] for track in tracks}
        for substation in supply.substations:
            if substation.feeds:
                for track in tracks:
                    if _feeds(substation.tracks, substation.km, track):
                        self._fed[track.id].append((substation.km, 0.0, substation.id))
        self._spread(scenario.line.connections)
        self._cache: dict[tuple[str, float], str] = {}

    def _spread(self, connections: tuple[Connection, ...]) -> None:
        """Let connections feed tracks that have no substation, from one to the next."""
        bare = {track for track, fed in self._fed.items() if not fed}
        ends = [(link.from_, link.to) for link in connections] + [(link.to, link.from_) for link in connections]
        for _ in range(len(bare)):
            for near, far in ends:
                if far.track in bare and self._fed.get(near.track):
                    way, name = self._nearest(near.track, near.km)
                    entry = (far.km, way, name)
                    if entry not in self._fed[far.track]:
                        self._fed[far.track].append(entry)

    def _nearest(self, track: str, km: float) -> tuple[float, str]:
        return min((abs(km - at) + way, name) for at, way, name in self._fed[track])

    def area(self, track: str, km: float) -> str:
        """Return the substation whose area holds a place; empty where nothing feeds the track."""
        key = (track, km)
        if key not in self._cache:
            self._cache[key] = self._nearest(track, km)[1] if self._fed.get(track) else ""
        return self._cache[key]


def _feeds(tracks: tuple[str, ...] | None, km: float, track: Track) -> bool:
    return track.id in tracks if tracks is not None else track.from_km <= km <= track.to_km
