"""What a train can climb and what its brakes can hold: bounds over the route that need no simulation."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.limits import SystemVoltages
from tractionpower.movement.compile import PlannedRun
from tractionpower.movement.drives import DrivePools, compile_drive
from tractionpower.movement.formation import Formation

Floats = NDArray[np.float64]

_ROUNDING = 1e-6
_LEAST_SPREAD_M = 1.0  # slopes under the front are steps; over a metre they become steep lines


class Stall(NamedTuple):
    """Where a train surely gets stuck, and from where and how fast it came.

    Attributes
    ----------
    at_m
        Where no energy is left [m].
    resistance_n
        The greatest resistance on the way there [N].
    from_m, speed_mps
        The last place where something else than its effort bounded the speed, and that speed [m], [m/s].
    """

    at_m: float
    resistance_n: float
    from_m: float
    speed_mps: float


def starting_effort_n(formation: Formation, voltages: SystemVoltages) -> float:
    """Return the greatest tractive effort at any speed and voltage [N], limited by the adhesion at standstill."""
    columns = compile_drive(formation, voltages, 1.0, DrivePools())
    if columns["drive"] == 0 or "start_n" not in columns:
        return 0.0
    if "adhesive_n" not in columns:
        return float(columns["start_n"])
    adhesion = columns["adhesion_a_mps"] / columns["adhesion_b_mps"] + columns["adhesion_c"]
    return float(min(columns["start_n"], adhesion * columns["adhesive_n"]))


def find_stall(planned: PlannedRun, ceiling: NDArray[np.void], effort_n: float) -> Stall | None:
    """Return where a train surely gets stuck, or None if that cannot be said.

    The kinetic energy is at most what it was, plus the work of the greatest effort against the part of the resistance that
    does not depend on the speed, and never above M w / 2 with the square w of the ceiling, 0 at a stop:

        E(s1) <= min(E(s0) + integral of (F - R) ds, M w(s1) / 2)

    Real efforts are smaller and real resistances greater, so a train whose bound falls below zero does not come there.

    Parameters
    ----------
    planned
        The run on its route.
    ceiling
        Its speed ceiling, records of `PIECE`.
    effort_n
        Its greatest effort [N].
    """
    mass = planned.formation
    stops = [call.at_m for call in planned.calls if call.call.stops]
    at, lacking = _lacking(planned, effort_n, np.append(ceiling["from_m"], stops))
    work = -np.concatenate(([0.0], np.cumsum(0.5 * (lacking[1:] + lacking[:-1]) * np.diff(at))))
    piece = (np.searchsorted(ceiling["from_m"], at) - 1).clip(0)
    w = np.maximum(ceiling["w"][piece] + ceiling["dw"][piece] * (at - ceiling["from_m"][piece]), 0.0)
    w[0] = 0.0 if stops and stops[0] <= 0.0 else planned.start_mps**2
    # E = work + the least of (cap - work) up to here: the recursion above, solved.
    spare = 0.5 * mass.inertia_kg * w - work
    energy = work + np.minimum.accumulate(spare)
    stuck = np.flatnonzero(energy < -_ROUNDING * mass.inertia_kg)
    if not len(stuck):
        return None
    k = int(stuck[0])
    origin = int(np.argmin(spare[: k + 1]))
    resistance = float(lacking[origin : k + 1].max()) + effort_n
    # Between the last two places the energy is taken as straight: it is zero where it crosses.
    before = max(float(energy[k - 1]), 0.0) if k else 0.0
    share = before / (before - float(energy[k]))
    return Stall(
        float(at[k - 1] + share * (at[k] - at[k - 1])) if k else 0.0, resistance, float(at[origin]), float(w[origin]) ** 0.5
    )


def hard_stretches(planned: PlannedRun, effort_n: float) -> list[tuple[float, float, float]]:
    """Return where a crawling train is held back by more than `effort_n` [N], as (from [m], to [m], greatest resistance [N])."""
    at, lacking = _lacking(planned, effort_n, np.zeros(0))
    hard = lacking > _ROUNDING * max(effort_n, 1.0)
    edges = np.flatnonzero(np.diff(np.concatenate(([False], hard, [False])).astype(int)))
    return [
        (float(at[max(start - 1, 0)]), float(at[min(end, len(at) - 1)]), float(lacking[start:end].max()) + effort_n)
        for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    ]


def least_braking(planned: PlannedRun) -> tuple[float, float, float]:
    """Return where the service brake slows the train least [m], with how much [m/s2], and the slope under it [permille]."""
    mass, path = planned.formation, planned.path
    at = _places(path, _spread(mass), planned.route_m, np.zeros(0))
    slope = _mean(path.height_m, path, at, _spread(mass))
    k = int(np.argmin(slope))
    left = mass.service_rate_mps2 + mass.mass_kg * GRAVITY / mass.inertia_kg * float(slope[k])
    return float(at[k]), left, 1000.0 * float(slope[k])


def _lacking(planned: PlannedRun, effort_n: float, marks: Floats) -> tuple[Floats, Floats]:
    """Return places [m] and by how much the resistance of a crawling train is above `effort_n` there [N].

    Between the places, which include `marks`, it is straight and keeps its sign.
    """
    path, mass = planned.path, planned.formation
    single, double = mass.tunnel[0][0], mass.tunnel[1][0]
    added = path.height_m + path.curve_m + single * path.single_tunnel_m + double * path.double_tunnel_m
    at = _places(path, _spread(mass), planned.route_m, marks)
    lacking = mass.a_n + mass.mass_kg * GRAVITY * _mean(added, path, at, _spread(mass)) - effort_n
    turns = np.flatnonzero(lacking[1:] * lacking[:-1] < 0.0)
    zeros = at[turns] + np.diff(at)[turns] * lacking[turns] / (lacking[turns] - lacking[turns + 1])
    order = np.argsort(np.concatenate((at, zeros)), kind="stable")
    return np.concatenate((at, zeros))[order], np.concatenate((lacking, np.zeros(len(zeros))))[order]


def _spread(mass: Formation) -> float:
    return max(mass.spread_m, _LEAST_SPREAD_M)


def _places(path: RoutePath, spread_m: float, route_m: float, marks: Floats) -> Floats:
    """Return the places of the route where front or tail of a train pass a change of slope, its ends and `marks` [m]."""
    at = np.concatenate((path.at_m, path.at_m + spread_m, marks))
    return np.unique(np.concatenate((at[(at > 0.0) & (at < route_m)], (0.0, route_m))))


def _mean(height_m: Floats, path: RoutePath, at: Floats, spread_m: float) -> Floats:
    """Return the mean slope under a train whose front is at the places `at` [m]."""
    return np.asarray((np.interp(at, path.at_m, height_m) - np.interp(at - spread_m, path.at_m, height_m)) / spread_m)
