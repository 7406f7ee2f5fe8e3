"""A train as many vehicles at one instant, in the units of the boundary: what a driver sees of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.chain_state import ChainState

KN, BAR, KWH, KMH = 1e3, 1e5, 3.6e6, 1.0 / 3.6

Array = NDArray[Any]


class Air(NamedTuple):
    """The brake pipe at the driver's valve.

    Attributes
    ----------
    reduction_pa, pipe_pa
        Reduction, and pressure of the charged pipe [Pa].
    """

    reduction_pa: float
    pipe_pa: float


def snapshot(state: ChainState, forces_n: Array, applied_n: Array, air: Air, weights_n: Array) -> dict[str, Any]:
    """Return what is the case now.

    Forces of brakes and resistance are sums against the direction of travel: traction less these and less gravity is mass times
    acceleration. Where a vehicle stands they are what holds it, against whatever acts on it, and so may cancel along the train.

    Parameters
    ----------
    state
        State of the chain, its forces those of this instant.
    forces_n
        Forces of the couplings, tension positive [N], shape (vehicles - 1,).
    applied_n
        What acts on each vehicle besides friction [N].
    air
        The brake pipe.
    weights_n
        Weights of the vehicles [N].
    """
    ledger, movers, links = state.ledger[0], state.movers, state.links
    control, first = state.controls[ledger["control_row"]], movers[0]
    against = np.sign(np.where(movers["v_mps"] != 0.0, movers["v_mps"], applied_n))
    greatest, least = np.maximum(links["greatest_n"], 0.0) / KN, np.minimum(links["least_n"], 0.0) / KN
    cylinders = np.maximum(movers["cylinder_pa"], movers["independent_pa"]) / BAR
    return {
        "time_s": float(ledger["time_s"]),
        "drive": int(control["drive"]),
        "brake": int(control["brake"]),
        "electric_percent": 100.0 * float(control["electric"]),
        "independent_bar": float(control["independent_pa"]) / BAR,
        "speed_kmh": float(first["v_mps"]) / KMH,
        "position_m": float(first["s_m"] - first["start_m"]),
        "acceleration_mps2": float(first["a_mps2"]),
        "gradient_permille": 1e3 * float(first["grade_n"]) / float(weights_n[0]),
        "tractive_force_kn": float(movers["traction_n"].sum()) / KN,
        "brake_force_kn": float((against * (movers["brake_n"] + movers["electric_acting_n"])).sum()) / KN,
        "resistance_kn": float((against * movers["resistance_n"]).sum()) / KN,
        "first_coupling_kn": float(forces_n[0]) / KN if len(forces_n) else 0.0,
        "greatest_tension_kn": float(greatest.max(initial=0.0)),
        "greatest_compression_kn": abs(float(least.min(initial=0.0))),
        "cylinder_bar": (float(cylinders[0]), float(cylinders[-1])),
        "pipe_bar": (air.pipe_pa - air.reduction_pa) / BAR,
        "energy_kwh": float(ledger["traction_j"]) / KWH,
        "forces_kn": (forces_n / KN).tolist(),
        "greatest_kn": greatest.tolist(),  # of each coupling in every step up to now
        "least_kn": least.tolist(),
        "finished": bool(ledger["ended"]),
    }


def distributions(state: ChainState, bins: Array) -> dict[str, Any]:
    """Return the distributions up to now as relative frequencies, with one bin more at either end, and the edges of the bins.

    ``drive_speed`` and ``brake_speed`` have a row for each level (Zobory and Bekefi, section 8); `bins` are records of
    `HISTOGRAM`: of speed, force and acceleration.
    """
    spent: Mapping[str, Array] = {
        "drive_speed": state.drive_speed,
        "brake_speed": state.brake_speed,
        "force": state.force,
        "acceleration": state.acceleration,
    }
    edges = [row["from_"] + row["width"] * np.arange(int(row["bins"]) + 1) for row in bins]
    return {
        **{name: times / max(float(times.sum()), 1e-12) for name, times in spent.items()},
        "speed_edges_kmh": edges[0] / KMH,
        "force_edges_kn": edges[1] / KN,
        "acceleration_edges_mps2": edges[2],
    }
