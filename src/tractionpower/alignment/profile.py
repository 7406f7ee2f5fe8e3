"""What lies along a route: rows of the line laid out by distance, and painted onto the cells between their ends."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import Metres, TrackAxis
from tractionpower.alignment.intervals import TOLERANCE_M, Row
from tractionpower.model.line import Line

Cells = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class PathLeg:
    """A part of a route on one track.

    Attributes
    ----------
    axis
        The track.
    start_m
        Distance from the start of the route at which the leg begins [m].
    from_track_m
        Metre of the track at which the leg begins [m].
    sign
        +1 with increasing kilometres, -1 with decreasing ones.
    length_m
        Length [m].
    """

    axis: TrackAxis
    start_m: float
    from_track_m: float
    sign: int
    length_m: float

    @property
    def end_m(self) -> float:
        """Distance from the start of the route at which the leg ends [m]."""
        return self.start_m + self.length_m

    @property
    def direction(self) -> Literal["increasing", "decreasing"]:
        """Direction of travel."""
        return "increasing" if self.sign > 0 else "decreasing"

    def track_m(self, s: Metres) -> Metres:
        """Return the metre of the track at distances `s` of the route [m], that of its end beyond it."""
        return np.clip(self.from_track_m + self.sign * (s - self.start_m), 0.0, self.axis.length_m)

    def distance(self, track_m: float) -> float | None:
        """Return the distance of a metre of the track from the start of the route [m], or None if it is not on the leg."""
        along = self.sign * (track_m - self.from_track_m)
        if along < -TOLERANCE_M or along > self.length_m + TOLERANCE_M:
            return None
        # A place within rounding of an end is the end: the same number for all who ask.
        if along > self.length_m - TOLERANCE_M:
            return self.end_m
        return self.start_m if along < TOLERANCE_M else self.start_m + along


class Laid(NamedTuple):
    """Parts of rows along a route: number of the row, distances of the two ends [m], +1 where kilometres rise or -1."""

    row: Cells
    from_m: Metres
    to_m: Metres
    sign: Cells


class Profile(NamedTuple):
    """Integrals along a route, straight between the distances `at_m`; all are 0 at the start of the route."""

    at_m: Metres
    height_m: Metres
    curve_m: Metres
    single_tunnel_m: Metres
    double_tunnel_m: Metres


class Limits(NamedTuple):
    """Values that hold from a distance [m] to the next one, the last to the end of the route; one column a quantity."""

    from_m: Metres
    values: NDArray[np.float64]


def lay_rows(rows: Sequence[Row], legs: Iterable[PathLeg]) -> Laid:
    """Return where `rows` lie along `legs`; a row with a direction only on legs of that direction."""
    return _chain([_lay_on_leg(rows, leg) for leg in legs])


def cut_up(start_m: float, end_m: float, laid: Laid, marks: Sequence[float] = ()) -> tuple[Metres, Cells, Cells]:
    """Return the places between which nothing changes [m], and for each part of a row its first and behind its last cell.

    Places closer than `TOLERANCE_M` are one, so that the rounding of two rows that meet makes neither gap nor sliver.
    """
    places = np.concatenate((laid.from_m, laid.to_m, (start_m, end_m), marks))
    ordered, inverse = np.unique(places, return_inverse=True)
    new = np.diff(ordered, prepend=-np.inf) > TOLERANCE_M
    edges = ordered[new]
    if len(edges) > 1:
        edges[-1] = end_m
    cell = (np.cumsum(new) - 1)[inverse]
    count = len(laid.row)
    return edges, cell[:count], cell[count : 2 * count]


def paint(cells: int, first: Cells, last: Cells, values: Metres, ground: float) -> Metres:
    """Return the lowest of the `values` that hold in each cell, `ground` where none does."""
    painted = np.full(cells, ground)
    for part in np.argsort(-values, kind="stable"):  # highest first: lower ones go on top
        painted[first[part] : last[part]] = values[part]
    return painted


def join_equal(from_m: Metres, values: NDArray[np.float64]) -> Limits:
    """Return cells and their values (cells x quantities) with equal neighbours joined; NaN is equal to NaN."""
    same = (values[1:] == values[:-1]) | (np.isnan(values[1:]) & np.isnan(values[:-1]))
    kept = np.concatenate(([True], ~same.all(axis=1)))
    return Limits(from_m[kept], values[kept])


def compile_profile(line: Line, stretches: Sequence[PathLeg], start_m: float, end_m: float) -> Profile:
    """Return the integrals of slope, curve resistance and tunnels over the distance, from `start_m` to `end_m`.

    `stretches` are the legs and what of the track lies behind them; elsewhere the track is level and straight.
    """
    lists: tuple[Sequence[Row], ...] = (
        line.gradients,
        line.curves,
        tuple(item for item in line.tunnels if item.kind == "single_track"),
        tuple(item for item in line.tunnels if item.kind == "double_track"),
    )
    slopes = np.array([item.permille for item in line.gradients]) / 1000.0
    values = (slopes, curve_resistance(line), *(np.ones(len(rows)) for rows in lists[2:]))
    laid = [lay_rows(rows, stretches) for rows in lists]
    edges, first, last = cut_up(start_m, end_m, _chain(laid), (0.0,))
    kinds = np.repeat(np.arange(len(lists)), [len(parts.row) for parts in laid])
    sums = []
    for kind, (parts, worth) in enumerate(zip(laid, values, strict=True)):
        each = worth[parts.row] * (parts.sign if kind == 0 else 1)
        painted = paint(len(edges) - 1, first[kinds == kind], last[kinds == kind], each, 0.0)
        total = np.concatenate(([0.0], np.cumsum(painted * np.diff(edges))))
        sums.append(total - np.interp(0.0, edges, total))
    return Profile(edges, *sums)


def curve_resistance(line: Line) -> Metres:
    """Return the resistance of each curve of `line` [N/N].

    Roeckl: 650/(R - 55) N/kN from a radius of 300 m, 500/(R - 30) below; or a/(R - b) as the line gives it. A radius
    at which the formula has no value counts as straight; `check_line` refuses it.
    """
    radius = np.array([item.radius_m for item in line.curves])
    if line.curve_resistance is not None:
        a, b = np.full(len(radius), line.curve_resistance.a), np.full(len(radius), line.curve_resistance.b_m)
    else:
        a, b = np.where(radius >= 300.0, 650.0, 500.0), np.where(radius >= 300.0, 55.0, 30.0)
    spare = radius - b
    return np.asarray(np.divide(a, 1000.0 * spare, out=np.zeros_like(radius), where=spare > 0.0))


def _lay_on_leg(rows: Sequence[Row], leg: PathLeg) -> Laid:
    axis, track = leg.axis, leg.axis.track
    direction = leg.direction
    mine = [
        number
        for number, row in enumerate(rows)
        if (row.tracks is None or track in row.tracks) and getattr(row, "direction", None) in (None, direction)
    ]
    low = np.array([rows[number].from_km for number in mine]).clip(axis.from_km)
    high = np.array([rows[number].to_km for number in mine]).clip(max=axis.to_km)
    on_track = low < high
    low, high = axis.metre(low[on_track]), axis.metre(high[on_track])
    ends = leg.start_m + leg.sign * (np.stack((low, high)[:: leg.sign]) - leg.from_track_m)
    from_m, to_m = ends.clip(leg.start_m, leg.end_m)
    on_leg = from_m < to_m
    row = np.array(mine, np.intp)[on_track][on_leg]
    return Laid(row, from_m[on_leg], to_m[on_leg], np.full(len(row), leg.sign))


def _chain(parts: Sequence[Laid]) -> Laid:
    return Laid(*(np.concatenate(column) for column in zip(*parts, strict=True)))
