"""A measurement and a run in one figure: both over time or place, the error below, one against the other beside."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.reporting.facts.series import peaks_kept
from tractionpower.reporting.figures.base.axes import clock_label, set_clock
from tractionpower.reporting.figures.base.drawing import FORMATS, remove_files, wanted
from tractionpower.reporting.figures.base.style import BLUE, GREY, INK, PAGE, STYLE, VERMILION, new_figure, save_as, stems
from tractionpower.reporting.texts import number, recorded, tr
from tractionpower.results.results import Results

Array = NDArray[Any]

WIDTH, HEIGHT = PAGE, 6.6
"""Size of a figure [inches]."""

MOST_FIGURES = 60
MOST_POINTS = 6000
"""Points of a line; of more the peaks are kept."""

MOST_DOTS = 8000
"""Points of the scatter; of more every n-th is drawn."""

SHIFT = "shift"
"""Name of the figure of the shift."""


def write_measured_figures(results: Results, folder: Path) -> list[Path]:
    """Write the figures of a comparison with a measurement into `folder`, as the template says, and return their paths.

    Others in the folder go: it holds nothing but these.
    """
    names = stems([SHIFT, *results.table("measured_errors")["series"].astype(str)])
    paths = [path for name, figure in _figures(results) if wanted(name) for path in save_as(figure, folder, names[name])]
    remove_files({path for path in folder.glob("*.*") if path.suffix[1:] in FORMATS} - {*paths})
    return paths


def _figures(results: Results) -> Iterator[tuple[str, Figure]]:
    rows, errors = results.table("measured"), results.table("measured_errors")
    told = results.run.get("measured", {})
    title = str(told.get("name") or told.get("file") or results.run.get("name", ""))
    if "measured_shift" in results.tables:
        yield SHIFT, shift_figure(results.table("measured_shift"), told, title)
    for line in errors.head(MOST_FIGURES).itertuples():
        own = rows[rows["series"] == line.series]
        if own["error"].notna().any():
            yield str(line.series), overlay(own, line, title)


def overlay(rows: pd.DataFrame, figures: Any, title: str) -> Figure:
    """Draw one series: measured and computed above, the error below, one against the other on the right.

    Parameters
    ----------
    rows
        Its rows of table ``measured``.
    figures
        Its row of table ``measured_errors``.
    title
        Name of the measurement.
    """
    in_time = bool(rows["time_s"].notna().any())
    x = rows["time_s" if in_time else "position_km"].to_numpy(float)
    measured, computed = rows["measured"].to_numpy(float), rows["computed"].to_numpy(float)
    quantity = recorded(str(figures.quantity).rpartition("_")[0].replace("_", " "))
    label = f"{quantity} [{figures.unit}]"
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, HEIGHT, 0.05)
        grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.1), height_ratios=(2.0, 1.0, 2.0))
        above = figure.add_subplot(grid[0, :])
        below = figure.add_subplot(grid[1, :], sharex=above)
        _line(above, x, measured, VERMILION, tr("measured"), (0, (3, 0.8)))
        _line(above, x, computed, BLUE, tr("computed"))
        above.set_ylabel(label)
        above.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.2)
        above.tick_params(labelbottom=False)
        below.axhline(0.0, color=INK, linewidth=0.6)
        _line(below, x, computed - measured, GREY, tr("error"))
        below.set_ylabel(tr("computed less\nmeasured [{unit}]", unit=figures.unit))
        if in_time:
            set_clock(below, float(np.nanmin(x)), float(np.nanmax(x)))
            below.set_xlabel(clock_label(below))
        else:
            below.set_xlabel(tr("place [km]"))
        _scatter(figure.add_subplot(grid[2, 0]), measured, computed, str(figures.unit))
        _tell(figure.add_subplot(grid[2, 1]), figures)
        figure.suptitle(f"{title}: {recorded(str(figures.subject))}, {quantity}", x=0.01, ha="left")
    return figure


def shift_figure(search: pd.DataFrame, told: dict[str, Any], title: str) -> Figure:
    """Draw the correlation over the shift of the clock."""
    shifts, correlation = search["shift_s"].to_numpy(float), search["correlation"].to_numpy(float)
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 3.2)
        axes = figure.add_subplot()
        axes.plot(shifts, correlation, color=BLUE, linewidth=1.2)
        if told.get("correlation") is not None:
            axes.axvline(told["shift_s"], color=VERMILION, linewidth=1.0)
            shift = signed(told["shift_s"], 2)
            words = tr(
                "{shift} s, correlation {correlation}", shift=shift, correlation=number(told["correlation"], 3, bare=False)
            )
            axes.annotate(words, (told["shift_s"], 0.02), (4, 0), xycoords=("data", "axes fraction"), textcoords="offset points",
                          fontsize=7.5, color=INK)  # fmt: skip
        axes.set_xlabel(tr("shift: added to the times of the measurement [s]"))
        axes.set_ylabel(tr("correlation of\nmeasured and computed"))
        figure.suptitle(tr("{title}: shift of the clock", title=title), x=0.01, ha="left")
    return figure


def _line(axes: Axes, x: Array, values: Array, colour: str, name: str, dashes: Any = "-") -> None:
    kept = peaks_kept(values, MOST_POINTS)
    if len(kept) < len(values):
        # Ends of gaps stay, so that no line is drawn across one.
        missing = np.isnan(values)
        edges = np.flatnonzero(missing[1:] != missing[:-1])
        kept = np.unique(np.concatenate([kept, edges, edges + 1])).astype(np.intp)
    axes.plot(x[kept], values[kept], color=colour, linewidth=1.0, linestyle=dashes, label=name, alpha=0.9)


def _scatter(axes: Axes, measured: Array, computed: Array, unit: str) -> None:
    both = np.flatnonzero(np.isfinite(measured) & np.isfinite(computed))
    both = both[:: max(1, len(both) // MOST_DOTS)]
    ends = [min(measured[both].min(), computed[both].min()), max(measured[both].max(), computed[both].max())]
    margin = 0.03 * max(ends[1] - ends[0], 1e-6)
    ends = [ends[0] - margin, ends[1] + margin]
    axes.plot(ends, ends, color=GREY, linewidth=0.8)
    axes.plot(measured[both], computed[both], ".", color=BLUE, markersize=2.0, alpha=0.4, rasterized=True)
    axes.set_xlim(*ends)
    axes.set_ylim(*ends)
    axes.set_aspect("equal")
    axes.set_xlabel(tr("measured [{unit}]", unit=unit))
    axes.set_ylabel(tr("computed [{unit}]", unit=unit))


def signed(value: float, digits: int) -> str:
    """Return a number with its sign, also where it is above zero."""
    return f"{'+' if value >= 0.0 else ''}{number(value, digits)}"


def digits_for(size: float) -> int:
    """Return how many digits behind the sign five figures of numbers of a size need.

    >>> digits_for(3200.0), digits_for(0.5)
    (1, 5)
    """
    return int(np.clip(4 - np.floor(np.log10(max(size, 1e-3))), 0, 6)) if np.isfinite(size) else 1


def _tell(axes: Axes, figures: Any) -> None:
    """Write the errors in words."""
    unit = figures.unit
    size = digits_for(max(abs(figures.highest_measured), abs(figures.lowest_measured)))
    lines = [
        tr("mean error {error} {unit}", error=signed(figures.mean_error, size), unit=unit),
        tr("RMS error {error} {unit}", error=number(figures.rms_error, size), unit=unit),
        tr("that is {percent} % of measured", percent=number(figures.relative_percent, 2)),
        tr("correlation {correlation}", correlation=number(figures.correlation, 4)),
        tr("lowest measured {value} {unit}", value=number(figures.lowest_measured, size, bare=False), unit=unit),
        tr("lowest computed {value} {unit}", value=number(figures.lowest_computed, size, bare=False), unit=unit),
        tr("highest measured {value} {unit}", value=number(figures.highest_measured, size, bare=False), unit=unit),
        tr("highest computed {value} {unit}", value=number(figures.highest_computed, size, bare=False), unit=unit),
    ]
    if np.isfinite(figures.energy_error_percent):
        percent, energy = signed(figures.energy_error_percent, 2), number(figures.energy_measured_kwh, 1)
        lines.append(tr("energy {percent} % of {energy} kWh", percent=percent, energy=energy))
    percent = number(figures.share_percent, 1)
    lines.append(tr("{rows} rows, {percent} % of the computed ones", rows=figures.rows, percent=percent))
    axes.axis("off")
    axes.text(0.0, 1.0, "\n".join(lines), va="top", fontsize=7.5, transform=axes.transAxes, linespacing=1.5)
