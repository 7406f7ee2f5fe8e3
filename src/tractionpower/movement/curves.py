"""Characteristics of a train over speed and voltage: effort F_p(v, u), current, resistance, electric brake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.characteristics import trace
from tractionpower.kernels.train_tables import KNOT, LINE_LIMIT, MOVER, NO_DRIVE, PIECE, STOP, TRAIN, TURN, TrainTables
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.drive import SeriesMotorDrive
from tractionpower.model.limits import Limit, system_voltages
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.movement.compile import knee_factor
from tractionpower.movement.drives import NO_LIMIT, DrivePools, compile_drive, pool_arrays
from tractionpower.movement.formation import form
from tractionpower.movement.notches import NotchCurve, notch_curves

Floats = NDArray[np.float64]

GRADIENTS_PERMILLE = (0.0, 5.0, 10.0, 20.0)
_SPEEDS = 401


@dataclass(frozen=True, eq=False)
class Curve:
    """Greatest effort [N] and line current with auxiliaries [A] over the speeds of `TrainCurves`, at one voltage [V]."""

    voltage_v: float
    effort_n: Floats
    current_a: Floats


@dataclass(frozen=True, eq=False)
class TrainCurves:
    """Characteristics of a train over speed.

    Attributes
    ----------
    train
        Its identifier.
    speed_mps
        Speeds from 0 to the greatest of the train [m/s].
    curves
        Effort and current, one for each voltage.
    adhesion_n
        Effort that adhesion permits [N]; infinite without a limit.
    resistance_n
        Running resistance [N] by gradient [permille].
    electric_brake_n
        Greatest effort of the electric brake [N].
    mass_kg, length_m
        Mass with load, length.
    notches
        Of series motors: each notch at nominal voltage.
    """

    train: str
    speed_mps: Floats
    curves: tuple[Curve, ...]
    adhesion_n: Floats
    resistance_n: dict[float, Floats]
    electric_brake_n: Floats
    mass_kg: float
    length_m: float
    notches: tuple[NotchCurve, ...] = ()


def drive_curves(
    train: Train,
    vehicles: Sequence[Vehicle],
    limits: Sequence[Limit],
    system: str = "dc3000",
    voltages_v: Sequence[float] | None = None,
) -> TrainCurves:
    """Return the characteristics of a train at some voltages; left out: between the limits of the system."""
    known = system_voltages(limits, system)
    if voltages_v is None:
        between = (known.u_min2, 0.5 * (known.u_min2 + 0.9 * known.u_n), 0.9 * known.u_n, known.u_n, known.u_max1)
        voltages_v = sorted({round(volts) * 1.0 for volts in between})
    formation = form(train, {vehicle.id: vehicle for vehicle in vehicles})
    drive = formation.driver.drive if formation.driver is not None else None
    pools = DrivePools()
    columns = compile_drive(formation, known, knee_factor(limits, system), pools)
    columns |= {"lowest_v": known.u_min2, "nominal_v": known.u_n, "inertia_kg": formation.inertia_kg}
    columns |= {"auxiliary_w": formation.auxiliary_w, "heating_s": formation.heating_w / known.u_n**2}
    row = np.array([tuple(columns.get(name, 0) for name in TRAIN.names or ())], TRAIN)
    kinds = {"knots": KNOT, "pieces": PIECE, "stops": STOP, "limits": LINE_LIMIT, "turns": TURN}
    tables = TrainTables(trains=row, **{name: np.zeros(0, kind) for name, kind in kinds.items()}, **pool_arrays(pools))
    speed = np.linspace(0.0, formation.max_mps, _SPEEDS)
    weight, brake = formation.mass_kg * GRAVITY, row[0]
    running = formation.a_n + formation.b_ns_per_m * speed + formation.c_ns2_per_m2 * speed**2
    with np.errstate(divide="ignore", invalid="ignore"):
        braking = np.where(speed > brake["brake_from_mps"], np.minimum(brake["brake_n"], brake["brake_w"] / speed), 0.0)
    adhesion = brake["adhesive_n"] * (brake["adhesion_a_mps"] / (speed + brake["adhesion_b_mps"]) + brake["adhesion_c"])
    return TrainCurves(
        train=train.id,
        speed_mps=speed,
        curves=tuple(_curve(tables, speed, volts) for volts in voltages_v),
        adhesion_n=np.where(adhesion < 1e-3 * NO_LIMIT, adhesion, np.inf),
        resistance_n={permille: running + weight * permille / 1e3 for permille in GRADIENTS_PERMILLE},
        electric_brake_n=braking,
        mass_kg=formation.mass_kg,
        length_m=formation.length_m,
        notches=notch_curves(drive, formation.units, known.u_n, formation.max_mps) if isinstance(drive, SeriesMotorDrive) else (),
    )


def _curve(tables: TrainTables, speed: Floats, volts: float) -> Curve:
    effort, current = np.zeros(len(speed)), np.zeros(len(speed))
    if tables.trains[0]["drive"] != NO_DRIVE:
        trace(tables, np.zeros(1, MOVER), volts, speed, effort, current)
    return Curve(volts, effort, current)
