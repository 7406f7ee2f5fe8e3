"""Couplings in a few words, and paths through them."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tractionpower.dynamics.couplings import coupling_tables
from tractionpower.kernels.chain_state import LINK
from tractionpower.kernels.couplings import trace_coupling
from tractionpower.model.dynamics.coupling import Coupling

SPRING_8_9 = ((50.0, 500.0), (100.0, 1750.0))
"""Arshad et al., eq. 8 and 9: 10 kN/mm up to 50 mm, then 25 kN/mm."""


def points(*pairs: tuple[float, float]) -> list[dict[str, float]]:
    """Return points (mm, kN) as an input file has them."""
    return [{"deflection_mm": x, "force_kn": f} for x, f in pairs]


def wedge(static: float = 0.2, kinetic: float | None = None, angle_deg: float = 35.0) -> dict[str, float]:
    """Return a wedge, by default with one coefficient of friction."""
    return {"angle_deg": angle_deg, "static_friction": static, "kinetic_friction": static if kinetic is None else kinetic}


def coupling(draw: dict[str, Any], **more: Any) -> Coupling:
    """Return a coupling with that draw gear."""
    return Coupling.model_validate({"id": "c", "draw": draw} | more)


def trace(
    which: Coupling, stretch_mm: ArrayLike, rate_mps: ArrayLike, links: NDArray[np.void] | None = None
) -> NDArray[np.float64]:
    """Return the forces [kN] along a path from a free coupling, or from where `links` is."""
    stretch = 1e-3 * np.atleast_1d(np.asarray(stretch_mm, float))
    rate = np.broadcast_to(np.asarray(rate_mps, float), stretch.shape).copy()
    force = np.empty_like(stretch)
    trace_coupling(coupling_tables(which), np.zeros(1, LINK) if links is None else links, stretch, rate, force)
    return 1e-3 * force


def work(force_kn: ArrayLike, stretch_mm: ArrayLike) -> float:
    """Return the work that is put in along a path [J], straight lines between its points."""
    return float(np.trapezoid(force_kn, stretch_mm))


def cycle(which: Coupling, top_mm: float, points_each_way: int, speed_mps: float = 1.0) -> tuple[float, float]:
    """Return the work put in from 0 to `top_mm`, and that given back on the way down [J].

    Both ways have the kinks of `SPRING_8_9` among their points, and the way down begins with the speed already turned.
    """
    way = np.unique(np.r_[np.linspace(0.0, top_mm, points_each_way), 50.0])
    forces = trace(which, np.r_[way, way[::-1]], np.r_[np.full(way.size, speed_mps), np.full(way.size, -speed_mps)])
    return work(forces[: way.size], way), -work(forces[way.size :], way[::-1])


TAN_35 = math.tan(math.radians(35.0))
