"""The two ledgers of a train that must close: work at the wheel against motion, energy from the line against that work."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.alignment.path import RoutePath
from tractionpower.kernels.wayside import GRAVITY
from tractionpower.movement.formation import Formation

Floats = NDArray[np.float64]

GIVEN = {"mechanical": ("wheel",), "pantograph_to_wheel": ("line", "recovered")}
"""Parts of the ledgers that give energy to a train; all others spend it."""

MECHANICAL_SHARE = 1e-3
"""The mechanical ledger closes within this share of what is exchanged."""

ELECTRIC_SHARE = 1e-6
"""The ledger from pantograph to wheel closes within this share."""

FITTED_SHARE = 1e-3
"""What the fit of a port may differ from the characteristic that it stands for, as a share."""


@dataclass(frozen=True, slots=True)
class TrainLedger:
    """Energies by name [J], positive where the train spends them, and whether their sum is nothing.

    The gap is the sum; its share is that of half of the absolute values.
    """

    energy_j: dict[str, float]
    allowed_share: float

    @property
    def gap_j(self) -> float:
        """What does not add up [J]."""
        return sum(self.energy_j.values())

    @property
    def gap_share(self) -> float:
        """The gap over what is exchanged."""
        return self._share(self.gap_j)

    @property
    def closes(self) -> bool:
        """Whether the gap is within what is allowed, and ports were fitted closely."""
        return self.gap_share <= self.allowed_share and self._share(self.energy_j.get("fitted", 0.0)) <= FITTED_SHARE

    def _share(self, joule: float) -> float:
        gross = 0.5 * sum(map(abs, self.energy_j.values()))
        return abs(joule) / gross if gross > 0.0 else 0.0


def mechanical_parts(rows: NDArray[np.void], seconds: Floats, mass: Formation, path: RoutePath) -> dict[str, Floats]:
    """Return work at the wheel, changes of kinetic and potential energy, work of resistance and brakes of each row [J].

    Kinetic energy counts rotating masses; potential energy is that of the mean height under the train. The work of the
    running resistance is integrated anew from places and speeds, not from the forces of the steps.

    Parameters
    ----------
    rows
        Steps of trains of one formation on one route, records of TRAIN_ROW.
    seconds
        Time for which each row holds [s].
    mass, path
        The train, and its route.
    """
    s, before = rows["s_m"], rows["v_mps"]
    ends, after = s + rows["moved_m"], before + rows["acceleration_mps2"] * seconds
    linear = 0.5 * (before + after)
    square = (before**2 + before * after + after**2) / 3.0
    cubic = 0.5 * linear * (before**2 + after**2)
    moving = np.divide(ends - s, linear, out=np.zeros_like(linear), where=linear > 0.0)  # a train may stand in part of a row
    running = mass.a_n * (ends - s) + moving * (mass.b_ns_per_m * square + mass.c_ns2_per_m2 * cubic)
    (single, single_drag), (double, double_drag) = mass.tunnel
    added = path.curve_m + single * path.single_tunnel_m + double * path.double_tunnel_m
    drag = single_drag * path.single_tunnel_m + double_drag * path.double_tunnel_m
    spread = mass.spread_m
    height, curves, dragged = (
        _mean_under(path, values, ends, spread) - _mean_under(path, values, s, spread) for values in (path.height_m, added, drag)
    )
    weight = mass.mass_kg * GRAVITY
    return {
        "wheel": -rows["wheel_w"] * seconds,
        "kinetic": 0.5 * mass.inertia_kg * (after**2 - before**2),
        "potential": weight * height,
        "resistance": running + weight * curves + dragged * 0.5 * (before**2 + after**2),
        "brakes": rows["brake_w"] * seconds,
    }


def pantograph_parts(rows: NDArray[np.void], seconds: Floats) -> dict[str, Floats]:
    """Return energy from the line, work at the wheel, losses, auxiliaries, and what braking gives, of each row [J].

    A drive that gives more than it takes leaves a gap, too. `coupling` is what the constant-voltage coupling leaves out,
    `fitted` by what the ports of duty cycles and tables differ from them.
    """
    named = {
        "line": -rows["voltage_v"] * rows["current_a"],
        "wheel": rows["wheel_w"],
        "drive_loss": rows["drive_loss_w"],
        "starting_resistors": rows["starting_resistor_w"],
        "auxiliaries": rows["auxiliary_w"],
        "recovered": -rows["recovered_w"],
        "coupling": rows["coupling_w"],
        "fitted": rows["fitted_w"],
        "out_of_nothing": np.maximum(-rows["drive_loss_w"], 0.0),
    }
    return {name: power * seconds for name, power in named.items()}


def mechanical_ledger(rows: NDArray[np.void], seconds: Floats, end_mps: float, mass: Formation, path: RoutePath) -> TrainLedger:
    """Return the mechanical ledger of one train that ends at the speed `end_mps` [m/s]; the rest as of `mechanical_parts`."""
    kinetic = 0.5 * mass.inertia_kg * (end_mps**2 - float(rows["v_mps"][0]) ** 2)  # without the rounding of all its changes
    return TrainLedger(_sums(mechanical_parts(rows, seconds, mass, path)) | {"kinetic": kinetic}, MECHANICAL_SHARE)


def pantograph_ledger(rows: NDArray[np.void], seconds: Floats) -> TrainLedger:
    """Return the ledger of one train from pantograph to wheel."""
    return TrainLedger(_sums(pantograph_parts(rows, seconds)), ELECTRIC_SHARE)


def told_kwh(kind: str, energy_j: Mapping[str, float]) -> dict[str, float]:
    """Return the energies of a ledger as they are told [kWh]: what is given and what is spent are both positive."""
    return {f"{name}_kwh": (-joule if name in GIVEN[kind] else joule) / 3.6e6 for name, joule in energy_j.items()}


def _sums(parts: dict[str, Floats]) -> dict[str, float]:
    return {name: float(values.sum()) for name, values in parts.items()}


def _mean_under(path: RoutePath, values: Floats, s: Floats, spread_m: float) -> Floats:
    """Return the mean under the train of what is straight between the places of `path`, the front at `s` [m]."""
    if spread_m <= 0.0:
        return np.interp(s, path.at_m, values)
    return (_integral(path.at_m, values, s) - _integral(path.at_m, values, s - spread_m)) / spread_m


def _integral(at: Floats, values: Floats, s: Floats) -> Floats:
    """Return the integral from the first place to `s` of what is straight between places and constant beyond them."""
    whole = np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(at))))
    k = np.clip(np.searchsorted(at, s, side="right") - 1, 0, len(at) - 1)
    here = np.interp(s, at, values)
    return np.asarray(np.where(s < at[0], values[0] * (s - at[0]), whole[k] + 0.5 * (values[k] + here) * (s - at[k])))
