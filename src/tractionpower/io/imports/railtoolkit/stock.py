"""Vehicles and trains of railtoolkit, with the resistance formulas of TrainRuns.jl.

TrainRuns.jl, src/formulary.jl, after Wende 2003, pages 151 and 153; V in km/h, m the mass, g the acceleration of gravity:

    traction unit      g (f0 m_driven + f1 (m - m_driven) + f2 m ((V + 15)/100)²)         without load
    passenger coaches  g m (f0 + f1 V/100 + f2 ((V + 15)/100)²)                           with load
    freight wagons     g m (f0 + f2 (V/100)²)                                             with load

f0, f1, f2 are base, rolling and air resistance in N/kN. The shifted square is a quadratic in V again, so nothing is lost.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.imports import foreign as f
from tractionpower.io.imports.imported import Notes
from tractionpower.io.imports.railtoolkit.files import StockFile, StockTrain, StockVehicle
from tractionpower.model.vehicle import Train, Vehicle

GRAVITY = 9.80665
WIND_KMH = 15.0
EFFICIENCY = 0.85
NOMINAL_V = 3000.0
FASTEST_KMH = 504.0
KINDS = {"traction unit": "locomotive", "multiple unit": "multiple_unit", "passenger": "coach", "freight": "wagon"}
ROTATION = {"traction unit": 1.09, "multiple unit": 1.09, "passenger": 1.06, "freight": 1.06}
"""Factors of rotating masses that TrainRuns assumes."""
BRAKING = {"freight": 0.225, "passenger": 0.375}
"""Decelerations that TrainRuns assumes [m/s²]; Brünger and Dahlhaus 2014, page 74."""
THIN_AIR = 0.1
"""Air resistance below this is told: at 100 km/h it is a twentieth of usual values or less."""


def is_powered(vehicle: StockVehicle) -> bool:
    """Return whether a vehicle drives."""
    return vehicle.vehicle_type in ("traction unit", "multiple unit")


def vehicles_of(file: StockFile, notes: Notes, place: str) -> list[Vehicle]:
    """Return the vehicles of a file."""
    vehicles = [f.built(Vehicle, _vehicle(vehicle, notes, place), notes, place) for vehicle in file.vehicles]
    notes.read.append(f"{place}: {len(file.vehicles)} vehicles, {len(file.trains)} trains (schema {file.schema_version})")
    notes.assumed.append(
        f"{place}: factors of rotating masses hold for loaded vehicles; no auxiliaries, no electric brake, no limit by adhesion"
    )
    return [vehicle for vehicle in vehicles if vehicle is not None]


def trains_of(file: StockFile, is_point: bool, notes: Notes, place: str) -> list[Train]:
    """Return the trains of a file: fully loaded, as TrainRuns reckons them."""
    known = {vehicle.id: vehicle for vehicle in file.vehicles}
    trains = [_train(train, known, is_point, notes, place) for train in file.trains]
    return [train for train in trains if train is not None]


def _vehicle(vehicle: StockVehicle, notes: Notes, place: str) -> dict[str, Any]:
    rotation = vehicle.rotation_mass
    if rotation is None:
        rotation = ROTATION[vehicle.vehicle_type]
        notes.assumed.append(f"{vehicle.id}: factor of rotating masses {rotation:g}, as in TrainRuns")
    if vehicle.speed_limit is None:
        notes.assumed.append(f"{vehicle.id}: greatest speed {FASTEST_KMH:g} km/h, as in TrainRuns")
    loaded = vehicle.mass + vehicle.load_limit
    data = {
        "id": vehicle.id,
        "name": vehicle.name,
        "kind": KINDS[vehicle.vehicle_type],
        "mass_t": vehicle.mass,
        "load_t": vehicle.load_limit,
        "length_m": vehicle.length,
        "max_speed_kmh": vehicle.speed_limit or FASTEST_KMH,
        # The load turns no wheels: what the source puts on the loaded vehicle is put on the empty one here.
        "rotating_mass_factor": f.tidy(1.0 + (rotation - 1.0) * loaded / vehicle.mass),
        "resistance": _resistance(vehicle),
    }
    if vehicle.air_resistance and vehicle.air_resistance < THIN_AIR:
        text = f"an air resistance of {vehicle.air_resistance:g} permille at 100 km/h"
        remedy = "usual are 2 to 10: the unit is in doubt; it is taken as written"
        path = f"vehicles[{vehicle.id}].air_resistance"
        notes.problems.append(Problem("doubtful_unit", path, text, "", remedy, "warning", place))
    if is_powered(vehicle):
        data["drive"] = _drive(vehicle, notes)
    elif vehicle.tractive_effort:
        notes.ignored.append(f"{vehicle.id}: tractive effort of a {vehicle.vehicle_type} vehicle")
    if vehicle.a_braking is not None:
        data["brake"] = {"service_rate_mps2": -vehicle.a_braking}
    return data


def _resistance(vehicle: StockVehicle) -> dict[str, float]:
    air = vehicle.air_resistance / 1e4
    if not is_powered(vehicle):
        passenger = vehicle.vehicle_type == "passenger"
        wind = WIND_KMH if passenger else 0.0
        return {
            "specific_a_n_per_kn": f.tidy(vehicle.base_resistance + air * wind**2),
            "specific_b_n_per_kn_per_kmh": f.tidy(2.0 * air * wind + (vehicle.rolling_resistance / 100.0 if passenger else 0.0)),
            "specific_c_n_per_kn_per_kmh2": f.tidy(air),
        }
    driven = vehicle.mass if vehicle.mass_traction is None else vehicle.mass_traction
    axles = vehicle.base_resistance * driven + vehicle.rolling_resistance * (vehicle.mass - driven)
    air *= vehicle.mass * GRAVITY
    return {
        "a_n": f.tidy(axles * GRAVITY + air * WIND_KMH**2),
        "b_n_per_kmh": f.tidy(2.0 * air * WIND_KMH),
        "c_n_per_kmh2": f.tidy(air),
    }


def _drive(vehicle: StockVehicle, notes: Notes) -> dict[str, Any]:
    points = vehicle.tractive_effort
    if not points:
        driven = vehicle.mass if vehicle.mass_traction is None else vehicle.mass_traction
        effort = 1000.0 * driven * GRAVITY * 0.33
        points = ((0.0, effort), (vehicle.speed_limit or FASTEST_KMH, effort))
        notes.assumed.append(
            f"{vehicle.id}: tractive effort of 0.33 of the weight on driven axles at any speed: the source has none"
        )
    notes.assumed.append(
        f"{vehicle.id}: current for {vehicle.power_type or 'unknown'} power as if the line gave it at {NOMINAL_V:g} V"
        f" with an efficiency of {EFFICIENCY:g}"
    )
    effort_points = [{"speed_kmh": v, "effort_kn": f.tidy(newton / 1000.0)} for v, newton in points]
    current = [{"speed_kmh": v, "current_a": f.tidy(newton * v / 3.6 / EFFICIENCY / NOMINAL_V)} for v, newton in points]
    return {"kind": "table", "effort": effort_points, "current": current}


def _train(train: StockTrain, known: dict[str, StockVehicle], is_point: bool, notes: Notes, place: str) -> Train | None:
    missing = [name for name in dict.fromkeys(train.formation) if name not in known]
    for name in missing:
        path, allowed = f"trains[{train.id}].formation", ", ".join(known)
        notes.problems.append(Problem("unknown_vehicle", path, f"{name}, which the file does not hold", allowed, place=place))
    members = [known[name] for name in train.formation if name in known]
    if missing or not any(is_powered(vehicle) for vehicle in members):
        if not missing:
            path, found = f"trains[{train.id}].formation", "no traction unit and no multiple unit"
            notes.problems.append(Problem("no_drive", path, found, "at least one", place=place))
        return None
    data = {
        "id": train.id,
        "name": train.name,
        "category": "freight" if _is_freight(members) else "passenger",
        "vehicles": [
            {"id": name, "count": count, "load_percent": 100.0 if known[name].load_limit else 0.0}
            for name, count in _in_a_row(train.formation)
        ],
        "service_rate_mps2": _rate(members, train.id, notes),
    }
    return f.built(Train, {**data, "mass_distribution": "point"} if is_point else data, notes, place)


def _is_freight(members: Iterable[StockVehicle]) -> bool:
    return not any(vehicle.vehicle_type in ("passenger", "multiple unit") for vehicle in members)


def _rate(members: list[StockVehicle], train: str, notes: Notes) -> float:
    given = next((vehicle.a_braking for vehicle in members if is_powered(vehicle) and vehicle.a_braking is not None), None)
    if given is not None:
        return -given
    kind = "freight" if _is_freight(members) else "passenger"
    notes.assumed.append(f"{train}: deceleration in service {BRAKING[kind]:g} m/s², as in TrainRuns for {kind} trains")
    return BRAKING[kind]


def _in_a_row(formation: Iterable[str]) -> list[tuple[str, int]]:
    rows: list[tuple[str, int]] = []
    for name in formation:
        if rows and rows[-1][0] == name:
            rows[-1] = (name, rows[-1][1] + 1)
        else:
            rows.append((name, 1))
    return rows


def length_m(train: StockTrain, file: StockFile) -> float:
    """Return the length of a train [m]."""
    lengths = {vehicle.id: vehicle.length for vehicle in file.vehicles}
    return sum(lengths.get(name, 0.0) * count for name, count in Counter(train.formation).items())
