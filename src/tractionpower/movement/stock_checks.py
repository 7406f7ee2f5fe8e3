"""Checks of vehicles and trains: masses, brakes, and vehicles that do not fit together. Drives: `drive_checks`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tractionpower.errors import Problem
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.drive import Drive, InverterDrive, TableDrive
from tractionpower.model.limits import SystemVoltages
from tractionpower.model.vehicle import Part, Resistance, Train, Vehicle
from tractionpower.movement.drive_checks import check_drive
from tractionpower.movement.formation import Formation, form, is_powered
from tractionpower.movement.telling import doubt, unknown

LIGHTEST_T_PER_M, HEAVIEST_T_PER_M = 0.2, 15.0
"""Mass by length that no rail vehicle goes below or beyond: line class E5 is 8.8 t/m (EN 15528), ore lines reach some 14."""

HEAVIEST_T_PER_AXLE = 45.0
"""Ore lines reach 42 t an axle (recalled)."""

GREATEST_EFFORT_PER_WEIGHT = 0.6
"""Effort over weight that no adhesion allows."""


GREATEST_POWER_KW = 20_000.0
"""Power of one vehicle that none has; the strongest locomotives have some 10 MW, long units some 17 MW (recalled)."""


def check_vehicle(vehicle: Vehicle, voltages: SystemVoltages | None, path: str = "") -> list[Problem]:
    """Return everything that is wrong or doubtful with a vehicle.

    Parameters
    ----------
    vehicle
        The vehicle.
    voltages
        Voltage limits of the system that it runs under; None leaves out what depends on them.
    path
        Its place in the model; left out: by its id.
    """
    path = path or f"vehicles[{vehicle.id}]"
    problems = _check_mass(path, vehicle)
    if vehicle.resistance == Resistance():
        found = "the vehicle has no running resistance"
        problems.append(doubt("no_resistance", f"{path}.resistance", found, remedy="give a_n and more"))
    if vehicle.drive is not None:
        problems += check_drive(f"{path}.drive", vehicle.drive, voltages) + _check_effort(path, vehicle)
        problems += _check_power(f"{path}.drive.power_kw", vehicle.drive) + _check_table_end(f"{path}.drive", vehicle)
    return problems + _check_brake(f"{path}.brake", vehicle)


def check_train(
    path: str, parts: Sequence[Part], vehicles: Mapping[str, Vehicle], voltages: SystemVoltages | None = None
) -> list[Problem]:
    """Return what is wrong or doubtful with the vehicles of a train, which stand at `path` of the model."""
    remedy = "name a vehicle that exists"
    problems = [
        unknown("vehicle", f"{path}[{k}].id", part.id, vehicles, remedy)
        for k, part in enumerate(parts)
        if part.id not in vehicles
    ]
    for k, part in enumerate(parts):
        if part.id in vehicles and part.load_percent > 0.0 and vehicles[part.id].load_t == 0.0:
            found = f"{part.load_percent:g} % of the load of {part.id}, whose load_t is 0"
            remedy = f"give load_t of {part.id}, or leave load_percent out"
            problems.append(doubt("load_without_mass", f"{path}[{k}].load_percent", found, remedy=remedy))
    kinds = sorted({part.id for part in parts if part.id in vehicles and is_powered(part, vehicles[part.id])})
    if len(kinds) > 1:
        found = f"powered vehicles of {len(kinds)} kinds: {', '.join(kinds)}"
        remedy = "set powered: false for those that are hauled; different drives in one train cannot be computed yet"
        problems.append(Problem("mixed_drives", path, found, "one kind of powered vehicle", remedy))
    if parts and voltages is not None and len(kinds) == 1 and all(part.id in vehicles for part in parts):
        problems += _check_current(path, form(Train(id="train", vehicles=tuple(parts)), vehicles), voltages)
    return problems


def auxiliary_current_a(formation: Formation, volts: float) -> float:
    """Return what the auxiliaries of a train take at the nominal voltage [A]."""
    return (formation.auxiliary_w + formation.heating_w) / volts


def _check_current(path: str, formation: Formation, voltages: SystemVoltages) -> list[Problem]:
    """Return a warning if the current of the train does not even feed its auxiliaries."""
    drive = formation.driver.drive if formation.driver is not None else None
    if formation.driver is None or drive is None or drive.max_current_a is None or voltages.u_n <= 0.0:
        return []
    limit, taken = drive.max_current_a * formation.units, auxiliary_current_a(formation, voltages.u_n)
    if limit > taken:
        return []
    found = (
        f"the auxiliaries of the train take {taken:.0f} A at {voltages.u_n:g} V, max_current_a of {formation.driver.id}"
        f" allows {limit:g} A in all: nothing is left for traction"
    )
    return [doubt("no_traction", path, found, remedy="correct max_current_a or the auxiliaries")]


def _check_mass(path: str, vehicle: Vehicle) -> list[Problem]:
    """Return a warning for a mass that no vehicle of this length and number of axles has, as from kg taken for t."""
    full, length = vehicle.mass_t + vehicle.load_t, vehicle.length_m
    remedy = "correct mass_t, load_t, length_m or axles; masses are in tonnes"
    if full > HEAVIEST_T_PER_M * length:
        found, allowed = f"{full:g} t on {length:g} m", f"up to {HEAVIEST_T_PER_M:g} t/m, here {HEAVIEST_T_PER_M * length:g} t"
    elif vehicle.mass_t < LIGHTEST_T_PER_M * length:
        least = LIGHTEST_T_PER_M * length
        found, allowed = f"{vehicle.mass_t:g} t on {length:g} m", f"from {LIGHTEST_T_PER_M:g} t/m, here {least:g} t"
    elif vehicle.axles is not None and full > HEAVIEST_T_PER_AXLE * vehicle.axles:
        found = f"{full:g} t on {vehicle.axles} axle{'s' * (vehicle.axles > 1)}"
        allowed = f"up to {HEAVIEST_T_PER_AXLE:g} t an axle, here {HEAVIEST_T_PER_AXLE * vehicle.axles:g} t"
    else:
        return []
    return [doubt("absurd_mass", f"{path}.mass_t", found, allowed, remedy)]


def _check_effort(path: str, vehicle: Vehicle) -> list[Problem]:
    """Return a warning for an effort that no adhesion allows, as from N taken for kN."""
    drive, most = vehicle.drive, GREATEST_EFFORT_PER_WEIGHT * vehicle.mass_t * GRAVITY
    if isinstance(drive, InverterDrive):
        where, effort = "starting_effort_kn", drive.starting_effort_kn
    elif isinstance(drive, TableDrive):
        k, effort = max(enumerate(point.effort_kn for point in drive.effort), key=lambda pair: pair[1])
        where = f"effort[{k}].effort_kn"
    else:
        return []
    if effort <= most:
        return []
    found, allowed = f"{effort:g} kN on a vehicle of {vehicle.mass_t:g} t", f"up to {most:.0f} kN, a share of its weight"
    return [doubt("absurd_effort", f"{path}.drive.{where}", found, allowed, "correct effort or mass; efforts are in kN")]


def _check_power(path: str, drive: Drive) -> list[Problem]:
    """Return a warning for a power that no vehicle has, as from W taken for kW."""
    if not isinstance(drive, InverterDrive) or drive.power_kw <= GREATEST_POWER_KW:
        return []
    return [doubt("absurd_power", path, f"{drive.power_kw:g} kW", f"up to {GREATEST_POWER_KW:g} kW", "is it in W?")]


def _check_table_end(path: str, vehicle: Vehicle) -> list[Problem]:
    """Return a warning if the points of a table end below the greatest speed: beyond them the last values hold."""
    drive = vehicle.drive
    if not isinstance(drive, TableDrive):
        return []
    for name, points, what in (
        ("effort", drive.effort, "effort and losses stay those"),
        ("current", drive.current, "the current stays that"),
    ):
        ends: dict[float | None, float] = {}
        for point in points:
            ends[point.voltage_v] = max(point.speed_kmh, ends.get(point.voltage_v, 0.0))
        volts, end = min(ends.items(), key=lambda pair: pair[1])
        if end < vehicle.max_speed_kmh:
            where = "" if volts is None else f" at {volts:g} V"
            found = f"the points{where} end at {end:g} km/h: {what} of {end:g} km/h up to {vehicle.max_speed_kmh:g} km/h"
            return [doubt("short_table", f"{path}.{name}", found, remedy="add points up to max_speed_kmh, or lower it")]
    return []


def _check_brake(path: str, vehicle: Vehicle) -> list[Problem]:
    brake = vehicle.brake
    if brake.electric_effort_kn == 0.0:
        return []
    if vehicle.drive is None:
        found = f"{brake.electric_effort_kn:g} kN of electric brake on a vehicle without a drive"
        remedy = "give the vehicle a drive, or leave the electric brake out"
        return [Problem("brake_without_drive", f"{path}.electric_effort_kn", found, "0", remedy)]
    if brake.electric_power_kw == 0.0:
        found = f"an electric brake of {brake.electric_effort_kn:g} kN without power gives nothing"
        return [doubt("brake_without_power", f"{path}.electric_power_kw", found, remedy="give electric_power_kw")]
    return _check_brake_adhesion(f"{path}.electric_effort_kn", vehicle)


def _check_brake_adhesion(path: str, vehicle: Vehicle) -> list[Problem]:
    """Return a warning for an electric brake beyond the adhesion at standstill, which is greatest there."""
    effort, adhesion = vehicle.brake.electric_effort_kn, vehicle.adhesion
    if vehicle.adhesive_mass_t is None:
        return []
    share = adhesion.a_kmh / adhesion.b_kmh + adhesion.c
    most = share * vehicle.adhesive_mass_t * GRAVITY
    if effort <= most:
        return []
    found = f"{effort:g} kN of electric brake, adhesion limits it to {most:.1f} kN at standstill"
    allowed = f"up to {most:.1f} kN, {share:.3g} of the weight of adhesive_mass_t = {vehicle.adhesive_mass_t:g} t"
    return [doubt("brake_adhesion", path, found, allowed, "correct electric_effort_kn or adhesive_mass_t")]
