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
    KINDS,
    kind_order,
    supply_points_along_line,
    zones_along_line,
)
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.axes import clock_label, set_clock
from tractionpower.reporting.figures.base.style import (
    BLUE,
    COLOURS,
    DASHES,
    GREEN,
    INK,
    ORANGE,
    SKY,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.studies.ratings.words import window_words

WIDTH = 8.3
"""Width of the figures that stand upright on A4 [inches]."""

WIDE = 11.7
"""Width of the figures that lie on A4 [inches]."""

MOST_BARS = 56
"""Bars of one figure; with more devices, those of each kind with the highest utilisation are shown."""

FEWEST_BARS = 5
"""Devices of a kind that are shown at least."""

MOST_CURVES = 12
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
        figure = new_figure(WIDTH, 1.5 + BAR * sum(heights))
        panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        highest = max(float(rows["utilisation_percent"].max()), permitted)
        for axes, (kind, own, every) in zip(panels, shown, strict=True):
            _draw_utilisation(axes, own, permitted)
            more = f": the {len(own)} with the highest utilisation of {every}" if len(own) < every else ""
            axes.set_title(f"{KINDS.get(kind, kind)}{more}", loc="left", fontsize=8.5, pad=3)
        panels[0].set_xlim(0.0, 1.16 * highest)
        panels[-1].set_xlabel("utilisation of what the rating permits in the window that rules [%]")
        figure.legend(handles=_margins(permitted), loc="outside lower center", ncols=4, fontsize=8)
        figure.suptitle(f"{data.title}: utilisation of the devices", x=0.01, ha="left", fontsize=11)
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
    return [
        Patch(color=GREEN, label=f"up to {tight:g} %"),
        Patch(color=ORANGE, label=f"{tight:g} to {permitted:g} %"),
        Patch(color=VERMILION, label=f"more than the permitted {permitted:g} %"),
    ]


def _draw_utilisation(axes: Axes, rows: pd.DataFrame, permitted: float) -> None:
    values = rows["utilisation_percent"].to_numpy(float)
    place = np.arange(len(rows), dtype=float)
    drawn = axes.barh(place, values, 0.72, color=[margin_colour(value, permitted) for value in values])
    texts = [f"{value:.0f} %, {window_words(window)}" for value, window in zip(values, rows["window_s"], strict=True)]
    axes.bar_label(drawn, texts, padding=2, fontsize=7, color=INK, bbox=BARE)
    axes.axvline(permitted, color=INK, linewidth=0.9, linestyle=(0, (5, 3)))
    axes.set_yticks(place, rows["device"].astype(str), fontsize=7)
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
        ("Substations", rows[rows["kind"] == "substation"]),
        ("Feeders and cabin feeders", rows[rows["kind"].isin(["feeder", "cabin_feeder"])]),
        ("Contact-line sections", rows[rows["kind"] == "contact_line"]),
    ]
    groups = [(words, own) for words, own in groups if len(own)]
    if not groups:
        return None
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDE, 0.9 + 3.3 * len(groups))
        panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (words, own) in zip(panels, groups, strict=True):
            every, shown = _draw_durations(axes, own)
            more = f": the {shown} with the highest currents of {every}" if shown < every else ""
            axes.set_title(f"{words}{more}", loc="left", fontsize=9)
            axes.set_ylabel("current at least [A]")
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), fontsize=7.5, handlelength=3.0)
        panels[0].set_xlim(0.0, 100.0)
        panels[-1].set_xlabel("share of the run [%]")
        figure.suptitle(f"{data.title}: load duration of the devices", x=0.01, ha="left", fontsize=11)
        return figure


def _draw_durations(axes: Axes, rows: pd.DataFrame) -> tuple[int, int]:
    """Draw the devices with the highest currents; return how many there are and how many are shown."""
    highest = rows.groupby(rows["device"].astype(str))["current_a"].max().sort_values(ascending=False, kind="stable")
    for number, (device, peak) in enumerate(highest.head(MOST_CURVES).items()):
        own = rows[rows["device"] == device].sort_values("share_percent", kind="stable")
        style: Any = {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number // len(COLOURS) % len(DASHES)]}
        axes.plot(own["share_percent"], own["current_a"], linewidth=1.3, label=f"{device}: {peak:.0f} A", **style)
    axes.set_ylim(0.0, None)
    return len(highest), min(len(highest), MOST_CURVES)


def sharing(data: RunData) -> Figure | None:
    """Draw how the two substations of each feeding zone share its current, along the line."""
    rows = data.table("sharing")
    if rows is None:
        return None
    both = rows.groupby(rows["zone"].astype(str), sort=False)["substation"].agg(list)
    zones = zones_along_line(data.scenario, {str(zone): names for zone, names in both.items()})
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDE, 1.5 + 0.3 * len(zones))
        shares, currents = figure.subplots(1, 2, sharey=True)
        for number, zone in enumerate(zones):
            _draw_zone(shares, currents, rows[rows["zone"] == zone], number)
        shares.set_yticks(range(len(zones)), zones, fontsize=7.5)
        shares.set_ylim(len(zones) - 0.4, -0.6)
        shares.axvline(50.0, color=INK, linewidth=0.8, linestyle=(0, (5, 3)))
        shares.set_xlim(min(0.0, *shares.get_xlim()), max(100.0, shares.get_xlim()[1]))
        shares.set_xlabel("share of the mean current of the zone [%]")
        currents.set_xlabel("mean current (bar), highest mean of a step (dash) [A]")
        for axes in (shares, currents):
            axes.grid(visible=False, axis="y")
            axes.set_axisbelow(True)
        handles = [Patch(color=BLUE, label="first substation of the zone"), Patch(color=ORANGE, label="second substation")]
        figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=8)
        figure.suptitle(f"{data.title}: load sharing of neighbouring substations", x=0.01, ha="left", fontsize=11)
        return figure


def _draw_zone(shares: Axes, currents: Axes, rows: pd.DataFrame, number: int) -> None:
    """Draw the zone of a row: the shares in one bar, the currents of the two below each other."""
    left = 0.0
    for k, (row, colour) in enumerate(zip(rows.to_dict("records"), (BLUE, ORANGE), strict=False)):
        share, highest = float(row["share_percent"]), float(row["highest_current_a"])
        if np.isfinite(share):
            left = left if share > 0.0 else 0.0
            shares.barh(number, share, 0.7, left=left, color=colour)
            style: Any = {"ha": "center", "va": "center", "color": "white" if colour == BLUE else INK, "fontsize": 7}
            shares.text(left + share / 2, number, f"{share:.0f} %", **style)
            left += max(share, 0.0)
        at = number + 0.36 * (k - 0.5)
        currents.barh(at, np.nan_to_num(float(row["mean_current_a"])), 0.32, color=colour)
        currents.plot([highest] * 2, [at - 0.15, at + 0.15], color=colour, linewidth=1.6)


def demand(data: RunData) -> Figure | None:
    """Draw the demand of each supply point by the quarter of an hour, with what is contracted, a panel for each."""
    rows = data.table("demand")
    if rows is None:
        return None
    points = supply_points_along_line(data.scenario, rows["supply_point"].astype(str))
    columns = 1 if len(points) <= 3 else 2 if len(points) <= 16 else 3
    lines = -(-len(points) // columns)
    with mpl.rc_context(STYLE):
        figure = new_figure(WIDE, max(4.0, 1.3 + (1.9 if columns == 1 else 1.15) * lines), 0.05)
        grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
        panels = grid.T.ravel()
        for axes, name in zip(panels, points, strict=False):
            _draw_demand(axes, rows[rows["supply_point"] == name].sort_values("from_s", kind="stable"), name)
        for axes in panels[len(points) :]:
            axes.set_frame_on(False)
            axes.grid(visible=False)
            axes.tick_params(left=False, labelleft=False)
        _clock(grid, float(rows["from_s"].min()), float(rows["from_s"].max()) + QUARTER_S, columns)
        figure.supylabel("mean power of a quarter of an hour by the clock [MW]", fontsize=9)
        figure.suptitle(f"{data.title}: demand of the supply points", x=0.01, ha="left", fontsize=11)
        handles: list[Any] = [Patch(color=SKY, label="demand")]
        if rows["contract_power_kw"].notna().any():
            handles += [Patch(color=VERMILION, label="beyond the contract"), Line2D([], [], label="contract", **CONTRACT)]
        figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=8)
        return figure


CONTRACT: dict[str, Any] = {"color": INK, "linewidth": 1.3, "linestyle": (0, (5, 3))}
"""Style of contracts."""

QUARTER_S = 900.0
"""A quarter of an hour [s]."""


def _clock(grid: Any, begin: float, end: float, columns: int) -> None:
    set_clock(grid[0, 0], begin, end, 10 if columns == 1 else 7)
    grid[0, 0].set_xlim(begin, end)
    for axes in grid[-1]:
        axes.set_xlabel(clock_label(grid[0, 0]))


def _draw_demand(axes: Axes, rows: pd.DataFrame, name: str) -> None:
    power, contract = rows["power_kw"].to_numpy(float) / 1000.0, rows["contract_power_kw"].to_numpy(float) / 1000.0
    starts = rows["from_s"].to_numpy(float)
    beyond = power > np.where(np.isnan(contract), np.inf, contract)
    axes.bar(starts, np.nan_to_num(power), QUARTER_S, align="edge", color=[VERMILION if over else SKY for over in beyond])
    title = f"{name}: highest {np.nanmax(power):.2f} MW" if np.isfinite(power).any() else name
    if np.isfinite(contract).any():
        # over the whole width: demand by the clock leaves out what is no whole quarter of an hour
        axes.axhline(float(np.nanmax(contract)), zorder=3.0, **CONTRACT)
        title += f", contract {np.nanmax(contract):.2f} MW"
    axes.set_axisbelow(True)
    axes.set_title(title, loc="left", fontsize=8, pad=3)
