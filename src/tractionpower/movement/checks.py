"""Checks of vehicles, trains and the timetable, gathered."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.checks import check_ids
from tractionpower.alignment.intervals import place_rows
from tractionpower.errors import Problem
from tractionpower.model.drive import InverterDrive
from tractionpower.model.limits import VOLTAGE_NAMES, SystemVoltages, find_limit, system_voltages
from tractionpower.model.rules import broken_rules
from tractionpower.model.scenario import Scenario
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.category_checks import check_categories
from tractionpower.movement.compile import PlannedRun, Routes, knee_factor, plan_run, train_of
from tractionpower.movement.day_checks import check_days
from tractionpower.movement.declared import declared_runs
from tractionpower.movement.drive_checks import check_knee
from tractionpower.movement.formation import form
from tractionpower.movement.pace_checks import check_pace
from tractionpower.movement.plan_checks import check_plans
from tractionpower.movement.run_checks import Site, check_run
from tractionpower.movement.stock_checks import check_train, check_vehicle
from tractionpower.movement.telling import item_paths, listed
from tractionpower.movement.timetable_checks import check_clock
from tractionpower.movement.turn_checks import check_turns
from tractionpower.movement.turns import declared_links

SHARED = (
    "cannot_start", "no_contact_line", "no_drive", "no_traction", "nothing_to_drive_to", "stop_without_power", "turns_round",
    "weak_brake",
)  # fmt: skip
"""Problems that are told once for all runs of which they are true in the same words."""


def check_movement(scenario: Scenario) -> list[Problem]:
    """Return everything that is wrong or doubtful with vehicles, trains and the timetable of a scenario.

    The line's own faults are told by `alignment.checks.check_line`, a lack of voltage limits by `supply.checks`.
    """
    broken = broken_rules(scenario, ("timetable", "trains", "vehicles"))
    if broken:  # built in Python past the model: nothing can be relied on
        return broken
    problems = [*check_days(scenario), *_check_ids(scenario)]
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    trains = {train.id: train for train in scenario.trains}
    voltages = _voltages(scenario)
    faulty: dict[str, set[str]] = {"vehicles": set(), "trains": set()}
    for path, vehicle in zip(item_paths("vehicles", [item.id for item in scenario.vehicles]), scenario.vehicles, strict=True):
        found = check_vehicle(vehicle, voltages, path)
        problems += found
        faulty["vehicles"] |= {vehicle.id} if _has_errors(found) else set()
    for path, train in zip(item_paths("trains", [item.id for item in scenario.trains]), scenario.trains, strict=True):
        found = check_train(f"{path}.vehicles", train.vehicles, vehicles, voltages)
        problems += found
        faulty["trains"] |= {train.id} if _has_errors(found) else set()
    axes = compile_axes(scenario.line)
    site = Site(
        line=scenario.line,
        axes=axes,
        trains=trains,
        vehicles=vehicles,
        faulty_vehicles=frozenset(faulty["vehicles"]),
        faulty_trains=frozenset(faulty["trains"]),
        voltages=voltages,
        contact=place_rows(enumerate(scenario.supply.contact_lines), axes),
        routes=Routes(scenario.line, axes, _longest_m(scenario, vehicles)),
        driving=scenario.timetable.driving,
    )
    return [*problems, *_check_runs(scenario, site), *_check_default_knee(scenario, voltages)]


def _check_runs(scenario: Scenario, site: Site) -> list[Problem]:
    """Return what is wrong or doubtful with the runs of the day, each by itself and with others; of a service once."""
    declared = declared_runs(scenario)
    told = {
        item.path: [replace(found, path=item.moved(found.path)) for found in check_run(item.path, item.run, site)]
        for item in declared
    }
    problems = _share((item.run.id, problem) for item in declared for problem in told[item.path])
    problems += check_clock(declared, scenario.clock) + check_categories(scenario)
    sound = [item for item in declared if not _has_errors(told[item.path])]
    turning = {name for link in declared_links(scenario.timetable) for name in (link.first, link.then)}
    planned = {run.id: _plan(item.run, site) for item in sound for run in item.runs if run.id in turning}
    problems += check_turns(scenario, planned)
    if site.voltages is None or _has_errors(_check_default_knee(scenario, site.voltages)):
        return problems
    driving = [item for item in sound if _drives(item.run, site)]
    return problems + check_pace(scenario, driving) + check_plans(scenario, driving)


def _check_ids(scenario: Scenario) -> list[Problem]:
    ids = {
        "trains": [train.id for train in scenario.trains],
        "vehicles": [vehicle.id for vehicle in scenario.vehicles],
    }
    return [problem for path, names in ids.items() for problem in check_ids(path, names)]


def _plan(run: TrainRun, site: Site) -> PlannedRun:
    """Return a run without errors on its route."""
    train = train_of(run, tuple(site.trains.values()))
    return plan_run(run, train, form(train, site.vehicles), site.routes.path(run, train), site.line)


def _drives(run: TrainRun, site: Site) -> bool:
    """Tell whether the train of a run without errors has a drive, and neither it nor one of its vehicles has errors."""
    train = train_of(run, tuple(site.trains.values()))
    if run.train in site.faulty_trains or not site.faulty_vehicles.isdisjoint(part.id for part in train.vehicles):
        return False
    return form(train, site.vehicles).driver is not None


def _has_errors(problems: Iterable[Problem]) -> bool:
    return any(problem.severity == "error" for problem in problems)


def _voltages(scenario: Scenario) -> SystemVoltages | None:
    system = scenario.supply.system
    if any(find_limit(scenario.limits, system, name) is None for name in VOLTAGE_NAMES):
        return None
    return system_voltages(scenario.limits, system)


def _longest_m(scenario: Scenario, vehicles: dict[str, Vehicle]) -> float:
    """Return the length of the longest train all of whose vehicles exist [m]."""
    named = [train.vehicles for train in scenario.trains] + [run.vehicles for run in scenario.runs if run.vehicles]
    whole = [parts for parts in named if all(part.id in vehicles for part in parts)]
    return max((form(Train(id="train", vehicles=parts), vehicles).length_m for parts in whole), default=0.0)


def _share(told: Iterable[tuple[str, Problem]]) -> list[Problem]:
    """Return the problems of runs, those that several runs share as one with their names."""
    kept: list[Problem] = []
    owners: dict[int, list[str]] = {}
    first: dict[tuple[str, str], int] = {}
    for run, problem in told:
        key = (problem.code, problem.found)
        if problem.code in SHARED and key in first:
            owners[first[key]].append(run)
            continue
        first[key] = len(kept)
        owners[len(kept)] = []
        kept.append(problem)
    for k, names in owners.items():
        others = sorted(set(names))
        if others:
            text = f"; likewise train{'s' * (len(others) > 1)} {listed(others)}"
            kept[k] = replace(kept[k], found=kept[k].found + text)
    return kept


def _check_default_knee(scenario: Scenario, voltages: SystemVoltages | None) -> list[Problem]:
    """Return an error if the knee of the system is too low for the inverter drives that have none of their own."""
    drives = [vehicle.drive for vehicle in scenario.vehicles]
    if not any(isinstance(drive, InverterDrive) and drive.knee_factor is None for drive in drives):
        return []
    system = scenario.supply.system
    return check_knee(f"limits[{system} knee_factor]", knee_factor(scenario.limits, system), voltages)
