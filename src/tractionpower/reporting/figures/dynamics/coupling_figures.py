"""Forces in the couplings of a train: along the train over time, their extremes, loops over the deflection."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.series import bucket_starts, peaks_kept
from tractionpower.reporting.figures.base.style import BLUE, INK, PAGE, PALE, SMALLEST, STYLE, VERMILION, new_figure
from tractionpower.reporting.figures.dynamics.panels import (
    TIME,
    coupling_told,
    label,
    line,
    name_sides,
    room,
    time_axis,
    time_figure,
    titled,
    told_value,
    zero_line,
)
from tractionpower.reporting.figures.supply.panels import legend_below, once
from tractionpower.reporting.texts import tr

Array = NDArray[Any]

TENSION, COMPRESSION = BLUE, VERMILION

MOST_COLUMNS = 1000
"""Instants of the map of forces; of what lies between them the greatest force of either sign is shown."""

MOST_LOOP_POINTS = 20_000

MOST_BARS = 60
"""Couplings with bars that stand apart."""

DIVERGING = "RdBu"
"""Colours about nothing: blue tension, red compression."""


def forces_along_train(data: ChainData) -> Figure | None:
    """Draw the forces of all couplings over time in colours about nothing."""
    if not data.has("couplings"):
        return None
    times, force = _peaks_in_time(data.times, data.of_couplings("force_kn") * data.units["force"].per)
    scale = max(float(np.nanmax(np.abs(force), initial=0.0)), 1e-6)
    count = len(data.couplings)
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        figure = new_figure(PAGE, 3.9 if count > 4 else 3.0)
        axes = figure.add_subplot()
        edges = np.append(times, times[-1] + (times[-1] - times[-2] if len(times) > 1 else 1.0))
        numbers = np.arange(count + 1) + 0.5
        mesh = axes.pcolormesh(edges, numbers, force.T, cmap=DIVERGING, vmin=-scale, vmax=scale, rasterized=True)
        bar = figure.colorbar(mesh, ax=axes, pad=0.015, fraction=0.055)
        bar.set_label(label(data, "force", tr("◂ compression   force   tension ▸")), fontsize=SMALLEST)
        bar.ax.tick_params(labelsize=SMALLEST)
        axes.set_ylim(count + 0.5, 0.5)  # the front of the train is above
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=10))
        axes.set_ylabel(tr("coupling, from the front of the train"))
        axes.set_xlabel(tr(TIME))
        time_axis(axes, times)
        _mark_extremes(axes, data)
        return titled(figure, tr("forces in the couplings along the train"), extremes_told(data))


def _peaks_in_time(times: Array, values: Array) -> tuple[Array, Array]:
    """Return fewer instants, of each spell the value that is farthest from nothing."""
    if len(times) <= MOST_COLUMNS:
        return times, values
    first = bucket_starts(len(times), MOST_COLUMNS)
    high, low = (ufunc.reduceat(values, first, axis=0) for ufunc in (np.fmax, np.fmin))
    return times[first], np.where(high >= -low, high, low)


def _mark_extremes(axes: Axes, data: ChainData) -> None:
    """Mark where and when the greatest tension and compression came about."""
    for side, sign in (("tension", "^"), ("compression", "v")):
        forces = data.greatest(side) if len(data.extremes) else np.zeros(0)
        if not len(forces) or not np.nanmax(forces) > 0.0:
            continue
        number_of = int(np.nanargmax(forces))
        at = float(data.extremes[f"{side}_at_s"].iloc[number_of])
        style: Any = {"color": INK, "markersize": 6.5, "markeredgecolor": "white", "markeredgewidth": 0.8, "clip_on": False}
        axes.plot([at], [number_of + 1.0], sign, zorder=4, **style)


def extremes_told(data: ChainData) -> str:
    """Return the greatest tension and compression of the run in words, with their coupling and time."""
    words = {
        "tension": tr("tension up to {force}, coupling {name} (▲)"),
        "compression": tr("compression up to {force}, coupling {name} (▼)"),
    }
    told = []
    for side, sentence in words.items():
        forces = data.greatest(side) if len(data.extremes) else np.zeros(0)
        if len(forces) and np.isfinite(forces).any():
            number_of = int(np.nanargmax(forces))
            told.append(sentence.format(force=told_value(data, "force", forces[number_of]), name=data.couplings[number_of]))
    return "; ".join(told)


def extremes(data: ChainData) -> Figure | None:
    """Draw the greatest tension and compression of each coupling along the train, with what it endures."""
    if not data.has("coupling_extremes"):
        return None
    per = data.units["force"].per
    numbers = np.arange(1, len(data.couplings) + 1)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.8)
        axes = figure.add_subplot()
        held = []
        for side, sign, colour, words, endured in (
            ("tension", 1.0, TENSION, tr("greatest tension"), tr("endurable tension")),
            ("compression", -1.0, COMPRESSION, tr("greatest compression"), tr("endurable compression")),
        ):
            values = sign * per * data.greatest(side)
            axes.bar(numbers, values, width=0.86 if len(numbers) <= MOST_BARS else 1.0, color=colour, label=words, zorder=2)
            limit = sign * per * data.endurable(side)
            held += [values, limit]
            if np.isfinite(limit).any():
                edges = np.repeat(np.arange(len(numbers) + 1) + 0.5, 2)[1:-1]
                axes.plot(edges, np.repeat(limit, 2), color=colour, linestyle=(0, (4, 2)), linewidth=1.2, label=endured, zorder=3)
        room(axes, held)
        zero_line(axes)
        axes.set_xlim(0.5, len(numbers) + 0.5)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12, min_n_ticks=1))
        axes.set_xlabel(tr("coupling, from the front of the train"))
        axes.set_ylabel(label(data, "force", tr("force, tension positive")))
        legend_below(figure, *axes.get_legend_handles_labels(), 4)
        return titled(figure, tr("greatest forces of the couplings"), extremes_told(data).replace(" (▲)", "").replace(" (▼)", ""))


def loops(data: ChainData) -> Figure | None:
    """Draw the forces of the first, the most loaded and the last coupling over their deflection."""
    if not data.has("couplings"):
        return None
    shown = data.chosen_couplings()
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.5, 0.04)
        panels = list(figure.subplots(1, len(shown), squeeze=False, sharex=True, sharey=True)[0])
        for axes, number_of in zip(panels, shown, strict=True):
            _loop(axes, *_force_and_deflection(data, number_of), folded=False)
            most = tr(", most loaded") if number_of == data.most_loaded and len(shown) > 1 else ""
            axes.set_title(f"{coupling_told(data.couplings[number_of])}{most}", fontsize=8.0)
            axes.set_xlabel(label(data, "deflection", tr("deflection, drawn out positive")), fontsize=SMALLEST)
            zero_line(axes)
        for axes, number_of in zip(panels, shown, strict=True):  # when all have shared their axes
            mark_slack(axes, data, number_of)
        panels[0].set_ylabel(label(data, "force", tr("force, tension positive")))
        if any(half_slack(data, number_of) > 0.0 for number_of in shown):
            handles, labels = once(panels)
            legend_below(figure, handles, labels, 3)
        return titled(figure, tr("force and deflection of couplings"))


def loop_of(axes: Axes, data: ChainData, number_of: int, quantity: str) -> None:
    """Draw the loop of one coupling with compression on the side of tension, signs changed; its force as `quantity`."""
    force, deflection = _force_and_deflection(data, number_of)
    _loop(axes, force / data.units["force"].per * data.units[quantity].per, deflection, folded=True)


def mark_slack(axes: Axes, data: ChainData, number_of: int) -> None:
    """Shade the slack of a coupling, in which it neither pulls nor pushes."""
    half = half_slack(data, number_of)
    low, high = axes.get_xlim()
    if half > 0.0:
        axes.axvspan(max(low, -half), min(high, half), color=PALE, alpha=0.45, linewidth=0.0, zorder=0.4, label=tr("slack"))
        axes.set_xlim(low, high)


def half_slack(data: ChainData, number_of: int) -> float:
    """Return half the slack of a coupling in the unit of the case; 0 where it is not known."""
    kind = data.coupling_of(number_of)
    return 0.0 if kind is None else 0.5 * kind.slack_mm * data.units["deflection"].per


def _force_and_deflection(data: ChainData, number_of: int) -> tuple[Array, Array]:
    """Return force and deflection of a coupling in the units of the case."""
    force = data.of_couplings("force_kn")[:, number_of] * data.units["force"].per
    return force, data.of_couplings("deflection_mm")[:, number_of] * data.units["deflection"].per


def _loop(axes: Axes, force: Array, deflection: Array, *, folded: bool) -> None:
    """Draw tension and compression in their colours; what is neither is both, so that no line is broken."""
    kept = peaks_kept(force, MOST_LOOP_POINTS)
    deflection, force = deflection[kept], force[kept]
    drawn = _with_neighbours(force > 0.0), _with_neighbours(force < 0.0)
    for is_shown, sign, colour, words in zip(
        drawn, (1.0, -1.0), (TENSION, COMPRESSION), (tr("tension (draft)"), tr("compression (buff)")), strict=True
    ):
        sign = sign if folded else 1.0  # noqa: PLW2901 - signs are changed on one side only
        x, y = (np.where(is_shown, sign * values, np.nan) for values in (deflection, force))
        axes.plot(x, y, color=colour, linewidth=0.8, label=words)


def _with_neighbours(chosen: Array) -> Array:
    """Return a choice of points with those beside them."""
    wide = chosen.copy()
    wide[1:] |= chosen[:-1]
    wide[:-1] |= chosen[1:]
    return wide


def first_coupling(data: ChainData) -> Figure | None:
    """Draw the force of the first coupling over time (Zobory and Bekefi, figure 14)."""
    if not data.has("couplings"):
        return None
    force = data.of_couplings("force_kn")[:, 0] * data.units["force"].per
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.3)
        line(axes, data.times, force, color=INK, linewidth=0.8)
        for side, colour in ((force >= 0.0, TENSION), (force <= 0.0, COMPRESSION)):
            kept = peaks_kept(force, 3000)
            axes.fill_between(data.times[kept], 0.0, np.where(side, force, 0.0)[kept], color=colour, alpha=0.25, linewidth=0.0)
        room(axes, [force])
        zero_line(axes)
        name_sides(axes, tr("tension"), tr("compression"))
        axes.set_ylabel(label(data, "force", tr("force, tension positive")))
        time_axis(axes, data.times)
        told = tr(
            "coupling {name}: {low} to {high}", name=data.couplings[0],
            low=told_value(data, "force", np.nanmin(force) / data.units["force"].per),
            high=told_value(data, "force", np.nanmax(force) / data.units["force"].per),
        )  # fmt: skip
        return titled(figure, tr("force of the first coupling"), told)
