"""What a page is told when it opens: the train, its controls, the track ahead, the keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.dynamics.commands import electric_levels
from tractionpower.dynamics.compile import CompiledChain
from tractionpower.model.dynamics.case import CaseGradient, DynamicsScenario
from tractionpower.web.keys import key_map
from tractionpower.web.pacing import FACTORS
from tractionpower.web.quantities import panel


def highest_levels(compiled: CompiledChain) -> dict[str, int]:
    """Return the highest level of each control; 0 where the train has no such control."""
    case, engines = compiled.scenario.case, compiled.chain.engines
    return {
        "drive": int(engines["levels"].max(initial=0)),
        "brake": case.air_brake.levels if bool((compiled.chain.vehicles["brake"] >= 0).any()) else 0,
        "electric": electric_levels(case) if bool((engines["electric_n"] > 0.0).any()) else 0,
    }


def has_independent_brake(compiled: CompiledChain) -> bool:
    """Return whether a vehicle of the train has the independent brake."""
    return bool(compiled.chain.brakes["independent"].any())


def hello(compiled: CompiledChain, folder: str) -> dict[str, Any]:
    """Return what a page is told first; `folder` is where the results go."""
    scenario = compiled.scenario
    case, parts, vehicles = scenario.case, scenario.parts, compiled.chain.vehicles
    return {
        "name": case.name,
        "folder": folder,
        "vehicles": list(compiled.vehicle_names),
        "powered": (vehicles["engine"] >= 0).tolist(),
        "mass_t": float(vehicles["mass_kg"].sum()) / 1e3,
        "limits": [_endurable(scenario, part.coupling) for part in parts[:-1]],
        "highest": highest_levels(compiled),
        "independent": has_independent_brake(compiled),
        "highest_bar": case.air_brake.cylinder_pressure_bar,
        "profile": profile(case.track.gradients),
        "curves": [[curve.from_m, curve.to_m, curve.radius_m, curve.turns] for curve in case.track.curves],
        "length_m": float(compiled.chain.chain[0]["length_m"]),
        "step_s": case.run.step_s,
        "keys": key_map(),
        "panel": panel(),
        "factors": list(FACTORS),
    }


def profile(gradients: tuple[CaseGradient, ...]) -> list[list[float]]:
    """Return rows of from [m], to [m], gradient [permille] and height [m] at the beginning, gaps as level rows between.

    >>> profile((CaseGradient(from_m=100.0, to_m=300.0, permille=5.0), CaseGradient(from_m=400.0, to_m=500.0, permille=-2.0)))
    [[100.0, 300.0, 5.0, 0.0], [300.0, 400.0, 0.0, 1.0], [400.0, 500.0, -2.0, 1.0]]
    """
    rows: list[list[float]] = []
    height = 0.0
    for gradient in sorted(gradients, key=lambda row: row.from_m):
        if rows and gradient.from_m > rows[-1][1]:
            rows.append([rows[-1][1], gradient.from_m, 0.0, height])
        rows.append([gradient.from_m, gradient.to_m, gradient.permille, height])
        height += gradient.permille * 1e-3 * (gradient.to_m - gradient.from_m)
    return rows


def _endurable(scenario: DynamicsScenario, coupling: str | None) -> Mapping[str, float | None]:
    """Return the forces [kN] that a coupling endures."""
    if coupling is None:
        return {"tension_kn": None, "compression_kn": None}
    found = scenario.coupling(coupling)
    return {"tension_kn": found.endurable_tension_kn, "compression_kn": found.endurable_compression_kn}
