"""How often what came about: levels and speeds together, forces, accelerations, cycles of the forces of couplings."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from numpy.typing import NDArray

from tractionpower.dynamics.statistics import MEAN_N, RANGE_N
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.spread import counted_told, histogram_of, joint_of
from tractionpower.reporting.figures.base.style import BLUE, INK, PAGE, SMALLEST, STYLE, new_figure
from tractionpower.reporting.figures.dynamics.panels import LINES, coupling_told, label, titled
from tractionpower.reporting.figures.supply.panels import legend_below
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

MOST_NUMBERS = 14
"""Columns of a joint distribution whose bins have their numbers written in them."""

MOST_CELLS = 20
"""Cells of a matrix of cycles in either direction."""

MOST_SMALL = 3
"""Levels of a joint distribution that is too low for long texts beside it."""

SHADES = "Blues"

PLAIN = FuncFormatter(lambda value, _: number(value, 3))
"""Ticks of a logarithmic axis as numbers."""


def drive_and_speed(data: ChainData) -> Figure | None:
    """Draw the joint distribution of drive control and speed (Zobory and Bekefi, figure 15)."""
    return _joint(
        data, "drive_speed", tr("drive control u₁, level"), tr("joint distribution of drive control and speed, P{u₁, v}")
    )


def brake_and_speed(data: ChainData) -> Figure | None:
    """Draw the joint distribution of brake control and speed (Zobory and Bekefi, figure 16)."""
    return _joint(
        data, "brake_speed", tr("brake control u₂, level"), tr("joint distribution of brake control and speed, P{u₂, v}")
    )


def _joint(data: ChainData, which: str, words: str, title: str) -> Figure | None:
    joint = joint_of(data, which)
    if joint is None:
        return None
    count, classes = joint.share.shape  # levels without any time have no row
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        figure = new_figure(PAGE, min(1.35 + 0.24 * max(count, 2), 5.6))
        axes = figure.add_subplot()
        mesh = axes.pcolormesh(joint.edges, np.arange(count + 1) - 0.5, 100.0 * joint.share, cmap=SHADES, vmin=0.0,
                               edgecolors="white", linewidth=0.4)  # fmt: skip
        bar = figure.colorbar(mesh, ax=axes, pad=0.015, fraction=0.055)
        bar.set_label(tr("share of the time [%]") if count > MOST_SMALL else tr("time [%]"), fontsize=SMALLEST)
        bar.ax.tick_params(labelsize=SMALLEST)
        bar.ax.yaxis.set_major_locator(MaxNLocator(nbins=min(count + 1, 6)))
        if classes <= MOST_NUMBERS:
            _write_shares(axes, joint.edges, joint.share)
        axes.set_yticks(range(count), [level_told(data, which, level) for level in joint.levels])
        axes.tick_params(axis="y", labelsize=SMALLEST, length=0.0)
        axes.set_ylim(-0.5, count - 0.5)
        axes.set_ylabel(words if count > MOST_SMALL else words.replace(", ", ",\n"))
        axes.set_xlabel(label(data, "speed", tr("speed")))
        return titled(figure, title, counted_told(of_rows=joint.of_rows))


def level_told(data: ChainData, which: str, level: int) -> str:
    """Return what a level of a control is called: that beyond the last one of the brake is emergency."""
    return tr("emergency") if which == "brake_speed" and level > data.scenario.case.air_brake.levels else str(level)


def _write_shares(axes: Axes, edges: Array, share: Array) -> None:
    """Write into each bin its share of the time [%]."""
    most = float(np.nanmax(share))
    for level, column in np.argwhere(np.isfinite(share)):
        value = share[level, column]
        colour = "white" if value > 0.55 * most else INK
        middle = (edges[column] + edges[column + 1]) / 2
        text = number(100.0 * value, 1) if value >= 0.0005 else f"< {number(0.1)}"
        axes.text(middle, level, text, ha="center", va="center", fontsize=SMALLEST, color=colour)


def coupling_histogram(data: ChainData) -> Figure | None:
    """Draw how often which force was in the first coupling (Zobory and Bekefi, figure 17)."""
    title = tr("relative frequency of the force of the first coupling")
    return _histogram(data, "coupler_force", "force", tr("force, tension positive"), title)


def acceleration_histogram(data: ChainData) -> Figure | None:
    """Draw how often the first vehicle had which acceleration (Zobory and Bekefi, figure 18)."""
    title = tr("relative frequency of the acceleration of the first vehicle")
    return _histogram(data, "acceleration", "acceleration", tr("acceleration"), title)


def _histogram(data: ChainData, which: str, quantity: str, words: str, title: str) -> Figure | None:
    found = histogram_of(data, which)
    if found is None:
        return None
    low, wide = found.edges[:-1], np.diff(found.edges)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.3)
        axes = figure.add_subplot()
        style: Any = {"align": "edge", "color": BLUE, "edgecolor": "white", "linewidth": 0.5, "zorder": 2}
        axes.bar(low, 100.0 * found.share, wide, **style)
        span = max(float(found.edges[-1] - found.edges[0]), 8.0 * float(wide.max()))
        middle = float(found.edges[-1] + found.edges[0]) / 2
        axes.set_xlim(middle - 0.53 * span, middle + 0.53 * span)
        axes.set_xlabel(label(data, quantity, words))
        axes.set_ylabel(tr("share of the time [%]"))
        told = tr("classes of {width} {unit}", width=number(float(np.median(wide)), 3), unit=data.units[quantity].unit)
        if found.open_low or found.open_high:
            told += tr("; the outermost have no end")
        return titled(figure, title, f"{told}; {counted_told(of_rows=found.of_rows)}")


def rainflow(data: ChainData) -> Figure | None:
    """Draw the cycles of the forces: by mean and range in the most loaded coupling, and how many exceed a range in some."""
    if not data.has("rainflow"):
        return None
    rows = data.table("rainflow")
    per = data.units["force"].per
    own = rows[rows["coupling"].astype(str) == data.couplings[data.most_loaded]]
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.6, 0.05)
        left, right = figure.subplots(1, 2)
        _matrix(figure, left, data, own, per)
        for colour, number_of in zip(LINES, data.chosen_couplings(), strict=False):
            of = rows[rows["coupling"].astype(str) == data.couplings[number_of]].sort_values("range_kn", ascending=False)
            if len(of):
                count = of["cycles"].cumsum().to_numpy(float)
                right.step(count, of["range_kn"].to_numpy(float) * per, where="pre", color=colour, linewidth=1.2,
                           label=coupling_told(data.couplings[number_of]))  # fmt: skip
        right.set_xscale("log")
        right.xaxis.set_major_locator(LogLocator(numticks=6))
        right.xaxis.set_major_formatter(PLAIN)
        right.xaxis.set_minor_formatter(NullFormatter())
        right.set_ylim(0.0, None)
        right.set_xlabel(tr("cycles of this range or more"))
        right.set_ylabel(label(data, "force", tr("range")))
        handles, labels = right.get_legend_handles_labels()
        legend_below(figure, handles, labels, 3)
        return titled(figure, tr("cycles of the forces of couplings, by rainflow counting"))


def _matrix(figure: Figure, axes: Axes, data: ChainData, rows: pd.DataFrame, per: float) -> None:
    """Draw how many cycles have which mean and range."""
    axes.set_title(coupling_told(data.couplings[data.most_loaded]) + tr(", most loaded"), fontsize=8.0)
    axes.set_xlabel(label(data, "force", tr("mean, tension positive")))
    axes.set_ylabel(label(data, "force", tr("range")))
    if rows.empty:
        return
    mean, wide = rows["mean_kn"].to_numpy(float), rows["range_kn"].to_numpy(float)
    of_mean, of_range = MEAN_N / 1000.0, RANGE_N / 1000.0  # classes that cycles are kept in: middles, and upper ends
    edges = _edges(mean.min() - 0.5 * of_mean, mean.max() + 0.5 * of_mean, of_mean), _edges(0.0, wide.max(), of_range)
    counts, x, y = np.histogram2d(mean, wide - 0.5 * of_range, edges, weights=rows["cycles"].to_numpy(float))
    counts[counts <= 0.0] = np.nan
    most = max(float(np.nanmax(counts)), 1.0)
    mesh = axes.pcolormesh(
        x * per, y * per, counts.T, cmap=SHADES, norm=LogNorm(0.25, 2.0 * most), edgecolors="white", linewidth=0.3
    )
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, fraction=0.06, format=PLAIN)
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    bar.set_label(tr("cycles"), fontsize=SMALLEST)
    bar.ax.tick_params(labelsize=SMALLEST)


def _edges(low: float, high: float, width: float) -> Array:
    """Return edges that hold some classes of a width each, so that few enough cells are drawn."""
    classes = max(round((high - low) / width), 1)
    step = -(-classes // MOST_CELLS)
    return low + width * step * np.arange(-(-classes // step) + 1)
