"""Trains as chains of vehicles made in two lines, and what their kernel makes of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.compile import compile_chain
from tractionpower.kernels.chain import advance_chain
from tractionpower.kernels.chain_state import (
    BUFFER_FULL,
    CHAIN_ROW,
    LINK_ROW,
    MARK,
    TURN,
    VEHICLE_ROW,
    ChainBuffers,
    ChainState,
    new_chain_work,
)
from tractionpower.model.dynamics.case import DynamicsScenario

G = 9.80665
LOCOMOTIVE: dict[str, Any] = {
    "id": "loco",
    "kind": "locomotive",
    "mass_t": 80.0,
    "length_m": 15.0,
    "max_speed_kmh": 200.0,
    "rotating_mass_factor": 1.0,
    "resistance": {},
    "drive": {"kind": "inverter", "starting_effort_kn": 200.0, "power_kw": 1e6, "efficiency": 0.85},
}
"""Pulls 200 kN at any speed, and resists nothing."""

WAGON: dict[str, Any] = {key: value for key, value in LOCOMOTIVE.items() if key != "drive"} | {"id": "wagon", "kind": "wagon"}

AT_ONCE = {"levels": 1, "time_constant_s": 0.0}
"""Traction of one level that comes without delay."""

FULL = [{"time_s": 0.0, "drive": 1}]

WEDGE = {
    "slack_mm": 30.0,
    "draw": {
        "loading": [
            {"deflection_mm": 0.0, "force_kn": 0.0},
            {"deflection_mm": 50.0, "force_kn": 300.0},
            {"deflection_mm": 80.0, "force_kn": 810.0},
        ],
        "wedge": {"angle_deg": 35.0, "static_friction": 0.4, "kinetic_friction": 0.2},
        "locked_stiffness_kn_per_mm": 200.0,
        "relaxing_stiffness_kn_per_mm": 0.6,
    },
}
"""Draft gear with a friction wedge, and slack."""


def spring(stiffness_kn_per_mm: float, **more: Any) -> dict[str, Any]:
    """Return a coupling that is a linear spring, in tension and compression alike."""
    return {"draw": {"stiffness_kn_per_mm": stiffness_kn_per_mm}, **more}


def make_chain(
    parts: Sequence[Mapping[str, Any]],
    coupling: Mapping[str, Any],
    vehicles: Sequence[Mapping[str, Any]] = (LOCOMOTIVE, WAGON),
    run: Mapping[str, Any] | None = None,
    **case: Any,
) -> DynamicsScenario:
    """Return a case with one coupling and these parts of a train; keywords go to the case."""
    declared = {
        "name": "chain",
        "vehicles": [dict(part) for part in parts],
        "coupling": "c",
        "run": {"duration_s": 1000.0, "step_s": 0.005, "record_every_s": 0.05} | dict(run or {}),
        "standstill_mps": 0.0001,
    }
    return DynamicsScenario.model_validate(
        {"case": declared | case, "vehicles": [dict(each) for each in vehicles], "couplings": [{"id": "c", **coupling}]}
    )


def pulled(wagons: int, coupling: Mapping[str, Any], **more: Any) -> DynamicsScenario:
    """Return a locomotive that pulls so many wagons with all that it has from the start on."""
    parts = [{"id": "loco"}, {"id": "wagon", "count": wagons}]
    return make_chain(parts, coupling, **{"traction": AT_ONCE, "commands": FULL} | more)


def free(masses_t: Sequence[float], coupling: Mapping[str, Any], **more: Any) -> DynamicsScenario:
    """Return vehicles of these masses that nothing drives; keywords with `rotating` give their rotating mass factors."""
    factors = more.pop("rotating", [1.0] * len(masses_t))
    vehicles = [
        WAGON | {"id": f"w{k}", "mass_t": float(mass), "rotating_mass_factor": float(factor)}
        for k, (mass, factor) in enumerate(zip(masses_t, factors, strict=True))
    ]
    return make_chain([{"id": each["id"]} for each in vehicles], coupling, vehicles, **more)


class Chained:
    """A case in its kernel: tables and state at hand, and all rows.

    Parameters
    ----------
    scenario
        The case.
    rows
        Rows that its buffer takes before it is emptied.
    """

    def __init__(self, scenario: DynamicsScenario, rows: int = 4000) -> None:
        self.compiled = compile_chain(scenario)
        self.chain = self.compiled.chain
        self.state: ChainState = self.compiled.new_state()
        self.work = new_chain_work(len(self.chain.vehicles))
        n = len(self.chain.vehicles)
        self._buffers = ChainBuffers(
            np.zeros(rows, CHAIN_ROW),
            np.zeros((rows, n), VEHICLE_ROW),
            np.zeros((rows, n - 1), LINK_ROW),
            np.zeros(50_000, TURN),
            np.zeros(1000, MARK),
            np.zeros(3, np.int64),
        )
        self._taken: list[tuple[NDArray[np.void], ...]] = []
        self.marks = np.zeros(0, MARK)

    def advance(self, until_s: float) -> int:
        """Run until a time; the buffer is emptied whenever it is full. Returns why the kernel came back in the end."""
        while True:
            reason = advance_chain(self.chain, self.state, self._buffers, self.work, until_s)
            used = self._buffers.used[0]
            self._taken.append(tuple(kept[:used].copy() for kept in self._buffers[:3]))
            self.turns = self._buffers.turns[: self._buffers.used[1]].copy()
            self.marks = np.concatenate([self.marks, self._buffers.marks[: self._buffers.used[2]]])
            self._buffers.used[:] = 0
            if reason != BUFFER_FULL:
                return int(reason)

    @property
    def movers(self) -> NDArray[np.void]:
        return self.state.movers

    @property
    def links(self) -> NDArray[np.void]:
        return self.state.links

    @property
    def ledger(self) -> np.void:
        return self.state.ledger[0]

    @property
    def rows(self) -> NDArray[np.void]:
        """Rows of the whole chain so far."""
        return np.concatenate([part[0] for part in self._taken])

    @property
    def vehicle_rows(self) -> NDArray[np.void]:
        """Rows of the vehicles so far, shape (rows, vehicles)."""
        return np.concatenate([part[1] for part in self._taken])

    @property
    def link_rows(self) -> NDArray[np.void]:
        """Rows of the couplings so far, shape (rows, vehicles - 1)."""
        return np.concatenate([part[2] for part in self._taken])

    def kinetic_j(self) -> float:
        """Return the kinetic energy of all vehicles with their rotating parts [J]."""
        return float(0.5 * (self.chain.vehicles["inertia_kg"] * self.movers["v_mps"] ** 2).sum())

    def ledger_gap(self, kinetic_before_j: float) -> tuple[float, float]:
        """Return by how much the works since the start miss the change of kinetic energy [J], and the sum of their sizes [J]."""
        ledger = self.ledger
        taken = [float(ledger[name]) for name in ("electric_j", "brake_j", "resistance_j", "grade_j", "coupling_j")]
        gap = float(ledger["traction_j"]) - sum(taken) - (self.kinetic_j() - kinetic_before_j)
        return gap, abs(float(ledger["traction_j"])) + sum(map(abs, taken)) + abs(self.kinetic_j() - kinetic_before_j)


def advanced(scenario: DynamicsScenario, until_s: float, speeds: Sequence[float] | None = None) -> Chained:
    """Return a case after a time, started with these speeds [m/s] of its vehicles if they are given."""
    chained = Chained(scenario)
    if speeds is not None:
        chained.movers["v_mps"] = speeds
    chained.advance(until_s)
    return chained
