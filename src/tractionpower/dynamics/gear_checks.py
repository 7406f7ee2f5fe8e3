"""Checks of what vehicles brake and pull with: effort by levels, electric brake, cylinders and rigging, friction of blocks."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from typing import Literal, TypeVar

from tractionpower.dynamics.engines import effort_of, electric_brake_of, powered
from tractionpower.errors import Problem
from tractionpower.model.drive import TableDrive
from tractionpower.model.dynamics.case import CasePart, DynamicsScenario
from tractionpower.model.dynamics.gear import BlockFriction, BrakeGear, ElectricBrake, Traction
from tractionpower.model.vehicle import Vehicle

Item = TypeVar("Item", Traction, BrakeGear, ElectricBrake)

_GIVE_TRACTION = "give a traction with starting_effort_kn and power_kw, or with effort by points"


def check_gear(scenario: DynamicsScenario) -> list[Problem]:
    """Return everything that is wrong or doubtful with traction, electric brake and brake gear of a case."""
    case = scenario.case
    problems: list[Problem] = []
    tractions = _declared("traction", case.traction, (part.traction for part in case.vehicles))
    electric = _declared("electric_brake", case.electric_brake, (part.electric_brake for part in case.vehicles))
    for path, traction in tractions:
        problems += _check_traction(path, traction)
    for path, gear in _declared("brake", case.brake, (part.brake for part in case.vehicles)):
        problems += _check_brake_gear(path, gear)
    problems += _check_efforts(scenario)
    problems += _check_equal_levels("traction", tractions)
    problems += _check_equal_levels("electric_brake", electric)
    return problems


def _declared(name: str, common: Item | None, own: Iterable[Item | None]) -> list[tuple[str, Item]]:
    """Return what a case declares under a name for all vehicles and for some, with the path of each."""
    found = [] if common is None else [(f"case.{name}", common)]
    return found + [(f"case.vehicles[{k}].{name}", value) for k, value in enumerate(own) if value is not None]


def own_parts(scenario: DynamicsScenario) -> list[tuple[int, CasePart, Vehicle, bool]]:
    """Return the parts of a train: index, the part with what the case says for all, its vehicle, whether it drives."""
    resolved, drives = scenario.parts, powered(scenario)
    rows, first = [], 0
    for k, part in enumerate(scenario.case.vehicles):
        rows.append((k, resolved[first], scenario.vehicle(part.id), drives[first]))
        first += part.count
    return rows


# --- traction ----------------------------------------------------------------------------------------------------


def _check_traction(path: str, traction: Traction) -> Iterator[Problem]:
    if not traction.effort:
        return
    for name in ("starting_effort_kn", "power_kw"):
        if getattr(traction, name) is not None:
            found = f"{getattr(traction, name):g} beside effort by points"
            yield Problem("contradiction", f"{path}.{name}", found, "one of the two", "leave one of them out")
    speeds: dict[int, list[float]] = defaultdict(list)
    for k, point in enumerate(traction.effort):
        where, before = f"{path}.effort[{k}]", speeds[point.level]
        if point.level > traction.levels:
            found, allowed = f"level {point.level}", f"1 to {traction.levels}, the levels of the control"
            yield Problem("level", f"{where}.level", found, allowed, "correct the level, or levels")
        elif before and point.speed_kmh <= before[-1]:
            found = f"{point.speed_kmh:g} km/h behind {before[-1]:g} km/h at level {point.level}"
            remedy = "sort the points of each level by speed, each speed once"
            yield Problem("unsorted", f"{where}.speed_kmh", found, f"above {before[-1]:g}", remedy)
        before.append(point.speed_kmh)
    missing = [str(level) for level in range(1, traction.levels + 1) if len(speeds[level]) < 2]
    if missing:
        some = ", ".join(missing[:8]) + (f", ... ({len(missing)} in all)" if len(missing) > 8 else "")
        found, allowed = f"less than two points at level {some}", f"two or more for each level from 1 to {traction.levels}"
        yield Problem("missing_level", f"{path}.effort", found, allowed, "add the points, or lower levels")


def _check_efforts(scenario: DynamicsScenario) -> Iterator[Problem]:
    """Yield what a powered vehicle lacks to have an effort."""
    told = set()
    for k, part, vehicle, drives in own_parts(scenario):
        given = scenario.case.vehicles[k].traction is not None
        path = f"case.vehicles[{k}].traction" if given or scenario.case.traction is None else "case.traction"
        if not drives or (path, vehicle.id) in told:
            continue
        told.add((path, vehicle.id))
        traction = part.traction or Traction()
        kind = "no drive" if vehicle.drive is None else f"a drive of kind {vehicle.drive.kind}"
        if not effort_of(traction, vehicle).known:
            lacks = [name for name in ("starting_effort_kn", "power_kw") if getattr(traction, name) is None]
            found = f"no {' and no '.join(lacks)}, and vehicle {vehicle.id} has {kind}, which does not tell"
            yield Problem("no_effort", path, found, "effort and power, or points", _GIVE_TRACTION)
        elif isinstance(vehicle.drive, TableDrive) and traction.law == "quadratic_power" and not traction.effort:
            if traction.starting_effort_kn is None:
                found = f"quadratic_power, and vehicle {vehicle.id} has a table of efforts, whose power has no level of its own"
                yield Problem("law", f"{path}.law", found, "linear", _GIVE_TRACTION)
        if traction.adhesion and vehicle.adhesive_mass_t is None:
            found = f"true, and vehicle {vehicle.id} has no adhesive_mass_t"
            yield Problem("no_adhesive_mass", f"{path}.adhesion", found, "", "give its adhesive_mass_t, or leave adhesion out")


def _check_equal_levels(name: str, given: list[tuple[str, Traction]] | list[tuple[str, ElectricBrake]]) -> Iterator[Problem]:
    """Yield where several declarations count the levels of the one control differently."""
    for path, each in given[1:]:
        first_path, first = given[0]
        if each.levels != first.levels:
            found = f"{each.levels}, but {first.levels} at {first_path}: the driver has one control for all vehicles"
            severity: Literal["error", "warning"] = "error" if name == "electric_brake" else "warning"
            remedy = "give all the same levels" if severity == "error" else "beyond its highest level a vehicle gives no more"
            yield Problem("different_levels", f"{path}.levels", found, f"{first.levels}", remedy, severity)


def has_electric_brake(scenario: DynamicsScenario) -> bool:
    """Tell whether some powered vehicle has an electric brake."""
    return any(drives and electric_brake_of(part, vehicle) is not None for _, part, vehicle, drives in own_parts(scenario))


# --- air brake ---------------------------------------------------------------------------------------------------


def _check_brake_gear(path: str, gear: BrakeGear) -> Iterator[Problem]:
    names = ("cylinder_area_cm2", "rigging_ratio")
    given = [name for name in names if getattr(gear, name) is not None]
    allowed = "either cylinder_area_cm2 and rigging_ratio, or brake_ratio"
    if gear.brake_ratio is not None and given:
        found = f"brake_ratio and {' and '.join(given)}"
        yield Problem("contradiction", path, found, allowed, "leave one of the two out")
    elif gear.brake_ratio is None and len(given) < len(names):
        found = f"{given[0]} alone" if given else "nothing that tells the force of the blocks"
        yield Problem("no_block_force", path, found, allowed, "give what is missing")
    yield from _check_friction(f"{path}.friction", gear.friction)


def _check_friction(path: str, friction: BlockFriction) -> Iterator[Problem]:
    points = friction.points
    if friction.law != "table":
        if points:
            found, allowed = f"points and the law {friction.law}", "points with the law table only"
            yield Problem("contradiction", f"{path}.points", found, allowed, "set law: table, or leave the points out")
        return
    if not points:
        remedy = "give points, or another law"
        yield Problem("no_points", f"{path}.points", "no points", "a full grid of speeds and block forces", remedy)
        return
    speeds = sorted({point.speed_kmh for point in points})
    forces = sorted({point.block_force_kn for point in points})
    counts = Counter((point.speed_kmh, point.block_force_kn) for point in points)
    pairs = [(speed, force) for speed in speeds for force in forces]
    missing = [pair for pair in pairs if counts[pair] == 0]
    twice = [pair for pair in pairs if counts[pair] > 1]
    texts = [f"no point at {_pair(missing[0])} ({len(missing)} missing)"] if missing else []
    texts += [f"several at {_pair(twice[0])}"] if twice else []
    if texts:
        allowed = f"one point at each of {len(speeds)} speeds and each of {len(forces)} block forces"
        remedy = "give one coefficient for each pair of speed and block force"
        yield Problem("friction_grid", f"{path}.points", " and ".join(texts), allowed, remedy)


def _pair(pair: tuple[float, float]) -> str:
    return f"{pair[0]:g} km/h and {pair[1]:g} kN"
