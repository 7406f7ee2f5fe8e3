"""The trains that come onto a line with stations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tractionpower.model.dynamics.stations import StationsCase, TrainKind


@dataclass(frozen=True, slots=True)
class Arrival:
    """A train that comes.

    Attributes
    ----------
    name, kind
        Its name and what it is.
    time_s
        When it comes [s].
    chances
        A random number from 0 to 1 for each station, by which it chooses a track.
    """

    name: str
    kind: TrainKind
    time_s: float
    chances: tuple[float, ...]


def traffic(case: StationsCase) -> list[Arrival]:
    """Return the trains of a case by their time; all that is random is drawn before, whatever the trains do then."""
    rng = np.random.default_rng(case.seed)
    given, count = case.traffic, case.traffic.trains
    if given.distribution == "exponential":
        gaps = given.least_headway_s + rng.exponential(given.headway_s - given.least_headway_s, count)
        times = np.cumsum(gaps) - gaps[0]
    else:
        times = given.headway_s * np.arange(count)
    shares = np.array([kind.share for kind in case.trains])
    kinds = [case.trains[k] for k in rng.choice(len(shares), count, p=shares / shares.sum())]
    chances = rng.random((count, len(case.stations)))
    return [Arrival(f"{kind.id} {k + 1}", kind, float(times[k]), tuple(chances[k].tolist())) for k, kind in enumerate(kinds)]
