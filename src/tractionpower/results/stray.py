"""Leakage and stray current along the line, and what needs no further study (EN 50122-2, recalled; rows of the limits table).

The standard speaks of a single track: what leaks from a return conductor of several tracks is shared out to them. Which
formation a track has the study does not say; the leakage conductance decides which criterion its potential is held against.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.base import DAY_S
from tractionpower.model.limits import Limit, common_limits
from tractionpower.results.verdicts import AT_MOST

Array = NDArray[np.float64]

PREFIX = "stray_"
_TOLERANCE = 1e-9
M_PER_KM = MA_PER_A = 1000.0

FORMATIONS = ("open", "closed")


@dataclass(frozen=True, slots=True)
class Leakage:
    """Means over the run at all places where rails leak.

    Attributes
    ----------
    tracks
        How many tracks the return conductor has.
    leakage_s_per_m
        Leakage conductance of the return conductor [S/m].
    mean_v, positive_v
        Mean potential, and mean of its positive part, in which current leaves the rails [V].
    seconds
        Length of the run that counts [s].
    """

    tracks: NDArray[np.int64]
    leakage_s_per_m: Array
    mean_v: Array
    positive_v: Array
    seconds: float

    @property
    def stray_ma_per_m(self) -> Array:
        """Mean current that leaves the rails of a single track [mA/m]."""
        return np.asarray(self.leakage_s_per_m * self.positive_v / self.tracks * MA_PER_A)

    @property
    def s_per_km(self) -> Array:
        """Leakage conductance of a single track [S/km]."""
        return np.asarray(self.leakage_s_per_m * M_PER_KM / self.tracks)

    @property
    def of_a_day(self) -> bool:
        """Whether the means are those of a day, as the criteria want them."""
        return self.seconds >= DAY_S - _TOLERANCE * DAY_S


def stray_rows(leakage: Leakage, places: Sequence[str], limits: Iterable[Limit], system: str) -> list[dict[str, Any]]:
    """Return what was found against what needs no further study; shorter runs than a day are not judged (`met` is None).

    `places` are the places of `leakage` in words.
    """
    named = common_limits(limits, system, PREFIX)
    leaks = (leakage.leakage_s_per_m > 0.0) & np.isfinite(leakage.mean_v)
    rows = []
    if "stray_current" in named and leaks.any():
        found = np.where(leaks, leakage.stray_ma_per_m, -np.inf)
        rows.append(_row("mean stray current", "mA/m", found, places, named["stray_current"]))
    floor = 0.0
    for formation in FORMATIONS:
        shift, most = named.get(f"stray_shift_{formation}"), named.get(f"stray_leakage_{formation}")
        if shift is None or most is None:
            continue
        within = leaks & (leakage.s_per_km > floor) & (leakage.s_per_km <= most.value * (1.0 + _TOLERANCE))
        if within.any():
            title = f"mean rail potential, leakage up to {most.value:g} S/km"
            rows.append(_row(title, "V", np.where(within, leakage.mean_v, -np.inf), places, shift))
        floor = most.value * (1.0 + _TOLERANCE)
    beyond = leaks & (leakage.s_per_km > floor)
    if floor > 0.0 and beyond.any():
        limit = next(named[name] for name in ("stray_leakage_closed", "stray_leakage_open") if name in named)
        rows.append(_row("leakage conductance", "S/km", np.where(beyond, leakage.s_per_km, -np.inf), places, limit))
    for row in rows:
        row["met"] = row["met"] if leakage.of_a_day else None
    return rows


def _row(title: str, unit: str, values: Array, places: Sequence[str], limit: Limit) -> dict[str, Any]:
    k = int(values.argmax())
    return {
        "name": title, "value": float(values[k]), "unit": unit, "place": places[k], "time": "", "limit": limit.name,
        "limit_value": limit.value, "source": limit.source, "status": limit.status, "sense": AT_MOST,
        "met": bool(values[k] <= limit.value * (1.0 + _TOLERANCE)),
    }  # fmt: skip


def stray_verdicts(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the rows that are judged, those of a day, as verdicts."""
    return [dict(row) for row in rows if row["met"] is not None]
