"""Mean useful voltage, of trains and of zones, by the two definitions that are in circulation.

Both are *secondary*: the text of EN 50388 is not at hand. The current-weighted mean is what a public design tool for
Polish 3 kV supply areas computes, and what the editions of 2005 and 2012 are recalled to say; the time mean is what public
evaluation scripts compute under the name of EN 50388:2022, annex B. They differ, so a report says which it shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.sums import add_by_group

Array = NDArray[np.float64]
Numbers = NDArray[np.integer[Any]]


class Means(NamedTuple):
    """Mean useful voltages of trains or zones by both definitions, and of how many trains; all of one length.

    Attributes
    ----------
    current_weighted_v, time_mean_v
        The means [V]; NaN where there is none.
    trains, left_out
        Trains that count, and trains that stayed too briefly.
    power_w, current_a
        Sums over the trains of the means of U |I| and of |I| while they are there [W], [A]; the current-weighted mean is their
        quotient.
    voltage_time_vs, counted_s
        Sum of the voltages by their times [V s] and of these times [s]; the time mean is their quotient.
    """

    current_weighted_v: Array
    time_mean_v: Array
    trains: NDArray[np.int64]
    left_out: NDArray[np.int64]
    power_w: Array
    current_a: Array
    voltage_time_vs: Array
    counted_s: Array


class UsefulVoltage:
    """Mean useful voltage of every train and zone, summed up row by row.

    Parameters
    ----------
    trains, zones
        How many there are.
    """

    def __init__(self, trains: int, zones: int) -> None:
        # One column more than zones: there go the rows of trains that are in none, which count for the train alone.
        self._shape = (trains, zones + 1)
        self._sums = np.zeros((trains * (zones + 1), 4))
        self._tractive = np.zeros((trains, 2))

    def add(
        self,
        train: Numbers,
        zone: Numbers,
        voltage_v: Array,
        current_a: Array,
        tractive: NDArray[np.bool_],
        weight_s: Array | float,
    ) -> None:
        """Add rows of many trains, ordered by time; all arrays of shape (rows,).

        Parameters
        ----------
        train, zone
            Number of the train and of the zone it is in, -1 where in none.
        voltage_v, current_a
            Means of the step at the pantograph [V], [A].
        tractive
            Whether the train exerts traction effort.
        weight_s
            Length of the steps [s], or one value for all; a step in which a train comes or goes counts in full.
        """
        zones = self._shape[1]
        cell = np.asarray(train, np.int64) * zones + np.where(np.asarray(zone) < 0, zones - 1, zone)
        voltage = np.asarray(voltage_v, float)
        weight = np.broadcast_to(np.asarray(weight_s, float), voltage.shape)
        volt_seconds, charge = voltage * weight, np.abs(np.asarray(current_a, float)) * weight
        add_by_group(self._sums, cell, np.stack([weight, volt_seconds, charge, voltage * charge], axis=1))
        pulls = np.asarray(tractive, bool)
        pulling = np.asarray(train, np.int64)[pulls]
        add_by_group(self._tractive, pulling, np.stack([weight[pulls], volt_seconds[pulls]], axis=1))

    def of_trains(self, shortest_stay_s: float = 0.0) -> Means:
        """Return the means of all trains that were there for `shortest_stay_s` at least [s].

        Current-weighted: sum U |I| dt over sum |I| dt. Time mean: mean voltage of the steps with traction effort.
        """
        time_s, _, charge, energy = self._table.sum(axis=1).T
        counts = _stays(time_s, shortest_stay_s)
        weighted = np.where(counts, _ratio(energy, charge), np.nan)
        pulling_s, volt_seconds = np.where(counts, self._tractive.T, 0.0)
        mean = _ratio(volt_seconds, pulling_s)
        left_out = ((time_s > 0.0) & ~counts).astype(np.int64)
        power, current = (np.where(counts, _ratio(total, time_s), 0.0) for total in (energy, charge))
        return Means(weighted, mean, counts.astype(np.int64), left_out, power, current, volt_seconds, pulling_s)

    def of_zones(self, zones: Sequence[NDArray[np.integer[Any]]] | None = None, shortest_stay_s: float = 0.0) -> Means:
        """Return the means of zones, or of zones that are put together of those that were counted.

        Current-weighted: sum_j (1/T_j) int U_j |I_j| dt over sum_j (1/T_j) int |I_j| dt, where T_j is the time that train j
        spent in the zone: every train counts by its mean current there, a slow one no more than a fast one. Time mean: mean
        voltage of all trains and steps in it, with and without traction effort.

        Parameters
        ----------
        zones
            Of each the numbers of the zones that it is made of; left out: each by itself.
        shortest_stay_s
            A train that was in it for less time [s] does not count there.
        """
        alone = [np.array([k]) for k in range(self._shape[1] - 1)]
        found = [self._of_zone(np.asarray(parts, np.int64), shortest_stay_s) for parts in (alone if zones is None else zones)]
        counted, left_out, power, current, volt_seconds, time_s = np.array(found, float).reshape(len(found), 6).T
        weighted, mean = _ratio(power, current), _ratio(volt_seconds, time_s)
        return Means(weighted, mean, counted.astype(np.int64), left_out.astype(np.int64), power, current, volt_seconds, time_s)

    def _of_zone(self, parts: NDArray[np.int64], shortest_stay_s: float) -> tuple[float, ...]:
        """Return how many trains count and how many do not, and the four sums of `Means`."""
        time_s, voltage, charge, energy = self._table[:, parts].sum(axis=1).T
        counts = _stays(time_s, shortest_stay_s)
        shares = np.where(counts, _ratio(np.ones(time_s.shape), time_s, without=0.0), 0.0)
        sums = (shares * energy).sum(), (shares * charge).sum(), voltage[counts].sum(), time_s[counts].sum()
        return float(counts.sum()), float(((time_s > 0.0) & ~counts).sum()), *map(float, sums)

    def energies(self) -> tuple[Array, Array, Array]:
        """Return of all trains int U |I| dt [J], int |I| dt [C], and the mean voltage of all their steps [V]."""
        time_s, volt_seconds, charge, energy = self._table.sum(axis=1).T
        return energy, charge, _ratio(volt_seconds, time_s)

    @property
    def _table(self) -> Array:
        """The sums by train, zone and kind."""
        return self._sums.reshape(*self._shape, 4)


def _stays(time_s: Array, shortest_s: float) -> NDArray[np.bool_]:
    """Return which trains were there, and long enough; sums of steps carry roundings."""
    return np.asarray((time_s > 0.0) & (time_s >= shortest_s * (1.0 - 1e-9)))


def _ratio(above: Array, below: Array, without: float = np.nan) -> Array:
    """Return the quotient, or `without` where there is nothing to divide by."""
    quotient = np.full(above.shape, without)
    np.divide(above, below, out=quotient, where=below > 0.0)
    return quotient
