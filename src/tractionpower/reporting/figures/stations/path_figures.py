"""Where trains on a line with stations are over time, and how fast they are over their way."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.reporting.figures.base.style import GREY, INK, ORANGE, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.dynamics.panels import titled
from tractionpower.reporting.figures.stations.marks import (
    PLACE,
    by_train,
    draw_by_state,
    name_stations,
    shade_stations,
    states_legend,
)
from tractionpower.reporting.texts import number, tr


def distance_over_time(case: StationsCase, rows: pd.DataFrame) -> Figure:
    """Draw the place of each train over the time."""
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 4.6)
        axes = figure.add_subplot()
        for _, train in by_train(rows):
            draw_by_state(axes, train["time_s"].to_numpy() / 60.0, train["position_m"].to_numpy() / 1e3, train["state"].tolist())
        shade_stations(axes, case, upright=True)
        name_stations(axes, case, upright=True)
        axes.set_xlim(0.0, max(float(rows["time_s"].max()) / 60.0, 1e-3))
        axes.set_ylim(0.0, case.length_m / 1e3)
        axes.set(xlabel=tr("time [min]"), ylabel=tr(PLACE))
        states_legend(figure, rows["state"].astype(str).tolist())
        told = tr("trains: {count}; sampling period {period} s", count=rows["train"].nunique(), period=number(case.run.period_s))
        return titled(figure, tr("place of trains over time"), told)


def speed_over_distance(case: StationsCase, rows: pd.DataFrame) -> Figure:
    """Draw the speed of each train over its way, and the gradient below."""
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 4.8)
        axes, lower = figure.subplots(2, sharex=True, height_ratios=(4, 1))
        for _, train in by_train(rows):
            draw_by_state(
                axes,
                train["position_m"].to_numpy() / 1e3,
                train["speed_kmh"].to_numpy(float),
                train["state"].tolist(),
                linewidth=0.9,
            )
        for panel in (axes, lower):
            shade_stations(panel, case)
        name_stations(axes, case)
        axes.axhline(case.speed_kmh, color=GREY, linewidth=0.9, linestyle=(0, (5, 3)))
        axes.set_ylim(0.0, 1.08 * max(case.speed_kmh, float(rows["speed_kmh"].max())))
        axes.set_ylabel(tr("speed [km/h]"))
        at, permille = _gradients(case)
        lower.fill_between(at, 0.0, permille, step="post", color=ORANGE, alpha=0.35, linewidth=0)
        lower.step(at, permille, where="post", color=INK, linewidth=0.8)
        lower.axhline(0.0, color=INK, linewidth=0.5)
        lower.set_ylabel(tr("gradient\n[‰]"))
        lower.set_xlim(0.0, case.length_m / 1e3)
        lower.set_xlabel(tr(PLACE))
        figure.align_ylabels([axes, lower])
        states_legend(figure, rows["state"].astype(str).tolist())
        told = tr("permitted speed of the line {speed} km/h, dashed", speed=number(case.speed_kmh))
        return titled(figure, tr("speed of trains over their way"), told)


def _gradients(case: StationsCase) -> tuple[list[float], list[float]]:
    """Return places [km] and the gradient from there on [permille]; gaps are level."""
    steps = {0.0: 0.0, case.length_m: 0.0}
    for row in sorted(case.gradients, key=lambda row: row.from_m):
        steps |= {row.from_m: row.permille}
        steps.setdefault(row.to_m, 0.0)
    order = sorted(steps)
    return [float(at) for at in np.array(order) / 1e3], [steps[at] for at in order]
