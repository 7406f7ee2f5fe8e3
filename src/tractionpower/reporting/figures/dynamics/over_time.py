"""What a train does over the time of a case: controls, speeds, brake cylinders, efforts, places, energies."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.chain_energy import energies_of
from tractionpower.reporting.figures.base.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, STYLE, VERMILION
from tractionpower.reporting.figures.dynamics.panels import (
    LINES,
    NOTHING,
    label,
    line,
    looks,
    room,
    time_axis,
    time_figure,
    titled,
    told_value,
    vehicle_told,
    zero_line,
)
from tractionpower.reporting.figures.supply.panels import legend_below, once
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

MOST_PLACES = 6
"""Vehicles whose places are drawn."""

MOST_SMALL_M = 1.0
"""Changes of place up to this are drawn in a small unit [m]."""

ENERGY_LOOKS: dict[str, tuple[str, Any]] = {
    "traction": (BLUE, "-"),
    "resistance": (GREY, (0, (5, 2))),
    "brake": (VERMILION, "-"),
    "electric": (PURPLE, "-"),
    "gravity": (GREEN, (0, (6, 2, 1, 2))),
    "coupling": (ORANGE, (0, (1, 1.2))),
    "kinetic": (SKY, "-"),
}
"""Colours and dashes of the energies."""


def controls(data: ChainData) -> Figure | None:
    """Draw what the driver does, and speed and acceleration of the first vehicle."""
    if not data.has("controls", "vehicles"):
        return None
    speed, acceleration = (data.of_vehicles(name)[:, 0] for name in ("speed_kmh", "acceleration_mps2"))
    more = [
        (column, words, quantity)
        for column, words, quantity in (
            ("electric_percent", tr("electric brake\n[%]"), ""),
            ("independent_bar", tr("independent\nbrake"), "pressure"),
            ("reduction_bar", tr("reduction of\nthe pipe"), "pressure"),
        )
        if data.control(column).any()
    ]
    with mpl.rc_context(STYLE):
        ratios = [1.25, *(0.8 for _ in more), 1.2, 1.2]
        figure, panels = time_figure(len(ratios), 1.0 + 1.05 * sum(ratios), ratios)
        _levels(panels[0], data)
        for axes, (column, words, quantity) in zip(panels[1:], more, strict=False):
            values = data.control(column) * (data.units[quantity].per if quantity else 1.0)
            line(
                axes,
                data.control("time_s"),
                values,
                color=INK,
                drawstyle="default" if column == "reduction_bar" else "steps-post",
            )
            axes.set_ylabel(label(data, quantity, words) if quantity else words)
            room(axes, [values])
        for axes, values, quantity, words in (
            (panels[-2], speed, "speed", tr("speed")),
            (panels[-1], acceleration, "acceleration", tr("acceleration")),
        ):
            shown = values * data.units[quantity].per
            line(axes, data.times, shown, color=BLUE)
            axes.set_ylabel(label(data, quantity, words).replace(" [", "\n["))
            room(axes, [shown])
            zero_line(axes)
        time_axis(panels[-1], data.times)
        figure.align_ylabels(panels)
        handles, labels = panels[0].get_legend_handles_labels()
        legend_below(figure, handles, labels)
        told = tr(
            "vehicle {name}: greatest speed {speed}", name=data.vehicles[0], speed=told_value(data, "speed", np.nanmax(speed))
        )
        return titled(figure, tr("controls, speed and acceleration"), told)


def _levels(axes: Axes, data: ChainData) -> None:
    """Draw the levels of drive and brake control, those of the brake downwards (Zobory and Bekefi, figure 12)."""
    times, drive, brake = (data.control(name) for name in ("time_s", "drive", "brake"))
    axes.step(times, drive, where="post", color=BLUE, linewidth=1.2, label=tr("drive control u₁, level"))
    axes.step(times, -brake, where="post", color=VERMILION, linewidth=1.2, label=tr("brake control u₂, level, downwards"))
    axes.set_ylabel(tr("control level"))
    room(axes, [drive, -brake], 0.12)
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -1.0), max(high, 1.0))
    zero_line(axes)
    emergency = brake > data.scenario.case.air_brake.levels
    _name_levels(axes, data.scenario.case.air_brake.levels, emergency=bool(emergency.any()))
    for k in np.flatnonzero(emergency & ~np.append(False, emergency[:-1])):
        style: Any = {"textcoords": "offset points", "fontsize": 7.0, "color": INK}
        axes.annotate(tr("emergency"), (times[k], -brake[k]), (3, 3), va="bottom", **style)


def _name_levels(axes: Axes, levels: int, *, emergency: bool) -> None:
    """Write levels without the sign that only tells where they are drawn; beyond the last one of the brake is emergency."""
    low, high = axes.get_ylim()
    ticks = [float(tick) for tick in MaxNLocator(nbins=5, integer=True).tick_values(low, high) if tick >= -levels]
    if emergency:
        ticks = [tick for tick in ticks if tick > -0.8 * levels]  # so that no number stands on the word
        ticks.append(-levels - 1.0)
    words = {tick: tr("emergency") if tick < -levels - 0.5 else number(abs(tick), 0) for tick in ticks if low <= tick <= high}
    axes.set_yticks(list(words), list(words.values()))


def speeds(data: ChainData) -> Figure | None:
    """Draw the speeds of the first, the middle and the last vehicle, and by how much they differ from the first."""
    if not data.has("vehicles"):
        return None
    speed, shown = data.of_vehicles("speed_kmh") * data.units["speed"].per, data.chosen_vehicles()
    with mpl.rc_context(STYLE):
        figure, panels = time_figure(2, 4.6, [1.5, 1.0])
        for number_of, (colour, dashes) in zip(shown, looks(len(shown)), strict=True):
            style: Any = {"color": colour, "linestyle": dashes}
            line(panels[0], data.times, speed[:, number_of], label=vehicle_told(data.vehicles[number_of]), **style)
            if number_of:
                line(panels[1], data.times, speed[:, number_of] - speed[:, 0], **style)
        panels[0].set_ylabel(label(data, "speed", tr("speed")))
        panels[1].set_ylabel(label(data, "speed", tr("speed less that of\nthe first vehicle")))
        room(panels[0], [speed])
        zero_line(panels[1])
        time_axis(panels[-1], data.times)
        figure.align_ylabels(panels)
        legend_below(figure, *panels[0].get_legend_handles_labels(), 3)
        return titled(figure, tr("speeds of vehicles"))


def cylinders(data: ChainData) -> Figure | None:
    """Draw the pressures of the brake cylinders of the first, the middle and the last braked vehicle, and of the brake pipe."""
    if not data.has("vehicles"):
        return None
    pressure = data.of_vehicles("cylinder_pressure_bar") * data.units["pressure"].per
    braked = np.flatnonzero(np.nan_to_num(pressure).max(axis=0) > 0.0)
    if not len(braked):
        return None
    shown = sorted({int(braked[0]), int(braked[len(braked) // 2]), int(braked[-1])})
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.6)
        for number_of, (colour, dashes) in zip(shown, looks(len(shown)), strict=True):
            name = tr("cylinder of {vehicle}", vehicle=vehicle_told(data.vehicles[number_of]))
            line(axes, data.times, pressure[:, number_of], color=colour, linestyle=dashes, label=name)
        highest = pressure.max()
        if data.has("controls"):
            pipe = (data.scenario.case.air_brake.pipe_pressure_bar - data.control("reduction_bar")) * data.units["pressure"].per
            line(
                axes,
                data.control("time_s"),
                pipe,
                color=GREY,
                linestyle=(0, (6, 2, 1, 2)),
                label=tr("brake pipe at the driver's valve"),
            )
            highest = max(highest, pipe.max())
        axes.set_ylabel(label(data, "pressure", tr("pressure, gauge")))
        axes.set_ylim(0.0, 1.08 * max(highest, NOTHING))
        time_axis(axes, data.times)
        legend_below(figure, *axes.get_legend_handles_labels(), 2)
        return titled(figure, tr("pressures of brake cylinders"))


def efforts(data: ChainData) -> Figure | None:
    """Draw what acts on the whole train: tractive effort and brakes above, resistance and gradient below."""
    if not data.has("vehicles"):
        return None
    per = data.units["force"].per
    above: tuple[tuple[str, float, str, str], ...] = (
        ("tractive_force_kn", 1.0, tr("tractive effort"), BLUE),
        ("electric_brake_force_kn", -1.0, tr("electric brake"), PURPLE),
        ("brake_force_kn", -1.0, tr("air brake"), VERMILION),
    )
    below: tuple[tuple[str, float, str, str], ...] = (
        ("resistance_kn", -1.0, tr("running, curve and tunnel resistance"), INK),
        ("grade_force_kn", -1.0, tr("gradient"), GREEN),
    )
    with mpl.rc_context(STYLE):
        figure, panels = time_figure(2, 4.8, [1.4, 1.0])
        for axes, shown in zip(panels, (above, below), strict=True):
            every = []
            for column, sign, words, colour in shown:
                values = sign * per * np.nansum(data.of_vehicles(column), axis=1)
                if values.any() or column != "electric_brake_force_kn":
                    line(axes, data.times, values, color=colour, label=words)
                    every.append(values)
            room(axes, every)
            zero_line(axes)
            axes.set_ylabel(label(data, "force", tr("force on the train,\nforwards positive")))
        time_axis(panels[-1], data.times)
        figure.align_ylabels(panels)
        legend_below(figure, *once(panels), 3)
        return titled(figure, tr("efforts and resistances of the train"))


def relative_positions(data: ChainData) -> Figure | None:
    """Draw by how much the places of vehicles against the first have changed since the start (Arshad et al., figure 10)."""
    if not data.has("vehicles") or len(data.vehicles) < 2:
        return None
    moved = data.of_vehicles("relative_position_m")
    quantity = "distance" if np.nanmax(np.abs(moved)) > MOST_SMALL_M else "deflection"
    moved = moved * (1.0 if quantity == "distance" else 1000.0) * data.units[quantity].per
    count = len(data.vehicles)
    shown = np.unique(np.linspace(1, count - 1, min(MOST_PLACES, count - 1)).round().astype(int))
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.8)
        for colour, number_of in zip(LINES, shown, strict=False):
            line(axes, data.times, moved[:, number_of], color=colour, label=vehicle_told(data.vehicles[number_of]))
        room(axes, [moved[:, shown]])
        zero_line(axes)
        axes.set_ylabel(label(data, quantity, tr("change of the place against the first\nvehicle; negative: drawn out")))
        time_axis(axes, data.times)
        legend_below(figure, *axes.get_legend_handles_labels(), 3)
        return titled(figure, tr("relative positions of vehicles"))


def energies(data: ChainData) -> Figure | None:
    """Draw where the work of the tractive effort goes over time."""
    found = energies_of(data)
    if found is None:
        return None
    words = {
        "traction": tr("work of the tractive effort"),
        "resistance": tr("taken by running, curve and tunnel resistance"),
        "brake": tr("taken by the air brakes"),
        "electric": tr("taken by the electric brake"),
        "gravity": tr("taken by gravity, negative downhill"),
        "coupling": tr("taken in by the couplings"),
        "kinetic": tr("change of kinetic energy"),
    }
    with mpl.rc_context(STYLE):
        figure, (axes,) = time_figure(1, 3.9)
        for name, values in found.parts.items():
            if values.any() or name in ("traction", "resistance"):
                colour, dashes = ENERGY_LOOKS[name]
                line(axes, found.times, values, color=colour, linestyle=dashes, label=words[name])
        room(axes, list(found.parts.values()))
        zero_line(axes)
        axes.set_ylabel(tr("energy since the start [kWh]"))
        time_axis(axes, found.times)
        legend_below(figure, *axes.get_legend_handles_labels(), 2)
        end = {name: number(float(values[-1]), 2) for name, values in found.parts.items()}
        told = tr("at the end: traction {traction} kWh, resistance {resistance} kWh, air brakes {brake} kWh", **end)
        return titled(figure, tr("energies"), told)
