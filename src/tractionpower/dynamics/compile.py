"""From a case to what the kernels read: vehicles, engines, brakes, couplings, track and commands as tables; and the state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.brakes import compile_brakes, settled_cylinder_pa
from tractionpower.dynamics.commands import compile_commands, drive_levels
from tractionpower.dynamics.couplings import compile_couplings
from tractionpower.dynamics.engines import compile_engines
from tractionpower.dynamics.masses import inertias, masses
from tractionpower.dynamics.way import compile_way
from tractionpower.kernels.chain_state import LEDGER, LINK, MOVER, ChainState
from tractionpower.kernels.chain_tables import CHAIN, EULER, HISTOGRAM, POINT, RK4, SYMPLECTIC, VARIABLE, VEHICLE, Chain
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.dynamics.case import Case, DynamicsScenario

Array = NDArray[np.void]
Floats = NDArray[np.float64]

METHODS = {"symplectic": SYMPLECTIC, "rk4": RK4, "euler": EULER, "variable": VARIABLE}

KMH = 3.6
"""km/h per m/s."""

SPEED_BINS, FORCE_BINS, ACCELERATION_BINS = (0.0, 5.0 / KMH, 32), (-1e6, 25e3, 80), (-2.0, 0.05, 80)
"""Bins of the distributions: first value, width, number; speed [m/s], force [N], acceleration [m/s2]."""


@dataclass(frozen=True, slots=True, eq=False)
class CompiledChain:
    """A case as tables.

    Attributes
    ----------
    scenario
        What was compiled.
    chain
        What the kernels read.
    pipe, controls
        Rows of PIPE and CONTROL of the commands.
    vehicle_names, coupling_names
        ``3 wagon``, the number from the front and the identifier; ``3-4``, the numbers of the two vehicles.
    """

    scenario: DynamicsScenario
    chain: Chain
    pipe: Array
    controls: Array
    vehicle_names: tuple[str, ...]
    coupling_names: tuple[str, ...]

    def new_state(self) -> ChainState:
        """Return the state at the start of the case."""
        count = len(self.vehicle_names)
        movers, links, ledger = np.zeros(count, MOVER), np.zeros(max(count - 1, 0), LINK), np.zeros(1, LEDGER)
        start = self.scenario.case.start
        side = {"centred": 0.0, "stretched": 1.0, "bunched": -1.0}[start.couplings]
        stretch = side * np.maximum(self.chain.couplings["half_slack_m"], 0.0)
        movers["s_m"] = -self.chain.vehicles["behind_m"] - np.concatenate(([0.0], np.cumsum(stretch)))
        movers["start_m"] = movers["s_m"]
        movers["v_mps"] = movers["greatest_mps"] = start.speed_kmh / KMH
        ledger["standing"] = start.speed_kmh == 0.0
        movers["cylinder_pa"] = movers["cylinder_before_pa"] = settled_cylinder_pa(self.chain.air[0], self.pipe[0])
        movers["cylinder_pa"][self.chain.vehicles["brake"] < 0] = 0.0
        movers["cylinder_before_pa"] = movers["cylinder_pa"]
        links["stretch_m"] = stretch
        ledger["control_rows"], ledger["pipe_rows"] = len(self.controls), len(self.pipe)
        ledger["step_s"] = self.chain.chain[0]["step_s"]
        speeds, forces, accelerations = (int(row["bins"]) + 2 for row in self.chain.bins)
        levels, brakes = drive_levels(self.scenario.case) + 1, self.scenario.case.air_brake.levels + 2
        return ChainState(
            movers, links, ledger, self.pipe.copy(), self.controls.copy(), np.zeros((levels, speeds)), np.zeros((brakes, speeds)),
            np.zeros(forces), np.zeros(accelerations),
        )  # fmt: skip


def compile_chain(scenario: DynamicsScenario, *, live: bool = False) -> CompiledChain:
    """Return a case as tables.

    Parameters
    ----------
    scenario
        The case; checked.
    live
        A driver sets the controls: the commands after time 0 are left out, and the case does not end by time.
    """
    curves: list[tuple[float, float]] = []
    case = scenario.case
    if live:
        case = case.model_copy(update={"commands": tuple(each for each in case.commands if each.time_s == 0.0)})
    weight = masses(scenario) * GRAVITY
    behind, length = _places(scenario)
    engines, brakes = compile_engines(scenario, curves), compile_brakes(scenario, weight.tolist(), behind.tolist())
    couplings, gears = compile_couplings([scenario.coupling(str(part.coupling)) for part in scenario.parts[:-1]], curves)
    pipe, controls = compile_commands(case)
    slopes, bends, bend = compile_way(case.track)
    vehicles = _vehicles(scenario, weight, behind)
    vehicles["engine"], vehicles["brake"] = engines.rows, brakes.rows
    chain = Chain(
        _setup(case, length, live=live), vehicles, engines.engines, engines.levels, brakes.brakes, brakes.frictions,
        brakes.grid, brakes.air, couplings, gears, np.array(curves, POINT), slopes, bends, bend,
        np.array([SPEED_BINS, FORCE_BINS, ACCELERATION_BINS], HISTOGRAM),
    )  # fmt: skip
    numbers = range(1, len(vehicles) + 1)
    names = tuple(f"{number} {part.id}" for number, part in zip(numbers, scenario.parts, strict=True))
    return CompiledChain(scenario, chain, pipe, controls, names, tuple(f"{a}-{b}" for a, b in pairwise(numbers)))


def _setup(case: Case, length_m: float, *, live: bool) -> Array:
    setup, run = np.zeros(1, CHAIN), case.run
    setup["method"], setup["step_s"], setup["tolerance"] = METHODS[run.method], run.step_s, run.tolerance
    setup["standstill_mps"] = case.standstill_mps
    setup["cap_all"], setup["mean_grade"] = case.unified_resistance == "paper", case.grade == "train"
    setup["length_m"], setup["record_s"] = length_m, run.record_every_s
    setup["end_s"] = math.inf if live else run.duration_s
    setup["end_m"] = math.inf if run.distance_limit_m is None else run.distance_limit_m
    setup["ends_standing"] = run.ends == "standstill" and not live
    return setup


def _places(scenario: DynamicsScenario) -> tuple[Floats, float]:
    """Return how far the middle of each vehicle is behind the front of the train [m], and the length of the train [m]."""
    lengths = np.array([scenario.vehicle(part.id).length_m for part in scenario.parts])
    ends = np.cumsum(lengths)
    return ends - 0.5 * lengths, float(ends[-1])


def _vehicles(scenario: DynamicsScenario, weight: Floats, behind: Floats) -> Array:
    rows = np.zeros(len(weight), VEHICLE)
    rows["mass_kg"], rows["inertia_kg"], rows["weight_n"], rows["behind_m"] = weight / GRAVITY, inertias(scenario), weight, behind
    rows["adhesive_n"] = weight  # all axles are braked
    for row, part in zip(rows, scenario.parts, strict=True):
        vehicle = scenario.vehicle(part.id)
        resistance, adhesion, kn = vehicle.resistance, vehicle.adhesion, row["weight_n"] / 1000.0
        row["a_n"] = resistance.a_n + resistance.specific_a_n_per_kn * kn
        row["b_ns_per_m"] = (resistance.b_n_per_kmh + resistance.specific_b_n_per_kn_per_kmh * kn) * KMH
        row["c_ns2_per_m2"] = (resistance.c_n_per_kmh2 + resistance.specific_c_n_per_kn_per_kmh2 * kn) * KMH**2
        row["adhesion_a"], row["adhesion_b"], row["adhesion_c"] = adhesion.a_kmh / KMH, adhesion.b_kmh / KMH, adhesion.c
    return rows
