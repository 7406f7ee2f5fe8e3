"""Where rail potentials are recorded: at all cross-sections, at loads, and in between so close that nothing is missed."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.rail_potential import RAIL, shares
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.loads import Load
from tractionpower.supply.numbering import Numbering
from tractionpower.supply.topology import Topology

SPACING_M = 1000.0
"""Largest distance of two places [m]: the potential bends between them, and leakage is summed up over them."""


@dataclass(frozen=True, slots=True)
class RailPlace:
    """A place of a return conductor whose potential is recorded.

    Attributes
    ----------
    tracks
        Tracks of the conductor, joined by blanks.
    km
        Place.
    leakage_s_per_m
        Conductance of the conductor to remote earth [S/m].
    length_m
        Length that the place stands for, half of the way to its neighbours: sums over places give totals [m].
    node
        Its node, or a node of its conductor where it lies within a span.
    span, x_m
        The span that it lies within, and the distance from its left end [m]; -1 at a cross-section.
    """

    tracks: str
    km: float
    leakage_s_per_m: float
    length_m: float
    node: int
    span: int = -1
    x_m: float = 0.0


def find_rail_places(topology: Topology, loads: Iterable[Load]) -> tuple[RailPlace, ...]:
    """Return the places by track and kilometre; none where nothing is joined with earth."""
    if topology.earth is None:
        return ()
    inside = _places_inside(topology, loads)
    length: dict[int, float] = {}
    ends: dict[int, tuple[str, float, float]] = {}
    places = []
    for number, (span, xs) in enumerate(zip(topology.spans, inside, strict=True)):
        tracks, leakage = " ".join(span.rail_tracks), span.rail.siemens_per_m
        gaps = np.diff([0.0, *xs, span.length_m]).tolist()
        for node, km, gap in ((span.rail.left, span.from_km, gaps[0]), (span.rail.right, span.to_km, gaps[-1])):
            length[node] = length.get(node, 0.0) + 0.5 * gap
            ends.setdefault(node, (tracks, km, leakage))
        axis = topology.axes[span.rail_tracks[0]]
        start = float(topology.metres(span.rail_tracks[0], [span.from_km])[0])
        for x, before, after in zip(xs, gaps, gaps[1:], strict=False):
            km = axis.km(min(start + x, axis.length_m))
            places.append(RailPlace(tracks, km, leakage, 0.5 * (before + after), span.rail.left, number, x))
    places += [RailPlace(tracks, km, leakage, length[node], node) for node, (tracks, km, leakage) in ends.items()]
    return tuple(sorted(places, key=lambda place: (place.tracks, place.km, place.node)))


def _places_inside(topology: Topology, loads: Iterable[Load]) -> list[list[float]]:
    """Return for each span the places within it [m]; rails without resistance have one potential."""
    inside: list[list[float]] = []
    for span in topology.spans:
        pieces = int(np.ceil(span.length_m / SPACING_M)) if span.rail.ohm_per_m > 0.0 else 1
        inside.append([span.length_m * k / pieces for k in range(1, pieces)])
    for load in loads:
        number, x = topology.locate(load.track, load.km)
        xs, span = inside[number], topology.spans[number]
        at = bisect_left(xs, x)
        beside = [0.0, *xs[max(at - 1, 0) : at + 1], span.length_m]
        if span.rail.ohm_per_m > 0.0 and min(abs(x - other) for other in beside) >= SHARED_NODE_M:
            insort(xs, x)
    return inside


def rail_table(
    topology: Topology, places: Sequence[RailPlace], nodes: Numbering, first_conductor: Sequence[int]
) -> NDArray[np.void]:
    """Return where the solver finds the potentials of places, record array of `RAIL`."""
    table = np.zeros(len(places), RAIL)
    table["node"] = table["span"] = -1
    for row, place in zip(table, places, strict=True):
        node = topology.find(place.node)
        if node not in nodes.earthed:
            continue
        if place.span < 0:
            row["node"] = nodes.number[node]
        else:
            span = topology.spans[place.span]
            row["span"], row["x_m"] = place.span, place.x_m
            row["conductor"] = first_conductor[place.span] + len(span.tracks)
            row["left"], row["right"] = shares(span.rail.ohm_per_m, span.rail.siemens_per_m, place.x_m, span.length_m)
    return table
