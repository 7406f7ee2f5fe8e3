"""The line as axes with kilometres: the longest way is the first one, others leave it at junctions.

Axes and junctions form trees. A way that leaves an axis and comes back to it is refused, as it would be a ring.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from tractionpower.errors import Problem
from tractionpower.io.imports.gtfs.patterns import Pattern
from tractionpower.io.imports.gtfs.shapes import Polyline
from tractionpower.io.wording import printable

_SAME_LINE_M = 60.0
"""A way that is nearer to an axis runs on it; parallel tracks and the drawing of shapes stay within."""

_SAMPLE_M = 20.0
_KM_DIGITS = 3


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """A place on an axis, by the axis' number and its kilometre."""

    axis: int
    km: float


@dataclass(slots=True)
class Axis:
    """A line of the network; `line` begins at `from_km`."""

    line: Polyline
    from_km: float
    tree: int

    def km(self, along_m: float) -> float:
        """Return the kilometre at a distance along the axis."""
        return round(self.from_km + along_m / 1000.0, _KM_DIGITS)

    @property
    def to_km(self) -> float:
        """Kilometre of its end."""
        return self.km(self.line.length_m)


@dataclass(frozen=True, slots=True)
class Leg:
    """A way on one axis."""

    axis: int
    from_km: float
    to_km: float


@dataclass(slots=True)
class Network:
    """Axes, the junctions between them, and where the stations lie."""

    axes: list[Axis] = field(default_factory=list)
    junctions: list[tuple[Place, Place]] = field(default_factory=list)
    stations: dict[str, Place] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    refused: set[str] = field(default_factory=set)

    def add(self, pattern: Pattern) -> None:
        """Take a way in: place its stations on the axes there are, and make axes of what lies beside them."""
        placed = [self._place(pattern, k) for k in range(len(pattern.stations))]
        for k, place in enumerate(placed):
            if place is not None:
                self.stations.setdefault(pattern.stations[k], place)
        for first, last in _gaps(placed):
            before = first - 1 if first > 0 else None
            after = last + 1 if last + 1 < len(placed) else None
            self._branch(pattern, (first, last), before, after)

    def _place(self, pattern: Pattern, k: int) -> Place | None:
        station = pattern.stations[k]
        if station in self.stations:
            return self.stations[station]
        lat, lon = pattern.line.at(float(pattern.along_m[k]))
        found = self._on_axis(lat, lon)
        return None if found is None else Place(found[0], self.axes[found[0]].km(found[1]))

    def _on_axis(self, lat: float, lon: float) -> tuple[int, float] | None:
        """Return the first axis on which a place lies, and the distance along it [m]."""
        for number, axis in enumerate(self.axes):
            along, away = axis.line.project(lat, lon)
            if away <= _SAME_LINE_M:
                return number, along
        return None

    def _branch(self, pattern: Pattern, gap: tuple[int, int], before: int | None, after: int | None) -> None:
        first, last = gap
        start_m, end_m = float(pattern.along_m[first]), float(pattern.along_m[last])
        leaves = comes = None
        if before is not None:
            leaves, start_m = self._junction(pattern, float(pattern.along_m[before]), start_m, pattern.stations[before])
        if after is not None:
            comes, end_m = self._junction(pattern, float(pattern.along_m[after]), end_m, pattern.stations[after])
        if leaves is not None and comes is not None and self.axes[leaves.axis].tree == self.axes[comes.axis].tree:
            self._refuse_loop(pattern, gap, leaves, comes)
            return
        if abs(end_m - start_m) < 1.0:
            return  # one place: told as stations at one place
        base, far = (leaves, comes) if leaves is not None or comes is None else (comes, None)
        line = pattern.line.part(start_m, end_m) if leaves is not None or comes is None else pattern.line.part(end_m, start_m)
        # joined at equal kilometres the two would be taken for parallel tracks of one line
        from_km = 1.0 if base is not None and abs(base.km) < 0.1 else 0.0
        number = len(self.axes)
        self.axes.append(Axis(line, from_km, number if base is None else self.axes[base.axis].tree))
        if base is not None:
            self.junctions.append((base, Place(number, from_km)))
        if far is not None:
            self.junctions.append((far, Place(number, self.axes[number].to_km)))
            gone, kept = self.axes[far.axis].tree, self.axes[number].tree
            for axis in self.axes:
                axis.tree = kept if axis.tree == gone else axis.tree
        for k in range(first, last + 1):
            lat, lon = pattern.line.at(float(pattern.along_m[k]))
            place = Place(number, self.axes[number].km(line.project(lat, lon)[0]))
            self.stations.setdefault(pattern.stations[k], place)

    def _junction(self, pattern: Pattern, known_m: float, beyond_m: float, station: str) -> tuple[Place, float]:
        """Return where a way leaves the axes between a known station and one beside them: the place, and its distance [m]."""
        steps = max(int(abs(beyond_m - known_m) / _SAMPLE_M), 1)
        last: tuple[Place, float] | None = None
        for along in np.linspace(known_m, beyond_m, steps + 1)[:-1]:
            lat, lon = pattern.line.at(float(along))
            found = self._on_axis(lat, lon)
            if found is not None:
                last = Place(found[0], self.axes[found[0]].km(found[1])), float(along)
        return last if last is not None else (self.stations[station], known_m)

    def _refuse_loop(self, pattern: Pattern, gap: tuple[int, int], leaves: Place, comes: Place) -> None:
        stations = pattern.stations[gap[0] : gap[1] + 1]
        if self.refused.issuperset(stations):
            return
        self.refused.update(stations)
        names = printable(", ".join(stations))
        found = (
            f"trips by {names} leave the line at km {leaves.km:g} of axis {leaves.axis + 1} and come back"
            f" at km {comes.km:g} of axis {comes.axis + 1}: a ring"
        )
        remedy = "choose routes of one of the two ways; two ways between the same stations cannot be imported together"
        self.problems.append(Problem("ring", "", found, "a line with branches", remedy, place="shapes.txt"))

    def way(self, stations: Sequence[str]) -> list[Leg]:
        """Return the legs of a train by its stations, in order; what goes on in the same direction is one leg."""
        legs: list[Leg] = []
        for a, b in pairwise(stations):
            for leg in self._between(self.stations[a], self.stations[b]):
                last = legs[-1] if legs else None
                if last is not None and last.axis == leg.axis and (last.to_km > last.from_km) == (leg.to_km > leg.from_km):
                    legs[-1] = Leg(leg.axis, last.from_km, leg.to_km)
                else:
                    legs.append(leg)
        return legs

    def turns(self, stations: Sequence[str]) -> int:
        """Return how often a train turns round on its way."""
        pairs = pairwise(self.way(stations))
        return sum(a.axis == b.axis and (a.to_km > a.from_km) != (b.to_km > b.from_km) for a, b in pairs)

    def _between(self, start: Place, end: Place) -> Iterator[Leg]:
        here = start
        for out, into in self._crossings(start.axis, end.axis):
            if out.km != here.km:
                yield Leg(here.axis, here.km, out.km)
            here = into
        if here.km != end.km:
            yield Leg(here.axis, here.km, end.km)

    def _crossings(self, start: int, end: int) -> list[tuple[Place, Place]]:
        """Return the junctions from one axis to another, each as (out of, into)."""
        came: dict[int, tuple[int, tuple[Place, Place]] | None] = {start: None}
        queue = deque([start])
        while queue and end not in came:
            here = queue.popleft()
            for one, other in self.junctions:
                for out, into in ((one, other), (other, one)):
                    if out.axis == here and into.axis not in came:
                        came[into.axis] = here, (out, into)
                        queue.append(into.axis)
        crossings = []
        step = came.get(end)
        while step is not None:
            crossings.append(step[1])
            step = came[step[0]]
        return crossings[::-1]


def _gaps(placed: Sequence[Place | None]) -> Iterator[tuple[int, int]]:
    """Yield first and last index of each run of stations without a place."""
    first = None
    for k, place in enumerate([*placed, Place(0, 0.0)]):
        if place is None and first is None:
            first = k
        elif place is not None and first is not None:
            yield first, k - 1
            first = None
