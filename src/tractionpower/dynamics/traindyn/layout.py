"""The tracks of a line with stations, as polylines, and what lies along them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.polyline import Polyline
from tractionpower.model.dynamics.stations import CaseStation, StationsCase

HOME_M = 50.0
"""A train that has no track yet waits so far before a station [m] (assumed)."""

SHORT_M = 80.0
"""A train that stops stands so far before its track joins another one, in the clear [m] (assumed)."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The tracks of a case.

    Attributes
    ----------
    lines
        Pieces of the line: before the first station, between stations, behind the last one.
    tracks
        Of each station its tracks by their identifiers.
    starts_m
        Distance from where trains come to the beginning of each piece of track, by its name [m].
    """

    lines: tuple[Polyline, ...]
    tracks: tuple[dict[str, Polyline], ...]
    starts_m: dict[str, float]

    @property
    def pieces(self) -> Iterator[Polyline]:
        """All pieces of track."""
        yield from self.lines
        for station in self.tracks:
            yield from station.values()


def lay_out(case: StationsCase) -> Layout:
    """Return the tracks of a case; x is the distance from where trains come, y sets the tracks of a station apart."""
    ends = [(0.0, 0.0), *((station.from_m, station.to_m) for station in case.stations), (case.length_m, case.length_m)]
    lines, starts = [], {}
    for k in range(len(ends) - 1):
        low, high = ends[k][1], ends[k + 1][0]
        lines.append(Polyline(f"line {k + 1}", ((low, 0.0), (high, 0.0))))
        starts[f"line {k + 1}"] = low
    tracks = tuple({track: _station_track(station, track) for track in station.tracks} for station in case.stations)
    for station, pieces in zip(case.stations, tracks, strict=True):
        starts |= {piece.name: station.from_m for piece in pieces.values()}
    return Layout(tuple(lines), tracks, starts)


def _station_track(station: CaseStation, track: str) -> Polyline:
    """Return a track of a station: the first one straight on, the others on its two sides by turns."""
    k = station.tracks.index(track)
    y = (k + 1) // 2 * station.track_distance_m * (1.0 if k % 2 else -1.0)
    low, high = station.from_m, station.to_m
    lead = min(0.2 * (high - low), 0.9 * SHORT_M)
    points = ((low, 0.0), (low + lead, y), (high - lead, y), (high, 0.0)) if y else ((low, 0.0), (high, 0.0))
    return Polyline(f"{station.id} {track}", points, high - low)


def add_track_data(core: TrainDynamics, layout: Layout, case: StationsCase) -> None:
    """Tell a core what lies along the tracks of a case."""
    for piece in layout.pieces:
        start = layout.starts_m[piece.name]

        def between(from_m: float, to_m: float, start: float = start, piece: Polyline = piece) -> tuple[float, float] | None:
            low, high = max(from_m - start, 0.0), min(to_m - start, piece.length_m)
            return (low, high) if low < high else None

        for gradient in case.gradients:
            if part := between(gradient.from_m, gradient.to_m):
                core.add_inclination(piece, gradient.permille, between_m=part)
        for curve in case.curves:
            if part := between(curve.from_m, curve.to_m):
                core.add_arc(piece, curve.radius_m, between_m=part)
        for tunnel in case.tunnels:
            if part := between(tunnel.from_m, tunnel.to_m):
                core.add_tunnel(piece, 1 if tunnel.kind == "single_track" else 2, between_m=part)
