"""Traction and electric brake as rows of tables: steady effort by levels, from the case or from the vehicle's drive."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.chain_tables import ENGINE, LEVEL
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.drive import InverterDrive, TableDrive
from tractionpower.model.dynamics.case import CasePart, DynamicsScenario
from tractionpower.model.dynamics.gear import ElectricBrake, Traction
from tractionpower.model.vehicle import Vehicle

KMH = 3.6
"""km/h per m/s."""


class EngineTables(NamedTuple):
    """Engines of a train.

    Attributes
    ----------
    engines, levels
        Record arrays of ENGINE and LEVEL.
    rows
        Row of ENGINE of each vehicle from the front, -1: not powered.
    """

    engines: NDArray[np.void]
    levels: NDArray[np.void]
    rows: tuple[int, ...]


class Effort(NamedTuple):
    """Greatest steady effort of a traction, or None where neither the case nor the drive says it.

    Attributes
    ----------
    effort_n, power_w
        Starting effort [N] and power at the wheel [W].
    pull_out_w_mps
        Effort times the square of the speed above the pull-out speed [N m2/s2]; 0: none.
    points
        Points (speed [m/s], effort [N]) of each level instead, from level 1 on.
    """

    effort_n: float | None = None
    power_w: float | None = None
    pull_out_w_mps: float = 0.0
    points: tuple[tuple[tuple[float, float], ...], ...] = ()

    @property
    def known(self) -> bool:
        """Whether it can be computed."""
        return bool(self.points) or (self.effort_n is not None and self.power_w is not None)


def powered(scenario: DynamicsScenario) -> tuple[bool, ...]:
    """Return which vehicles from the front drive the train.

    Those whose drive works, or that have traction of their own; a locomotive without a drive takes the case's traction.
    """
    own = (part for part in scenario.case.vehicles for _ in range(part.count))
    return tuple(
        part.powered and _drives(scenario.vehicle(part.id), given, part) for given, part in zip(own, scenario.parts, strict=True)
    )


def _drives(vehicle: Vehicle, own: CasePart, part: CasePart) -> bool:
    if vehicle.drive is not None or own.traction is not None:
        return True
    return vehicle.kind == "locomotive" and part.traction is not None


def effort_of(traction: Traction, vehicle: Vehicle) -> Effort:
    """Return the steady effort of a traction in a vehicle: what the traction says, else what the vehicle's drive says.

    An inverter drive gives starting effort, power and pull-out; a table its curve of the highest voltage, scaled by the level.
    """
    if traction.effort:
        levels: dict[int, list[tuple[float, float]]] = defaultdict(list)
        for point in traction.effort:
            levels[point.level].append((point.speed_kmh / KMH, point.effort_kn * 1e3))
        return Effort(points=tuple(tuple(levels[level]) for level in range(1, traction.levels + 1)))
    effort_n = None if traction.starting_effort_kn is None else traction.starting_effort_kn * 1e3
    power_w = None if traction.power_kw is None else traction.power_kw * 1e3
    drive = vehicle.drive
    if isinstance(drive, InverterDrive):
        pull_out = 0.0
        if traction.power_kw is None and drive.pull_out_kmh is not None:
            pull_out = drive.power_kw * 1e3 * drive.pull_out_kmh / KMH
        effort_n = drive.starting_effort_kn * 1e3 if effort_n is None else effort_n
        return Effort(effort_n, drive.power_kw * 1e3 if power_w is None else power_w, pull_out)
    if isinstance(drive, TableDrive) and effort_n is None and power_w is None:
        top = _highest_voltage(drive)
        shares = (level / traction.levels for level in range(1, traction.levels + 1))
        return Effort(points=tuple(tuple((v, share * force) for v, force in top) for share in shares))
    return Effort(effort_n, power_w)


def _highest_voltage(drive: TableDrive) -> list[tuple[float, float]]:
    highest = max((point.voltage_v for point in drive.effort if point.voltage_v is not None), default=None)
    points = [point for point in drive.effort if point.voltage_v == highest]
    return sorted((point.speed_kmh / KMH, point.effort_kn * 1e3) for point in points)


def electric_brake_of(part: CasePart, vehicle: Vehicle) -> ElectricBrake | None:
    """Return the electric brake of a powered vehicle: that of the case, else the vehicle's own, None where it has none."""
    if part.electric_brake is not None:
        return part.electric_brake
    own = vehicle.brake
    if own.electric_effort_kn <= 0.0 or own.electric_power_kw <= 0.0:
        return None
    brake = ElectricBrake(effort_kn=own.electric_effort_kn, power_kw=own.electric_power_kw)
    return brake if own.electric_above_kmh <= 0.0 else brake.model_copy(update={"fades_below_kmh": own.electric_above_kmh})


def compile_engines(scenario: DynamicsScenario, curves: list[tuple[float, float]]) -> EngineTables:
    """Return the engines of a train, one row for each kind; points of levels are appended to `curves`.

    Parameters
    ----------
    scenario
        The case, without problems.
    curves
        Points of the chain's curves so far; levels add theirs, speed [m/s] and effort [N].
    """
    engines: list[tuple[float, ...]] = []
    levels: list[tuple[float, ...]] = []
    known: dict[tuple[str, Traction, ElectricBrake | None], int] = {}
    rows = []
    for part, drives in zip(scenario.parts, powered(scenario), strict=True):
        if not drives:
            rows.append(-1)
            continue
        vehicle, traction = scenario.vehicle(part.id), part.traction or Traction()
        electric = electric_brake_of(part, vehicle)
        key = (part.id, traction, electric)
        if key not in known:
            known[key] = len(engines)
            engines.append(_engine(traction, electric, vehicle, len(levels)))
            levels += _levels(traction, effort_of(traction, vehicle), curves)
        rows.append(known[key])
    return EngineTables(np.array(engines, ENGINE), np.array(levels, LEVEL), tuple(rows))


def _engine(traction: Traction, electric: ElectricBrake | None, vehicle: Vehicle, first_level: int) -> tuple[float, ...]:
    adhesive = np.inf
    if traction.adhesion and vehicle.adhesive_mass_t is not None:
        adhesive = vehicle.adhesive_mass_t * 1e3 * GRAVITY
    head = (first_level, traction.levels, traction.time_constant_s, adhesive)
    if electric is None:
        return (*head, 0.0, 0.0, 0.0, 0.0)
    return (
        *head,
        electric.effort_kn * 1e3,
        electric.power_kw * 1e3,
        electric.fades_below_kmh / KMH,
        electric.time_constant_s,
    )


def _levels(traction: Traction, effort: Effort, curves: list[tuple[float, float]]) -> Iterable[tuple[float, ...]]:
    for level in range(1, traction.levels + 1):
        share = level / traction.levels
        if effort.points:
            points = effort.points[level - 1]
            yield (0.0, 0.0, len(curves), len(points), 0.0)
            curves += points
            continue
        by_power = share if traction.law == "linear" else share * share
        yield (share * (effort.effort_n or 0.0), by_power * (effort.power_w or 0.0), 0, 0, by_power * effort.pull_out_w_mps)
