"""Whether a step is short enough for the stiffest couplings: the largest stable one is computed, a larger one refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.couplings import greatest_damping, greatest_stiffness
from tractionpower.dynamics.masses import inertias
from tractionpower.errors import Problem
from tractionpower.model.dynamics.case import DynamicsScenario

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

_ROUNDING = 1e-9
_HALVINGS = 60


class Modes(NamedTuple):
    """Modes of the train at its stiffest: angular frequency [rad/s] and damping rate [1/s] of each, q'' + d q' + w2 q = 0."""

    frequency: Floats
    damping: Floats


def stiffest_modes(scenario: DynamicsScenario) -> Modes:
    """Return the modes of the free chain with all couplings at their greatest stiffness and damping."""
    parts = scenario.parts
    mass = inertias(scenario)
    couplings = [scenario.coupling(str(part.coupling)) for part in parts[:-1]]
    each = {coupling.id: (greatest_stiffness(coupling), greatest_damping(coupling)) for coupling in couplings}
    root = 1.0 / np.sqrt(mass)
    stiffness, damping = (
        root[:, None] * _chain_matrix([each[coupling.id][k] for coupling in couplings]) * root[None, :] for k in (0, 1)
    )
    squares, shapes = np.linalg.eigh(stiffness)
    rates = np.einsum("ik,ij,jk->k", shapes, damping, shapes)
    return Modes(np.sqrt(np.maximum(squares, 0.0)), np.maximum(rates, 0.0))


def largest_step(modes: Modes, method: str) -> float:
    """Return the largest step with which a method does not blow up any of the modes [s]; infinite without couplings.

    A step is stable where no mode grows: |R(h l)| <= 1 for the eigenvalues l of a mode and the stability function R of a
    Runge-Kutta method, or the spectral radius of the leapfrog step. An undamped mode is stable up to w h = 2 for leapfrog
    and 2.83 for the classical Runge-Kutta method, and never for Euler's.
    """
    swinging = modes.frequency > 1e-6 * max(float(modes.frequency.max(initial=0.0)), 1e-30)
    kept = Modes(modes.frequency[swinging], modes.damping[swinging])
    if not len(kept.frequency):
        return math.inf
    growth = _GROWTH[method]
    low, high = 0.0, 4.0 / float(kept.frequency.max())
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        stable = bool(np.all(growth(kept, middle) <= 1.0 + _ROUNDING))
        low, high = (middle, high) if stable else (low, middle)
    return low


def check_step(scenario: DynamicsScenario) -> list[Problem]:
    """Return the problem that the step of a case is too large for its stiffness, if it is."""
    run = scenario.case.run
    if run.method == "variable" or len(scenario.parts) < 2:
        return []
    modes = stiffest_modes(scenario)
    limit = largest_step(modes, run.method)
    if run.step_s <= limit * (1.0 + 1e-6):
        return []
    fastest = float(modes.frequency.max())
    told = f"the stiffest couplings swing at {fastest:.0f} rad/s ({fastest / (2.0 * math.pi):.1f} Hz)"
    if limit * fastest < 1e-3:
        allowed = f"no step: {told} without enough damping for method {run.method}"
        remedy = "take method symplectic or rk4"
    else:
        allowed = f"at most {_rounded_down(limit):g} s with method {run.method}: {told}"
        remedy = "shorten step_s, soften locked_stiffness_kn_per_mm, or take method variable"
    return [Problem("step_too_large", "case.run.step_s", f"{run.step_s:g} s", allowed, remedy)]


def _rounded_down(value: float) -> float:
    """Return a number cut to three digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.floor(value / digit) * digit


def _chain_matrix(values: list[float]) -> Floats:
    """Return the matrix of a free chain of springs or dampers: tridiagonal, symmetric, row sums zero (Zobory, eq. 9)."""
    behind = np.array([*values, 0.0])
    ahead = np.array([0.0, *values])
    matrix: Floats = np.diag(behind + ahead) - np.diag(behind[:-1], 1) - np.diag(behind[:-1], -1)
    return matrix


def _eigenvalues(modes: Modes) -> Complexes:
    """Return the eigenvalues of the modes, shape (2, modes) [1/s]."""
    root = np.sqrt((0.25 * modes.damping**2 - modes.frequency**2).astype(complex))
    return np.stack((-0.5 * modes.damping + root, -0.5 * modes.damping - root))


def _euler(modes: Modes, h: float) -> Floats:
    return np.asarray(np.abs(1.0 + h * _eigenvalues(modes)))


def _rk4(modes: Modes, h: float) -> Floats:
    z = h * _eigenvalues(modes)
    return np.asarray(np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))))


def _leapfrog(modes: Modes, h: float) -> Floats:
    """Return the spectral radius of a leapfrog step for each mode.

    State (s, v, a): v' = v - h (w2 (s + h v/2) + d (v + h a/2)), a' = (v' - v)/h, s' = s + h (v + v')/2.
    """
    w2, d = modes.frequency**2, modes.damping
    step = np.zeros((len(w2), 3, 3))
    gain = step[:, 2]
    gain[:, 0], gain[:, 1], gain[:, 2] = -w2, -0.5 * h * w2 - d, -0.5 * h * d
    step[:, 1] = h * gain
    step[:, 1, 1] += 1.0
    step[:, 0] = 0.5 * h * step[:, 1]
    step[:, 0, 0] += 1.0
    step[:, 0, 1] += 0.5 * h
    return np.asarray(np.abs(np.linalg.eigvals(step)).max(axis=1))


_GROWTH: dict[str, Callable[[Modes, float], Floats]] = {"euler": _euler, "rk4": _rk4, "symplectic": _leapfrog}
