"""Polylines: the pieces of track that trains run on, and what lies along them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.errors import UsageError
from tractionpower.kernels.point_mass import SECTION


@dataclass(frozen=True, slots=True)
class Polyline:
    """A piece of track: its name and how it runs in the plane. Trains run from its first point to its last.

    Attributes
    ----------
    name
        Name; one piece of track has one, whichever way it is run along.
    points
        Its points (x, y) [m], at least two.
    length_m
        Its length; the points may be a schematic drawing of it. Left out: the length between the points.
    is_reversed
        Whether it is run along from its end to its beginning.
    """

    name: str
    points: tuple[tuple[float, float], ...]
    length_m: float = 0.0
    is_reversed: bool = False

    def __post_init__(self) -> None:
        drawn = self._drawn()
        if len(self.points) < 2 or not drawn > 0.0:
            raise UsageError(f"the polyline {self.name!r} has no length: it needs two points at least, apart from each other")
        if self.length_m < 0.0 or not np.isfinite(self.length_m):
            raise UsageError(f"the polyline {self.name!r} has a length of {self.length_m} m; it must be above 0")
        if not self.length_m:
            object.__setattr__(self, "length_m", drawn)

    @classmethod
    def straight(cls, name: str, length_m: float) -> Polyline:
        """Return a piece of track of a length [m] that is drawn as a straight line from the origin."""
        return cls(name, ((0.0, 0.0), (float(length_m), 0.0)), float(length_m))

    @property
    def reversed(self) -> Polyline:
        """The same piece of track, run along the other way."""
        return Polyline(self.name, self.points[::-1], self.length_m, not self.is_reversed)

    def point(self, at_m: float) -> tuple[float, float]:
        """Return the point (x, y) [m] at a distance [m] from where trains enter it; outside it, that of the nearer end."""
        left = min(max(at_m / self.length_m, 0.0), 1.0) * self._drawn()
        for (x0, y0), (x1, y1) in pairwise(self.points):
            run = hypot(x1 - x0, y1 - y0)
            if left <= run and run > 0.0:
                return x0 + (x1 - x0) * left / run, y0 + (y1 - y0) * left / run
            left -= run
        return self.points[-1]

    def _drawn(self) -> float:
        return sum(hypot(x1 - x0, y1 - y0) for (x0, y0), (x1, y1) in pairwise(self.points))


@dataclass(slots=True)
class TrackData:
    """What lies along pieces of track, by their names: rows (from [m], to [m], resistance over weight [N/N]).

    Attributes
    ----------
    level
        Rows that do not depend on the direction: arcs and tunnels.
    slopes
        Rows of gradients in the direction of the points, rising ones positive.
    version
        Grows with each row, so that who has laid them along a route notices.
    """

    level: dict[str, list[tuple[float, float, float]]] = field(default_factory=dict)
    slopes: dict[str, list[tuple[float, float, float]]] = field(default_factory=dict)
    version: int = 0

    def add(self, polylines: Polyline | Iterable[Polyline], n_per_n: float, between_m: tuple[float, float] | None, *,
            is_slope: bool = False) -> None:  # fmt: skip
        """Add a resistance over weight [N/N] to the whole of some polylines, or to what lies between two distances on one."""
        pieces = _pieces(polylines)
        for piece in pieces:  # all are looked at before the first is added
            low, high = (0.0, piece.length_m) if between_m is None else between_m
            if not 0.0 <= low < high <= piece.length_m:
                raise UsageError(f"from {low} m to {high} m is not on {piece.name!r}, which is {piece.length_m:g} m long")
        for piece in pieces:
            low, high = (0.0, piece.length_m) if between_m is None else between_m
            if piece.is_reversed:
                low, high = piece.length_m - high, piece.length_m - low
            rows = (self.slopes if is_slope else self.level).setdefault(piece.name, [])
            rows.append((low, high, -n_per_n if is_slope and piece.is_reversed else n_per_n))
        self.version += 1

    def along(self, route: Iterable[Polyline]) -> NDArray[np.void]:
        """Return the resistance of the track along a route, as records of `SECTION`; behind its end there is none."""
        rows, start = [], 0.0
        for piece in route:
            for table, sign in ((self.level, 1.0), (self.slopes, -1.0 if piece.is_reversed else 1.0)):
                for low, high, worth in table.get(piece.name, ()):
                    ends = (piece.length_m - high, piece.length_m - low) if piece.is_reversed else (low, high)
                    rows.append((start + ends[0], start + ends[1], sign * worth))
            start += piece.length_m
        edges = sorted({edge for low, high, _ in rows for edge in (low, high)})
        sums = [(edge, sum(worth for low, high, worth in rows if low <= edge < high)) for edge in edges]
        return np.array(sums, SECTION)


def _pieces(polylines: object) -> list[Polyline]:
    """Return polylines as a list; what is none is refused."""
    several = isinstance(polylines, Iterable) and not isinstance(polylines, str)
    pieces: list[Any] = list(polylines) if several else [polylines]  # type: ignore[call-overload]
    for piece in pieces:
        if not isinstance(piece, Polyline):
            raise UsageError(f"found {piece!r}; allowed: a Polyline, or several, such as Polyline.straight(name, length_m)")
    return pieces
