"""Masses of the vehicles of a case, as loaded."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.dynamics.case import CasePart, DynamicsScenario


def masses(scenario: DynamicsScenario) -> NDArray[np.float64]:
    """Return the masses of the vehicles from the front [kg]."""
    return np.array([_mass_and_inertia(scenario, part)[0] for part in scenario.parts])


def inertias(scenario: DynamicsScenario) -> NDArray[np.float64]:
    """Return their masses with rotating parts [kg]; the factor of a vehicle is that of the empty one."""
    return np.array([_mass_and_inertia(scenario, part)[1] for part in scenario.parts])


def _mass_and_inertia(scenario: DynamicsScenario, part: CasePart) -> tuple[float, float]:
    vehicle = scenario.vehicle(part.id)
    load = vehicle.load_t * part.load_percent / 100.0
    return 1000.0 * (vehicle.mass_t + load), 1000.0 * (vehicle.mass_t * vehicle.rotating_mass_factor + load)
