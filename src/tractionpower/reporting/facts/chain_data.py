"""What reports of train dynamics are made of: the tables of a run as arrays, by time and vehicle or coupling."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.model.dynamics.case import CasePart, DynamicsScenario
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.reporting.facts.measures import Measure, measures
from tractionpower.results.results import Results

Array = NDArray[np.float64]

ENDURABLE = {"tension": "endurable_tension_kn", "compression": "endurable_compression_kn"}
"""Fields of a coupling with the forces that it endures."""


class ChainData:
    """A run of train dynamics as its reports see it.

    Parameters
    ----------
    results, scenario
        What the run wrote, and what it was a run of.
    """

    def __init__(self, results: Results, scenario: DynamicsScenario) -> None:
        self.results, self.scenario = results, scenario
        self._frames: dict[str, pd.DataFrame] = {}
        self._places: dict[str, tuple[Array, list[str], NDArray[np.intp], NDArray[np.intp]]] = {}

    @property
    def units(self) -> dict[str, Measure]:
        """What quantities are shown in."""
        return measures(self.scenario.case.units)

    def has(self, *tables: str) -> bool:
        """Return whether the run has rows of all these tables."""
        return all(name in self.results.tables and self.results.row_count(name) > 0 for name in tables)

    def table(self, name: str) -> pd.DataFrame:
        """Return a table, an empty one where the run has none; for the small ones, which are kept."""
        if name not in self._frames:
            self._frames[name] = self.results.table(name) if name in self.results.tables else pd.DataFrame()
        return self._frames[name]

    def control(self, column: str) -> Array:
        """Return a column of the table of controls."""
        return np.asarray(self.table("controls")[column].to_numpy(float))

    @cached_property
    def vehicles(self) -> list[str]:
        """Vehicles as the tables name them, from the front."""
        return self._place("vehicles", "vehicle")[1]

    @cached_property
    def couplings(self) -> list[str]:
        """Couplings as the tables name them, from the front."""
        if self.has("couplings"):
            return self._place("couplings", "coupling")[1]
        return from_the_front(self.table("coupling_extremes")["coupling"]) if self.has("coupling_extremes") else []

    @cached_property
    def times(self) -> Array:
        """Recorded times of the vehicles [s]."""
        return self._place("vehicles", "vehicle")[0]

    def of_vehicles(self, column: str) -> Array:
        """Return a column of the table of vehicles, a row for each time and a column for each vehicle."""
        return self._matrix("vehicles", "vehicle", column)

    def of_couplings(self, column: str) -> Array:
        """Return a column of the table of couplings, a row for each time and a column for each coupling."""
        return self._matrix("couplings", "coupling", column)

    @cached_property
    def extremes(self) -> pd.DataFrame:
        """The table of extremes, a row for each coupling from the front."""
        rows = self.table("coupling_extremes")
        order = from_the_front(rows["coupling"]) if len(rows) else []
        return rows.set_index(rows["coupling"].astype(str)).loc[order].reset_index(drop=True) if order else rows

    @cached_property
    def parts(self) -> tuple[CasePart, ...]:
        """The vehicles one by one from the front."""
        return self.scenario.parts

    def coupling_of(self, number: int) -> Coupling | None:
        """Return the coupling behind a vehicle by its number from 0; None where the case does not tell it."""
        name = self.parts[number].coupling if number < len(self.parts) else None
        return next((each for each in self.scenario.couplings if each.id == name), None)

    def endurable(self, side: str) -> Array:
        """Return what each coupling endures in ``tension`` or ``compression`` [kN]; not a number where that is not known."""
        found = (self.coupling_of(k) for k in range(len(self.couplings)))
        return np.array([np.nan if one is None else _or_nan(getattr(one, ENDURABLE[side])) for one in found])

    def chosen_vehicles(self) -> list[int]:
        """Return the numbers of the first, the middle and the last vehicle, each once."""
        count = len(self.vehicles)
        return sorted({0, count // 2, count - 1}) if count else []

    def chosen_couplings(self) -> list[int]:
        """Return the numbers of the first, the most loaded and the last coupling, each once."""
        count = len(self.couplings)
        if not count:
            return []
        return sorted({0, self.most_loaded, count - 1})

    @cached_property
    def most_loaded(self) -> int:
        """Number of the coupling with the greatest force of either sign."""
        if len(self.extremes):
            forces = self.extremes[["greatest_tension_kn", "greatest_compression_kn"]].abs().max(axis=1).to_numpy(float)
        else:
            forces = np.nanmax(np.abs(self.of_couplings("force_kn")), axis=0)
        return int(np.nanargmax(forces)) if np.isfinite(forces).any() else 0

    def greatest(self, side: str) -> Array:
        """Return the greatest force of each coupling in ``tension`` or ``compression`` [kN], a magnitude."""
        values = self.extremes[f"greatest_{side}_kn"].to_numpy(float)
        return np.asarray(np.abs(values))

    def _place(self, table: str, key: str) -> tuple[Array, list[str], NDArray[np.intp], NDArray[np.intp]]:
        """Return times and names of a table, and for each of its rows which of either it has."""
        if table not in self._places:
            rows = self.results.table(table, ("time_s", key))
            times, row = np.unique(rows["time_s"].to_numpy(float), return_inverse=True)
            names = rows[key].astype("category")
            found = [str(name) for name in names.cat.categories]
            order = from_the_front(found)
            column = np.array([order.index(name) for name in found], np.intp)
            self._places[table] = times, order, row, column[names.cat.codes.to_numpy()] if found else np.zeros(0, np.intp)
        return self._places[table]

    def _matrix(self, table: str, key: str, column: str) -> Array:
        times, names, row, place = self._place(table, key)
        values = np.full((len(times), len(names)), np.nan)
        values[row, place] = self.results.table(table, (column,))[column].to_numpy(float)
        return values


def from_the_front(names: Any) -> list[str]:
    """Return names of vehicles or couplings, which begin with a number from the front, each once in that order.

    >>> from_the_front(["10 wagon", "2 wagon", "1 loco", "2 wagon"])
    ['1 loco', '2 wagon', '10 wagon']
    """
    known = dict.fromkeys(str(name) for name in names)
    return sorted(known, key=lambda name: (_first_number(name), name))


def _first_number(name: str) -> int:
    digits = ""
    for letter in name:
        if not letter.isascii() or not letter.isdigit():
            break
        digits += letter
    return int(digits or 0)


def _or_nan(value: float | None) -> float:
    return float("nan") if value is None else value
