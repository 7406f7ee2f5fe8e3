"""Chains with controls only: vehicles, engines, brakes and a driver, without couplings and track."""

from typing import Any

import numpy as np

from tractionpower.dynamics.brakes import compile_brakes, settled_cylinder_pa
from tractionpower.dynamics.commands import compile_commands
from tractionpower.dynamics.engines import compile_engines
from tractionpower.kernels.air_brake import brake_force, friction_of, move_brakes, reduction_at
from tractionpower.kernels.chain_state import LEDGER, MOVER, ChainState
from tractionpower.kernels.chain_tables import POINT, VEHICLE, Chain
from tractionpower.kernels.engines import electric_effort, lagged, steady_effort
from tractionpower.kernels.jit import njit
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.dynamics.case import Case, DynamicsScenario
from tractionpower.model.vehicle import Vehicle

LENGTH_M = 20.0
"""Length of every vehicle."""

GEAR = {"cylinder_area_cm2": 1000.0, "rigging_ratio": 5.0, "rigging_efficiency": 1.0, "friction": {"law": "constant"}}
"""A brake gear of 0.5 N/Pa and a friction of 0.3."""


def vehicle(identifier: str = "wagon", kind: str = "wagon", **given: Any) -> Vehicle:
    """Return a vehicle of 80 t."""
    plain = {"mass_t": 80.0, "length_m": LENGTH_M, "max_speed_kmh": 120.0, "rotating_mass_factor": 1.0, "resistance": {}}
    return Vehicle.model_validate({"id": identifier, "kind": kind} | plain | given)


def locomotive(**given: Any) -> Vehicle:
    """Return a locomotive with an inverter drive of 270 kN and 1500 kW."""
    drive = {"kind": "inverter", "starting_effort_kn": 270.0, "power_kw": 1500.0, "efficiency": 0.85}
    return vehicle("loco", "locomotive", **{"drive": drive} | given)


def scenario(*commands: dict[str, Any], wagons: int = 2, loco: Vehicle | None = None, **given: Any) -> DynamicsScenario:
    """Return a locomotive and wagons, and what the driver does; `given` are further keys of the case."""
    plain = {
        "name": "controls",
        "vehicles": [{"id": "loco"}, *([{"id": "wagon", "count": wagons}] if wagons else [])],
        "brake": GEAR,
        "run": {"duration_s": 100.0},
        "commands": commands,
    }
    case = Case.model_validate(plain | given)
    return DynamicsScenario(case=case, vehicles=(loco or locomotive(), vehicle()), couplings=())


def compiled(given: DynamicsScenario) -> tuple[Chain, ChainState]:
    """Return the controls of a scenario as tables, and how they start."""
    parts, curves = given.parts, []
    weights = [given.vehicle(part.id).mass_t * 1e3 * GRAVITY for part in parts]
    behind = [LENGTH_M * (k + 0.5) for k in range(len(parts))]
    engines = compile_engines(given, curves)
    brakes = compile_brakes(given, weights, behind)
    pipe, controls = compile_commands(given.case)
    vehicles = np.zeros(len(parts), VEHICLE)
    vehicles["engine"], vehicles["brake"] = engines.rows, brakes.rows
    movers, ledger = np.zeros(len(parts), MOVER), np.zeros(1, LEDGER)
    ledger["pipe_rows"], ledger["control_rows"] = len(pipe), len(controls)
    controls = np.append(controls, np.full(3, -1, controls.dtype))  # room for a driver, not in use
    movers["cylinder_pa"] = np.where(vehicles["brake"] >= 0, settled_cylinder_pa(brakes.air[0], pipe[0]), 0.0)
    rows = {"vehicles": vehicles, "engines": engines.engines, "levels": engines.levels, "curves": np.array(curves, POINT)}
    rows |= {"brakes": brakes.brakes, "frictions": brakes.frictions, "grid": brakes.grid, "air": brakes.air}
    chain = Chain(**_filled(Chain, **rows))
    state = ChainState(**_filled(ChainState, movers=movers, ledger=ledger, pipe=pipe, controls=controls))
    return chain, state


def _filled(bundle: Any, **given: Any) -> dict[str, Any]:
    """Return the fields of a bundle of arrays; those that controls do not read are empty."""
    return dict.fromkeys(bundle._fields, np.zeros(0)) | given


@njit
def run_brakes(chain, state, times, cylinders, independents):
    """Fill the pressures of all vehicles (rows: instants) on steps from instant to instant."""
    for k in range(times.shape[0]):
        if k > 0:
            move_brakes(chain, state, times[k - 1], times[k] - times[k - 1])
        for i in range(state.movers.shape[0]):
            cylinders[k, i] = state.movers[i].cylinder_pa
            independents[k, i] = state.movers[i].independent_pa


def pressures(given: DynamicsScenario, times: Any) -> tuple[Any, Any]:
    """Return the pressures of cylinders and independent brakes [Pa] at instants, the first of which is 0."""
    chain, state = compiled(given)
    at = np.asarray(times, dtype=float)
    cylinders, independents = np.zeros((len(at), len(state.movers))), np.zeros((len(at), len(state.movers)))
    run_brakes(chain, state, at, cylinders, independents)
    return cylinders, independents


@njit
def steady_effort_at(chain, row, level, v):
    return steady_effort(chain, row, level, v)


@njit
def electric_effort_at(chain, row, share, v):
    return electric_effort(chain, row, share, v)


@njit
def lagged_by(before, aim_before, aim_after, tau_s, time_constant_s):
    return lagged(before, aim_before, aim_after, tau_s, time_constant_s)


@njit
def brake_force_at(chain, row, cylinder_pa, independent_pa, v):
    return brake_force(chain, row, cylinder_pa, independent_pa, v)


@njit
def friction_at(chain, row, force_n, v):
    return friction_of(chain.frictions[row], chain.grid, force_n, v)


@njit
def reduction(chain, state, t_s):
    return reduction_at(chain, state, t_s)
