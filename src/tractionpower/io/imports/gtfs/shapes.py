"""Shapes as polylines on the ground: lengths, the nearest place to a stop, stops in order along a shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_A_M, _E2 = 6_378_137.0, 6.69437999014e-3
"""Semi-major axis and squared eccentricity of the ellipsoid of WGS 84."""

_SLACK_M = 50.0
"""Stops on one straight piece may be drawn this much against their order."""

OFF_SHAPE_M = 150.0
"""A stop further from its shape is taken as drawn wrongly: it must not pull its neighbours from their places."""

_PULL_M = 1e-3
"""What each further metre adds to the cost of such a stop [m²/m]: it decides where nothing else does."""


def _metres_per_degree(lat: Floats) -> tuple[Floats, Floats]:
    """Return lengths of a degree of latitude and of longitude [m], by the radii of curvature of the ellipsoid."""
    sine2 = np.sin(np.radians(lat)) ** 2
    root = np.sqrt(1.0 - _E2 * sine2)
    meridian = _A_M * (1.0 - _E2) / root**3
    parallel = _A_M / root * np.cos(np.radians(lat))
    return np.radians(1.0) * meridian, np.radians(1.0) * parallel


def distance_m(lat1: float, lon1: float, lat2: float, lon2: float) -> float:
    """Return the distance of two places not far from each other [m]."""
    north, east = _metres_per_degree(np.array([0.5 * (lat1 + lat2)]))
    return float(np.hypot((lat2 - lat1) * north[0], (lon2 - lon1) * east[0]))


@dataclass(frozen=True, eq=False)
class Polyline:
    """A line on the ground.

    Attributes
    ----------
    lat, lon
        Its points [degrees], no two neighbours equal.
    along_m
        Distances of the points from the first one along the line [m].
    """

    lat: Floats
    lon: Floats
    along_m: Floats

    @classmethod
    def through(cls, lat: Sequence[float] | Floats, lon: Sequence[float] | Floats) -> Polyline:
        """Return the line through points; repeated points are left out."""
        lats, lons = np.asarray(lat, float), np.asarray(lon, float)
        keep = np.ones(len(lats), bool)
        keep[1:] = (np.diff(lats) != 0.0) | (np.diff(lons) != 0.0)
        lats, lons = lats[keep], lons[keep]
        north, east = _metres_per_degree(0.5 * (lats[1:] + lats[:-1]))
        steps = np.hypot(np.diff(lats) * north, np.diff(lons) * east)
        return cls(lats, lons, np.concatenate([[0.0], np.cumsum(steps)]))

    @property
    def length_m(self) -> float:
        """Length of the whole line [m]."""
        return float(self.along_m[-1])

    def reversed(self) -> Polyline:
        """Return the same line in the other direction."""
        return Polyline.through(self.lat[::-1], self.lon[::-1])

    def at(self, along_m: float) -> tuple[float, float]:
        """Return latitude and longitude at a distance along the line [m]."""
        return float(np.interp(along_m, self.along_m, self.lat)), float(np.interp(along_m, self.along_m, self.lon))

    def part(self, from_m: float, to_m: float) -> Polyline:
        """Return the line between two distances; in the other direction if the second is the smaller one."""
        low, high = min(from_m, to_m), max(from_m, to_m)
        places = np.concatenate([[low], self.along_m[(self.along_m > low) & (self.along_m < high)], [high]])
        cut = Polyline.through(np.interp(places, self.along_m, self.lat), np.interp(places, self.along_m, self.lon))
        return cut if to_m >= from_m else cut.reversed()

    def nearest(self, lat: float, lon: float) -> tuple[Floats, Floats]:
        """Return for each of its segments the place nearest to a point: distance along the line and from the point [m]."""
        north, east = (float(value[0]) for value in _metres_per_degree(np.array([lat])))
        x, y = (self.lon - lon) * east, (self.lat - lat) * north
        if len(x) == 1:
            return np.zeros(1), np.hypot(x, y)
        dx, dy = np.diff(x), np.diff(y)
        square = np.maximum(dx * dx + dy * dy, 1e-12)
        share = np.clip(-(x[:-1] * dx + y[:-1] * dy) / square, 0.0, 1.0)
        along = self.along_m[:-1] + share * np.diff(self.along_m)
        return along, np.hypot(x[:-1] + share * dx, y[:-1] + share * dy)

    def project(self, lat: float, lon: float) -> tuple[float, float]:
        """Return the place nearest to a point: distance along the line and from the point [m]."""
        along, away = self.nearest(lat, lon)
        best = int(np.argmin(away))
        return float(along[best]), float(away[best])


def place_in_order(line: Polyline, lat: Floats, lon: Floats) -> tuple[Floats, Floats]:
    """Return where stops in their order lie along a line, and how far from it [m].

    Of all places that do not fall along the line those with the least sum of squared distances: a line that comes by twice,
    or turns back, gets each stop at its own turn. Solved by dynamic programming over the segments. Beyond `OFF_SHAPE_M` a
    distance counts hardly more, so that a stop with wrong coordinates leaves the others where they are; it is put between
    them (`_between`).
    """
    found = [line.nearest(float(a), float(b)) for a, b in zip(lat, lon, strict=True)]
    costs = np.array([np.minimum(away, OFF_SHAPE_M) ** 2 + _PULL_M * np.maximum(away - OFF_SHAPE_M, 0.0) for _, away in found])
    best = np.empty_like(costs)
    best[0] = costs[0]
    stays = np.zeros(costs.shape, bool)
    for k in range(1, len(costs)):
        before = np.concatenate([[np.inf], np.minimum.accumulate(best[k - 1])[:-1]])
        stays[k] = found[k][0] >= found[k - 1][0] - _SLACK_M
        best[k] = costs[k] + np.minimum(before, np.where(stays[k], best[k - 1], np.inf))
    chosen = np.empty(len(costs), int)
    chosen[-1] = int(np.argmin(best[-1]))
    for k in range(len(costs) - 2, -1, -1):
        last = chosen[k + 1]
        chosen[k] = int(np.argmin(best[k][: last + 1 if stays[k + 1][last] or last == 0 else last]))
    along = np.array([found[k][0][j] for k, j in enumerate(chosen)])
    away = np.array([found[k][1][j] for k, j in enumerate(chosen)])
    return _between(np.maximum.accumulate(along), away), away


def _between(along: Floats, away: Floats) -> Floats:
    """Return places along a line where stops off it, pushed onto a neighbour by their order, lie evenly between neighbours."""
    off = away > OFF_SHAPE_M
    good = np.flatnonzero(~off)
    places = along.copy()
    for before, after in pairwise(good.tolist()):
        if after - before > 1 and np.min(np.diff(along[before : after + 1])) <= _SLACK_M:
            places[before : after + 1] = np.linspace(along[before], along[after], after - before + 1)
    return places
