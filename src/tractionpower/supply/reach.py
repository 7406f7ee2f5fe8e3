"""Which stretches of contact line a substation in service can reach: a graph of stretches, before anything is solved.

Stretches end where the contact line ends or where an open device cuts it. Busbars of substations and closed section
cabins tie all stretches that touch them; a stretch is live if ties lead from it to a substation in service.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tractionpower.alignment.axis import TrackAxis, tracks_at
from tractionpower.alignment.intervals import Coverage, cut, merge
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.supply import SectionCabin, SectionPoint, Substation, Supply

Place = tuple[str, float]
"""Track and metre along it [m]."""


@dataclass(frozen=True, slots=True)
class LineStretch:
    """An electrically continuous piece of one track's contact line [m]."""

    track: str
    start_m: float
    end_m: float
    live: bool

    def touches(self, place: Place) -> bool:
        """Tell whether a place lies on the stretch, or so close to it that they share a node."""
        track, metre = place
        return track == self.track and self.start_m - SHARED_NODE_M < metre < self.end_m + SHARED_NODE_M


def find_stretches(supply: Supply, axes: Mapping[str, TrackAxis], coverage: Coverage) -> list[LineStretch]:
    """Return the stretches of contact line, each with whether a substation in service reaches it.

    Parameters
    ----------
    supply
        The supply system; devices off the tracks are passed over.
    axes
        Axes of the tracks.
    coverage
        Where contact lines lie on each track.
    """
    open_places = [place for device in _devices(supply) if device.state == "open" for place in places(device, axes)]
    stretches = [
        LineStretch(track, start, end, live=False)
        for track, parts in coverage.items()
        for start, end in cut(
            merge((part.start_m, part.end_m) for part in parts), (metre for name, metre in open_places if name == track)
        )
        if end - start >= SHARED_NODE_M  # a shorter piece is one node with its neighbour
    ]
    live = _live(stretches, supply, axes)
    return [LineStretch(item.track, item.start_m, item.end_m, number in live) for number, item in enumerate(stretches)]


def places(device: Substation | SectionCabin | SectionPoint, axes: Mapping[str, TrackAxis]) -> list[Place]:
    """Return where a device stands on each of its tracks that exist there."""
    tracks = (device.track,) if isinstance(device, SectionPoint) else device.tracks
    return [(track, axes[track].metre(device.km)) for track in tracks_at(axes, device.km, tracks)]


def _live(stretches: Sequence[LineStretch], supply: Supply, axes: Mapping[str, TrackAxis]) -> set[int]:
    """Return the numbers of the stretches that current can reach from the substations in service."""

    def touched(device: Substation | SectionCabin) -> set[int]:
        return {number for place in places(device, axes) for number, item in enumerate(stretches) if item.touches(place)}

    devices: tuple[Substation | SectionCabin, ...] = (*supply.substations, *supply.section_cabins)
    tying = [device for device in devices if device.state in {"in_service", "rectifiers_out", "closed"}]
    ties = [touched(item) for item in tying]
    live: set[int] = set().union(*(tie for item, tie in zip(tying, ties, strict=True) if item.state == "in_service"))
    while more := set().union(*(tie for tie in ties if tie & live)) - live:
        live |= more
    return live


def _devices(supply: Supply) -> list[Substation | SectionCabin | SectionPoint]:
    return [*supply.substations, *supply.section_cabins, *supply.section_points]
