"""The six plots of Arshad et al., section 7.3 (their figures 5 to 10), of a case of theirs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tractionpower.io.arshad.reading import PAPER
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.figures.base.style import BLUE, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.dynamics.coupling_figures import half_slack, loop_of, mark_slack
from tractionpower.reporting.figures.dynamics.panels import (
    LINES,
    coupling_told,
    label,
    line,
    looks,
    room,
    time_axis,
    time_figure,
    titled,
    vehicle_told,
    zero_line,
)
from tractionpower.reporting.figures.supply.panels import legend_below
from tractionpower.reporting.texts import tr

Array = NDArray[Any]

LOOP = 2
"""Number of the coupling of their figure 9, from 0.

It joins "the 3rd and the 4th car". The locomotive is counted here as the first one, as the model of the paper is a chain of N
cars that begins with it: what is drawn is the coupling between the second and the third of the cars that are hauled.
"""

MOST_CARS = 6


def is_of_arshad(data: ChainData) -> bool:
    """Return whether a case was read from their files."""
    return data.scenario.case.source.startswith(PAPER)


def speed(data: ChainData) -> Figure | None:
    """Draw the speeds of three cars (figure 5)."""
    shown = data.chosen_vehicles()
    values = data.of_vehicles("speed_kmh")
    return _cars(data, values, shown, ("speed", tr("speed")), tr("speed curves (Arshad et al., figure 5)"))


def tractive_effort(data: ChainData) -> Figure | None:
    """Draw the tractive effort of the locomotives (figure 6)."""
    effort = np.nansum(data.of_vehicles("tractive_force_kn"), axis=1)
    title = tr("tractive effort (Arshad et al., figure 6)")
    return _single(data, effort, ("effort", tr("tractive effort")), title)


def acceleration(data: ChainData) -> Figure | None:
    """Draw the acceleration of the locomotive (figure 7)."""
    values = data.of_vehicles("acceleration_mps2")[:, 0]
    title = tr("acceleration of the locomotive (Arshad et al., figure 7)")
    return _single(data, values, ("acceleration", tr("acceleration")), title)


def cylinder_pressure(data: ChainData) -> Figure | None:
    """Draw the cylinder pressures of two cars, the first and the last behind the locomotive that have one (figure 8)."""
    pressure = data.of_vehicles("cylinder_pressure_bar")
    braked = [int(k) for k in np.flatnonzero(np.nan_to_num(pressure).max(axis=0) > 0.0)]
    cars = [k for k in braked if k > 0] or braked
    title = tr("brake cylinder pressures (Arshad et al., figure 8)")
    shown = sorted({cars[0], cars[-1]}) if cars else data.chosen_vehicles()[:1]
    return _cars(data, pressure, shown, ("pressure", tr("cylinder pressure, gauge")), title)


def coupler(data: ChainData) -> Figure | None:
    """Draw force over displacement of the coupler between the third and the fourth vehicle, signs changed (figure 9)."""
    if not data.has("couplings"):
        return None
    number_of = min(LOOP, len(data.couplings) - 1)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.6, 0.05)
        panels = list(figure.subplots(1, 2, sharey=True))
        for axes in panels:
            loop_of(axes, data, number_of, "effort")
            axes.set_xlabel(label(data, "deflection", tr("displacement, the sign of\ncompression changed")))
            axes.set_ylim(0.0, None)
        whole, near = panels
        if np.ptp(whole.get_xlim()) > 0.0:
            whole.set_xlim(min(0.0, whole.get_xlim()[0]), None)
        mark_slack(whole, data, number_of)
        whole.set_title(tr("with the slack"), fontsize=8.0)
        low, high = near.get_xlim()
        near.set_xlim(max(low, half_slack(data, number_of) - 0.05 * (high - half_slack(data, number_of))), high)
        mark_slack(near, data, number_of)
        near.set_title(tr("beyond the slack"), fontsize=8.0)
        whole.set_ylabel(label(data, "effort", tr("force, the sign of\ncompression changed")))
        handles, labels = whole.get_legend_handles_labels()
        legend_below(figure, handles, labels, 3)
        told = coupling_told(data.couplings[number_of])
        if number_of == LOOP:
            told = tr("{coupling}: between the third and the fourth vehicle, the locomotive counted as the first", coupling=told)
        return titled(figure, tr("force over displacement (Arshad et al., figure 9)"), told)


def relative_position(data: ChainData) -> Figure | None:
    """Draw by how much the places of the cars against the locomotive have changed (figure 10)."""
    if len(data.vehicles) < 2:
        return None
    moved = data.of_vehicles("relative_position_m") * 1000.0
    title = tr("variation in position (Arshad et al., figure 10)")
    shown = list(range(1, min(len(data.vehicles), MOST_CARS + 1)))
    return _cars(data, moved, shown, ("deflection", tr("change of the place\nagainst the locomotive")), title)


FIGURES = {
    "arshad_5_speed": speed,
    "arshad_6_tractive_effort": tractive_effort,
    "arshad_7_acceleration": acceleration,
    "arshad_8_cylinder_pressure": cylinder_pressure,
    "arshad_9_coupler": coupler,
    "arshad_10_relative_position": relative_position,
}
"""The six plots by name."""

TWICE = ("dynamics_speeds", "brake_cylinders", "relative_positions")
"""Figures of all cases that show what these six do; they are drawn where the template names them."""


def _single(data: ChainData, values: Array, axis: tuple[str, str], title: str) -> Figure:
    """Draw one line over time; `axis` is its quantity and its words."""
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.2)
        shown = values * data.units[axis[0]].per
        line(axes, data.times, shown, color=BLUE)
        _finish(axes, data, axis, [shown])
        return titled(figure, title)


def _cars(data: ChainData, values: Array, shown: Sequence[int], axis: tuple[str, str], title: str) -> Figure:
    """Draw a line over time for each of some vehicles."""
    per = data.units[axis[0]].per
    styles = looks(len(shown)) if len(shown) <= 3 else tuple((colour, "-") for colour in LINES)
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.5)
        for number_of, (colour, dashes) in zip(shown, styles, strict=False):
            name = vehicle_told(data.vehicles[number_of])
            line(axes, data.times, values[:, number_of] * per, color=colour, linestyle=dashes, label=name)
        _finish(axes, data, axis, [values[:, list(shown)] * per])
        legend_below(figure, *axes.get_legend_handles_labels(), 3)
        return titled(figure, title)


def _finish(axes: Axes, data: ChainData, axis: tuple[str, str], values: Sequence[Array]) -> None:
    room(axes, values)
    zero_line(axes)
    axes.set_ylabel(label(data, *axis))
    time_axis(axes, data.times)
