"""Stops of a train in a run of train dynamics: from the first brake command until the whole train stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tractionpower.results.results import Results


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop that was braked.

    Attributes
    ----------
    from_s, to_s
        Time of the brake command, and when the whole train stands [s].
    from_m, to_m
        Place of the first vehicle then [m].
    speed_kmh
        Speed of the first vehicle at the brake command, its magnitude.
    deceleration_mps2
        Mean deceleration over the distance, v²/(2 s) [m/s²]; no number where the train stood at the command, or has rolled back.
    """

    from_s: float
    to_s: float
    from_m: float
    to_m: float
    speed_kmh: float
    deceleration_mps2: float = float("nan")

    @property
    def distance_m(self) -> float:
        """Stopping distance [m], whichever way."""
        return abs(self.to_m - self.from_m)

    @property
    def time_s(self) -> float:
        """Stopping time [s]."""
        return self.to_s - self.from_s


def stops_of(results: Results) -> list[Stop]:
    """Return the stops of a run to which its driver braked, in their order."""
    told: list[Mapping[str, Any]] = results.run.get("stops") or []
    keys = ("braked_at_s", "stopped_at_s", "braked_at_m", "stopped_at_m", "braked_from_kmh")
    found = [[stop.get(key) for key in keys] for stop in told]
    rates = [float("nan") if (rate := stop.get("mean_deceleration_mps2")) is None else float(rate) for stop in told]
    every = zip(found, rates, strict=True)
    return [Stop(*map(float, values), rate) for values, rate in every if None not in values]  # type: ignore[call-arg, arg-type]
