"""Checks of drives: curves that turn back, groupings and resistors that do not fit, tables that make power."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tractionpower.errors import Problem
from tractionpower.model.drive import Drive, InverterDrive, Relay, SeriesMotorDrive, TableDrive
from tractionpower.model.limits import SystemVoltages
from tractionpower.movement.formation import KMH
from tractionpower.movement.telling import doubt, listed

_ROUNDING = 1e-6

LOWEST_KNEE = 1.05
"""Voltage over U_min2 at which the knee must at least lie: nearer the current would fall in one leap."""


def check_drive(path: str, drive: Drive, voltages: SystemVoltages | None) -> list[Problem]:
    """Return everything that is wrong or doubtful with a drive, which stands at `path` of the model.

    Without `voltages`, the limits of the system, what depends on them is left out.
    """
    knee = check_knee(f"{path}.knee_factor", drive.knee_factor, voltages)
    if isinstance(drive, SeriesMotorDrive):
        problems = knee + _check_series_motors(path, drive)
        problems += _check_resistors(f"{path}.starting_resistors_ohm", drive, voltages)
        return problems + _check_relay(f"{path}.relay.on_v", drive.relay, voltages)
    problems = knee + _check_fold_back(path, drive, voltages)
    return problems + (_check_inverter(path, drive) if isinstance(drive, InverterDrive) else _check_table(path, drive, voltages))


def check_knee(path: str, factor: float | None, voltages: SystemVoltages | None) -> list[Problem]:
    """Return an error if the knee is not clear of U_min2, where the current has fallen to that of the auxiliaries."""
    if factor is None or voltages is None or factor * voltages.u_n > LOWEST_KNEE * voltages.u_min2:
        return []
    found = f"{factor:g}, a knee at {factor * voltages.u_n:g} V"
    least = LOWEST_KNEE * voltages.u_min2
    allowed = f"above {least:g} V, {LOWEST_KNEE:g} of U_min2 = {voltages.u_min2:g} V"
    if 0.0 < least < voltages.u_n:
        allowed += f": above {least / voltages.u_n:.4g}"
    return [Problem("low_knee", path, found, allowed, "raise it, or leave it out")]


def _check_falls(path: str, name: str, values: Sequence[float]) -> list[Problem]:
    """Return a problem for each value that is below the one before."""
    remedy = "correct one of them"
    return [
        Problem("non_monotone_curve", f"{path}[{k}].{name}", f"{after:g} behind {before:g}", f"at least {before:g}", remedy)
        for k, (before, after) in enumerate(pairwise(values), start=1)
        if after < before
    ]


# --- inverter drives ---------------------------------------------------------------------------------------------


def _check_fold_back(path: str, drive: InverterDrive | TableDrive, voltages: SystemVoltages | None) -> list[Problem]:
    start, end = drive.fold_back_from_v, drive.fold_back_to_v
    given = "fold_back_from_v" if start is not None else "fold_back_to_v"
    if voltages is not None:
        start = voltages.u_max1 if start is None else start
        end = voltages.u_max2 if end is None else end
    if (drive.fold_back_from_v is None and drive.fold_back_to_v is None) or start is None or end is None or start < end:
        return []
    from_, to = ("" if own is not None else " by default" for own in (drive.fold_back_from_v, drive.fold_back_to_v))
    found = f"a fold-back from {start:g} V{from_} to {end:g} V{to}"
    allowed = f"fold_back_from_v below {end:g} V" if given == "fold_back_from_v" else f"fold_back_to_v above {start:g} V"
    return [Problem("fold_back", f"{path}.{given}", found, allowed, "correct one of them")]


def _check_inverter(path: str, drive: InverterDrive) -> list[Problem]:
    table = f"{path}.power_over_voltage"
    problems = _check_falls(table, "power_kw", [point.power_kw for point in drive.power_over_voltage])
    by_load: dict[float, list[float]] = defaultdict(list)
    for point in drive.efficiency_map:
        by_load[point.load_percent].append(point.speed_kmh)
    speeds = sorted({speed for row in by_load.values() for speed in row})
    for load, row in sorted(by_load.items()):
        missing = [f"{speed:g}" for speed in speeds if speed not in row]
        twice = [f"{speed:g}" for speed in speeds if row.count(speed) > 1]
        if missing or twice:
            texts = [f"no point at {listed(missing)} km/h"] * bool(missing) + [f"several at {listed(twice)} km/h"] * bool(twice)
            found = f"the load of {load:g} % has {' and '.join(texts)}"
            allowed = "a full grid: every load at each of the same speeds"
            remedy = "give one efficiency for each pair of speed and load"
            problems.append(Problem("efficiency_map", f"{path}.efficiency_map", found, allowed, remedy))
    return problems


# --- series motors -----------------------------------------------------------------------------------------------


def _check_series_motors(path: str, drive: SeriesMotorDrive) -> list[Problem]:
    problems = []
    for k, grouping in enumerate(drive.groupings):
        if grouping.series * grouping.parallel != drive.motors:
            found = f"{grouping.series} in series in {grouping.parallel} branch{'es' * (grouping.parallel > 1)}"
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
        where, found = f"{path}.field_steps_percent[0]", f"{first:g} % as the first field step"
        problems.append(Problem("field_steps", where, found, "100 %, the full field", "put 100 first"))
    most = max(_held_a(drive, k) for k in range(len(drive.groupings)))
    last = drive.magnetisation[-1].current_a
    if most > last:
        found = f"the curve ends at {last:g} A, motors take up to {most:g} A"
        problems.append(doubt("short_curve", curve, found, remedy="add points; beyond the last one they count as saturated"))
    return problems


def _held_a(drive: SeriesMotorDrive, k: int) -> float:
    own = drive.groupings[k].starting_current_a
    return drive.starting_current_a if own is None else own


def _check_resistors(path: str, drive: SeriesMotorDrive, voltages: SystemVoltages | None) -> list[Problem]:
    given = drive.starting_resistors_ohm
    if given is None:
        return []
    count = len(drive.groupings)
    exists = {"series": True, "series_parallel": count > 2, "parallel": count > 1}
    named = [name for name, is_there in exists.items() if is_there]
    problems: list[Problem] = []
    for name, is_there in exists.items():
        notches: tuple[float, ...] = getattr(given, name)
        if notches and not is_there:
            found = f"{len(notches)} notch{'es' * (len(notches) > 1)} of a grouping that does not exist"
            remedy = "leave them out, or add the grouping"
            problems.append(Problem("starting_resistors", f"{path}.{name}", found, f"only {' and '.join(named)}", remedy))
        elif notches:
            problems += _check_notches(f"{path}.{name}", notches)
    if given.series and voltages is not None:
        problems += _check_first_notch(f"{path}.series[0]", drive, given.series[0], voltages.u_n)
    return problems


def _check_notches(path: str, notches: Sequence[float]) -> list[Problem]:
    remedy = "give the resistance of one branch notch by notch, from the first to none"
    rising = [k for k, (before, after) in enumerate(pairwise(notches), start=1) if after > before]
    if rising:
        k = rising[0]
        found = f"{notches[k]:g} ohm behind {notches[k - 1]:g} ohm"
        return [Problem("starting_resistors", f"{path}[{k}]", found, f"at most {notches[k - 1]:g} ohm", remedy)]
    if notches[-1] != 0.0:
        where, found = f"{path}[{len(notches) - 1}]", f"{notches[-1]:g} ohm at the last notch"
        return [Problem("starting_resistors", where, found, "0, no resistance", remedy)]
    return []


def _check_first_notch(path: str, drive: SeriesMotorDrive, first_ohm: float, nominal_v: float) -> list[Problem]:
    """Return a warning if the first notch at standstill takes more than the current that is held, I = U / (R + k R_m)."""
    held = _held_a(drive, 0)
    ohm = first_ohm + drive.groupings[0].series * drive.motor_resistance_ohm
    if nominal_v <= held * ohm * (1.0 + _ROUNDING):
        return []
    takes = f"takes {nominal_v / ohm:.0f} A at standstill and {nominal_v:g} V" if ohm > 0.0 else "has no resistance"
    found = f"the first notch {takes}, the motors are held at {held:g} A"
    return [doubt("first_notch", path, found, remedy="a greater first resistance, or a greater starting_current_a")]


def _check_relay(path: str, relay: Relay | None, voltages: SystemVoltages | None) -> list[Problem]:
    if relay is None or voltages is None or relay.on_v < voltages.u_n:
        return []
    found = f"{relay.on_v:g} V: once open, the relay leaves the motors off at nominal voltage and below"
    return [doubt("relay_never_closes", path, found, f"below U_n = {voltages.u_n:g} V", "lower it")]


# --- tables ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _TablePoint:
    row: int
    kmh: float
    value: float


_Curves = Mapping[float | None, Sequence[_TablePoint]]


def _check_table(path: str, drive: TableDrive, voltages: SystemVoltages | None) -> list[Problem]:
    efforts = _curves((p.voltage_v, _TablePoint(k, p.speed_kmh, p.effort_kn)) for k, p in enumerate(drive.effort))
    currents = _curves((p.voltage_v, _TablePoint(k, p.speed_kmh, p.current_a)) for k, p in enumerate(drive.current))
    problems = _check_points(f"{path}.effort", efforts) + _check_points(f"{path}.current", currents)
    if set(efforts) != set(currents):
        found = f"efforts at {_volts(efforts)}, currents at {_volts(currents)}"
        problems.append(Problem("table_voltages", path, found, "the same voltages in both", "add the missing curve"))
    if problems:
        return problems
    nominal_v = None if voltages is None else voltages.u_n
    problems = _check_table_power(f"{path}.effort", efforts, currents, nominal_v)
    return problems + _check_table_falls(f"{path}.effort", efforts)


def _check_points(path: str, curves: _Curves) -> list[Problem]:
    problems = []
    if None in curves and len(curves) > 1:
        found, remedy = "points with a voltage and points without one", "complete them"
        problems.append(Problem("table_voltages", path, found, "voltage_v in all points, or in none", remedy))
    for volts, points in curves.items():
        where = "" if volts is None else f" at {volts:g} V"
        allowed, remedy = "two or more points of different speed", "correct or add points"
        twice = [point for before, point in pairwise(points) if point.kmh == before.kmh]
        if twice:
            found = f"the curve{where} has two points at {twice[0].kmh:g} km/h"
            problems.append(Problem("table_curve", f"{path}[{twice[0].row}].speed_kmh", found, allowed, remedy))
        elif len(points) < 2:
            found = f"the curve{where} has one point only"
            problems.append(Problem("table_curve", f"{path}[{points[0].row}]", found, allowed, remedy))
    return problems


def _check_table_power(path: str, efforts: _Curves, currents: _Curves, nominal_v: float | None) -> list[Problem]:
    """Return a problem for the first speed of each curve with more power at the wheel than comes from the line."""
    problems = []
    for volts, points in efforts.items():
        line_v = nominal_v if volts is None else volts
        if line_v is None:
            continue
        kmh = np.union1d([p.kmh for p in points], [p.kmh for p in currents[volts]])
        wheel_kw = _at(points, kmh) * kmh / KMH
        line_kw = line_v * _at(currents[volts], kmh) / 1e3
        made = np.flatnonzero(wheel_kw > line_kw * (1.0 + _ROUNDING) + _ROUNDING)
        if len(made):
            k = int(made[0])
            near = min(points, key=lambda p: abs(p.kmh - kmh[k]))
            found = f"{wheel_kw[k]:.0f} kW at the wheel from {line_kw[k]:.0f} kW of the line at {kmh[k]:g} km/h and {line_v:g} V"
            allowed, remedy = "no more than the line gives", "correct effort or current"
            problems.append(Problem("table_power", f"{path}[{near.row}]", found, allowed, remedy))
    return problems


def _check_table_falls(path: str, efforts: _Curves) -> list[Problem]:
    """Return a warning for the first point of each curve whose effort is greater than that of a lower speed."""
    problems = []
    for points in efforts.values():
        for before, after in pairwise(points):
            if after.value > before.value:
                found = (
                    f"{after.value:g} kN at {after.kmh:g} km/h, {before.value:g} kN at {before.kmh:g} km/h: rising with the speed"
                )
                where = f"{path}[{after.row}].effort_kn"
                problems.append(doubt("rising_effort", where, found, f"up to {before.value:g} kN", "correct one of them"))
                break
    return problems


def _curves(points: Iterable[tuple[float | None, _TablePoint]]) -> dict[float | None, list[_TablePoint]]:
    """Return the points by voltage, each curve by rising speed."""
    curves: dict[float | None, list[_TablePoint]] = defaultdict(list)
    for volts, point in points:
        curves[volts].append(point)
    return {volts: sorted(curve, key=lambda point: point.kmh) for volts, curve in curves.items()}


def _at(
    points: Sequence[_TablePoint], kmh: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the values of a curve by points at speeds, constant beyond its ends."""
    return np.asarray(np.interp(kmh, [point.kmh for point in points], [point.value for point in points]))


def _volts(curves: Iterable[float | None]) -> str:
    return ", ".join("any voltage" if volts is None else f"{volts:g} V" for volts in curves)
