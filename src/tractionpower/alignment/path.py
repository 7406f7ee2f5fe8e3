"""A route as a path: distance from its start <-> track and kilometre, and slope, curves, tunnels and limits along it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import Metres, TrackAxis
from tractionpower.alignment.profile import Limits, PathLeg, compile_profile, cut_up, join_equal, lay_rows, paint
from tractionpower.kernels.train_tables import COASTS, DARK, POWERED
from tractionpower.model.line import Line
from tractionpower.model.timetable import Leg


@dataclass(frozen=True, slots=True, eq=False)
class RoutePath:
    """One route as arrays by the distance `s` [m] from its start, for trains of one category.

    Heights, curves and tunnels are integrals over the distance, straight between the places `at_m`, level before the
    first and behind the last, and 0 at the start of the route. The track behind the start counts where it exists,
    because the tail of a train stands there.

    Attributes
    ----------
    legs
        Parts of the route, each on one track.
    length_m
        Length of the route [m].
    at_m
        Places between which slope, curve and tunnel are constant [m]; the first lies behind the start of the route.
    height_m
        Height [m]; it grows where the line rises in the direction of travel.
    curve_m
        Integral of the curve resistance [N/N m].
    single_tunnel_m, double_tunnel_m
        Metres of tunnels of one and of two tracks.
    limit_from_m, limit_mps
        Speed limits of the line [m/s] and where each begins to hold for the front of the train [m], the first at 0; NaN
        where the line gives none. How long the train is does not matter here.
    current_from_m, max_current_a, standstill_current_a
        Largest train currents of the line in motion and at standstill [A], infinite where it gives none, and where each
        begins to hold [m], the first at 0.
    power_from_m, power_kind
        What the front of a train may take, one of `POWERED`, `COASTS`, `DARK`, and where each begins to hold [m], the first
        at 0.
    """

    legs: tuple[PathLeg, ...]
    length_m: float
    at_m: Metres
    height_m: Metres
    curve_m: Metres
    single_tunnel_m: Metres
    double_tunnel_m: Metres
    limit_from_m: Metres
    limit_mps: Metres
    current_from_m: Metres
    max_current_a: Metres
    standstill_current_a: Metres
    power_from_m: Metres
    power_kind: NDArray[np.intp]

    def place(self, s: float) -> tuple[str, float]:
        """Return track and kilometre at the distance `s` [m]; where two legs meet, those of the second."""
        leg, km = self.places(np.array([s], float))
        return self.legs[int(leg[0])].axis.track, float(km[0])

    def places(self, s: Metres) -> tuple[NDArray[np.intp], Metres]:
        """Return the number of the leg and the kilometre [km] at distances [m].

        Before the start and behind the end the first and the last leg go on, as far as their tracks exist.
        """
        number = self._leg_at(s)
        km = np.empty(number.shape)
        for index in np.unique(number):
            here, leg = number == index, self.legs[index]
            km[here] = leg.axis.km(leg.track_m(s[here]))
        return number, km

    def distance(self, track: str, km: float, *, from_m: float = 0.0) -> float | None:
        """Return the distance [m] of the first place of the route at a kilometre of a track, or None if it has none.

        `from_m` leaves out what lies before it: a route may pass a place twice. A kilometre that a jump back doubles means
        its first occurrence, as everywhere.
        """
        for leg in self.legs:
            if leg.axis.track == track and leg.axis.contains(km):
                found = leg.distance(leg.axis.metre(km))
                if found is not None and found >= from_m:
                    return found
        return None

    def direction_at(self, s: float) -> Literal["increasing", "decreasing"]:
        """Return whether kilometres rise or fall in the direction of travel at the distance `s` [m]."""
        return self.legs[int(self._leg_at(np.array(s, float)))].direction

    def _leg_at(self, s: Metres) -> NDArray[np.intp]:
        starts = np.array([leg.start_m for leg in self.legs[1:]])
        return np.searchsorted(starts, s, side="right")


def compile_path(
    line: Line, axes: Mapping[str, TrackAxis], route: Sequence[Leg], category: str | None, behind_m: float
) -> RoutePath:
    """Return a route as arrays for trains of a `category`, with the `behind_m` [m] behind its start.

    The route is in order by `check_route`, the line by `check_line`.

    Raises
    ------
    KeyError, ValueError
        If a track does not exist, or a leg ends off its track.
    """
    legs = _compile_legs(axes, route)
    length_m = legs[-1].end_m
    profile = compile_profile(line, (*_behind(legs[0], behind_m), *legs), -behind_m, length_m)
    limits = _speed_limits(line, legs, category)
    currents, power = _current_limits(line, legs), _power_off(line, legs)
    return RoutePath(
        legs,
        length_m,
        *profile,
        limit_from_m=limits.from_m,
        limit_mps=limits.values[:, 0],
        current_from_m=currents.from_m,
        max_current_a=currents.values[:, 0],
        standstill_current_a=currents.values[:, 1],
        power_from_m=power.from_m,
        power_kind=power.values[:, 0].astype(np.intp),
    )


def _compile_legs(axes: Mapping[str, TrackAxis], route: Sequence[Leg]) -> tuple[PathLeg, ...]:
    legs: list[PathLeg] = []
    start_m = 0.0
    for leg in route:
        axis = axes[leg.track]
        from_m, to_m = axis.metre(leg.from_km), axis.metre(leg.to_km)
        legs.append(PathLeg(axis, start_m, from_m, 1 if leg.to_km > leg.from_km else -1, abs(to_m - from_m)))
        start_m = legs[-1].end_m
    return tuple(legs)


def _behind(first: PathLeg, behind_m: float) -> tuple[PathLeg, ...]:
    """Return what exists of the track in the `behind_m` behind the start of the first leg, as a leg, or nothing."""
    room = first.from_track_m if first.sign > 0 else first.axis.length_m - first.from_track_m
    length = min(behind_m, room)
    if length <= 0.0:
        return ()
    return (PathLeg(first.axis, -length, first.from_track_m - first.sign * length, first.sign, length),)


def _speed_limits(line: Line, legs: Sequence[PathLeg], category: str | None) -> Limits:
    """Return the speed limit along the route [m/s], NaN where there is none.

    Where rows of the train's own category lie, they alone hold, elsewhere the rows without one; of several the lowest.
    """
    rows = [row for row in line.speed_limits if row.category is None or row.category == category]
    mps = np.array([row.kmh for row in rows]) / 3.6
    own = np.array([row.category is not None for row in rows], bool)
    laid = lay_rows(rows, legs)
    edges, first, last = cut_up(0.0, legs[-1].end_m, laid)
    general, special = (
        paint(len(edges) - 1, first[mine], last[mine], mps[laid.row[mine]], np.nan) for mine in (~own[laid.row], own[laid.row])
    )
    return join_equal(edges[:-1], np.where(np.isnan(special), general, special)[:, None])


def _current_limits(line: Line, legs: Sequence[PathLeg]) -> Limits:
    """Return the largest train currents in motion and at standstill along the route [A]; of several rows the lowest."""
    rows = line.train_current_limits
    still = [np.inf if row.standstill_current_a is None else row.standstill_current_a for row in rows]
    amps = np.array([[row.max_current_a for row in rows], still])
    laid = lay_rows(rows, legs)
    edges, first, last = cut_up(0.0, legs[-1].end_m, laid)
    columns = [paint(len(edges) - 1, first, last, column[laid.row], np.inf) for column in amps]
    return join_equal(edges[:-1], np.stack(columns, axis=1))


def _power_off(line: Line, legs: Sequence[PathLeg]) -> Limits:
    """Return what trains may take along the route; where two rows lie, what takes more away."""
    rows = line.power_off
    kinds = np.array([COASTS if row.kind == "coast" else DARK for row in rows], float)
    laid = lay_rows(rows, legs)
    edges, first, last = cut_up(0.0, legs[-1].end_m, laid)
    painted = -paint(len(edges) - 1, first, last, -kinds[laid.row], -float(POWERED))  # the lowest value wins
    return join_equal(edges[:-1], painted[:, None])
