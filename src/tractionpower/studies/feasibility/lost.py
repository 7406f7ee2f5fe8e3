"""Seconds lost to low voltage along the line: a train alone on its recorded voltages beside itself at nominal voltage."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.scenario import ROUNDING_S
from tractionpower.studies.feasibility.areas import Areas
from tractionpower.studies.feasibility.chain import TrainFacts
from tractionpower.studies.feasibility.judgement import NAN, LostTime

Floats = NDArray[np.float64]

BIN_KM = 1.0
"""Length of the places in which lost seconds are summed up [km]."""

SAMPLE_M = 20.0
"""Distance of the places at which running times are compared [m]."""

SHARE = 0.1
"""Share of lost seconds that a stretch told in words leaves out at either end."""


@dataclass(frozen=True, eq=False)
class LossProfile:
    """Seconds that one train loses to low voltage along its way.

    Attributes
    ----------
    from_m, to_m
        Ends of pieces of the way [m].
    lost_s
        Seconds lost in each.
    track, km
        Track of each piece, and middle of the kilometre that it lies in.
    area
        Area of that kilometre.
    """

    from_m: Floats
    to_m: Floats
    lost_s: Floats
    track: list[str]
    km: Floats
    area: list[str]

    def within(self, from_m: float, to_m: float) -> LossProfile:
        """Return what lies between two calls, by their places on the way [m]."""
        middle = 0.5 * (self.from_m + self.to_m)
        return self._those(np.flatnonzero((middle >= from_m) & (middle < to_m)))

    def _those(self, rows: NDArray[np.intp]) -> LossProfile:
        track, area = [self.track[k] for k in rows], [self.area[k] for k in rows]
        return LossProfile(self.from_m[rows], self.to_m[rows], self.lost_s[rows], track, self.km[rows], area)

    def bins(self) -> list[tuple[str, float, str, float]]:
        """Return track, middle [km], area and lost seconds of every kilometre, in the order of the run."""
        found: dict[tuple[str, float, str], float] = {}
        for track, km, area, lost in zip(self.track, self.km.tolist(), self.area, self.lost_s.tolist(), strict=True):
            key = (track, km, area)
            found[key] = found.get(key, 0.0) + lost
        return [(*key, lost) for key, lost in found.items()]

    def worst(self) -> tuple[str, float, str]:
        """Return track, kilometre and area where most seconds are lost; blank where none are."""
        worst = max(self.bins(), key=lambda row: row[3], default=("", NAN, "", 0.0))
        return worst[:3] if worst[3] > 0.0 else ("", NAN, "")

    def worst_area(self) -> str:
        """Return the area in which most seconds are lost; blank where none are."""
        lost: dict[str, float] = {}
        for _, _, area, seconds in self.bins():
            lost[area] = lost.get(area, 0.0) + seconds
        area = max(lost, key=lambda name: lost[name], default="")
        return area if lost.get(area, 0.0) > 0.0 else ""

    def stretch(self) -> tuple[float, float] | None:
        """Return the kilometres between which nearly all seconds are lost, the lower one first; None where none are."""
        bins = self.bins()
        losses = np.array([max(row[3], 0.0) for row in bins])
        if not losses.sum() > 0.0:
            return None
        share = np.cumsum(losses) / losses.sum()
        first, last = int(np.searchsorted(share, SHARE)), int(np.searchsorted(share, 1.0 - SHARE))
        places = sorted((bins[first][1], bins[last][1]))
        return places[0] - 0.5 * BIN_KM, places[1] + 0.5 * BIN_KM


def loss_profile(facts: TrainFacts, areas: Areas, from_s: float) -> LossProfile:
    """Return where a train lost time to low voltage after the time `from_s` [s], up to where it came."""
    rows = facts.trace.rows
    counts = rows["time_s"] >= from_s - ROUNDING_S
    counted, held = rows[counts], facts.held_s[counts]
    from_m, to_m = (float(counted["s_m"][0]) if len(counted) else facts.reached_m), facts.reached_m
    if not to_m > from_m:
        nothing = np.zeros(0)
        return LossProfile(nothing, nothing, nothing, [], nothing, [])
    path = facts.planned.path
    marks = [call.at_m for call in facts.calls] + [leg.start_m for leg in path.legs]
    count = max(2, int(np.ceil((to_m - from_m) / SAMPLE_M)) + 1)
    inner = np.array([mark for mark in marks if from_m < mark < to_m])
    places = np.unique(np.concatenate((np.linspace(from_m, to_m, count), inner)))
    slower = facts.alone.recorded.until(places) - facts.alone.limited.until(places)
    lost = np.nan_to_num(np.diff(slower))
    piece = np.clip(np.searchsorted(places, counted["s_m"], side="right") - 1, 0, len(lost) - 1)
    np.add.at(lost, piece, held)
    return _by_kilometre(facts, areas, places, lost)


def _by_kilometre(facts: TrainFacts, areas: Areas, places: Floats, lost: Floats) -> LossProfile:
    """Sum up what is lost between `places` [m] over the kilometres of the tracks, cut at calls."""
    path = facts.planned.path
    leg, km = path.places(0.5 * (places[:-1] + places[1:]))
    number = np.floor(km / BIN_KM)
    call = np.searchsorted([call.at_m for call in facts.calls], places[:-1], side="right")
    changes = np.diff(leg, prepend=-1) != 0
    first = np.flatnonzero(changes | (np.diff(number, prepend=-np.inf) != 0.0) | (np.diff(call, prepend=-1) != 0))
    track, middle = [path.legs[k].axis.track for k in leg[first]], (number[first] + 0.5) * BIN_KM
    area = [areas.area(name, place) for name, place in zip(track, middle.tolist(), strict=True)]
    to_m = np.append(places[first[1:]], places[-1])
    return LossProfile(places[first], to_m, np.add.reduceat(lost, first), track, middle, area)


def lost_times(train: str, profile: LossProfile) -> Iterable[LostTime]:
    """Return the rows of table ``lost_time`` of a train; kilometres in which it neither loses nor gains are left out."""
    return [LostTime(train, track, km, area, lost) for track, km, area, lost in profile.bins() if abs(lost) > 1e-6]
