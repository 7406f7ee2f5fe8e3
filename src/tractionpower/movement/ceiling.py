"""The speed ceiling of a train on its route: limits of line and train, and braking curves to lower limits and stops."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.axis import Metres
from tractionpower.alignment.intervals import TOLERANCE_M
from tractionpower.alignment.path import RoutePath
from tractionpower.kernels.train_tables import PIECE

LOWEST_SHARE = 0.1
"""On steep falls a train still brakes with this share of its rate."""

_SLIVER_M = 1e-6  # shorter pieces are not worth a row
_ROUNDING = 1e-9  # of squares of speeds [m2/s2]
_SAME_SLOPE = 1e-9


def compile_ceiling(
    path: RoutePath,
    *,
    length_m: float,
    max_mps: float,
    rate_mps2: float,
    weight_per_inertia: float,
    spread_m: float,
    stops_m: Sequence[float],
    end_stops: bool,
) -> NDArray[np.void]:
    """Return the highest speed of the front along the route as pieces in which its square is linear in the distance.

    A limit holds until the tail has cleared it. Braking curves run backwards from each lower limit and stop,

        dv2/ds = -2 max(r + (m g / M) i(s), r / 10),

    with the mean slope i under the train: the equation of motion (Krzysztozek 2019, eq. 1-4) under a constant braking force.
    The deceleration is constant between the places where front or tail pass a change of slope, and exact as the mean
    of each such piece. The integral D of the deceleration depends on the place only, so a braking curve to v at s0 is
    v2 + 2 D(s0) - 2 D(s), and the lowest curve is the one with the lowest v2 + 2 D(s0) of all places ahead.

    Parameters
    ----------
    path
        The route; where it has no speed limit that of the train holds alone.
    length_m
        Length of the train [m].
    max_mps
        Greatest speed of the train [m/s].
    rate_mps2
        Braking rate on level straight track [m/s2].
    weight_per_inertia
        Weight over inertia, m g / M [m/s2].
    spread_m
        Length over which gradients act [m]; 0: under the front.
    stops_m
        Where the front stops [m].
    end_stops
        Whether the train stops at the end of the route.

    Returns
    -------
    Records of `PIECE`. The ceiling jumps upwards only and is 0 just before each stop; the last piece begins at the end of the
    route and keeps the value just before.
    """
    stops = _snap(np.array(sorted(stops_m), float), np.array((0.0, path.length_m)))
    edges, static = _static_limit(path, length_m, max_mps, np.append(stops, (0.0, path.length_m)))
    edges, static = _refine(edges, static, stops, _slope_changes(path, spread_m))
    rates = np.maximum(rate_mps2 + weight_per_inertia * _mean_slopes(path, edges, spread_m), LOWEST_SHARE * rate_mps2)
    twice_d = np.concatenate(([0.0], np.cumsum(2.0 * rates * np.diff(edges))))
    goals = np.append(static, 0.0 if end_stops else np.inf)
    goals[np.isin(edges, stops)] = 0.0
    lowest = np.minimum.accumulate((goals + twice_d)[::-1])[::-1][1:]
    return _pieces(edges, static, 2.0 * rates, lowest - twice_d[1:])


def _static_limit(path: RoutePath, length_m: float, max_mps: float, marks: Metres) -> tuple[Metres, Metres]:
    """Return places [m] and the square of the limit between them [m2/s2], lowered until the tail has cleared each limit.

    Places within rounding of one of the `marks` are that mark.
    """
    mps = np.fmin(path.limit_mps, max_mps)
    clear_m = np.minimum(np.append(path.limit_from_m[1:], path.length_m) + length_m, path.length_m)
    from_m, clear_m = _snap(path.limit_from_m, marks), _snap(clear_m, marks)
    edges = np.unique(np.concatenate((from_m, clear_m, (path.length_m,))))
    edges = _thin(edges, marks)
    first = np.searchsorted(edges, from_m + TOLERANCE_M, side="right") - 1
    last = np.searchsorted(edges, clear_m + TOLERANCE_M, side="right") - 1
    squares = np.full(len(edges) - 1, max_mps**2)
    for row in np.argsort(-mps, kind="stable"):  # highest first: lower ones go on top
        squares[first[row] : last[row]] = mps[row] ** 2
    return edges, squares


def _refine(edges: Metres, static: Metres, stops: Metres, changes: Metres) -> tuple[Metres, Metres]:
    """Return the limits cut at stops and where the slope under the train changes."""
    inside = changes[(changes > edges[0]) & (changes < edges[-1])]
    fixed = np.union1d(edges, stops[(stops > edges[0]) & (stops < edges[-1])])
    finer = _thin(np.union1d(fixed, inside), fixed)
    return finer, static[np.searchsorted(edges, finer[:-1], side="right") - 1]


def _slope_changes(path: RoutePath, spread_m: float) -> Metres:
    """Return where front or tail pass a change of slope [m]."""
    slopes = np.diff(path.height_m) / np.diff(path.at_m)
    places = path.at_m[np.abs(np.diff(slopes, prepend=0.0, append=0.0)) > _SAME_SLOPE]
    return np.union1d(places, places + spread_m)


def _mean_slopes(path: RoutePath, edges: Metres, spread_m: float) -> Metres:
    """Return the mean slope under the train in each piece between `edges`, rises positive."""
    if spread_m > 0.0:  # linear within a piece, so the mean of both ends is exact
        under = (np.interp(edges, path.at_m, path.height_m) - np.interp(edges - spread_m, path.at_m, path.height_m)) / spread_m
        return 0.5 * (under[1:] + under[:-1])
    slopes = np.diff(path.height_m) / np.diff(path.at_m)
    here = np.searchsorted(path.at_m, 0.5 * (edges[1:] + edges[:-1]), side="right") - 1
    return np.asarray(slopes[here.clip(0, len(slopes) - 1)])


def _pieces(edges: Metres, static: Metres, falls: Metres, ends: Metres) -> NDArray[np.void]:
    """Return the lower of the static limit and a braking curve in each piece between `edges`, cut where they cross.

    The curve of a piece falls by `falls` a metre [m/s2] down to `ends` [m2/s2].
    """
    lengths = np.diff(edges)
    braked = static - ends > _ROUNDING
    above = np.where(braked, (static - ends) / falls, 0.0)  # length of the braking before the end of the piece
    full = above >= lengths
    split = (above > _SLIVER_M) & (above < lengths - _SLIVER_M)
    slivers = braked & ~split & ~full
    flat = np.zeros(len(static), PIECE)
    flat["from_m"], flat["w"] = edges[:-1], static
    # Where the curve is lower from the start on, w is made from the end, so that a stop is exactly 0.
    flat["w"][full], flat["dw"][full] = ends[full] + falls[full] * lengths[full], -falls[full]
    flat["dw"][slivers] = (ends[slivers] - static[slivers]) / lengths[slivers]
    curve = np.zeros(np.count_nonzero(split), PIECE)
    curve["from_m"] = edges[1:][split] - above[split]
    curve["w"] = ends[split] + falls[split] * (edges[1:][split] - curve["from_m"])
    curve["dw"] = -falls[split]
    last = np.zeros(1, PIECE)
    last["from_m"], last["w"] = edges[-1], min(static[-1], ends[-1])
    return _join(np.concatenate((flat, curve)), last)


def _join(pieces: NDArray[np.void], last: NDArray[np.void]) -> NDArray[np.void]:
    """Return `pieces` by distance, with level neighbours of one speed as one, and the `last` one behind them."""
    pieces = pieces[np.argsort(pieces["from_m"], kind="stable")]
    level = pieces["dw"] == 0.0
    again = level[1:] & level[:-1] & (pieces["w"][1:] == pieces["w"][:-1])
    return np.concatenate((pieces[np.concatenate(([True], ~again))], last))


def _snap(places: Metres, marks: Metres) -> Metres:
    """Return `places` with those within rounding of a mark moved onto it."""
    ordered = np.unique(marks)
    right = np.searchsorted(ordered, places).clip(max=len(ordered) - 1)
    left = (right - 1).clip(0)
    nearest = np.where(np.abs(ordered[left] - places) < np.abs(ordered[right] - places), ordered[left], ordered[right])
    return np.where(np.abs(nearest - places) <= TOLERANCE_M, nearest, places)


def _thin(places: Metres, kept: Metres) -> Metres:
    """Return sorted `places` without those within rounding of the one before or of a `kept` one; these stay."""
    stays = np.isin(places, kept)
    near = np.diff(places, prepend=-np.inf) <= TOLERANCE_M
    near |= np.abs(_snap(places, kept) - places) > 0.0
    return places[stays | ~near]
