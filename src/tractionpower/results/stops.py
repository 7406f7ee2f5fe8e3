"""Stops of a train: from the brake command to standstill."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Spell = tuple[float, float]
"""Time in which the driver brakes [s]: from, to (infinite: still)."""

MOVES_MPS = 0.1
"""A train that has stood moves again when its first vehicle is faster than that; slower it settles in its couplings [m/s]."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop of the train.

    Attributes
    ----------
    stopped_at_s, stopped_at_m
        When the whole train stands, and where the middle of its first vehicle is then.
    braked_at_s, braked_at_m, speed_mps
        When the command came from which on the driver braked to this stop, place and speed of the first vehicle then; not a
        number where he did not brake.
    """

    stopped_at_s: float
    stopped_at_m: float
    braked_at_s: float = float("nan")
    braked_at_m: float = float("nan")
    speed_mps: float = float("nan")

    @property
    def is_braked(self) -> bool:
        """Whether the driver braked to it."""
        return bool(np.isfinite(self.braked_at_s))

    @property
    def distance_m(self) -> float:
        """Stopping distance [m]."""
        return self.stopped_at_m - self.braked_at_m

    @property
    def time_s(self) -> float:
        """Stopping time [s]."""
        return self.stopped_at_s - self.braked_at_s

    @property
    def mean_deceleration_mps2(self) -> float:
        """v²/(2 s), the mean over the way [m/s²]."""
        return self.speed_mps**2 / (2.0 * self.distance_m) if self.distance_m > 0.0 else float("nan")

    def as_dict(self) -> dict[str, float | None]:
        """Return the stop as ``run.json`` has it, none where there is no number."""
        told = {
            "braked_at_s": self.braked_at_s,
            "braked_at_m": self.braked_at_m,
            "braked_from_kmh": self.speed_mps * 3.6,
            "stopped_at_s": self.stopped_at_s,
            "stopped_at_m": self.stopped_at_m,
            "stopping_distance_m": self.distance_m,
            "stopping_time_s": self.time_s,
            "mean_deceleration_mps2": self.mean_deceleration_mps2,
        }
        return {name: value if np.isfinite(value) else None for name, value in told.items()}


def find_stops(time_s: Array, place_m: Array, speed_mps: Array, standing: Array, spells: Sequence[Spell]) -> list[Stop]:
    """Return the stops in recorded rows.

    Parameters
    ----------
    time_s, place_m, speed_mps
        Time, and place and speed of the first vehicle.
    standing
        Whether the whole train stands.
    spells
        Times in which the driver brakes, in their order.
    """
    stops: list[Stop] = []
    moves, since_s = False, -np.inf
    moving = np.abs(speed_mps) > MOVES_MPS
    changes = np.flatnonzero(np.diff(np.stack([moving, standing]), axis=1, prepend=True).any(axis=0))
    for row in sorted({0, *changes.tolist()} if len(time_s) else ()):
        if moving[row] and not moves:
            moves, since_s = True, float(time_s[row - 1]) if row else -np.inf
        elif standing[row] and moves:
            moves = False
            stops.append(_stop(time_s, place_m, speed_mps, row, [s for s in spells if s[1] > since_s]))
    return stops


def _stop(time_s: Array, place_m: Array, speed_mps: Array, row: int, spells: Sequence[Spell]) -> Stop:
    """Return the stop at a row, with the spell of braking that reaches to it."""
    at_s, at_m = float(time_s[row]), float(place_m[row])
    before_s = float(time_s[row - 1]) if row else at_s
    reaching = [begin for begin, end in spells if begin <= at_s and end >= before_s]
    if not reaching:
        return Stop(at_s, at_m)
    begin = max(reaching[-1], float(time_s[0]))
    return Stop(at_s, at_m, begin, *_between(time_s, place_m, speed_mps, begin))


def _between(time_s: Array, place_m: Array, speed_mps: Array, at_s: float) -> tuple[float, float]:
    """Return place and speed between rows: the cubic through places and speeds of the rows on both sides."""
    k = int(np.clip(np.searchsorted(time_s, at_s, side="right") - 1, 0, max(len(time_s) - 2, 0)))
    if k + 1 >= len(time_s):
        return float(place_m[k]), float(speed_mps[k])
    width = float(time_s[k + 1] - time_s[k])
    u = (at_s - float(time_s[k])) / width
    s0, s1, v0, v1 = float(place_m[k]), float(place_m[k + 1]), float(speed_mps[k]), float(speed_mps[k + 1])
    rise = s1 - s0
    place = s0 + u * (width * v0 + u * (3.0 * rise - width * (2.0 * v0 + v1) + u * (width * (v0 + v1) - 2.0 * rise)))
    speed = v0 + u * (6.0 * rise / width - 4.0 * v0 - 2.0 * v1 + u * 3.0 * (v0 + v1 - 2.0 * rise / width))
    return place, speed


def braking_spells(controls: Array, pipe: Array) -> list[Spell]:
    """Return when the driver brakes, in whatever way.

    Parameters
    ----------
    controls, pipe
        Records of `CONTROL` and `PIPE` that have come into force, in their order.
    """
    times = sorted({*controls["at_s"].tolist(), *pipe["from_s"].tolist()})
    spells: list[Spell] = []
    begun: float | None = None
    for at_s in times:
        own = controls[controls["at_s"] <= at_s][-1:]
        air = pipe[pipe["from_s"] <= at_s][-1:]
        brakes = bool((own["electric"] > 0.0).any() or (own["independent_pa"] > 0.0).any() or (air["target_pa"] > 0.0).any())
        if brakes and begun is None:
            begun = at_s
        elif not brakes and begun is not None:
            spells.append((begun, at_s))
            begun = None
    return spells if begun is None else [*spells, (begun, float("inf"))]
