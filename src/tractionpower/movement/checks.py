"""Checks of the timetable against line and rolling stock: routes, calls, times, and what a train can climb."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.checks import Axes, check_ids
from tractionpower.alignment.intervals import name_km
from tractionpower.alignment.path import compile_path
from tractionpower.alignment.routes import check_route, check_speed_limits
from tractionpower.errors import Problem, Severity
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.base import format_time
from tractionpower.model.drive import InverterDrive, SeriesMotorDrive, TableDrive
from tractionpower.model.limits import VOLTAGE_NAMES, find_limit, system_voltages
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import Call, TrainRun
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.compile import PlannedRun, ceiling_of, plan_run, train_of
from tractionpower.movement.formation import KMH, Formation, form
from tractionpower.movement.stock_checks import check_train, check_vehicle

_TOO_FAST_MPS = 1e-6


def check_movement(scenario: Scenario) -> list[Problem]:
    """Return everything that is wrong or doubtful with vehicles, trains and the timetable of a scenario.

    The line's own faults are told by `alignment.checks.check_line`, a lack of voltage limits by `supply.checks`.
    """
    problems = check_ids("timetable.trains", [run.id for run in scenario.timetable.trains])
    problems += check_ids("trains", [train.id for train in scenario.trains])
    problems += check_ids("vehicles", [vehicle.id for vehicle in scenario.vehicles])
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    system = scenario.supply.system
    if all(find_limit(scenario.limits, system, name) is not None for name in VOLTAGE_NAMES):
        voltages = system_voltages(scenario.limits, system)
        for vehicle in scenario.vehicles:
            problems += check_vehicle(vehicle, voltages)
    for train in scenario.trains:
        problems += check_train(f"trains[{train.id}].vehicles", train.vehicles, vehicles)
    site = _Site(scenario, vehicles, {train.id: train for train in scenario.trains}, compile_axes(scenario.line))
    for run in scenario.timetable.trains:
        problems += _check_run(run, site)
    return problems + _check_power_off(scenario)


@dataclass(frozen=True, slots=True)
class _Site:
    scenario: Scenario
    vehicles: Mapping[str, Vehicle]
    trains: Mapping[str, Train]
    axes: Axes


def _check_run(run: TrainRun, site: _Site) -> list[Problem]:
    path = f"timetable.trains[{run.id}]"
    problems = check_train(f"{path}.vehicles", run.vehicles, site.vehicles)
    if run.train is not None and run.train not in site.trains:
        known = ", ".join(sorted(site.trains))
        problems.append(Problem("unknown_train", f"{path}.train", repr(run.train), known, "name a train that exists"))
    stations = {station.id for station in site.scenario.line.stations}
    for k, call in enumerate(run.calls):
        if call.station not in stations:
            known = ", ".join(sorted(stations)) or "the line has no stations"
            where = f"{path}.calls[{k}].station"
            problems.append(Problem("unknown_station", where, repr(call.station), known, "name a station of the line"))
    problems += _check_times(path, run)
    route = check_route(f"{path}.route", run.route, site.scenario.line, site.axes)
    problems += route
    if any(problem.severity == "error" for problem in problems) or _has_faulty_vehicles(run, site):
        return problems
    train = train_of(run, site.scenario.trains)
    return problems + _check_planned(path, run, train, form(train, site.vehicles), site)


def _has_faulty_vehicles(run: TrainRun, site: _Site) -> bool:
    parts = run.vehicles if run.train is None else site.trains[run.train].vehicles
    return bool(check_train("", parts, site.vehicles))


def _check_planned(path: str, run: TrainRun, train: Train, formation: Formation, site: _Site) -> list[Problem]:
    line = site.scenario.line
    category = run.category if run.category is not None else train.category
    route = compile_path(line, site.axes, run.route, category, formation.length_m)
    planned = plan_run(run, train, formation, route, line)
    problems = check_speed_limits(f"{path}.route", route)
    placed = len(planned.calls)
    if placed < len(run.calls):
        call = run.calls[placed]
        found = f"the route does not come to {call.station}" + (f" behind {run.calls[placed - 1].station}" if placed else "")
        remedy = "correct the route, the order of the calls or the tracks of the station"
        return [*problems, Problem("off_route", f"{path}.calls[{placed}].station", found, remedy=remedy)]
    if problems:
        return problems
    return [*_check_start(path, planned), *_check_climb(path, planned)]


def _check_times(path: str, run: TrainRun) -> Iterator[Problem]:
    """Yield times of a run that go backwards, and departures before the shortest dwell is over."""
    last, where = (run.start.time, "start") if run.start is not None else (None, "")
    for k, call in enumerate(run.calls):
        for name in ("arrival", "departure"):
            time = getattr(call, name)
            if time is None:
                continue
            if last is not None and time < last:
                found = f"{format_time(time)}, before {format_time(last)} of {where}"
                yield Problem("times_backwards", f"{path}.calls[{k}].{name}", found, f"at least {format_time(last)}")
            last, where = time, f"{name} at {call.station}"
        yield from _check_dwell(f"{path}.calls[{k}]", call)


def _check_dwell(path: str, call: Call) -> Iterator[Problem]:
    if not call.stops and call.min_dwell_s > 0.0:
        found = f"{call.min_dwell_s:g} s at a station that the train passes"
        yield Problem("dwell_of_passing", f"{path}.min_dwell_s", found, "0, or stops: true")
    if call.arrival is not None and call.departure is not None and call.departure - call.arrival < call.min_dwell_s:
        found = f"{call.departure - call.arrival:g} s planned, min_dwell_s is {call.min_dwell_s:g} s: the train leaves late"
        yield Problem("short_dwell", f"{path}.departure", found, severity="warning")


def _check_start(path: str, planned: PlannedRun) -> Iterator[Problem]:
    ceiling = float(np.sqrt(max(ceiling_of(planned)["w"][0], 0.0)))
    if planned.start_mps > ceiling + _TOO_FAST_MPS:
        found = f"{planned.start_mps * KMH:g} km/h, faster than it may run there"
        allowed = f"at most {np.floor(ceiling * KMH * 1e6) / 1e6:g} km/h"
        yield Problem("start_too_fast", f"{path}.start.speed_kmh", found, allowed, "lower it, or start farther back")
    if planned.formation.driver is None:
        found = "no vehicle of the train drives it"
        severity: Severity = "warning" if planned.start_mps > 0.0 else "error"
        yield Problem("no_drive", path, found, remedy="add a vehicle with a drive", severity=severity)


def _check_climb(path: str, planned: PlannedRun) -> Iterator[Problem]:
    """Yield where resistance is greater than the starting effort: an error where no speed carries the train over it.

    The effort falls with the speed, so a train gets stuck if, and only if, its kinetic energy at the greatest speed it
    may have is less than what starting effort and resistance differ by over the stretch.
    """
    mass = planned.formation
    effort = starting_effort_n(mass)
    if effort is None:
        return
    at, lacking = _lacking(planned, effort)
    for first, last in _runs(lacking > 0.0):
        span = slice(first, min(last + 2, len(at)))
        work = float(np.trapezoid(np.maximum(lacking[span], 0.0), at[span]))
        energy = 0.5 * mass.inertia_kg * mass.max_mps**2
        standing = [c for c in planned.calls if c.call.stops and c.at_m < planned.route_m and at[first] <= c.at_m <= at[span][-1]]
        places = [f"it stops there at {call.call.station}" for call in standing]
        if first == 0 and planned.start_mps == 0.0:
            places.append("it starts there from rest")
        steepest = first + int(np.argmax(lacking[span]))
        track, km = planned.path.place(float(at[steepest]))
        found = (
            f"on track {track} at km {name_km(round(km, 3))} the train is held back by"
            f" {(lacking[steepest] + effort) / 1e3:.1f} kN,"
            f" its starting effort is {effort / 1e3:.1f} kN"
        )
        if work > energy or places:
            yield Problem("cannot_climb", path, "; ".join([found, *places]), remedy="a lighter train, or more effort")
        else:
            yield Problem("cannot_start", path, f"{found}: having stopped there it could not go on", severity="warning")


def _runs(mask: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """Return first and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return [(int(start), int(end) - 1) for start, end in zip(edges[::2], edges[1::2], strict=True)]


def _lacking(planned: PlannedRun, effort: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places [m] and by how much the resistance of a crawling train is greater than its effort there [N]."""
    path, mass = planned.path, planned.formation
    single, double = mass.tunnel[0][0], mass.tunnel[1][0]
    added = path.height_m + path.curve_m + single * path.single_tunnel_m + double * path.double_tunnel_m
    spread = mass.spread_m if mass.spread_m > 0.0 else 1.0
    at = np.union1d(path.at_m, path.at_m + spread)
    at = np.union1d(at[(at > 0.0) & (at < planned.route_m)], (0.0, planned.route_m))
    slope = (np.interp(at, path.at_m, added) - np.interp(at - spread, path.at_m, added)) / spread
    return at, mass.a_n + mass.mass_kg * GRAVITY * slope - effort


def starting_effort_n(formation: Formation) -> float | None:
    """Return the greatest effort at standstill [N] at any voltage; None without a drive."""
    vehicle = formation.driver
    drive = vehicle.drive if vehicle is not None else None
    if vehicle is None or drive is None:
        return None
    if isinstance(drive, InverterDrive):
        effort = drive.starting_effort_kn * 1e3
    elif isinstance(drive, TableDrive):
        effort = max(point.effort_kn for point in drive.effort) * 1e3
    else:
        effort = _motor_effort(drive)
    effort *= formation.units
    if vehicle.adhesive_mass_t is not None:
        adhesion = vehicle.adhesion.a_kmh / vehicle.adhesion.b_kmh + vehicle.adhesion.c
        effort = min(effort, adhesion * vehicle.adhesive_mass_t * 1e3 * formation.units * GRAVITY)
    return effort


def _motor_effort(drive: SeriesMotorDrive) -> float:
    """Return the effort of the motors of one vehicle at the greatest current that is held, full field [N]."""
    amps = [0.0, *(point.current_a for point in drive.magnetisation)]
    emf = [0.0, *(point.emf_vs_per_rev for point in drive.magnetisation)]
    held = max(grouping.starting_current_a or drive.starting_current_a for grouping in drive.groupings)
    per_m = drive.gear_ratio / (np.pi * drive.wheel_diameter_m)
    return float(drive.motors * drive.gear_efficiency * np.interp(held, amps, emf) * per_m * held)


def _check_power_off(scenario: Scenario) -> list[Problem]:
    if not scenario.line.power_off or not scenario.timetable.trains:
        return []
    found = f"{len(scenario.line.power_off)} stretches without traction current, which trains do not heed in this version"
    return [Problem("power_off_unused", "line.power_off", found, severity="warning")]
