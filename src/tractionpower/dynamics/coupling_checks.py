"""Checks of couplings: curves, wedges, stiffnesses and strokes that contradict each other, or would give energy from nothing."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from tractionpower.dynamics.couplings import N_PER_M, envelope_slopes, force_at, loading_curve, slopes, unloading_curve
from tractionpower.errors import Problem
from tractionpower.model.dynamics.coupling import Coupling, Gear, GearPoint, Wedge

_ROUNDING = 1e-9
"""Relative difference of two forces that counts as none."""

_DEFAULT_BLENDING = Gear.model_fields["blending_mps"].default


def check_coupling(coupling: Coupling, path: str) -> list[Problem]:
    """Return everything that is wrong or doubtful with a coupling that stands at `path` of the model."""
    sides = [("draw", coupling.draw)] + ([("buff", coupling.buff)] if coupling.buff is not None else [])
    problems = [problem for side, gear in sides for problem in _check_gear(f"{path}.{side}", gear)]
    preload_mm = -0.5 * coupling.slack_mm
    for side, gear in sides:
        stroke_mm = math.inf if gear.stroke_mm is None else gear.stroke_mm * gear.in_series
        if preload_mm > stroke_mm:
            found = f"each side is deflected by {preload_mm:g} mm at rest, {side} is solid from {stroke_mm:g} mm"
            allowed = f"from {-2.0 * stroke_mm:g} mm"
            problems.append(Problem("solid_at_rest", f"{path}.slack_mm", found, allowed, "give less preload or a longer stroke"))
    return problems


def _check_gear(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield what is wrong with one side of a coupling; what builds on its curves only where these are sound."""
    curves = [*_check_points(f"{path}.loading", gear.loading), *_check_points(f"{path}.unloading", gear.unloading)]
    curves += _check_source(path, gear)
    yield from curves
    yield from _check_contradictions(path, gear)
    yield from _check_solid(path, gear)
    wedge = [] if gear.wedge is None else [*_check_wedge(path, gear, gear.wedge)]
    yield from wedge
    if any(problem.severity == "error" for problem in curves):
        return
    yield from _check_unloading(path, gear)
    yield from _check_stroke(path, gear)
    if not any(problem.severity == "error" for problem in wedge):
        yield from _check_locked(path, gear)


def _check_points(path: str, points: Sequence[GearPoint]) -> Iterator[Problem]:
    """Yield where a curve goes back or falls."""
    for k in range(1, len(points)):
        before, here = points[k - 1], points[k]
        if here.deflection_mm <= before.deflection_mm:
            found, allowed = f"{here.deflection_mm:g} mm after {before.deflection_mm:g} mm", f"above {before.deflection_mm:g}"
            yield Problem("unsorted", f"{path}[{k}].deflection_mm", found, allowed, "sort the points by deflection, each once")
        elif here.force_kn < before.force_kn:
            found, allowed = f"{here.force_kn:g} kN after {before.force_kn:g} kN", f"{before.force_kn:g} or more"
            yield Problem("falling", f"{path}[{k}].force_kn", found, allowed, "correct the force: a spring does not get weaker")


def _check_source(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield that a gear has no curve, two of them, or one without a force."""
    if gear.stiffness_kn_per_mm is not None:
        if gear.loading:
            found = f"stiffness_kn_per_mm {gear.stiffness_kn_per_mm:g} and {len(gear.loading)} points of loading"
            yield Problem("two_curves", path, found, "one of them", "leave one out")
    elif not gear.loading:
        yield Problem("no_curve", path, "neither a stiffness nor points", "one of them", "give stiffness_kn_per_mm or loading")
    elif gear.loading[-1].deflection_mm == 0.0:
        yield Problem("no_curve", f"{path}.loading", "no point beyond deflection 0", "one or more", "add where the stroke ends")
    elif gear.loading[-1].force_kn == 0.0:
        yield Problem("no_force", f"{path}.loading", "no point has a force", "a force above 0", "correct force_kn")
    if gear.unloading and gear.unloading[-1].deflection_mm == 0.0:
        yield Problem("no_curve", f"{path}.unloading", "no point beyond deflection 0", "one or more", "add one, or leave all out")


def _check_contradictions(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield what is said twice about unloading, and what would have no effect."""
    ways = [
        name
        for name, given in (
            ("unloading", bool(gear.unloading)),
            ("damping_percent", gear.damping_percent > 0.0),
            ("wedge", gear.wedge is not None),
        )
        if given
    ]
    if len(ways) > 1:
        found = (
            f"{' and '.join(ways)} all say how it unloads" if len(ways) > 2 else f"{' and '.join(ways)} both say how it unloads"
        )
        yield Problem("contradictory_unloading", path, found, "one of them", "leave out all but one")
    if gear.blending_mps != _DEFAULT_BLENDING and (gear.wedge is not None or gear.locked_stiffness_kn_per_mm is not None):
        other = "the wedge has a blending_mps of its own" if gear.wedge is not None else "a locked stiffness takes its place"
        remedy = "leave it out" if gear.wedge is None else "give it in wedge"
        yield _doubt("no_effect", f"{path}.blending_mps", f"{gear.blending_mps:g} m/s has no effect: {other}", remedy)
    preload = gear.loading[0].force_kn if gear.loading and gear.loading[0].deflection_mm == 0.0 else 0.0
    if preload > 0.0 and gear.locked_stiffness_kn_per_mm is None:
        found = f"{preload:g} kN at deflection 0: the force would jump where the coupling leaves its slack"
        remedy = "give locked_stiffness_kn_per_mm, along which it rises, or begin at 0 kN"
        yield Problem("preload_without_locked_stiffness", f"{path}.loading[0].force_kn", found, "0", remedy)


def _check_wedge(path: str, gear: Gear, wedge: Wedge) -> Iterator[Problem]:
    """Yield what is wrong with the friction of a wedge (Arshad et al., eq. 1, 6)."""
    tan = math.tan(math.radians(wedge.angle_deg))
    for name, mu in (("static_friction", wedge.static_friction), ("kinetic_friction", wedge.kinetic_friction)):
        if mu >= tan:
            found = f"{mu:g} is not below tan({wedge.angle_deg:g} deg) = {tan:.4f}: the wedge locks, tan / (tan - mu) has no end"
            yield Problem("locked_wedge", f"{path}.wedge.{name}", found, f"below {tan:.4f}", "correct the friction or angle_deg")
    slow, fast = wedge.static_friction, wedge.kinetic_friction
    if fast > slow:
        found = f"kinetic friction {fast:g} is above static friction {slow:g}"
        yield _doubt("friction_rises", f"{path}.wedge.kinetic_friction", found, "check whether the two are exchanged")
    if slow != fast and gear.locked_stiffness_kn_per_mm is None:
        found = (
            f"without a locked stiffness and with friction from {slow:g} to {fast:g} the gear would return more energy when it is"
            " unloaded slowly than loading it fast has taken"
        )
        remedy = "give locked_stiffness_kn_per_mm (Arshad et al.: 600), or equal coefficients"
        yield Problem("wedge_without_locked_stiffness", path, found, remedy=remedy)


def _check_unloading(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield where unloading lies above loading."""
    if gear.wedge is not None or not gear.unloading:
        return
    load, unload = loading_curve(gear), unloading_curve(gear)
    for x in sorted({x for x, _ in load + unload}):
        high, low = force_at(load, x), force_at(unload, x)
        if low > high * (1.0 + _ROUNDING):
            found = f"{1e-3 * low:g} kN on unloading at {1e3 * x:g} mm, {1e-3 * high:g} kN on loading: energy from nothing"
            yield Problem(
                "unloading_above_loading", f"{path}.unloading", found, "nowhere above loading", "exchange or correct them"
            )
            return


def _check_locked(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield that the locked stiffness is softer than an envelope, or that relaxing lies above loading."""
    steepest = max(envelope_slopes(gear)) * gear.in_series / N_PER_M
    locked = gear.locked_stiffness_kn_per_mm
    if locked is not None and locked < steepest * (1.0 - _ROUNDING):
        found = f"{locked:g} kN/mm, while loading or unloading rises by {steepest:.4g} kN/mm (friction included)"
        remedy = "the parts in series cannot be softer than the whole: raise it, or leave it out"
        yield Problem("soft_locked_stiffness", f"{path}.locked_stiffness_kn_per_mm", found, f"{steepest:.4g} or more", remedy)
    relaxing, load = gear.relaxing_stiffness_kn_per_mm, loading_curve(gear)
    for x, force in load[1:]:
        if N_PER_M * relaxing / gear.in_series * x > force * (1.0 + _ROUNDING):
            found = f"{relaxing:g} kN/mm lies above loading at {1e3 * x:g} mm: no friction is left there"
            yield _doubt("stiff_relaxing", f"{path}.relaxing_stiffness_kn_per_mm", found, "lower it")
            return


def _check_stroke(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield that points lie beyond the stroke, or that the gear is softer when solid."""
    if gear.stroke_mm is None:
        return
    for name, points in (("loading", gear.loading), ("unloading", gear.unloading)):
        if points and points[-1].deflection_mm > gear.stroke_mm:
            found = f"solid from {gear.stroke_mm:g} mm, but {name} has points up to {points[-1].deflection_mm:g} mm"
            yield _doubt(
                "points_beyond_stroke", f"{path}.stroke_mm", found, "they are not reached: correct the stroke or the points"
            )
    solid = gear.solid_stiffness_kn_per_mm or gear.locked_stiffness_kn_per_mm
    last = slopes(loading_curve(gear))[-1] * gear.in_series / N_PER_M
    if solid is not None and solid < last:
        found = f"{solid:g} kN/mm when solid, {last:.4g} kN/mm before"
        yield _doubt("soft_when_solid", f"{path}.solid_stiffness_kn_per_mm", found, "raise it")


def _check_solid(path: str, gear: Gear) -> Iterator[Problem]:
    """Yield that a stroke has no stiffness beyond it, or a stiffness no stroke."""
    if gear.stroke_mm is None and gear.solid_stiffness_kn_per_mm is not None:
        yield _doubt("no_effect", f"{path}.solid_stiffness_kn_per_mm", "without stroke_mm it is never solid", "give stroke_mm")
    if gear.stroke_mm is not None and gear.solid_stiffness_kn_per_mm is None and gear.locked_stiffness_kn_per_mm is None:
        found = f"solid from {gear.stroke_mm:g} mm, but neither a solid nor a locked stiffness"
        yield Problem("no_solid_stiffness", f"{path}.stroke_mm", found, "one of them", "give solid_stiffness_kn_per_mm")


def _doubt(code: str, path: str, found: str, remedy: str) -> Problem:
    """Return a warning."""
    return Problem(code, path, found, remedy=remedy, severity="warning")
