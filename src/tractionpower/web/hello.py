"""What a page is told when it opens: the train, its controls, the track ahead, the keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tractionpower.model.dynamics.case import CaseGradient, DynamicsScenario
from tractionpower.web.keys import key_map
from tractionpower.web.pacing import FACTORS
from tractionpower.web.quantities import panel


def highest_levels(scenario: DynamicsScenario) -> dict[str, int]:
    """Return the highest level of each control; 0 where the train has no such control."""
    parts = scenario.parts
    return {
        "drive": max((part.traction.levels for part in parts if part.traction), default=0),
        "brake": scenario.case.air_brake.levels if any(part.brake for part in parts) else 0,
        "electric": max((part.electric_brake.levels for part in parts if part.electric_brake), default=0),
    }


def has_independent_brake(scenario: DynamicsScenario) -> bool:
    """Return whether a powered vehicle of the train has an air brake."""
    return any(part.brake is not None and part.traction is not None for part in scenario.parts)


def hello(scenario: DynamicsScenario, folder: str) -> dict[str, Any]:
    """Return what a page is told first; `folder` is where the results go."""
    case, parts = scenario.case, scenario.parts
    return {
        "name": case.name,
        "folder": folder,
        "vehicles": [part.id for part in parts],
        "powered": [part.traction is not None for part in parts],
        "limits": [_endurable(scenario, part.coupling) for part in parts[:-1]],
        "highest": highest_levels(scenario),
        "independent": has_independent_brake(scenario),
        "highest_bar": case.air_brake.cylinder_pressure_bar,
        "profile": profile(case.track.gradients),
        "curves": [[curve.from_m, curve.to_m, curve.radius_m, curve.turns] for curve in case.track.curves],
        "length_m": train_length_m(scenario),
        "duration_s": case.run.duration_s,
        "step_s": case.run.step_s,
        "keys": key_map(),
        "panel": panel(),
        "factors": list(FACTORS),
    }


def train_length_m(scenario: DynamicsScenario) -> float:
    """Return the length of the train [m], as far as its vehicles say theirs."""
    return sum(scenario.vehicle(part.id).length_m or 0.0 for part in scenario.parts)


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


def gradient_at(rows: list[list[float]], place_m: float) -> float:
    """Return the gradient [permille] of a profile at a place; level where it says nothing."""
    return next((permille for start, end, permille, _ in rows if start <= place_m < end), 0.0)


def _endurable(scenario: DynamicsScenario, coupling: str | None) -> Mapping[str, float | None]:
    """Return the forces [kN] that a coupling endures."""
    if coupling is None:
        return {"tension_kn": None, "compression_kn": None}
    found = scenario.coupling(coupling)
    return {"tension_kn": found.endurable_tension_kn, "compression_kn": found.endurable_compression_kn}
