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

MOVED_M = 0.1
"""A train that has stood has moved when its first vehicle is farther away than that; nearer it settles in its couplings [m]."""

_TINY_S = 1e-6
"""Times closer than this are one."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop of the train.

    Attributes
    ----------
    stopped_at_s, stopped_at_m
        When the whole train stands, and where the middle of its first vehicle is then.
    braked_at_s, braked_at_m, speed_mps
        When the command came from which on the driver braked to this stop, place and speed of the first vehicle then, negative
        backwards; not a number where he did not brake.
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
        """Stopping distance: how far the first vehicle is from where the command came, whichever way it went [m]."""
        return abs(self.stopped_at_m - self.braked_at_m)

    @property
    def is_backwards(self) -> bool:
        """Whether the first vehicle came to its stand behind the place of the command."""
        return self.stopped_at_m < self.braked_at_m

    @property
    def time_s(self) -> float:
        """Stopping time [s]."""
        return self.stopped_at_s - self.braked_at_s

    @property
    def mean_deceleration_mps2(self) -> float:
        """v²/(2 s), the mean over the way [m/s²]; no number for a train that stood at the command, or has rolled back since."""
        has_turned = self.speed_mps * (self.stopped_at_m - self.braked_at_m) <= 0.0
        return float("nan") if has_turned else self.speed_mps**2 / (2.0 * self.distance_m)

    def as_dict(self) -> dict[str, float | bool | None]:
        """Return the stop as ``run.json`` has it, speed and distance as magnitudes; none where there is no number."""
        told = {
            "braked_at_s": self.braked_at_s,
            "braked_at_m": self.braked_at_m,
            "braked_from_kmh": abs(self.speed_mps) * 3.6,
            "stopped_at_s": self.stopped_at_s,
            "stopped_at_m": self.stopped_at_m,
            "stopping_distance_m": self.distance_m,
            "stopping_time_s": self.time_s,
            "mean_deceleration_mps2": self.mean_deceleration_mps2,
        }
        found = {name: value if np.isfinite(value) else None for name, value in told.items()}
        return found | {"backwards": self.is_backwards if self.is_braked else None}


def find_stops(marks: Array, start: tuple[float, float], spells: Sequence[Spell]) -> list[Stop]:
    """Return the stops of a train; they are those of the steps, however coarse rows are recorded.

    Parameters
    ----------
    marks
        Records of `MARK`: where the first vehicle was when controls came to hold, and when the whole train came to a stand.
    start
        Place [m] and speed [m/s] of the first vehicle at time 0.
    spells
        Times in which the driver brakes, in their order.
    """
    stops: list[Stop] = []
    (from_m, speed_mps), since_s = start, -np.inf
    moves = speed_mps != 0.0
    commands = marks[marks["control"] >= 0]
    for mark in marks[marks["control"] < 0]:
        at_s, at_m = float(mark["time_s"]), float(mark["s_m"])
        if moves or abs(at_m - from_m) > MOVED_M:
            reaching = [begin for begin, end in spells if end > since_s and begin <= at_s and end >= at_s - _TINY_S]
            stops.append(Stop(at_s, at_m, *_commanded(commands, start, reaching[-1])) if reaching else Stop(at_s, at_m))
            from_m, moves = at_m, False
        since_s = at_s
    return stops


def _commanded(commands: Array, start: tuple[float, float], at_s: float) -> tuple[float, float, float]:
    """Return time [s], place [m] and speed [m/s] of the first vehicle when a command came."""
    if at_s <= _TINY_S:  # what holds at the start is not marked
        return 0.0, *start
    found = commands[np.abs(commands["time_s"] - at_s) <= _TINY_S]
    return (at_s, float(found[0]["s_m"]), float(found[0]["v_mps"])) if len(found) else (at_s, np.nan, np.nan)


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
