"""Mean useful voltage, of trains and of zones, by the two definitions that are in circulation.

Both are *secondary*: the text of EN 50388 is not at hand. The current-weighted mean is what a public design tool for
Polish 3 kV supply areas computes, and what the editions of 2005 and 2012 are recalled to say; the time mean is what public
evaluation scripts compute under the name of EN 50388:2022, annex B. They differ, so a report says which it shows.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.integer[Any]]


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
        cells = trains * (zones + 1)
        self._time_s, self._voltage_vs = np.zeros(cells), np.zeros(cells)
        self._charge_as, self._energy_j = np.zeros(cells), np.zeros(cells)
        self._tractive_s, self._tractive_vs = np.zeros(trains), np.zeros(trains)

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
        # np.add.at adds in the order of the rows, so the sums do not depend on how many rows come at a time.
        np.add.at(self._time_s, cell, weight)
        np.add.at(self._voltage_vs, cell, volt_seconds)
        np.add.at(self._charge_as, cell, charge)
        np.add.at(self._energy_j, cell, voltage * charge)
        tractive = np.asarray(tractive, bool)
        pulling = np.asarray(train, np.int64)[tractive]
        np.add.at(self._tractive_s, pulling, weight[tractive])
        np.add.at(self._tractive_vs, pulling, volt_seconds[tractive])

    @property
    def train_current_weighted_v(self) -> Array:
        """Of each train, sum U |I| dt over sum |I| dt [V]; NaN without current."""
        return _ratio(self._table(self._energy_j).sum(axis=1), self._table(self._charge_as).sum(axis=1))

    @property
    def train_time_mean_v(self) -> Array:
        """Of each train, mean voltage of the steps with traction effort [V]; NaN without one."""
        return _ratio(self._tractive_vs, self._tractive_s)

    @property
    def zone_current_weighted_v(self) -> Array:
        """Of each zone, sum_j (1/T_j) int U_j |I_j| dt over sum_j (1/T_j) int |I_j| dt [V]; NaN without current.

        T_j is the time that train j spent in the zone: every train counts by its mean current there, a slow one no more
        than a fast one.
        """
        shares = _ratio(np.ones(self._time_s.shape), self._time_s, without=0.0)
        totals = [self._table(shares * sums)[:, :-1].sum(axis=0) for sums in (self._energy_j, self._charge_as)]
        return _ratio(*totals)

    @property
    def zone_time_mean_v(self) -> Array:
        """Of each zone, mean voltage of all trains and steps in it, with and without traction effort [V]; NaN without any."""
        return _ratio(*(self._table(sums)[:, :-1].sum(axis=0) for sums in (self._voltage_vs, self._time_s)))

    def _table(self, cells: Array) -> Array:
        return cells.reshape(self._shape)


def _ratio(above: Array, below: Array, without: float = np.nan) -> Array:
    """Return the quotient, or `without` where there is nothing to divide by."""
    quotient = np.full(above.shape, without)
    np.divide(above, below, out=quotient, where=below > 0.0)
    return quotient
