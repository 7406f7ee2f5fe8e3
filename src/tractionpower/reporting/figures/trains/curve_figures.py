"""Curves of a train: effort, resistance, electric brake and current over speed, at several voltages."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.kernels.wayside import GRAVITY
from tractionpower.movement.curves import TrainCurves, drive_curves
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.drawing import wanted
from tractionpower.reporting.figures.base.style import GREY, INK, PAGE, PURPLE, STYLE, VERMILION, new_figure
from tractionpower.reporting.texts import number, tr

CURVES = "curves"
"""Beginning of the names of the figures of curves in a run."""

MOST_KINDS = 8
"""Kinds of trains of a run that get a figure."""

ROOM = 1.12
"""Height of the axes over the greatest value."""


NAME_ROOM = 0.032
"""Height of a gradient's name over that of the axes."""


def curves_table(curves: TrainCurves) -> pd.DataFrame:
    """Return the curves as one long table: a row for each voltage and speed; what no voltage changes is repeated."""
    parts = []
    for curve in curves.curves:
        columns: dict[str, Any] = {
            "speed_kmh": 3.6 * curves.speed_mps,
            "voltage_v": curve.voltage_v,
            "effort_kn": curve.effort_n / 1000.0,
            "current_a": curve.current_a,
            "adhesion_kn": np.where(np.isfinite(curves.adhesion_n), curves.adhesion_n, np.nan) / 1000.0,
            "electric_brake_kn": curves.electric_brake_n / 1000.0,
        }
        for permille, resistance in sorted(curves.resistance_n.items()):
            columns[resistance_name(permille)] = resistance / 1000.0
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def resistance_name(permille: float) -> str:
    """Return the column of the resistance on a gradient.

    >>> resistance_name(0.0), resistance_name(12.5)
    ('resistance_kn', 'resistance_at_12.5_permille_kn')
    """
    return f"resistance_at_{permille:g}_permille_kn" if permille else "resistance_kn"


def balancing_speed(curves: TrainCurves) -> float | None:
    """Return the speed [m/s] at which the effort of the first curve comes down to the resistance on the level.

    None if the train could run faster than it may.
    """
    surplus = curves.curves[0].effort_n - curves.resistance_n[0.0]
    short = np.flatnonzero(surplus <= 0.0)
    if not short.size:
        return None
    k = int(short[0])
    if k == 0:
        return 0.0
    share = surplus[k - 1] / (surplus[k - 1] - surplus[k])
    return float(curves.speed_mps[k - 1] + share * (curves.speed_mps[k] - curves.speed_mps[k - 1]))


def write_curves_csv(curves: TrainCurves, path: Path) -> Path:
    """Write the curves as CSV; the file gets its name when it is complete."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    try:
        curves_table(curves).to_csv(temporary, index=False, float_format="%.6g", lineterminator="\n")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def has_drive(nominal: TrainCurves) -> bool:
    """Tell from curves at nominal voltage whether a train has a drive."""
    return any(bool(curve.effort_n.any()) for curve in nominal.curves)


def starting_gradient(nominal: TrainCurves) -> float:
    """Return the steepest gradient on which a train can start [permille]; below 0 it needs a slope."""
    surplus = float(nominal.curves[0].effort_n[0] - nominal.resistance_n[0.0][0])
    return 1000.0 * surplus / (nominal.mass_kg * GRAVITY)


def run_curves(data: RunData) -> Iterator[tuple[str, Figure]]:
    """Yield the curves of the kinds of trains of a run that have a drive, those of most trains first, with their names."""
    scenario = data.scenario
    system, limits = scenario.supply.system, scenario.limits
    shown = 0
    for kind, train in data.kinds.items():
        name = f"{CURVES}_{kind}"
        if shown == MOST_KINDS or not wanted(name):
            continue
        curves = drive_curves(train, scenario.vehicles, limits, system)
        if has_drive(curves):
            shown += 1
            mass, length = number(curves.mass_kg / 1000.0), number(curves.length_m)
            called = train.name or kind
            title = tr("{study}: {train}, {mass} t, {length} m", study=data.title, train=called, mass=mass, length=length)
            yield name, curves_figure(curves, title)


def resistance_figure(curves: TrainCurves, title: str) -> Figure:
    """Draw the resistances over speed of a train, or a vehicle, that has no drive."""
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.6)
        axes = figure.add_subplot()
        top = ROOM * max(float(resistance.max()) for resistance in curves.resistance_n.values()) / 1000.0
        _draw_resistances(axes, curves, top)
        axes.set_xlim(0.0, 3.6 * float(curves.speed_mps[-1]))
        axes.set_ylim(0.0, top)
        axes.set(xlabel=tr("speed [km/h]"), ylabel=tr("resistance [kN]"))
        axes.legend(loc="upper left", bbox_to_anchor=(1.09, 1.0), fontsize=7.5, handlelength=3.0)
        figure.suptitle(tr("{title}, no drive", title=title), x=0.01, ha="left")
        return figure


def curves_figure(curves: TrainCurves, title: str) -> Figure:
    """Draw effort over speed at several voltages with resistances, adhesion and electric brake; below it the current."""
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 6.6)
        upper, lower = figure.subplots(2, sharex=True, height_ratios=(3, 2))
        kmh = 3.6 * curves.speed_mps
        # Dark is a low voltage, light a high one, with dashes besides: apart for colour-blind eyes and in print.
        shades = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(curves.curves)))
        for k, (curve, shade) in enumerate(zip(curves.curves, shades, strict=True)):
            style: Any = {"color": shade, "linestyle": _dashes(k), "linewidth": 1.5}
            upper.plot(kmh, curve.effort_n / 1000.0, label=tr("effort at {voltage} V", voltage=number(curve.voltage_v)), **style)
            lower.plot(kmh, curve.current_a, label=tr("current at {voltage} V", voltage=number(curve.voltage_v)), **style)
        top = ROOM * max(float(np.nanmax(curve.effort_n)) for curve in curves.curves) / 1000.0
        top = max(top, ROOM * float(curves.electric_brake_n.max()) / 1000.0, 1.0)
        _draw_notches(upper, curves)
        _draw_limits(upper, curves, top)
        _draw_resistances(upper, curves, top)
        upper.set_ylim(0.0, top)
        upper.set_ylabel(tr("effort at the wheel [kN]"))
        lower.set_ylim(0.0, ROOM * max(1.0, *(float(np.nanmax(curve.current_a)) for curve in curves.curves)))
        lower.set(
            ylabel=tr("current at the pantograph [A]\nat the greatest effort,\nauxiliaries included"), xlabel=tr("speed [km/h]")
        )
        lower.set_xlim(0.0, float(kmh[-1]))
        for axes in (upper, lower):
            axes.legend(loc="upper left", bbox_to_anchor=(1.09, 1.0), fontsize=7.5, handlelength=3.0)
        figure.suptitle(title, x=0.01, ha="left")
        return figure


def _draw_notches(axes: Axes, curves: TrainCurves) -> None:
    """Draw the single notches of series motors behind all else."""
    for k, notch in enumerate(curves.notches):
        label = tr("single notches\nat nominal voltage") if k == 0 else None
        kmh, kn = 3.6 * notch.speed_mps, notch.effort_n / 1000.0
        axes.plot(kmh, kn, color=INK, linewidth=0.4, alpha=0.45, zorder=1.0, label=label)


def _draw_limits(axes: Axes, curves: TrainCurves, top: float) -> None:
    kmh = 3.6 * curves.speed_mps
    adhesion = np.where(np.isfinite(curves.adhesion_n), curves.adhesion_n, np.nan) / 1000.0
    if np.nanmin(adhesion, initial=np.inf) < top:
        axes.plot(kmh, adhesion, color=VERMILION, linestyle=(0, (8, 3)), linewidth=1.1, label=tr("adhesion limit"))
    if curves.electric_brake_n.any():
        axes.plot(kmh, curves.electric_brake_n / 1000.0, color=PURPLE, linestyle=(0, (6, 2, 1, 2)), linewidth=1.8,
                  label=tr("electric brake"))  # fmt: skip


def _draw_resistances(axes: Axes, curves: TrainCurves, top: float) -> None:
    """Draw the resistance on each gradient and name it where its line leaves the axes, names one above the other."""
    kmh, last_y = 3.6 * curves.speed_mps, -np.inf
    for permille, resistance_n in sorted(curves.resistance_n.items()):
        resistance = resistance_n / 1000.0
        label = tr("resistance on level\nand gradients") if permille == min(curves.resistance_n) else None
        axes.plot(kmh, resistance, color=GREY, linewidth=0.9, label=label)
        inside = np.flatnonzero(resistance <= top)
        if not inside.size:
            continue
        last = int(inside[-1])
        at_edge = last == len(kmh) - 1
        y = float(resistance[last])
        if at_edge:
            y = last_y = max(y, last_y + NAME_ROOM * top)
        axes.annotate(
            f"{number(permille, 2)} ‰" if permille else tr("level"), (float(kmh[last]), y), (3, 0) if at_edge else (-3, 0),
            textcoords="offset points", ha="left" if at_edge else "right", va="center" if at_edge else "top",
            fontsize=7.5, color=INK, annotation_clip=False,
        )  # fmt: skip


def _dashes(number: int) -> Any:
    return ("-", (0, (5, 1.5)), (0, (3, 1.5)), (0, (1, 1)), (0, (5, 1.5, 1, 1.5)), (0, (5, 1.5, 1, 1.5, 1, 1.5)))[number % 6]
