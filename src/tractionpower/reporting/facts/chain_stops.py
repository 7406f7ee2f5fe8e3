"""Stops of a train in a run of train dynamics: from the first brake command until the train stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData

Array = NDArray[Any]

STANDING_KMH = 0.01
"""A vehicle that is not faster stands."""

BRAKING_BAR = 0.01
"""A brake pipe that is lowered by more than this, and further than before, is a brake command."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop of the first vehicle.

    Attributes
    ----------
    command, stand
        Numbers of the recorded rows of the brake command and of standstill.
    from_s, to_s
        Their times [s].
    speed_kmh
        Speed at the brake command.
    distance_m
        Distance of the first vehicle from the command to standstill.
    """

    command: int
    stand: int
    from_s: float
    to_s: float
    speed_kmh: float
    distance_m: float

    @property
    def time_s(self) -> float:
        """Time from the command to standstill."""
        return self.to_s - self.from_s

    @property
    def deceleration_mps2(self) -> float:
        """Mean deceleration over the distance, v2 / 2 s."""
        return float((self.speed_kmh / 3.6) ** 2 / (2.0 * self.distance_m)) if self.distance_m > 0.0 else float("nan")


def stops_of(data: ChainData) -> list[Stop]:
    """Return the stops of a run to which its brakes were commanded, in their order."""
    if not data.has("vehicles", "controls"):
        return []
    speed, place = data.of_vehicles("speed_kmh")[:, 0], data.of_vehicles("position_m")[:, 0]
    times = data.times
    commanded = np.interp(times, data.control("time_s"), brakes_commanded(data).astype(float)) >= 0.5
    stops = []
    for stand in np.flatnonzero((np.abs(speed[1:]) <= STANDING_KMH) & (np.abs(speed[:-1]) > STANDING_KMH)) + 1:
        command = _begins(commanded, int(stand))
        if command is not None:
            distance = float(place[stand] - place[command])
            stops.append(Stop(command, int(stand), float(times[command]), float(times[stand]), float(speed[command]), distance))
    return stops


def brakes_commanded(data: ChainData) -> Array:
    """Return for each row of the controls whether a brake is commanded: by its level, or by the pipe that is lowered."""
    level, reduction = data.control("brake") > 0, data.control("reduction_bar")
    others = (data.control("electric_percent") > 0.0) | (data.control("independent_bar") > 0.0)
    lowered = reduction > BRAKING_BAR
    rising = np.diff(reduction, prepend=0.0) >= 0.0
    return np.asarray(level | others | (lowered & rising))


def _begins(commanded: Array, stand: int) -> int | None:
    """Return where the braking began that lasted until a row, or ended shortly before; None where there was none."""
    if not commanded[: stand + 1].any():
        return None
    last = int(np.flatnonzero(commanded[: stand + 1])[-1])
    before = np.flatnonzero(~commanded[: last + 1])
    return int(before[-1]) + 1 if len(before) else 0
