"""How long trains have which voltage, in the bands of EN 50163, and what is permitted there.

The standard's text is not at hand: limits of voltages and times are rows of the limits table, each with its status.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.model.limits import SystemVoltages
from tractionpower.results.spells import TOLERANCE_V, TrainSpells
from tractionpower.results.tables import make_table

Array = NDArray[np.float64]
Numbers = NDArray[np.integer[Any]]

AT_NOMINAL_V = float(np.nextafter(0.0, -1.0))
"""Tolerance by which the nominal voltage itself belongs to the band above it [V]."""

ROUNDING_S = 1e-6


@dataclass(frozen=True, slots=True)
class Band:
    """A band of voltages.

    Attributes
    ----------
    name
        By its limits.
    from_v, to_v
        Its ends [V]; NaN: none.
    permitted_s
        How long a voltage may last in it or beyond it without a break [s]; NaN: as long as it likes.
    """

    name: str
    from_v: float
    to_v: float
    permitted_s: float = np.nan


def bands_of(voltages: SystemVoltages, low_s: float = np.nan, high_s: float = np.nan) -> tuple[Band, ...]:
    """Return the bands by rising voltage; those without a width are left out.

    Parameters
    ----------
    voltages
        Limits of the supply system [V].
    low_s, high_s
        Longest permitted time between U_min2 and U_min1, and between U_max1 and U_max2 [s]; NaN: not known.
    """
    v, nan = voltages, np.nan
    bands = (
        Band("below U_min2", nan, v.u_min2, 0.0),
        Band("U_min2 to U_min1", v.u_min2, v.u_min1, low_s),
        Band("U_min1 to U_n", v.u_min1, v.u_n),
        Band("U_n to U_max1", v.u_n, v.u_max1),
        Band("U_max1 to U_max2", v.u_max1, v.u_max2, high_s),
        Band("above U_max2", v.u_max2, nan, 0.0),
    )
    return tuple(band for band in bands if not band.from_v == band.to_v)


class VoltageDurations:
    """Time of every train in each band, and the longest one in it or beyond it: further away from the nominal voltage.

    A voltage is beyond U_min or U_max only when it differs by more than 0.1 V, as in `TrainSpells`.

    Parameters
    ----------
    trains
        How many there are.
    bands
        The bands, by rising voltage.
    nominal_v
        Nominal voltage, a limit of two of them [V].
    step_s
        Length of a step [s].
    """

    def __init__(self, trains: int, bands: Sequence[Band], nominal_v: float, step_s: float) -> None:
        self.bands, self._step_s = tuple(bands), step_s
        self._rows = np.zeros(trains, np.int64)
        self._low = [band.from_v < nominal_v or not np.isfinite(band.from_v) for band in self.bands]
        self._beyond = [
            TrainSpells(trains, band.to_v if low else band.from_v, not low, self._tolerance(band, nominal_v, low))
            for band, low in zip(self.bands, self._low, strict=True)
        ]

    @staticmethod
    def _tolerance(band: Band, nominal_v: float, low: bool) -> float:
        if (band.to_v if low else band.from_v) != nominal_v:
            return TOLERANCE_V
        return 0.0 if low else AT_NOMINAL_V

    def add(self, time_s: Array, train: Numbers, voltage_v: Array) -> None:
        """Add rows ordered by time: start of the step [s], number of the train, voltage at its pantograph [V]."""
        np.add.at(self._rows, np.asarray(train, np.int64), 1)
        for spells in self._beyond:
            spells.add(time_s, train, voltage_v, self._step_s)

    @property
    def time_s(self) -> Array:
        """Time of each train with a voltage [s]."""
        return self._rows.astype(float) * self._step_s

    @property
    def total_s(self) -> Array:
        """Time in each band, shape (trains, bands) [s]."""
        beyond = np.array([spells.total_s for spells in self._beyond])
        inner = np.zeros_like(beyond)
        for k, low in enumerate(self._low):
            further = k - 1 if low else k + 1  # what is beyond the next limit is not in this band
            inner[k] = beyond[further] if 0 <= further < len(beyond) else 0.0
        total: Array = np.round(beyond - inner, 6).T
        return total

    @property
    def longest_s(self) -> Array:
        """Longest time in each band or beyond it, shape (trains, bands) [s]."""
        return np.array([spells.longest_s for spells in self._beyond]).T

    @property
    def longest_from_s(self) -> Array:
        """When that begins [s]; NaN where there was none."""
        return np.array([spells.longest_from_s for spells in self._beyond]).T

    def met(self, longest_s: Array) -> Array:
        """Return for times in each band, shape (..., bands) [s], 1 where they are permitted, 0 where not, NaN without a limit."""
        permitted = np.array([band.permitted_s for band in self.bands])
        return np.where(np.isnan(permitted), np.nan, (longest_s <= permitted + ROUNDING_S).astype(float))

    def table(self, names: Sequence[str]) -> pa.Table:
        """Return table ``voltage_durations``: all trains together, then each that had a voltage."""
        seen = np.flatnonzero(self._rows)
        time_s, total = self.time_s[seen], self.total_s[seen]
        longest, since = self.longest_s[seen], self.longest_from_s[seen]
        if len(seen):
            worst = longest.argmax(axis=0), np.arange(len(self.bands))
            time_s = np.concatenate(([time_s.sum()], time_s))
            total = np.concatenate((total.sum(axis=0, keepdims=True), total))
            longest, since = np.concatenate((longest[worst][None], longest)), np.concatenate((since[worst][None], since))
        count, width = total.shape
        met = np.nan_to_num(self.met(longest), nan=2.0).astype(int)
        texts = ["", *(names[k] for k in seen.tolist())]
        repeated = {
            name: np.tile([getattr(band, name) for band in self.bands], count) for name in ("from_v", "to_v", "permitted_s")
        }
        columns: dict[str, Any] = {
            "train": (np.repeat(np.arange(count), width), texts),
            "band": (np.tile(np.arange(width), count), [band.name for band in self.bands]),
            "total_s": total.ravel(),
            "share_percent": (100.0 * total / time_s[:, None]).ravel(),
            "longest_s": longest.ravel(),
            "longest_from_s": since.ravel(),
            "met": (met.ravel(), ["no", "yes", ""]),
        }
        return make_table("voltage_durations", columns | repeated)
