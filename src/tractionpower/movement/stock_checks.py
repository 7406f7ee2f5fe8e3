"""Checks of vehicles and trains: curves that turn back, drives that do not fit together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from tractionpower.errors import Problem, Severity
from tractionpower.model.drive import CurrentPoint, Drive, EffortPoint, InverterDrive, SeriesMotorDrive, TableDrive
from tractionpower.model.limits import SystemVoltages
from tractionpower.model.vehicle import Part, Resistance, Vehicle
from tractionpower.movement.formation import KMH, is_powered


def check_vehicle(vehicle: Vehicle, voltages: SystemVoltages) -> list[Problem]:
    """Return everything that is wrong or doubtful with a vehicle under a system of `voltages`."""
    path = f"vehicles[{vehicle.id}]"
    problems = _check_fold_back(f"{path}.drive", vehicle.drive, voltages)
    if vehicle.resistance == Resistance():
        found = "the vehicle has no running resistance"
        problems.append(_doubt("no_resistance", f"{path}.resistance", found, "give a_n and more"))
    drive = vehicle.drive
    if isinstance(drive, InverterDrive):
        problems += _check_inverter(f"{path}.drive", drive)
    elif isinstance(drive, SeriesMotorDrive):
        problems += _check_series_motors(f"{path}.drive", drive, voltages)
    elif isinstance(drive, TableDrive):
        problems += _check_table(f"{path}.drive", drive, voltages)
    elif vehicle.brake.electric_effort_kn > 0.0:
        found = f"{vehicle.brake.electric_effort_kn:g} kN on a vehicle without a drive"
        problems.append(Problem("brake_without_drive", f"{path}.brake.electric_effort_kn", found, "0"))
    if vehicle.brake.electric_effort_kn > 0.0 and vehicle.brake.electric_power_kw == 0.0:
        found = "an electric brake without power gives nothing"
        problems.append(_doubt("brake_without_power", f"{path}.brake.electric_power_kw", found, "give its power"))
    return problems


def check_train(path: str, parts: Sequence[Part], vehicles: Mapping[str, Vehicle]) -> list[Problem]:
    """Return what is wrong with the vehicles of a train, which stand at `path` of the model."""
    problems = [
        Problem("unknown_vehicle", f"{path}[{k}].id", repr(part.id), ", ".join(sorted(vehicles)), "name a vehicle that exists")
        for k, part in enumerate(parts)
        if part.id not in vehicles
    ]
    kinds = sorted({part.id for part in parts if part.id in vehicles and is_powered(part, vehicles[part.id])})
    if len(kinds) > 1:
        found = f"powered vehicles of {len(kinds)} kinds: {', '.join(kinds)}"
        remedy = "set `powered: false` for those that are hauled; different drives in one train cannot be computed yet"
        problems.append(Problem("mixed_drives", path, found, "one kind of powered vehicle", remedy))
    return problems


def _doubt(code: str, path: str, found: str, remedy: str = "") -> Problem:
    severity: Severity = "warning"
    return Problem(code, path, found, remedy=remedy, severity=severity)


def _check_falls(path: str, name: str, values: Sequence[float]) -> list[Problem]:
    """Return a problem for each value that is below the one before."""
    return [
        Problem(
            "non_monotone_curve",
            f"{path}[{k}].{name}",
            f"{after:g} behind {before:g}",
            f"at least {before:g}",
            "correct one of them",
        )
        for k, (before, after) in enumerate(pairwise(values), start=1)
        if after < before
    ]


def _check_fold_back(path: str, drive: Drive | None, voltages: SystemVoltages) -> list[Problem]:
    if not isinstance(drive, InverterDrive | TableDrive):
        return []
    start = drive.fold_back_from_v if drive.fold_back_from_v is not None else voltages.u_max1
    end = drive.fold_back_to_v if drive.fold_back_to_v is not None else voltages.u_max2
    if start < end:
        return []
    found = f"feeding back ends at {end:g} V and begins to fold back at {start:g} V"
    return [Problem("fold_back", f"{path}.fold_back_from_v", found, f"below {end:g} V", "correct one of them")]


def _check_inverter(path: str, drive: InverterDrive) -> list[Problem]:
    table = f"{path}.power_over_voltage"
    problems = _check_falls(table, "power_kw", [point.power_kw for point in drive.power_over_voltage])
    by_load: dict[float, list[float]] = defaultdict(list)
    for point in drive.efficiency_map:
        by_load[point.load_percent].append(point.speed_kmh)
    grids = {tuple(sorted(speeds)) for speeds in by_load.values()}
    twice = any(len(set(speeds)) < len(speeds) for speeds in by_load.values())
    if len(grids) > 1 or twice:
        found = "not every load has a point at each of the same speeds"
        remedy = "give one efficiency for each pair of speed and load"
        problems.append(Problem("efficiency_map", f"{path}.efficiency_map", found, "a full grid", remedy))
    return problems


def _check_series_motors(path: str, drive: SeriesMotorDrive, voltages: SystemVoltages) -> list[Problem]:
    problems = []
    for k, grouping in enumerate(drive.groupings):
        if grouping.series * grouping.parallel != drive.motors:
            found = f"{grouping.series} in series in {grouping.parallel} branches"
            allowed = f"a product of {drive.motors}, the number of motors"
            problems.append(Problem("grouping", f"{path}.groupings[{k}]", found, allowed, "correct motors or the grouping"))
    for k, (before, after) in enumerate(pairwise(drive.groupings), start=1):
        if after.series >= before.series:
            found = f"{after.series} in series behind {before.series}"
            remedy = "put the grouping with most motors in series first"
            problems.append(Problem("grouping_order", f"{path}.groupings[{k}].series", found, f"below {before.series}", remedy))
    curve = f"{path}.magnetisation"
    problems += _check_falls(curve, "emf_vs_per_rev", [point.emf_vs_per_rev for point in drive.magnetisation])
    first = drive.field_steps_percent[0]
    if first != 100.0:
        where = f"{path}.field_steps_percent[0]"
        problems.append(Problem("field_steps", where, f"{first:g} %", "100 %, the full field", "put 100 first"))
    most = max([drive.starting_current_a, *(g.starting_current_a or 0.0 for g in drive.groupings)])
    last = max(point.current_a for point in drive.magnetisation)
    if most > last:
        found = f"the curve ends at {last:g} A, motors take up to {most:g} A"
        problems.append(_doubt("short_curve", curve, found, "add points; beyond the last one the motors count as saturated"))
    return problems + _check_resistors(f"{path}.starting_resistors_ohm", drive, voltages.u_n)


def _check_resistors(path: str, drive: SeriesMotorDrive, nominal_v: float) -> list[Problem]:
    given = drive.starting_resistors_ohm
    if given is None:
        return []
    places = {"series": 0, "series_parallel": 1, "parallel": len(drive.groupings) - 1}
    problems = []
    for name, index in places.items():
        notches: tuple[float, ...] = getattr(given, name)
        exists = index < len(drive.groupings) and not (name == "series_parallel" and len(drive.groupings) < 3)
        if notches and not exists:
            problems.append(Problem("starting_resistors", f"{path}.{name}", "notches of a grouping that does not exist"))
        if not notches or not exists:
            continue
        rising = [k for k, (before, after) in enumerate(pairwise(notches), start=1) if after > before or after < 0.0]
        if rising or notches[-1] != 0.0:
            found = f"notch {rising[0] + 1} has more than the one before" if rising else f"the last notch has {notches[-1]:g} ohm"
            problems.append(Problem("starting_resistors", f"{path}.{name}", found, "falling values, the last one 0"))
        if index == 0:
            problems += _check_first_notch(f"{path}.{name}", drive, notches, nominal_v)
    return problems


def _check_first_notch(path: str, drive: SeriesMotorDrive, notches: Sequence[float], nominal_v: float) -> list[Problem]:
    """Return a warning if the first notch at standstill takes more than the current that is held."""
    grouping = drive.groupings[0]
    held = grouping.starting_current_a or drive.starting_current_a
    ohm = notches[0] + grouping.series * drive.motor_resistance_ohm
    if ohm > 0.0 and nominal_v / ohm <= held:
        return []
    found = f"the first notch takes {nominal_v / ohm:.0f} A at standstill" if ohm > 0.0 else "the first notch has no resistance"
    return [_doubt("first_notch", f"{path}[0]", found, f"the motors are held at {held:g} A")]


def _check_table(path: str, drive: TableDrive, voltages: SystemVoltages) -> list[Problem]:
    efforts, currents = _curves(drive.effort), _curves(drive.current)
    problems = []
    for name, curves in (("effort", efforts), ("current", currents)):
        if None in curves and len(curves) > 1:
            found = "points with a voltage and points without one"
            problems.append(Problem("table_voltages", f"{path}.{name}", found, "voltage_v in all points, or in none"))
        for volts, points in curves.items():
            where = "" if volts is None else f" at {volts:g} V"
            if len(points) < 2 or len({speed for speed, _ in points}) < len(points):
                found = f"the curve{where} has a speed twice or one point only"
                problems.append(Problem("table_curve", f"{path}.{name}", found, "two or more points of different speed"))
    if set(efforts) != set(currents):
        found = f"efforts at {_volts(efforts)}, currents at {_volts(currents)}"
        problems.append(Problem("table_voltages", path, found, "the same voltages in both", "add the missing curve"))
    return problems or _check_table_power(path, drive, currents, voltages.u_n)


def _check_table_power(
    path: str, drive: TableDrive, currents: Mapping[float | None, list[tuple[float, float]]], nominal_v: float
) -> list[Problem]:
    """Return a problem for the first point that gives more power at the wheel than it takes from the line."""
    for k, point in enumerate(drive.effort):
        volts = nominal_v if point.voltage_v is None else point.voltage_v
        wheel_kw = point.effort_kn * point.speed_kmh / KMH
        line_kw = volts * _between(sorted(currents[point.voltage_v]), point.speed_kmh) / 1e3
        if wheel_kw > line_kw * (1.0 + 1e-6):
            found = f"{wheel_kw:.0f} kW at the wheel from {line_kw:.0f} kW of the line at {point.speed_kmh:g} km/h"
            remedy = "correct effort or current"
            return [Problem("table_power", f"{path}.effort[{k}]", found, "less than the line gives", remedy)]
    return []


def _curves(points: Iterable[EffortPoint | CurrentPoint]) -> dict[float | None, list[tuple[float, float]]]:
    curves: dict[float | None, list[tuple[float, float]]] = defaultdict(list)
    for point in points:
        value = point.effort_kn if isinstance(point, EffortPoint) else point.current_a
        curves[point.voltage_v].append((point.speed_kmh, value))
    return dict(curves)


def _volts(curves: Iterable[float | None]) -> str:
    return ", ".join("any voltage" if volts is None else f"{volts:g} V" for volts in curves)


def _between(points: Sequence[tuple[float, float]], x: float) -> float:
    """Return the value at `x` of a curve by points, constant beyond its ends."""
    if x <= points[0][0]:
        return points[0][1]
    for (x0, y0), (x1, y1) in pairwise(points):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return points[-1][1]
