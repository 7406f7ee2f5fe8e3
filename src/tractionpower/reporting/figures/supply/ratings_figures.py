"""How much of its rating each device uses, how long which current lasts, how substations share the load."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tractionpower.reporting.facts.device_words import (
    device_told,
    kind_order,
    kind_told,
    supply_points_along_line,
    window_told,
    zones_along_line,
)
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import (
    BLUE,
    COLOURS,
    DASHES,
    GREEN,
    INK,
    ORANGE,
    PAGE,
    SKY,
    SMALLEST,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.reporting.figures.supply.panels import head, legend_below, most_loaded, time_panels
from tractionpower.reporting.texts import number, tr

MOST_BARS = 56
"""Bars of one figure; with more devices, those of each kind with the highest utilisation are shown."""

FEWEST_BARS = 5
"""Devices of a kind that are shown at least."""

MOST_CURVES = 12

MOST_LETTERS = 34
"""Letters of a name."""

MOST_ZONES = 30
"""Zones of the figure of load sharing; with more, those with the highest currents are shown."""

TIGHT_PERCENT = 80.0
"""From here on a utilisation shows amber [%]."""

BAR = 0.155
"""Height of a bar with its label [inches]."""


BARE: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
"""Behind texts that a line would cross."""


def utilisation(data: RunData) -> Figure | None:
    """Draw the utilisation of every rated device in its ruling window, by kind, along the line; the colour tells the margin."""
    ratings = data.table("ratings")
    if ratings is None:
        return None
    rows = ratings[ratings["ruling"] & ratings["utilisation_percent"].notna()]
    if rows.empty:
        return None
    kinds = sorted(rows["kind"].astype(str).unique(), key=kind_order)
    groups = [(kind, rows[rows["kind"] == kind]) for kind in kinds]
    shown = [(kind, _worst(own, _room(len(own), [len(each) for _, each in groups])), len(own)) for kind, own in groups]
    heights = [len(own) + 2.0 for _, own, _ in shown]
    permitted = data.scenario.sizing.utilisation_percent
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.2 + BAR * sum(heights))
        panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        highest = max(float(rows["utilisation_percent"].max()), permitted)
        for axes, (kind, own, every) in zip(panels, shown, strict=True):
            _draw_utilisation(axes, own, permitted)
            more = tr(": the {shown} with the highest utilisation of {every}", shown=len(own), every=every)
            axes.set_title(kind_told(kind) + (more if len(own) < every else ""), loc="left", fontsize=8, pad=3)
        panels[0].set_xlim(0.0, 1.25 * highest)
        panels[-1].set_xlabel(tr("utilisation of what the rating permits in the window that rules [%]"), fontsize=8)
        panels[-1].tick_params(axis="x", labelsize=8)
        margins = _margins(permitted)
        legend_below(figure, margins, [handle.get_label() for handle in margins])
        head(figure, tr("{study}: utilisation of the devices", study=data.title))
        return figure


def _room(many: int, counts: list[int]) -> int:
    """Return how many bars a kind of `many` devices gets, so that all kinds together fit."""
    if sum(counts) <= MOST_BARS:
        return many
    most = next((most for most in range(max(counts), FEWEST_BARS, -1) if sum(min(most, n) for n in counts) <= MOST_BARS), 0)
    return min(many, max(most, FEWEST_BARS))


def _worst(rows: pd.DataFrame, most: int) -> pd.DataFrame:
    """Return the rows with the highest utilisation, in their order along the line."""
    kept = rows.sort_values("utilisation_percent", ascending=False, kind="stable").head(most)
    return kept.sort_values(["from_km", "device"], kind="stable")


def margin_colour(percent: float, permitted: float) -> str:
    """Return the colour of a utilisation [%]."""
    return VERMILION if percent > permitted else ORANGE if percent > TIGHT_PERCENT / 100.0 * permitted else GREEN


def _margins(permitted: float) -> list[Any]:
    tight = TIGHT_PERCENT / 100.0 * permitted
    low, high = number(tight), number(permitted)
    return [
        Patch(color=GREEN, label=tr("up to {percent} %", percent=low)),
        Patch(color=ORANGE, label=tr("{low} to {high} %", low=low, high=high)),
        Patch(color=VERMILION, label=tr("more than the permitted {percent} %", percent=high)),
    ]


def _draw_utilisation(axes: Axes, rows: pd.DataFrame, permitted: float) -> None:
    values = rows["utilisation_percent"].to_numpy(float)
    place = np.arange(len(rows), dtype=float)
    drawn = axes.barh(place, values, 0.72, color=[margin_colour(value, permitted) for value in values])
    texts = [f"{number(value, 0)} %, {window_told(window)}" for value, window in zip(values, rows["window_s"], strict=True)]
    axes.bar_label(drawn, texts, padding=2, fontsize=SMALLEST, color=INK, bbox=BARE)
    axes.axvline(permitted, color=INK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.set_yticks(place, [shortened(device_told(name), MOST_LETTERS) for name in rows["device"]], fontsize=SMALLEST)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_axisbelow(True)
    axes.grid(visible=False, axis="y")
    axes.tick_params(axis="y", length=0)


def device_load_duration(data: RunData) -> Figure | None:
    """Draw for how much of the time the current of a device is at least so high: substations, and the feeders with most."""
    rows = data.table("load_duration")
    if rows is None:
        return None
    groups = [
        (tr("Substations"), rows[rows["kind"] == "substation"]),
        (tr("Feeders and cabin feeders"), rows[rows["kind"].isin(["feeder", "cabin_feeder"])]),
        (tr("Sections of contact line"), rows[rows["kind"] == "contact_line"]),
    ]
    groups = [(words, own) for words, own in groups if len(own)]
    if not groups:
        return None
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 0.8 + 3.1 * len(groups))
        panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (words, own) in zip(panels, groups, strict=True):
            every, shown = _draw_durations(axes, own)
            more = tr(": the {shown} with the highest currents of {every}", shown=shown, every=every)
            axes.set_title(words + (more if shown < every else ""), loc="left", fontsize=8)
            axes.set_ylabel(tr("current at least [A]"), fontsize=8)
            axes.tick_params(labelsize=8)
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.04), fontsize=SMALLEST, handlelength=2.8)
        panels[0].set_xlim(0.0, 100.0)
        panels[-1].set_xlabel(tr("share of the run [%]"), fontsize=8)
        head(figure, tr("{study}: load duration of the devices", study=data.title))
        return figure


def _draw_durations(axes: Axes, rows: pd.DataFrame) -> tuple[int, int]:
    """Draw the devices with the highest currents; return how many there are and how many are shown."""
    highest = rows.groupby(rows["device"].astype(str))["current_a"].max().sort_values(ascending=False, kind="stable")
    for row, (device, peak) in enumerate(highest.head(MOST_CURVES).items()):
        own = rows[rows["device"] == device].sort_values("share_percent", kind="stable")
        style: Any = {"color": COLOURS[row % len(COLOURS)], "linestyle": DASHES[row // len(COLOURS) % len(DASHES)]}
        axes.plot(
            own["share_percent"],
            own["current_a"],
            linewidth=1.2,
            label=f"{shortened(device_told(device), 24)}: {number(peak, 0)} A",
            **style,
        )
    axes.set_ylim(0.0, None)
    return len(highest), min(len(highest), MOST_CURVES)


def sharing(data: RunData) -> Figure | None:
    """Draw how the two substations of each feeding zone share its current, along the line."""
    rows = data.table("sharing")
    if rows is None:
        return None
    both = rows.groupby(rows["zone"].astype(str), sort=False)["substation"].agg(list)
    zones = zones_along_line(data.scenario, {str(zone): names for zone, names in both.items()})
    every = len(zones)
    highest = rows.groupby(rows["zone"].astype(str))["highest_current_a"].max()
    zones = [zones[k] for k in most_loaded([float(highest[zone]) for zone in zones], MOST_ZONES)]
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.3 + 0.27 * len(zones))
        shares, currents = figure.subplots(1, 2, sharey=True)
        for row, zone in enumerate(zones):
            _draw_zone(shares, currents, rows[rows["zone"] == zone], row)
        shares.set_yticks(range(len(zones)), [shortened(zone, MOST_LETTERS) for zone in zones], fontsize=SMALLEST)
        shares.set_ylim(len(zones) - 0.4, -0.6)
        shares.axvline(50.0, color=INK, linewidth=0.8, linestyle=(0, (5, 3)))
        shares.set_xlim(min(0.0, *shares.get_xlim()), max(100.0, shares.get_xlim()[1]))
        shares.set_xlabel(tr("share of the mean current\nof the zone [%]"), fontsize=8)
        currents.set_xlabel(tr("mean current (bar), highest\nmean of a step (dash) [A]"), fontsize=8)
        for axes in (shares, currents):
            axes.tick_params(axis="x", labelsize=8)
            axes.grid(visible=False, axis="y")
            axes.set_axisbelow(True)
        labels = [tr("first substation of the zone"), tr("second substation")]
        legend_below(figure, [Patch(color=BLUE), Patch(color=ORANGE)], labels)
        more = tr(", the {shown} most loaded of {every} zones", shown=len(zones), every=every) if len(zones) < every else ""
        head(figure, tr("{study}: load sharing of neighbouring substations", study=data.title) + more)
        return figure


def _draw_zone(shares: Axes, currents: Axes, rows: pd.DataFrame, line: int) -> None:
    """Draw the zone of a row: the shares in one bar, the currents of the two below each other."""
    left = 0.0
    for k, (row, colour) in enumerate(zip(rows.to_dict("records"), (BLUE, ORANGE), strict=False)):
        share, highest = float(row["share_percent"]), float(row["highest_current_a"])
        if np.isfinite(share):
            left = left if share > 0.0 else 0.0
            shares.barh(line, share, 0.7, left=left, color=colour)
            style: Any = {"ha": "center", "va": "center", "color": "white" if colour == BLUE else INK, "fontsize": SMALLEST}
            shares.text(left + share / 2, line, f"{number(share, 0)} %", **style)
            left += max(share, 0.0)
        at = line + 0.36 * (k - 0.5)
        currents.barh(at, np.nan_to_num(float(row["mean_current_a"])), 0.32, color=colour)
        currents.plot([highest] * 2, [at - 0.15, at + 0.15], color=colour, linewidth=1.6)


def demand(data: RunData) -> Figure | None:
    """Draw the demand of each supply point by the quarter of an hour, with what is contracted, a panel for each."""
    rows = data.table("demand")
    if rows is None:
        return None
    points = supply_points_along_line(data.scenario, rows["supply_point"].astype(str))
    highest = rows.groupby(rows["supply_point"].astype(str))["power_kw"].max()
    every = len(points)
    points = [points[k] for k in most_loaded([float(highest[point]) for point in points])]
    with mpl.rc_context(STYLE):
        figure, panels = time_panels(len(points), float(rows["from_s"].min()), float(rows["from_s"].max()) + QUARTER_S)
        for axes, name in zip(panels, points, strict=False):
            _draw_demand(axes, rows[rows["supply_point"] == name].sort_values("from_s", kind="stable"), name)
        figure.supylabel(tr("mean power of a quarter of an hour by the clock [MW]"), fontsize=8)
        more = tr(", the {shown} most loaded of {every}", shown=len(points), every=every) if len(points) < every else ""
        head(figure, tr("{study}: demand of the supply points", study=data.title) + more)
        handles: list[Any] = [Patch(color=SKY, label=tr("demand"))]
        if rows["contract_power_kw"].notna().any():
            handles += [Patch(color=VERMILION, label=tr("beyond the contract")), Line2D([], [], label=tr("contract"), **CONTRACT)]
        legend_below(figure, handles, [str(handle.get_label()) for handle in handles])
        return figure


CONTRACT: dict[str, Any] = {"color": INK, "linewidth": 1.3, "linestyle": (0, (5, 3))}
"""Style of contracts."""

QUARTER_S = 900.0
"""A quarter of an hour [s]."""


def _draw_demand(axes: Axes, rows: pd.DataFrame, name: str) -> None:
    power, contract = rows["power_kw"].to_numpy(float) / 1000.0, rows["contract_power_kw"].to_numpy(float) / 1000.0
    starts = rows["from_s"].to_numpy(float)
    beyond = power > np.where(np.isnan(contract), np.inf, contract)
    axes.bar(starts, np.nan_to_num(power), QUARTER_S, align="edge", color=[VERMILION if over else SKY for over in beyond])
    title = name = shortened(name, MOST_LETTERS - 10)
    if np.isfinite(power).any():
        title = tr("{name}: highest {power} MW", name=name, power=number(np.nanmax(power), 2, bare=False))
    if np.isfinite(contract).any():
        # over the whole width: demand by the clock leaves out what is no whole quarter of an hour
        axes.axhline(float(np.nanmax(contract)), zorder=3.0, **CONTRACT)
        title += tr(", contract {power} MW", power=number(np.nanmax(contract), 2, bare=False))
    axes.set_axisbelow(True)
    axes.set_title(title, loc="left", fontsize=SMALLEST, pad=3)
