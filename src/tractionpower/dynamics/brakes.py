"""Air brakes as rows of tables: cylinders and rigging, friction of the blocks, delay along the pipe."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.commands import BAR
from tractionpower.dynamics.engines import KMH, powered
from tractionpower.kernels.chain_tables import AIR, BRAKE, FRICTION
from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.gear import AirBrake, BlockFriction, BrakeGear

KARWATZKI_G = 9.81
"""Acceleration that makes tonnes of the block force in Karwatzki's law [m/s2]."""


class BrakeTables(NamedTuple):
    """Air brakes of a train.

    Attributes
    ----------
    brakes, frictions, air
        Record arrays of BRAKE, FRICTION and AIR.
    grid
        Tables of friction: speeds [m/s], block forces [N], friction row by row of speeds.
    rows
        Row of BRAKE of each vehicle from the front, -1: no air brake in use.
    """

    brakes: NDArray[np.void]
    frictions: NDArray[np.void]
    grid: NDArray[np.float64]
    air: NDArray[np.void]
    rows: tuple[int, ...]


def compile_brakes(scenario: DynamicsScenario, weights_n: Sequence[float], behind_m: Sequence[float]) -> BrakeTables:
    """Return the air brakes of a train: a row for each vehicle that brakes, and one for each law of friction.

    The driver's valve is in the first vehicle: a change of pressure comes to another one after its distance from there over
    the speed of propagation.

    Parameters
    ----------
    scenario
        The case, without problems.
    weights_n
        Weight of each vehicle as loaded [N].
    behind_m
        Distance of the middle of each vehicle behind the front of the train [m].
    """
    air_brake = scenario.case.air_brake
    brakes: list[tuple[float, ...]] = []
    frictions: list[tuple[float, ...]] = []
    known: dict[BlockFriction, int] = {}
    grid: list[float] = []
    rows = []
    for k, (part, drives) in enumerate(zip(scenario.parts, powered(scenario), strict=True)):
        gear = part.brake
        if gear is None or not gear.in_use:
            rows.append(-1)
            continue
        if gear.friction not in known:
            known[gear.friction] = len(frictions)
            frictions.append(friction_row(gear.friction, grid))
        rows.append(len(brakes))
        delay = (behind_m[k] - behind_m[0]) / air_brake.propagation_mps
        force = newton_per_pascal(gear, weights_n[k], air_brake)
        brakes.append((delay, force, gear.blocks, known[gear.friction], drives))
    air = np.array([_air(air_brake)], AIR)
    return BrakeTables(np.array(brakes, BRAKE), np.array(frictions, FRICTION), np.array(grid), air, tuple(rows))


def newton_per_pascal(gear: BrakeGear, weight_n: float, air_brake: AirBrake) -> float:
    """Return the force of all blocks over the cylinder pressure [N/Pa].

    Piston area times rigging ratio and efficiency (Zobory and Bekefi, eq. 4), or the ratio to the weight at the greatest
    cylinder pressure of service.
    """
    if gear.brake_ratio is not None:
        return gear.brake_ratio * weight_n / (air_brake.cylinder_pressure_bar * BAR)
    return (gear.cylinder_area_cm2 or 0.0) * 1e-4 * (gear.rigging_ratio or 0.0) * gear.rigging_efficiency


def friction_row(friction: BlockFriction, grid: list[float]) -> tuple[float, ...]:
    """Return the row of FRICTION of a law, and append the table of the law `table` to `grid`."""
    if friction.law == "constant":
        return (friction.friction, 0.0, 0.0, 0.0, 0.0, 0, 0, 0)
    if friction.law == "karwatzki":
        per_newton = 1.0 / (KARWATZKI_G * 1e3 * 100.0)
        return (0.6, 16.0 * per_newton, 80.0 * per_newton, KMH / 100.0, 5.0 * KMH / 100.0, 0, 0, 0)
    speeds = sorted({point.speed_kmh for point in friction.points})
    forces = sorted({point.block_force_kn for point in friction.points})
    value = {(point.speed_kmh, point.block_force_kn): point.friction for point in friction.points}
    first = len(grid)
    grid += [speed / KMH for speed in speeds] + [force * 1e3 for force in forces]
    grid += [value[speed, force] for speed in speeds for force in forces]
    return (0.0, 0.0, 0.0, 0.0, 0.0, first, len(speeds), len(forces))


def settled_cylinder_pa(air: np.void, pipe_row: np.void) -> float:
    """Return the cylinder pressure that a row of PIPE leads to: how a train starts whose brake has settled [Pa]."""
    most = air["cylinder_emergency_pa"] if pipe_row["emergency"] else air["cylinder_pa"]
    return float(min(air["gain"] * pipe_row["target_pa"], most))


def _air(air_brake: AirBrake) -> tuple[float, ...]:
    emergency = air_brake.cylinder_emergency_bar
    fill = air_brake.cylinder_emergency_fill_s
    return (
        air_brake.gain,
        air_brake.cylinder_pressure_bar * BAR,
        (air_brake.cylinder_pressure_bar if emergency is None else emergency) * BAR,
        air_brake.cylinder_fill_s,
        air_brake.cylinder_release_s,
        air_brake.independent_time_constant_s,
        air_brake.pipe_pressure_bar * BAR,
        max(air_brake.cylinder_fill_s, air_brake.application_time_constant_s) if fill is None else fill,
    )
