"""How far a computed series is from a measured one: means, RMS, extremes, energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.studies.measured.shift import correlation

Array = NDArray[Any]

JOULES = 3600.0
"""Kilowatt-seconds in a kilowatt-hour."""


@dataclass(frozen=True, slots=True)
class Compared:
    """Measured and computed values of the same steps, or places.

    Attributes
    ----------
    at
        Starts of the steps [s], or middles of the places [km].
    measured, computed
        NaN where there is none.
    every_s
        Time that a row stands for [s]; NaN for places.
    """

    at: Array
    measured: Array
    computed: Array
    every_s: float

    @property
    def both(self) -> Array:
        """Rows that have both."""
        return np.isfinite(self.measured) & np.isfinite(self.computed)


def errors_of(compared: Compared, *, is_power: bool) -> dict[str, float]:
    """Return the errors, computed less measured, over the rows that have both; NaN where there are none.

    Parameters
    ----------
    compared
        The series.
    is_power
        Whether the integral is an energy, for values in kW.
    """
    both = compared.both
    names = (
        "mean_measured mean_computed mean_error mean_absolute_error rms_measured rms_computed rms_error relative_percent"
        " correlation lowest_measured lowest_measured_at lowest_computed lowest_computed_at highest_measured"
        " highest_measured_at highest_computed highest_computed_at energy_measured energy_computed energy_error_percent"
    ).split()
    found = dict.fromkeys(names, np.nan)
    with_computed = np.count_nonzero(np.isfinite(compared.computed))
    found |= {"rows": float(both.sum()), "share_percent": 100.0 * both.sum() / with_computed if with_computed else np.nan}
    if not both.any():
        return found
    at, measured, computed = compared.at[both], compared.measured[both], compared.computed[both]
    error = computed - measured
    found |= {"mean_error": error.mean(), "mean_absolute_error": np.abs(error).mean(), "rms_error": _rms(error)}
    found |= {"correlation": correlation(computed, measured)}
    for name, values in (("measured", measured), ("computed", computed)):
        low, high = int(values.argmin()), int(values.argmax())
        found |= {f"mean_{name}": values.mean(), f"rms_{name}": _rms(values)}
        found |= {f"lowest_{name}": values[low], f"lowest_{name}_at": at[low]}
        found |= {f"highest_{name}": values[high], f"highest_{name}_at": at[high]}
    found["relative_percent"] = _percent(found["rms_error"], found["rms_measured"])
    if is_power:
        given, got = (float(values.sum()) * compared.every_s / JOULES for values in (measured, computed))
        found |= {"energy_measured": given, "energy_computed": got, "energy_error_percent": _percent(got - given, abs(given))}
    return found


def smoothed(values: Array, rows: int) -> Array:
    """Return the mean of the values around each of them, NaN where it is NaN; an even number of rows becomes odd."""
    half = rows // 2
    if half < 1:
        return values
    known = np.isfinite(values)
    total = np.concatenate(([0.0], np.cumsum(np.where(known, values, 0.0))))
    count = np.concatenate(([0], np.cumsum(known)))
    low = np.maximum(np.arange(len(values)) - half, 0)
    high = np.minimum(np.arange(len(values)) + half + 1, len(values))
    mean = np.divide(total[high] - total[low], count[high] - count[low], out=np.full(len(values), np.nan), where=known)
    return np.asarray(mean)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _percent(part: float, whole: float) -> float:
    return 100.0 * part / whole if whole > 0.0 else np.nan
