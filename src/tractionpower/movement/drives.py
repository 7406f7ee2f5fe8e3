"""Drives as rows of tables: effort limits of inverters, notches of series motors, curves of tables."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import CURVE, INVERTER, MOTOR_POINT, NO_DRIVE, NOTCH, POINT, SERIES_MOTORS, TABLE
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.drive import InverterDrive, SeriesMotorDrive, TableDrive
from tractionpower.model.limits import SystemVoltages
from tractionpower.movement.formation import KMH, Formation, brake_efficiency
from tractionpower.movement.pools import Pool

MOTOR_POINTS = 24
"""Points of a motor curve between zero and the set current."""

NO_LIMIT = 1e300
"""Stands for no limit in the tables; infinite would make NaN when multiplied by zero."""


Curve = Sequence[tuple[float, float]]
"""Points of a curve over speed [m/s]."""


class Limited(Protocol):
    """A drive whose current may be limited."""

    @property
    def max_current_a(self) -> float | None:
        """Largest current [A]."""

    @property
    def knee_factor(self) -> float | None:
        """Share of the nominal voltage below which the current is reduced."""


class DrivePools:
    """Pools that drives share."""

    def __init__(self) -> None:
        self.curves, self.notches = Pool(CURVE), Pool(NOTCH)
        self.motor, self.points = Pool(MOTOR_POINT), Pool(POINT)


def compile_drive(formation: Formation, voltages: SystemVoltages, knee: float, pools: DrivePools) -> dict[str, Any]:
    """Return the columns of TRAIN that come from the drive, and fill `pools`.

    Parameters
    ----------
    formation
        The train; its powered vehicles are equal.
    voltages
        Voltage limits of the system [V].
    knee
        Knee factor of inverter drives that give none.
    pools
        Receives curves, notches and points.
    """
    drive = formation.driver.drive if formation.driver is not None else None
    columns: dict[str, Any] = {"drive": NO_DRIVE, "efficiency": 1.0, "max_current_a": NO_LIMIT}
    columns |= {"adhesive_n": NO_LIMIT, "adhesion_b_mps": 1.0, "pull_out_w_mps": NO_LIMIT, "fold_from_v": NO_LIMIT}
    columns["fold_to_v"] = NO_LIMIT
    if formation.driver is None or drive is None:
        return columns
    columns |= _limits(drive, formation, voltages, None)
    if isinstance(drive, InverterDrive):
        columns |= _inverter(drive, formation, pools)
        columns |= _limits(drive, formation, voltages, drive.knee_factor if drive.knee_factor is not None else knee)
    elif isinstance(drive, SeriesMotorDrive):
        columns |= _series_motors(drive, formation, pools)
    else:
        columns |= _table(drive, formation, voltages, pools)
    return columns | _brake(formation, voltages)


def _limits(drive: Limited, formation: Formation, voltages: SystemVoltages, knee: float | None) -> dict[str, Any]:
    """Return the current limit; without one that of an inverter drive is what its full power takes at the knee."""
    knee = drive.knee_factor if knee is None else knee
    if drive.max_current_a is not None:
        limit = drive.max_current_a * formation.units
    elif isinstance(drive, InverterDrive) and knee is not None:
        volts = knee * voltages.u_n
        power = drive.power_kw * 1e3 * formation.units / _least_efficiency(drive) + formation.auxiliary_w
        limit = power / volts + formation.heating_w * volts / voltages.u_n**2
    else:
        limit = NO_LIMIT
    reduced = knee is not None and limit < NO_LIMIT
    return {"max_current_a": limit, "knee_v": knee * voltages.u_n if reduced and knee is not None else 0.0}


def _least_efficiency(drive: InverterDrive) -> float:
    return drive.efficiency if drive.efficiency is not None else min(point.efficiency for point in drive.efficiency_map)


def _brake(formation: Formation, voltages: SystemVoltages) -> dict[str, Any]:
    vehicle, n = formation.driver, formation.units
    assert vehicle is not None
    assert vehicle.drive is not None
    brake, adhesion, drive = vehicle.brake, vehicle.adhesion, vehicle.drive
    feeds_back = not isinstance(drive, SeriesMotorDrive)
    columns: dict[str, Any] = {
        "brake_n": brake.electric_effort_kn * 1e3 * n,
        "brake_w": brake.electric_power_kw * 1e3 * n,
        "brake_from_mps": brake.electric_above_kmh / KMH,
        "brake_efficiency": brake_efficiency(vehicle),
        "regenerates": feeds_back if brake.regenerates is None else brake.regenerates,
        "rheostat_w": brake.rheostat_kw * 1e3 * n,
        "adhesion_a_mps": adhesion.a_kmh / KMH,
        "adhesion_b_mps": adhesion.b_kmh / KMH,
        "adhesion_c": adhesion.c,
        "fold_from_v": voltages.u_max1,
        "fold_to_v": voltages.u_max2,
    }
    for name in ("fold_from_v", "fold_to_v"):
        given = getattr(drive, name.replace("fold_", "fold_back_"), None)
        if given is not None:
            columns[name] = given
    if vehicle.adhesive_mass_t is not None:
        from_kg = vehicle.adhesive_mass_t * 1e3 * n
        columns["adhesive_n"] = from_kg * GRAVITY
    return columns


def _inverter(drive: InverterDrive, formation: Formation, pools: DrivePools) -> dict[str, Any]:
    n = formation.units
    start, power = drive.starting_effort_kn * 1e3 * n, drive.power_kw * 1e3 * n
    columns: dict[str, Any] = {"drive": INVERTER, "start_n": start}
    if drive.power_over_voltage:
        rows = [(point.voltage_v, point.power_kw * 1e3 * n) for point in drive.power_over_voltage]
        power = max(watts for _, watts in rows)
        columns["first_power"], columns["powers"] = pools.points.add(rows)
    columns["power_w"] = power
    if drive.pull_out_kmh is not None:
        v = drive.pull_out_kmh / KMH
        columns["pull_out_w_mps"] = min(start, power / v) * v**2
    if drive.efficiency is not None:
        return columns | {"efficiency": drive.efficiency}
    by_load: dict[float, list[tuple[float, float]]] = defaultdict(list)
    for point in drive.efficiency_map:
        by_load[point.load_percent / 100.0].append((point.speed_kmh / KMH, point.efficiency))
    firsts = [(load, float(pools.points.add(sorted(by_load[load]))[0])) for load in sorted(by_load)]
    first, loads = pools.points.add(firsts)
    speeds = len(next(iter(by_load.values())))
    mean = sum(point.efficiency for point in drive.efficiency_map) / len(drive.efficiency_map)
    return columns | {"efficiency": mean, "first_map": first, "map_loads": loads, "map_speeds": speeds}


def _series_motors(drive: SeriesMotorDrive, formation: Formation, pools: DrivePools) -> dict[str, Any]:
    n = formation.units
    per_m = drive.gear_ratio / (np.pi * drive.wheel_diameter_m)  # revolutions of the motor per metre
    currents = np.array([0.0, *(point.current_a for point in drive.magnetisation)])
    constants = np.array([0.0, *(point.emf_vs_per_rev for point in drive.magnetisation)])
    rows = []
    most = 0.0
    for grouping in drive.groupings:
        set_a = grouping.starting_current_a if grouping.starting_current_a is not None else drive.starting_current_a
        for step, share in enumerate(drive.field_steps_percent):
            amps = np.linspace(0.0, set_a, MOTOR_POINTS + 1)
            emf = np.interp(share / 100.0 * amps, currents, constants) * per_m
            effort = drive.motors * n * drive.gear_efficiency * emf * amps
            first, count = pools.motor.add(list(zip(amps.tolist(), emf.tolist(), effort.tolist(), strict=True)))
            branches = drive.motors // grouping.series * n
            rows.append((grouping.series, branches, set_a, drive.motor_resistance_ohm, step == 0, first, count))
            most = max(most, float(effort[-1]))
    first, count = pools.notches.add(rows)
    columns: dict[str, Any] = {"drive": SERIES_MOTORS, "start_n": most, "first_notch": first, "notches": count}
    columns["notch_s"] = drive.notch_time_s
    if drive.relay is not None:
        columns |= {"relay_off_v": drive.relay.off_v, "relay_on_v": drive.relay.on_v, "relay_s": drive.relay.delay_s}
    return columns


def _table(drive: TableDrive, formation: Formation, voltages: SystemVoltages, pools: DrivePools) -> dict[str, Any]:
    efforts = _by_voltage(((p.voltage_v, p.speed_kmh, p.effort_kn * 1e3) for p in drive.effort), voltages.u_n, formation.units)
    currents = _by_voltage(((p.voltage_v, p.speed_kmh, p.current_a) for p in drive.current), voltages.u_n, formation.units)
    rows = []
    for volts in sorted(efforts):
        first_effort, count = pools.points.add(efforts[volts])
        first_loss, also = pools.points.add(_losses(volts, efforts[volts], currents[volts]))
        rows.append((volts, first_effort, count, first_loss, also))
    first, count = pools.curves.add(rows)
    start = max(effort for points in efforts.values() for _, effort in points)
    return {"drive": TABLE, "start_n": start, "first_curve": first, "curves": count}


def _losses(volts: float, efforts: Curve, currents: Curve) -> Curve:
    """Return losses [W] at all speeds of two curves; straight between them, so that no power comes out of nothing."""
    effort, current = np.array(efforts).T, np.array(currents).T
    speeds = np.union1d(effort[0], current[0])
    lost = volts * np.interp(speeds, current[0], current[1]) - np.interp(speeds, effort[0], effort[1]) * speeds
    return list(zip(speeds.tolist(), lost.tolist(), strict=True))


def _by_voltage(points: Iterable[tuple[float | None, float, float]], nominal_v: float, units: int) -> dict[float, Curve]:
    """Return the curves over speed [m/s] by voltage; points without one hold at nominal voltage."""
    found: dict[float, list[tuple[float, float]]] = defaultdict(list)
    for volts, kmh, value in points:
        found[nominal_v if volts is None else volts].append((kmh / KMH, value * units))
    return {volts: sorted(curve) for volts, curve in found.items()}


def pool_arrays(pools: DrivePools) -> dict[str, NDArray[np.void]]:
    """Return the filled pools by the names of `TrainTables`."""
    return {name: getattr(pools, name).array() for name in ("curves", "notches", "motor", "points")}
