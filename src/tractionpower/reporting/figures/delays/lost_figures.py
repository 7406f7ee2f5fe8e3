"""Seconds lost to low voltage along the line, and delays of the worst trains by cause."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.reporting.facts.formations import kind_of
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.axes import mark_devices, with_margin
from tractionpower.reporting.figures.base.labels import LETTER, shortened
from tractionpower.reporting.figures.base.style import COLOURS, GREY, INK, PAGE, STYLE, new_figure
from tractionpower.reporting.figures.delays.delay_styles import CAUSES, ORIGINS
from tractionpower.reporting.texts import number, tr

WIDTH = PAGE
"""Width of the figures [inches]."""

LEAST_S = 0.05
"""Less is not shown [s]."""

LEVELS = (0.99, 0.92)
"""Heights at which sums of areas may stand, as shares of the axis."""

MOST_CLASSES = 6
"""Types of trains that are told apart; the others are shown together."""

MOST_TRAINS = 18
"""Trains in the figure of delays by cause."""

HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----", "++++")


def lost_time(data: RunData) -> Figure | None:
    """Draw seconds lost to low voltage in each kilometre of all trains, by type of train, a panel for each line.

    Substations are marked, and the sum of each area is written above it. Seconds gained by a voltage above the nominal one
    are not set against them, and left out.
    """
    lost = data.table("lost_time")
    lost = lost[lost["lost_s"] > 0.0] if lost is not None else None
    if lost is None or not (lost["lost_s"] > LEAST_S).any():
        return None
    lost = lost[lost.groupby(lost["train"].astype(str))["lost_s"].transform("sum") >= LEAST_S]  # others show no bar
    classes = _classes(data, lost)
    lost = lost.assign(kind=_kinds(data, lost, classes))
    lines = [tracks for tracks in data.places.lines if lost["track"].isin(list(tracks)).any()]
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 1.2 + 2.6 * len(lines))
        panels = list(figure.subplots(len(lines), 1, squeeze=False)[:, 0])
        for axes, tracks in zip(panels, lines, strict=True):
            own = lost[lost["track"].isin(list(tracks))]
            _draw_lost(axes, own, classes)
            axes.set_xlim(*with_margin(*_ends(data, tracks)))
            _write_areas(axes, own)
            mark_devices(axes, data.places.devices(tracks), WIDTH - 0.8)
            axes.set_xlabel(tr("kilometre of the line [km], {tracks}", tracks=told(tracks)))
            axes.set_ylabel(tr("lost to low voltage,\nall trains [s per km]"))
        total = float(lost.loc[lost["lost_s"] > 0.0, "lost_s"].sum())
        figure.suptitle(
            tr(
                "{study}: {seconds} s lost to low voltage, by place and type of train", study=data.title, seconds=number(total, 0)
            ),
            x=0.01,
            ha="left",
        )
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return figure


def _classes(data: RunData, lost: pd.DataFrame) -> list[str]:
    """Return types of trains by the seconds that they lose, the greatest first; the last stands for all others."""
    kinds = pd.Series({run.id: kind_of(run) for run in data.scenario.runs}, dtype=object)
    sums = lost["lost_s"].clip(lower=0.0).groupby(lost["train"].astype(str).map(kinds).fillna(tr("unknown"))).sum()
    order = [str(name) for name in sums.sort_values(ascending=False, kind="stable").index]
    return order if len(order) <= MOST_CLASSES else [*order[: MOST_CLASSES - 1], tr("other trains")]


def _kinds(data: RunData, lost: pd.DataFrame, classes: Sequence[str]) -> Any:
    kinds = {run.id: kind_of(run) for run in data.scenario.runs}
    names = [kinds.get(str(train), tr("unknown")) for train in lost["train"]]
    return [name if name in classes else classes[-1] for name in names]


def _draw_lost(axes: Axes, rows: pd.DataFrame, classes: Sequence[str]) -> None:
    """Stack the seconds of each kilometre by type of train."""
    km = np.sort(rows["km"].round(6).unique())
    above = np.zeros(len(km))
    axes.set_axisbelow(True)
    for k, name in enumerate(classes):
        seconds = _by_km(rows[(rows["kind"] == name) & (rows["lost_s"] > 0.0)], km)
        style: Any = {"color": COLOURS[k % len(COLOURS)], "hatch": HATCHES[k], "edgecolor": "white", "linewidth": 0.4}
        axes.bar(km, seconds, 1.0, bottom=above, label=shortened(name, 40), **style)
        above = above + seconds
    axes.axhline(0.0, color=INK, linewidth=0.8)
    axes.set_ylim(0.0, 1.32 * max(float(above.max()), LEAST_S))


def _by_km(rows: pd.DataFrame, km: Any) -> Any:
    """Return the seconds lost in each kilometre."""
    return rows["lost_s"].groupby(rows["km"].round(6)).sum().reindex(km).fillna(0.0).to_numpy(float)


def _write_areas(axes: Axes, rows: pd.DataFrame) -> None:
    """Write what is lost in the area of each substation above its stretch, where there is room."""
    taken: list[tuple[float, float, float]] = []
    left, right = axes.get_xlim()
    per_inch = (right - left) / (WIDTH - 0.8)
    positive = rows[rows["lost_s"] > 0.0]
    sums = positive["lost_s"].groupby(positive["area"].astype(str)).sum().sort_values(ascending=False, kind="stable")
    for area, seconds in sums[sums >= LEAST_S].items():
        own = positive[positive["area"].astype(str) == area]
        text = tr(
            "area of {area}: {seconds} s", area=shortened(str(area), 30), seconds=number(seconds, 0 if seconds >= 9.95 else 1)
        )
        wide = (LETTER * len(text) + 0.15) * per_inch
        at = float(np.average(own["km"], weights=own["lost_s"]))
        at = min(max(at, left + wide / 2), right - wide / 2)
        for level in LEVELS:
            if all(level != other or abs(at - x) > (wide + w) / 2 for x, w, other in taken):
                taken.append((at, wide, level))
                axes.annotate(
                    text, (at, level), xycoords=("data", "axes fraction"), ha="center", va="top", fontsize=7.5, color=INK,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.85},
                )  # fmt: skip
                break


def _ends(data: RunData, tracks: Sequence[str]) -> tuple[float, float]:
    ends = [data.places.ends(track) for track in tracks]
    return min(low for low, _ in ends), max(high for _, high in ends)


def delays_by_cause(data: RunData) -> Figure | None:
    """Draw the delay of the latest trains where they are latest, stacked by where its seconds first arose."""
    notes, delays = data.results.run.get("feasibility"), data.table("delays")
    if notes is None or delays is None:
        return None
    late = delays[delays["delay_s"] > notes["tolerance_s"]]
    if late.empty:
        return None
    worst = late.loc[late.groupby("train", observed=True)["delay_s"].idxmax()]
    worst = worst.sort_values(["delay_s", "train"], ascending=[False, True], kind="stable")
    shown = worst.head(MOST_TRAINS)
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDTH, 1.5 + 0.24 * len(shown))
        axes = figure.add_subplot()
        _draw_causes(axes, shown)
        names = {station.id: station.name or station.id for station in data.scenario.line.stations}
        axes.set_yticks(np.arange(len(shown)), [shortened(str(train), 24) for train in shown["train"]])
        for place, (_, row) in enumerate(shown.iterrows()):
            where = shortened(str(names.get(str(row["station"]), row["station"])), 30)
            text = tr("{seconds} s at {station}", seconds=number(float(row["delay_s"]), 0), station=where)
            axes.annotate(text, (row["delay_s"], place), (4, 0), textcoords="offset points", va="center", fontsize=7.5, color=INK)
        axes.set_xlim(0.0, 1.45 * float(shown["delay_s"].max()))
        axes.set_xlabel(tr("delay where the train is latest [s], by where the seconds first arose"))
        title = tr("{study}: delays by cause", study=data.title)
        if len(worst) > len(shown):
            title = tr(
                "{study}: delays by cause, the {some} latest of {all} late trains",
                study=data.title,
                some=len(shown),
                all=len(worst),
            )
        figure.suptitle(title, x=0.01, ha="left")
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return figure


def _draw_causes(axes: Axes, shown: pd.DataFrame) -> None:
    place, base = np.arange(len(shown), dtype=float), np.zeros(len(shown))
    for name in ORIGINS:
        seconds = np.nan_to_num(shown[f"origin_{name}_s"].to_numpy(float))
        if seconds.max() > 0.0:
            style = CAUSES[name]
            axes.barh(place, seconds, 0.62, left=base, color=style.colour, hatch=style.hatch, edgecolor="white", linewidth=0.4,
                      label=tr(style.words))  # fmt: skip
            base = base + seconds
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_axisbelow(True)
    axes.grid(visible=False, axis="y")
    axes.axvline(0.0, color=GREY, linewidth=0.8)
