"""A supply and where it lies along the line: what all checks of the supply share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from tractionpower.alignment.axis import TrackAxis, compile_axes, tracks_at
from tractionpower.alignment.intervals import TOLERANCE_M, Coverage, Placed, place_rows
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.line import Line
from tractionpower.model.supply import SectionCabin, Substation, Supply
from tractionpower.model.switchgear import Feeder, Side, feeder_id

Station = Substation | SectionCabin

Place = tuple[str, float]
"""Track and metre along it [m]."""

LOW: Side = "low_km"
HIGH: Side = "high_km"


@dataclass(frozen=True, slots=True)
class Site:
    """A supply and where it lies.

    Attributes
    ----------
    supply, line
        What is declared.
    axes
        Axes of the tracks.
    contact, returns
        Where contact lines and return conductors lie on each track.
    fed
        Where each station meets each of its tracks, whatever its state.
    """

    supply: Supply
    line: Line
    axes: Mapping[str, TrackAxis]
    contact: Coverage
    returns: Coverage
    fed: Mapping[str, Mapping[str, Place]] = field(default_factory=dict)

    @property
    def stations(self) -> tuple[Station, ...]:
        """Substations, then section cabins; of two with one identifier the first, the other is told as an error."""
        found: dict[str, Station] = {}
        every: tuple[Station, ...] = (*self.supply.substations, *self.supply.section_cabins)
        for station in every:
            found.setdefault(station.id, station)
        return tuple(found.values())

    def place(self, track: str | None, km: float | None) -> Place | None:
        """Return a place on a track, or None if it does not exist."""
        if track is None or km is None or track not in self.axes or not self.axes[track].contains(km):
            return None
        return track, self.axes[track].metre(km)

    def has_contact_line(self, place: Place) -> bool:
        """Tell whether the track has a contact line at a place."""
        return bool(_parts_at(self.contact[place[0]], place[1]))

    def line_sides(self, place: Place) -> tuple[Side, ...]:
        """Return on which sides of a place its track has a contact line."""
        return _sides(self.contact[place[0]], place[1])

    def rail_rows(self, place: Place) -> list[Placed]:
        """Return the parts of the return circuit that the rails of a track belong to at a place, the low side first."""
        return _parts_at(self.returns[place[0]], place[1])

    def feeders(self, station: Station) -> list[tuple[str, Side]]:
        """Return track and side of the feeders of a station that feed something; to another line lead those that are named."""
        own = tracks_at(self.axes, station.km, station.tracks)
        named = {(row.track, row.side) for row in self.supply.feeders if row.at == station.id}
        fed = ((track, side) for track, place in self.fed[station.id].items() for side in self.line_sides(place))
        return [(track, side) for track, side in fed if track in own or (track, side) in named]

    def feeder_ids(self, station: Station) -> list[str]:
        """Return the identifiers of all feeders of a station that feed something, and of its own return feeders."""
        found = [feeder_id(station.id, *key) for key in self.feeders(station)]
        return found + [row.id for row in self.supply.feeders if row.at == station.id and row.side == "return"]


def survey(supply: Supply, line: Line) -> Site:
    """Return a supply with the places of its conductors; what is off the tracks is passed over."""
    axes = compile_axes(line)
    contact = place_rows(enumerate(supply.contact_lines), axes)
    site = Site(supply, line, axes, contact, place_rows(enumerate(supply.return_circuit), axes))
    return replace(site, fed={station.id: _fed_places(site, station) for station in site.stations})


def _fed_places(site: Site, station: Station) -> dict[str, Place]:
    """Return where a station meets each of its tracks; a row of its feeders may say otherwise than its own km."""
    axes = site.axes
    places = {track: (track, axes[track].metre(station.km)) for track in tracks_at(axes, station.km, station.tracks)}
    for row in site.supply.feeders:
        is_moved = row.at == station.id and row.km is not None and row.side != "return"
        moved = site.place(row.track, row.km) if is_moved and row.km is not None else None
        if moved is not None:
            places[row.track] = moved
    return places


def rows_by_side(feeders: Sequence[Feeder]) -> dict[tuple[str, str, str], int]:
    """Return the index of each row of feeders by station, track and side; of two the last one."""
    return {(row.at, row.track, row.side): index for index, row in enumerate(feeders)}


def _sides(parts: Sequence[Placed], metre: float) -> tuple[Side, ...]:
    low = any(part.start_m + SHARED_NODE_M <= metre <= part.end_m + SHARED_NODE_M for part in parts)
    high = any(part.start_m - SHARED_NODE_M <= metre <= part.end_m - SHARED_NODE_M for part in parts)
    return (LOW,) * low + (HIGH,) * high


def _parts_at(parts: Sequence[Placed], metre: float) -> list[Placed]:
    return [part for part in parts if part.start_m - TOLERANCE_M <= metre <= part.end_m + TOLERANCE_M]
