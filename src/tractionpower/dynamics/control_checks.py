"""Checks of the controls: what the brake pipe can give, and what the driver asks of his levels."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from tractionpower.dynamics.commands import drive_levels, electric_levels
from tractionpower.dynamics.engines import powered
from tractionpower.dynamics.gear_checks import check_gear, has_electric_brake
from tractionpower.errors import Problem
from tractionpower.model.dynamics.case import Command, DynamicsScenario
from tractionpower.model.dynamics.gear import AirBrake

_FAR = 0.1
"""Relative distance of the cylinder pressure of full service from the greatest one that is doubtful."""

_AIR = "case.air_brake"


def check_controls(scenario: DynamicsScenario) -> list[Problem]:
    """Return everything that is wrong or doubtful with traction, brakes and commands of a case."""
    problems = [*check_gear(scenario), *_check_air_brake(scenario.case.air_brake)]
    return [*problems, *_check_use(scenario), *_check_commands(scenario)]


# --- the pipe ----------------------------------------------------------------------------------------------------


def _check_air_brake(air: AirBrake) -> Iterator[Problem]:
    full, pipe = air.full_service_reduction_bar, air.pipe_pressure_bar
    if full > pipe:
        yield _beyond_pipe(f"{_AIR}.full_service_reduction_bar", full, pipe)
    first = air.first_reduction_bar
    if first is not None and air.reductions_bar is not None:
        found = "first_reduction_bar and reductions_bar"
        yield Problem("contradiction", f"{_AIR}.first_reduction_bar", found, "one of the two", "leave one of them out")
    elif first is not None and first > full:
        found = f"{first:g} bar at the first level, {full:g} bar in full service"
        yield Problem("first_reduction", f"{_AIR}.first_reduction_bar", found, f"up to {full:g}", "correct one of them")
    yield from _check_reductions(air)
    reached = air.gain * full
    if abs(reached - air.cylinder_pressure_bar) > _FAR * air.cylinder_pressure_bar:
        more = "its last levels brake no more than those before" if reached > air.cylinder_pressure_bar else "it is never reached"
        found = f"{air.gain:g} times {full:g} bar of full service make {reached:.3g} bar, the greatest cylinder pressure is"
        found += f" {air.cylinder_pressure_bar:g} bar: {more}"
        allowed = f"about {air.cylinder_pressure_bar / full:.4g}"
        yield Problem("gain", f"{_AIR}.gain", found, allowed, "correct gain, reduction or pressure", "warning")
    emergency = air.cylinder_emergency_bar
    if emergency is not None and emergency < air.cylinder_pressure_bar:
        found = f"{emergency:g} bar, less than the {air.cylinder_pressure_bar:g} bar of service"
        allowed, remedy = f"{air.cylinder_pressure_bar:g} or more", "correct one of them"
        yield Problem("emergency_pressure", f"{_AIR}.cylinder_emergency_bar", found, allowed, remedy, "warning")


def _check_reductions(air: AirBrake) -> Iterator[Problem]:
    reductions, path = air.reductions_bar, f"{_AIR}.reductions_bar"
    if reductions is None:
        return
    if len(reductions) != air.levels:
        found, allowed = f"{len(reductions)} reductions", f"{air.levels}, one for each level from 1 on"
        yield Problem("levels", path, found, allowed, "correct levels, or the list")
    for k, (before, after) in enumerate(pairwise((0.0, *reductions))):
        if after <= before:
            found = f"{after:g} bar at level {k + 1}, {before:g} bar at level {k}"
            yield Problem("unsorted", f"{path}[{k}]", found, f"above {before:g}", "give reductions that rise with the level")
        if after > air.pipe_pressure_bar:
            yield _beyond_pipe(f"{path}[{k}]", after, air.pipe_pressure_bar)
    full = air.full_service_reduction_bar
    if reductions and abs(reductions[-1] - full) > 1e-6 * full:
        found = f"{reductions[-1]:g} bar at the highest level, full_service_reduction_bar is {full:g} bar"
        where = f"{path}[{len(reductions) - 1}]"
        yield Problem("full_service", where, found, f"{full:g}", "make them equal if they mean the same", "warning")


def _beyond_pipe(path: str, reduction: float, pipe: float) -> Problem:
    found = f"a reduction by {reduction:g} bar of a pipe that holds {pipe:g} bar"
    return Problem("reduction", path, found, f"up to {pipe:g}", "correct the reduction, or pipe_pressure_bar")


# --- commands ----------------------------------------------------------------------------------------------------


def _check_use(scenario: DynamicsScenario) -> Iterator[Problem]:
    """Yield the first command of each kind that nothing in the train obeys."""
    case, drives = scenario.case, powered(scenario)
    braked = [part.brake is not None and part.brake.in_use for part in scenario.parts]
    independent = any(drive and brake for drive, brake in zip(drives, braked, strict=True))
    obeyed = {
        "drive": (any(drives), "no vehicle of the train drives", "name a powered vehicle, or give one a traction"),
        "brake": (any(braked), "no vehicle has an air brake in use", "give the case a brake"),
        "reduction_bar": (any(braked), "no vehicle has an air brake in use", "give the case a brake"),
        "electric": (has_electric_brake(scenario), "no powered vehicle has an electric brake", "give an electric_brake"),
        "independent_bar": (independent, "no powered vehicle has an air brake in use", "give the case a brake"),
    }
    for name, (is_obeyed, found, remedy) in obeyed.items():
        for k, command in enumerate(case.commands):
            if not is_obeyed and getattr(command, name) not in (None, 0, "charge", "release", "unchanged"):
                yield Problem("nothing_obeys", f"case.commands[{k}].{name}", found, "", remedy, "warning")
                break


def _check_commands(scenario: DynamicsScenario) -> Iterator[Problem]:
    case = scenario.case
    air, electric = case.air_brake, electric_levels(case)
    drive = drive_levels(case)
    level, emergency = 0, case.start.brake == "emergency"
    for k, command in enumerate(case.commands):
        path = f"case.commands[{k}]"
        limits = {"drive": (command.drive, drive), "brake": (command.brake, air.levels), "electric": (command.electric, electric)}
        for name, (asked, highest) in limits.items():
            if isinstance(asked, int | float) and asked > highest:
                found, allowed = f"level {asked:g}", f"0 to {highest}"
                yield Problem("level", f"{path}.{name}", found, allowed, "correct the level, or the levels of the control")
        if command.reduction_bar is not None and command.reduction_bar > air.pipe_pressure_bar:
            yield _beyond_pipe(f"{path}.reduction_bar", command.reduction_bar, air.pipe_pressure_bar)
        before = (level, emergency)
        level = level if command.drive is None else command.drive
        emergency = _is_emergency(command, emergency)
        if level > 0 and emergency and not (before[0] > 0 and before[1]):
            found = f"the drive control stays at level {level} in emergency"
            remedy = "locomotives cut their traction then: add drive: 0"
            yield Problem("power_in_emergency", path, found, "", remedy, "warning")


def _is_emergency(command: Command, before: bool) -> bool:
    if command.brake in (None, "unchanged") and command.reduction_bar is None:
        return before
    return command.brake == "emergency"
