"""The force of a coupling over its stretch, its rate and what it has been through: slack, springs, friction, solid stops.

A gear has a loading and an unloading envelope, L(x, v) >= U(x, v). With a locked stiffness k its force moves between them
along lines of that slope (Arshad et al., table 2: loading, locked unloading, unloading release, unloading):

    F = min(max(F_committed + k (x - x_committed), U), L),    L never above k x.

Without one it passes from L to U with the speed of unloading (TrainDy, section 3.2): F = c U + (1 - c) L, with c from 0 at
standstill to 1 at `blending_mps`, and remembers nothing.
"""

from __future__ import annotations

from tractionpower.kernels.jit import inlined, njit

_NEAREST = 1e-6
"""Least distance of friction from the tangent of the wedge, where loading becomes infinite; the checks keep it far away."""


@inlined
def coupling_force(chain, link, row, stretch_m, rate_mps):
    """Return the force of a coupling [N], tension positive, and the part of its dampers in it; nothing is changed.

    Parameters
    ----------
    chain
        Bundle with `gears` and `curves`: `Chain` or `Couplings`.
    link
        Record of LINK: what was committed at the beginning of the step.
    row
        Record of COUPLING.
    stretch_m, rate_mps
        How much longer it is than in the middle of its slack [m], and the speed at which it lengthens [m/s].
    """
    damper_n = row.damping_ns_per_m * rate_mps
    force_n = damper_n
    x = stretch_m - row.half_slack_m
    if x > 0.0:
        gear = chain.gears[row.draw]
        pull = _gear_force(chain.curves, gear, x, -rate_mps, link.draw_n, link.draw_m) + _solid_force(gear, x)
        lost = _locked_damping(gear, pull, rate_mps)
        force_n += pull + lost
        damper_n += lost
    x = -stretch_m - row.half_slack_m
    if x > 0.0:
        gear = chain.gears[row.buff]
        push = _gear_force(chain.curves, gear, x, rate_mps, link.buff_n, link.buff_m) + _solid_force(gear, x)
        lost = _locked_damping(gear, push, -rate_mps)
        force_n -= push + lost
        damper_n -= lost
    return force_n, damper_n


@inlined
def commit_coupling(chain, link, row, stretch_m, rate_mps):
    """Take stretch and rate as the instant that has been reached: write force, stretch and what the gears remember.

    Returns the part of its dampers in the force [N], which is that of `coupling_force`.
    """
    damper_n = row.damping_ns_per_m * rate_mps
    force_n = damper_n
    draw_n, draw_m, buff_n, buff_m = 0.0, 0.0, 0.0, 0.0
    x = stretch_m - row.half_slack_m
    if x > 0.0:
        gear = chain.gears[row.draw]
        draw_m = min(x, gear.stroke_m)
        draw_n = _gear_force(chain.curves, gear, x, -rate_mps, link.draw_n, link.draw_m)
        pull = draw_n + _solid_force(gear, x)
        lost = _locked_damping(gear, pull, rate_mps)
        force_n += pull + lost
        damper_n += lost
    x = -stretch_m - row.half_slack_m
    if x > 0.0:
        gear = chain.gears[row.buff]
        buff_m = min(x, gear.stroke_m)
        buff_n = _gear_force(chain.curves, gear, x, rate_mps, link.buff_n, link.buff_m)
        push = buff_n + _solid_force(gear, x)
        lost = _locked_damping(gear, push, -rate_mps)
        force_n -= push + lost
        damper_n -= lost
    link.force_n, link.stretch_m = force_n, stretch_m
    link.draw_n, link.draw_m, link.buff_n, link.buff_m = draw_n, draw_m, buff_n, buff_m
    return damper_n


@njit
def trace_coupling(tables, links, stretch, rate, force):
    """Fill the forces [N] of the first coupling of `tables` as it goes through stretches [m] at rates [m/s].

    Each is committed before the next. `links` holds a record of LINK, which goes on from where it is.
    """
    row, link = tables.couplings[0], links[0]
    for n in range(stretch.shape[0]):
        force[n], _ = coupling_force(tables, link, row, stretch[n], rate[n])
        commit_coupling(tables, link, row, stretch[n], rate[n])


@njit
def _gear_force(curves, gear, x, opening, before_n, before_m):
    """Return the force [N] of a gear deflected by `x` > 0 [m] that is unloaded at the speed `opening` [m/s].

    `before_n`, `before_m` are its force and deflection committed last. Beyond the stroke the gear stays as it is there.
    """
    x = min(x, gear.stroke_m)
    load = _on_curve(curves, gear.first_load, gear.loads, x)
    unload = load
    if gear.tan_wedge > 0.0:
        tan, mu = gear.tan_wedge, _friction(gear, abs(opening))
        unload = load * tan / (tan + mu)  # Arshad et al., eq. 7
        load = load * tan / max(tan - mu, _NEAREST)  # eq. 6
    elif gear.first_unload != gear.first_load:
        unload = _on_curve(curves, gear.first_unload, gear.unloads, x)
    unload = max(unload, gear.relaxing_n_per_m * x)
    locked = gear.locked_n_per_m
    if locked > 0.0:
        load = min(load, locked * x)
        return min(max(before_n + locked * (x - before_m), min(unload, load)), load)
    if opening <= 0.0:
        return load
    c = min(opening / gear.blending_mps, 1.0) if gear.blending_mps > 0.0 else 1.0
    return load - c * (load - min(unload, load))


@inlined
def _solid_force(gear, x):
    """Return what the solid parts add beyond the stroke [N]."""
    return gear.solid_n_per_m * (x - gear.stroke_m) if x > gear.stroke_m else 0.0


@inlined
def _locked_damping(gear, force_n, closing_mps):
    """Return what the damping of the parts in series adds to the force of a gear that is loaded at a speed [N]; never a pull."""
    return max(gear.locked_damping_ns_per_m * closing_mps, -force_n)


@inlined
def _friction(gear, speed):
    """Return the coefficient of friction of the wedge at a `speed` [m/s] (Arshad et al., eq. 1)."""
    if speed >= gear.blending_mps:
        return gear.mu_kinetic
    return gear.mu_static + (gear.mu_kinetic - gear.mu_static) * (speed / gear.blending_mps)


@inlined
def _on_curve(curves, first, points, x):
    """Return the force [N] at the deflection `x` [m] on a curve of two points or more; the last slope goes on."""
    k, last = first + 1, first + points - 1
    while k < last and x > curves[k].x:
        k += 1
    low, high = curves[k - 1], curves[k]
    return low.y + (high.y - low.y) / (high.x - low.x) * (x - low.x)
