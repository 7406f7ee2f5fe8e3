"""The energy ledger of a train as many vehicles: where the energy has gone, and how well a method has to close it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tractionpower.results.dynamics_tables import KWH

CLOSING: dict[str, tuple[float, float]] = {
    "symplectic": (1e-6, 1e-6),
    "variable": (1e-6, 1e-6),
    "rk4": (1e-6, 1e-3),
    "euler": (5e-2, 5e-2),
}
"""Parts of the energy put in that a method may leave over: what it is asked for, above which a note tells of it, and above which
the run is flagged. The symplectic method closes to rounding, the variable one by its tolerance; that of Runge and Kutta loses
some where forces of couplings have kinks within a step, that of Euler is of first order."""

_ORDER = {"euler": 1.0}
"""Order at which the gap falls with the step where it is not 4, found so for rk4 with buffers that have kinks too."""


@dataclass(frozen=True, slots=True)
class EnergyLedger:
    """Where the energy has gone [J]: traction + kinetic at the start = all that took some + kinetic at the end.

    Attributes
    ----------
    traction, electric, brake, resistance, gravity, coupling
        Works since the start; gravity is negative downhill.
    kinetic_start, kinetic_end
        Kinetic energy with rotating parts.
    """

    traction: float
    electric: float
    brake: float
    resistance: float
    gravity: float
    coupling: float
    kinetic_start: float
    kinetic_end: float

    @classmethod
    def of(cls, ledger: Any, kinetic_start_j: float, kinetic_end_j: float) -> EnergyLedger:
        """Return the ledger from a record of `LEDGER` or `CHAIN_ROW`, and the kinetic energies [J]."""
        names = ("traction_j", "electric_j", "brake_j", "resistance_j", "grade_j", "coupling_j")
        traction, electric, brake, resistance, gravity, coupling = (float(ledger[name]) for name in names)
        return cls(traction, electric, brake, resistance, gravity, coupling, kinetic_start_j, kinetic_end_j)

    @property
    def gap(self) -> float:
        """What is left over [J]."""
        taken = self.electric + self.brake + self.resistance + self.gravity + self.coupling
        return self.traction + self.kinetic_start - taken - self.kinetic_end

    @property
    def put_in(self) -> float:
        """Energy put in [J]: traction, kinetic energy at the start, what a descent gives."""
        return max(self.traction, 0.0) + self.kinetic_start + max(-self.gravity, 0.0)

    @property
    def gap_share(self) -> float:
        """The gap over the energy put in; where nothing was put in, 0 without a gap and infinite with one."""
        if self.put_in == 0.0:
            return 0.0 if self.gap == 0.0 else float("inf")
        return abs(self.gap) / self.put_in

    def as_dict(self, method: str) -> dict[str, Any]:
        """Return energies [kWh] and how well they close, by what is asked of a method; none where there is no number."""
        names = ("traction", "electric", "brake", "resistance", "gravity", "coupling", "kinetic_start", "kinetic_end")
        target, limit = CLOSING[method]
        told = {"gap_kwh": self.gap / KWH, "gap_share": self.gap_share, "target_share": target, "limit_share": limit}
        told |= {f"{name}_kwh": getattr(self, name) / KWH for name in names}
        closes = bool(self.gap_share <= limit)  # not a number does not close
        return {"closes": closes} | {name: value if np.isfinite(value) else None for name, value in told.items()}


def closing_note(gap_share: float, method: str, step_s: float, tolerance: float) -> str:
    """Return what to do about a ledger that leaves more over than is asked of its method; nothing where it does not.

    Parameters
    ----------
    gap_share
        Part of the energy put in that is left over.
    method
        Method of integration.
    step_s
        Its step [s].
    tolerance
        Tolerance of the variable method.

    >>> closing_note(6e-5, "rk4", 0.005, 1e-6)
    'the energy ledger leaves 6e-05 of the energy put in, more than the 1e-06 asked of rk4: shorten step_s of 0.005 s to 0.001 s'
    >>> closing_note(6.4e-7, "rk4", 0.005, 1e-6)
    ''
    """
    target, _ = CLOSING[method]
    if gap_share <= target:
        return ""
    if method == "variable":
        way = f"lower tolerance of {tolerance:g} to {_rounded_down(tolerance / 10.0):g}"
    else:
        less = (
            min((target / gap_share) ** (1.0 / _ORDER.get(method, 4.0)), 0.5)
            if math.isfinite(gap_share) and gap_share > 0.0
            else 0.5
        )
        way = f"shorten step_s of {step_s:g} s to {_rounded_down(step_s * less):g} s"
    return f"the energy ledger leaves {gap_share:.2g} of the energy put in, more than the {target:g} asked of {method}: {way}"


def _rounded_down(value: float) -> float:
    """Return a number of one digit, 1, 2 or 5, that is not above a value."""
    decade = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return max(digit * decade for digit in (1.0, 2.0, 5.0) if digit == 1.0 or digit * decade <= value * (1.0 + 1e-9))
