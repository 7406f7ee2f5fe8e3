"""Couplings as rows of tables: springs as curves, wedges as tangents; how stiff they are, and their loops."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tractionpower.kernels.chain_state import LINK
from tractionpower.kernels.chain_tables import COUPLING, GEAR, POINT
from tractionpower.kernels.couplings import trace_coupling
from tractionpower.model.dynamics.coupling import Coupling, Gear, GearPoint, Wedge

Curve = list[tuple[float, float]]
"""Points (deflection [m], force [N]) from deflection 0 on; deflections rise."""

N_PER_M = 1e6
"""Stiffness of 1 kN/mm."""

_SPRING_M = 0.1
"""Where the second point of a linear spring lies; its slope goes on."""


class Couplings(NamedTuple):
    """What the kernel of couplings reads, without the rest of a chain."""

    couplings: NDArray[np.void]  # COUPLING
    gears: NDArray[np.void]  # GEAR
    curves: NDArray[np.void]  # POINT


def compile_couplings(
    couplings: Sequence[Coupling], curves: list[tuple[float, float]]
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return the rows of COUPLING, one for each of `couplings`, and those of GEAR, equal gears once.

    Parameters
    ----------
    couplings
        The coupling behind each vehicle but the last; checked.
    curves
        Points that the rows of GEAR point at; those of the gears are appended.
    """
    gears: dict[Gear, int] = {}
    rows: list[tuple[float, ...]] = []
    found = np.zeros(len(couplings), COUPLING)
    for row, coupling in zip(found, couplings, strict=True):
        row["half_slack_m"] = 0.5e-3 * coupling.slack_mm
        row["damping_ns_per_m"] = 1e3 * coupling.damping_kns_per_m
        for side, gear in (("draw", coupling.draw), ("buff", coupling.buff or coupling.draw)):
            if gear not in gears:
                gears[gear] = len(rows)
                rows.append(_gear_row(gear, curves))
            row[side] = gears[gear]
    return found, np.array(rows, GEAR)


def loading_curve(gear: Gear) -> Curve:
    """Return the loading curve of a gear, that of its spring where it has a wedge."""
    if gear.stiffness_kn_per_mm is not None:
        points: Curve = [(0.0, 0.0), (_SPRING_M, N_PER_M * gear.stiffness_kn_per_mm * _SPRING_M)]
    else:
        points = _points(gear.loading)
    return [(gear.in_series * x, force) for x, force in points]


def unloading_curve(gear: Gear) -> Curve:
    """Return the unloading curve of a gear without a wedge."""
    if gear.unloading:
        return [(gear.in_series * x, force) for x, force in _points(gear.unloading)]
    kept = 1.0 - gear.damping_percent / 100.0
    return [(x, kept * force) for x, force in loading_curve(gear)]


def greatest_stiffness(coupling: Coupling, solid: bool = True) -> float:
    """Return the greatest tangent dF/dx of a coupling, loaded or unloaded, either way [N/m].

    Parameters
    ----------
    coupling
        The coupling; checked.
    solid
        Whether to count what is solid beyond the strokes.
    """
    draw, buff = coupling.draw, coupling.buff or coupling.draw
    either = [_gear_stiffness(gear, solid) for gear in (draw, buff)]
    return sum(either) if coupling.slack_mm < 0.0 else max(either)  # preloaded against each other both act


def greatest_damping(coupling: Coupling) -> float:
    """Return the greatest tangent dF/dv of a coupling up to its strokes or last points, either way [N s/m].

    That of its damper, and where no stiffness is locked that of the passage from loading to unloading, which acts as one.
    """
    draw, buff = coupling.draw, coupling.buff or coupling.draw
    either = [_gear_damping(gear) for gear in (draw, buff)]
    return 1e3 * coupling.damping_kns_per_m + (sum(either) if coupling.slack_mm < 0.0 else max(either))


def loop(coupling: Coupling, deflections_mm: ArrayLike, speed_mps: float) -> NDArray[np.float64]:
    """Return the forces [kN] of a coupling, tension positive, that goes through deflections at one speed from where it is free.

    Parameters
    ----------
    coupling
        The coupling; checked.
    deflections_mm
        How much longer it is than in the middle of its slack, in the order of time.
    speed_mps
        Speed of the changes between them; where a deflection is repeated the coupling rests.
    """
    stretch = 1e-3 * np.atleast_1d(np.asarray(deflections_mm, float))
    rate = abs(speed_mps) * np.sign(np.diff(stretch, prepend=0.0))
    force, links = np.empty_like(stretch), np.zeros(1, LINK)
    trace_coupling(coupling_tables(coupling), links, stretch, rate, force)
    return 1e-3 * force


def coupling_tables(coupling: Coupling) -> Couplings:
    """Return the tables of one coupling alone."""
    curves: list[tuple[float, float]] = []
    rows, gears = compile_couplings([coupling], curves)
    return Couplings(rows, gears, np.array(curves, POINT))


def wedge_factors(wedge: Wedge, friction: float) -> tuple[float, float]:
    """Return the factors of the spring force on loading and on unloading (Arshad et al., eq. 6 and 7)."""
    tan = math.tan(math.radians(wedge.angle_deg))
    return tan / (tan - friction), tan / (tan + friction)


def slopes(curve: Curve) -> list[float]:
    """Return the slope of each piece of a curve [N/m]."""
    return [(y1 - y0) / (x1 - x0) for (x0, y0), (x1, y1) in pairwise(curve)]


def force_at(curve: Curve, x: float) -> float:
    """Return the force of a curve at a deflection [m]; the last slope goes on [N]."""
    k = next((k for k in range(1, len(curve)) if x <= curve[k][0]), len(curve) - 1)
    (x0, y0), (x1, y1) = curve[k - 1], curve[k]
    return y0 + (y1 - y0) / (x1 - x0) * (x - x0)


def envelope_slopes(gear: Gear) -> list[float]:
    """Return the slopes of the envelopes of a gear [N/m], those with a wedge at both of its coefficients of friction."""
    springs = slopes(loading_curve(gear))
    if gear.wedge is None:
        envelopes = springs + slopes(unloading_curve(gear))
    else:
        frictions = (gear.wedge.static_friction, gear.wedge.kinetic_friction)
        factors = [factor for friction in frictions for factor in wedge_factors(gear.wedge, friction)]
        envelopes = [factor * spring for factor in factors for spring in springs]
    return [*envelopes, N_PER_M * gear.relaxing_stiffness_kn_per_mm / gear.in_series]


def _gear_row(gear: Gear, curves: Curve) -> tuple[float, ...]:
    """Return a row of GEAR and append its points to `curves`."""
    load = loading_curve(gear)
    unload = load if gear.wedge is not None else unloading_curve(gear)
    first_load = first_unload = len(curves)
    curves += load
    if unload != load:
        first_unload = len(curves)
        curves += unload
    wedge, series = gear.wedge, gear.in_series
    locked = N_PER_M * (gear.locked_stiffness_kn_per_mm or 0.0) / series
    solid = gear.solid_stiffness_kn_per_mm
    return (
        first_load,
        len(load),
        first_unload,
        len(unload),
        math.tan(math.radians(wedge.angle_deg)) if wedge is not None else 0.0,
        wedge.static_friction if wedge is not None else 0.0,
        wedge.kinetic_friction if wedge is not None else 0.0,
        wedge.blending_mps if wedge is not None else gear.blending_mps,
        locked,
        N_PER_M * gear.relaxing_stiffness_kn_per_mm / series,
        series * 1e-3 * gear.stroke_mm if gear.stroke_mm is not None else math.inf,
        N_PER_M * solid / series if solid is not None else locked,
        1e3 * gear.locked_damping_kns_per_m / series,
    )


def _points(points: Sequence[GearPoint]) -> Curve:
    """Return points in SI, from deflection 0 on."""
    curve = [(1e-3 * point.deflection_mm, 1e3 * point.force_kn) for point in points]
    return curve if curve and curve[0][0] == 0.0 else [(0.0, 0.0), *curve]


def _gear_stiffness(gear: Gear, solid: bool) -> float:
    """Return the greatest tangent dF/dx of a gear [N/m]."""
    found = [*envelope_slopes(gear), N_PER_M * (gear.locked_stiffness_kn_per_mm or 0.0) / gear.in_series]
    if solid and gear.stroke_mm is not None:
        found.append(N_PER_M * (gear.solid_stiffness_kn_per_mm or 0.0) / gear.in_series)
    return max(found)


def _gear_damping(gear: Gear) -> float:
    """Return the greatest tangent dF/dv of a gear up to its stroke or last point [N s/m]."""
    parts = 1e3 * gear.locked_damping_kns_per_m / gear.in_series
    if gear.locked_stiffness_kn_per_mm is not None:
        return parts
    load = loading_curve(gear)
    x = load[-1][0] if gear.stroke_mm is None else gear.in_series * 1e-3 * gear.stroke_mm
    force = force_at(load, x)
    if gear.wedge is None:
        return parts + (force - min(force, force_at(unloading_curve(gear), x))) / gear.blending_mps
    high, low = wedge_factors(gear.wedge, gear.wedge.kinetic_friction)
    return parts + force * (high - low) / gear.wedge.blending_mps
