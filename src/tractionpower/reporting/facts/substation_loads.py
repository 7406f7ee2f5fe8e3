"""Substations over time as figures see them: power and current of each, what its units and its contract permit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.limits import find_limit
from tractionpower.model.ratings import find_unit
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import Substation
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.supply.devices import Device
from tractionpower.supply.ratings import Rating, ratings_of

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Load:
    """The load of a substation over the rows of a run.

    Attributes
    ----------
    station
        The substation.
    time_s
        Start of the rows [s].
    current_a, power_kw
        Fed current [A], and power at the busbars [kW]; 0 where the substation is cut off.
    rating
        What the units that are in service from the start bear together.
    rated_kw
        Their rated current at the rated voltage of their type, or else at the nominal voltage [kW]; NaN without a rating.
    contract_kw
        Greatest mean power of a quarter of an hour by the clock that is contracted for this substation alone [kW]; NaN if none.
    """

    station: Substation
    time_s: Array
    current_a: Array
    power_kw: Array
    rating: Rating
    rated_kw: float
    contract_kw: float


def substation_loads(data: RunData) -> list[Load]:
    """Return the loads of the substations that have rows, in their order along the line."""
    found = dict(data.rows_of("substations", "substation"))
    stations = [station for station in along_line(data.scenario) if station.id in found]
    ratings = substation_ratings(data.scenario, stations)
    loads = []
    for station, rating in zip(stations, ratings, strict=True):
        rows = found[station.id]
        current, power = (np.nan_to_num(rows[name].to_numpy(float)) for name in ("current_a", "power_kw"))
        contract = math.nan if station.contract_power_kw is None else station.contract_power_kw
        contract = contract if _alone(data.scenario, station) else math.nan
        rated = rating.rated_a * _rated_voltage(data.scenario, station) / 1000.0
        loads.append(Load(station, rows["time_s"].to_numpy(float), current, power, rating, rated, contract))
    return loads


def along_line(scenario: Scenario) -> list[Substation]:
    """Return the substations in their order along the line."""
    return sorted(scenario.supply.substations, key=lambda each: (each.km, each.id))


def substation_ratings(scenario: Scenario, stations: Sequence[Substation]) -> tuple[Rating, ...]:
    """Return what the units in service of substations bear together."""
    return ratings_of(scenario, [Device("substation", each.id, each.id, "", each.km, each.km) for each in stations])


def _rated_voltage(scenario: Scenario, station: Substation) -> float:
    kind = find_unit(scenario.rectifier_units, station.unit) if station.unit is not None else None
    if kind is not None:
        return kind.rated_voltage_v
    nominal = find_limit(scenario.limits, scenario.supply.system, "u_n")
    return math.nan if nominal is None else nominal.value


def _alone(scenario: Scenario, station: Substation) -> bool:
    """Return whether no other substation shares its supply point: else the contract is one for the sum of them."""
    point = station.supply_point or station.id
    return sum((each.supply_point or each.id) == point for each in scenario.supply.substations) == 1
