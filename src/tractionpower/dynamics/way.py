"""The track of a case as pieces: slopes with vertical rounding, curvature with transition curves, tunnels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.chain_tables import BEND, CURVE, SLOPE
from tractionpower.model.dynamics.case import CaseTrack

TUNNEL_N_PER_N = {"single_track": 2e-3, "double_track": 1e-3}
"""Specific tunnel resistance, 2 and 1 N/kN (TrainDyn, 2.2.1)."""

ROECKL = (0.650, 55.0, 0.500, 30.0, 1 / 300.0)
"""Roeckl: 650/(R - 55) N/kN from a radius of 300 m on, 500/(R - 30) below."""

_BEFORE_M = 1.0

_SHARP_M = 1e-6
"""A transition shorter than this is a sharp break [m]."""

Metres = NDArray[np.float64]


class Ramp(NamedTuple):
    """A value that is added from a place on, growing linearly between two places; at once where they are one."""

    from_m: float
    to_m: float
    change: float


def compile_way(track: CaseTrack) -> tuple[NDArray[np.void], NDArray[np.void], NDArray[np.void]]:
    """Return the pieces of slope, those of curve and tunnel, and the law of curve resistance.

    Gradients meet in a linear transition whose slope is that of a circle of the rounding radius; its length is the radius
    times the change of the slope, half of it on either side, so that heights far from a break are those of the sharp one
    (Zobory and Bekefi, section 3). Curves likewise begin and end in transitions in which the curvature is linear.

    Returns
    -------
    tuple
        Record arrays of `SLOPE`, `CURVE` and `BEND`; the distance is that of the case.
    """
    return _slopes(track), _bends(track), _law(track)


def slope_ramps(track: CaseTrack) -> list[Ramp]:
    """Return the changes of the slope [m/m] along the track."""
    ramps = []
    for at_m, change in _changes((row.from_m, row.to_m, row.permille / 1000.0) for row in track.gradients):
        half = 0.5 * track.rounding_radius_m * abs(change)
        ramps.append(Ramp(at_m - half, at_m + half, change))
    return ramps


def curvature_ramps(track: CaseTrack) -> list[Ramp]:
    """Return the changes of the curvature [1/m] along the track; to the right is positive."""
    ramps = []
    for row in track.curves:
        half = half_length(track, row.radius_m)
        curvature = (1.0 if row.turns == "right" else -1.0) / row.radius_m
        ramps.append(Ramp(row.from_m - half, row.from_m + half, curvature))
        ramps.append(Ramp(row.to_m - half, row.to_m + half, -curvature))
    return ramps


def half_length(track: CaseTrack, radius_m: float) -> float:
    """Return half the length of the transition curve to a circle [m], linear between the rows of the case."""
    rows = sorted(track.transitions, key=lambda row: row.radius_m)
    if not rows:
        return 0.0
    return float(np.interp(radius_m, [row.radius_m for row in rows], [row.half_length_m for row in rows]))


def _changes(rows: Iterable[tuple[float, float, float]]) -> list[tuple[float, float]]:
    """Return where the value that rows (from, to, value) give changes, and by how much; 0 where there is no row."""
    changes: dict[float, float] = {}
    for from_m, to_m, value in rows:
        changes[from_m] = changes.get(from_m, 0.0) + value
        changes[to_m] = changes.get(to_m, 0.0) - value
    return [(at_m, change) for at_m, change in sorted(changes.items()) if change != 0.0]


def _sum_of(ramps: Sequence[Ramp], edges: Metres) -> tuple[Metres, Metres]:
    """Return the value behind each of the edges, and its change per metre up to the next one."""
    value, change = np.zeros(len(edges)), np.zeros(len(edges))
    for ramp in ramps:
        length = ramp.to_m - ramp.from_m
        if length > _SHARP_M:
            value += ramp.change * np.clip((edges - ramp.from_m) / length, 0.0, 1.0)
            change += np.where((edges >= ramp.from_m) & (edges < ramp.to_m), ramp.change / length, 0.0)
        else:
            value += np.where(edges >= ramp.from_m, ramp.change, 0.0)
    return value, change


def _edges(ramps: Iterable[Ramp]) -> Metres:
    """Return the places between which all ramps are linear, and one before them all."""
    places = sorted({place for ramp in ramps for place in (ramp.from_m, ramp.to_m)})
    return np.array([(places[0] if places else 0.0) - _BEFORE_M, *places])


def _slopes(track: CaseTrack) -> NDArray[np.void]:
    ramps = slope_ramps(track)
    pieces = np.zeros(len(edges := _edges(ramps)), SLOPE)
    slope, change = _sum_of(ramps, edges)
    lengths = np.diff(edges)
    rises = (slope[:-1] + 0.5 * change[:-1] * lengths) * lengths
    pieces["from_m"], pieces["slope"], pieces["change_per_m"] = edges, slope, change
    pieces["height_m"] = np.concatenate(([0.0], np.cumsum(rises)))
    return pieces


def _bends(track: CaseTrack) -> NDArray[np.void]:
    curves = curvature_ramps(track)
    tunnels = [
        Ramp(at_m, at_m, change)
        for at_m, change in _changes((row.from_m, row.to_m, TUNNEL_N_PER_N[row.kind]) for row in track.tunnels)
    ]
    pieces = np.zeros(len(edges := _edges([*curves, *tunnels])), CURVE)
    pieces["from_m"] = edges
    pieces["per_m"], pieces["change_per_m2"] = _sum_of(curves, edges)
    pieces["tunnel"], _ = _sum_of(tunnels, edges)
    return pieces


def _law(track: CaseTrack) -> NDArray[np.void]:
    law = np.zeros(1, BEND)
    given = track.curve_resistance
    law[0] = ROECKL if given is None else (given.a_n_m_per_kn / 1000.0, given.b_m) * 2 + (np.inf,)
    return law
