"""What outages do: worst voltage and rail potential along the line with the outage that causes them, delays, loads."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tractionpower.model.limits import common_limits
from tractionpower.reporting.facts.device_words import device_told, window_told
from tractionpower.reporting.facts.outages import COMPUTED, Outages, grid_told
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.axes import draw_limits, panels_of_lines, voltage_range, with_margin
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PAGE,
    PALE,
    SKY,
    SMALLEST,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.reporting.figures.supply.km_axis import name_devices, name_stations
from tractionpower.reporting.figures.supply.panels import LETTER_7, head, in_lines, legend_below
from tractionpower.reporting.figures.supply.ratings_figures import BARE, TIGHT_PERCENT, margin_colour
from tractionpower.reporting.texts import number, recorded, tr, trn

INCHES = PAGE - 1.1
"""Width of a panel [inches]."""

MOST_TRACKS = 6
MOST_ROWS = 50
MOST_LETTERS = 48
"""Letters of a name beside a row."""

ROW = 0.15
"""Height of a row of dots [inches]."""

GAP_KM = 1.5
"""Where neighbouring values are further apart the lines are broken [km]."""

NEAR = 0.6
"""A limit of the rail potential is drawn when it comes to this share of it."""

LEGEND_LETTERS = 100
"""Letters of what is said of a case below a figure."""

GRID_STYLES: dict[str, tuple[str, str]] = {"normal": (BLUE, "o"), "low": (VERMILION, "v"), "high": (GREEN, "^")}


def envelope_voltage(outages: Outages, title: str) -> Figure | None:
    """Draw the lowest voltage along each track without outage and of all cases, and which case rules where."""
    return _envelope(outages, "voltage", tr("{study}: lowest voltage along the line in all outages", study=title))


def envelope_rails(outages: Outages, title: str) -> Figure | None:
    """Draw the greatest rail potential along the line without outage and of all cases, and which case rules where."""
    return _envelope(outages, "rail_potential", tr("{study}: greatest rail potential in all outages", study=title))


def _envelope(outages: Outages, quantity: str, title: str) -> Figure | None:
    rows = outages.table("envelope")
    rows = rows[rows["quantity"] == quantity] if len(rows) else rows
    if not len(rows) or not np.isfinite(rows["worst_v"].to_numpy(float)).any():
        return None
    worst = rows.groupby(rows["track"].astype(str))["worst_v"].agg("min" if quantity == "voltage" else "max")
    order = worst.sort_values(ascending=quantity == "voltage", kind="stable").index[:MOST_TRACKS]
    lines = outages.places.by_line(str(track) for track in order)
    tracks = [track for line in lines for track in line]
    numbers = _ruling_numbers(rows[rows["track"].isin(tracks)])
    legend = [f"{count}  {shortened(outages.told(case), LEGEND_LETTERS)}" for case, count in numbers.items()]
    columns, texts = _in_columns(legend)
    with mpl.rc_context(STYLE):
        height = 1.5 + 0.9 * len(lines) + 1.9 * len(tracks)
        words = 0.25 + 0.13 * texts
        figure = new_figure(PAGE, height + words)
        parts: Any = figure.subfigures(2, 1, height_ratios=[height, words])
        above, below = parts
        panels = panels_of_lines(above, lines)
        for axes, track in zip(panels, tracks, strict=True):
            line = next(line for line in lines if track in line)
            axes.tick_params(labelsize=8, labelbottom=track == line[-1])
            _draw_envelope(axes, outages, rows, track, line, numbers, quantity)
        for line in lines:
            own = {*line, *(track for conductor in line for track in conductor.split())}
            name_stations(panels[tracks.index(line[-1])], outages.places.stations(own), INCHES)
        legend_below(above, *panels[0].get_legend_handles_labels(), 3)
        _write_legend(below, legend, columns, texts)
        head(figure, title)
        return figure


def _ruling_numbers(rows: pd.DataFrame) -> dict[str, int]:
    """Return a number for each case that rules somewhere, in the order along the line."""
    ordered = rows[rows["worst_v"].notna()].sort_values(["km", "track"], kind="stable")
    return {case: count for count, case in enumerate(dict.fromkeys(ordered["case"].astype(str)), 1)}


def _draw_envelope(
    axes: Axes, outages: Outages, rows: pd.DataFrame, track: str, line: Sequence[str], numbers: Mapping[str, int], quantity: str
) -> None:
    own = rows[(rows["track"] == track) & rows["worst_v"].notna()].sort_values("km", kind="stable")
    km = own["km"].to_numpy(float)
    gaps = np.flatnonzero(np.diff(km) > GAP_KM) + 1
    at = np.insert(km, gaps, np.nan)
    for name, colour, label in (
        ("base_v", BLUE, tr("nothing out, normal grid voltage")),
        ("worst_v", VERMILION, tr("worst of all cases")),
    ):
        values = own[name].to_numpy(float)
        axes.plot(at, np.insert(values, gaps, np.nan), color=colour, linewidth=1.4, label=label)
    every = rows.loc[rows["track"].isin(line), "km"]
    axes.set_xlim(*with_margin(float(every.min()), float(every.max())))
    both = rows[["base_v", "worst_v"]].to_numpy(float)
    top, bottom = float(np.nanmax(both)), float(np.nanmin(both))
    tracks = line if track in outages.places.site.axes else track.split()
    if quantity == "voltage":
        limit = outages.limit("u_min2")
        axes.set_ylim(*voltage_range(min(bottom, limit.value if limit and bottom - limit.value < 600.0 else bottom), top, 0.12))
        draw_limits(axes, outages.scenario)
        axes.set_ylabel(tr("{tracks}\nlowest voltage [V]", tracks=told([track])), fontsize=8)
    else:
        _rail_axis(axes, outages, top)
        axes.set_ylabel(tr("rails of {tracks}\nrail potential [V]", tracks=told(track.split())), fontsize=8)
    name_devices(axes, outages.places.devices(tracks), INCHES, names=track == line[0])
    _draw_rulers(axes, km, own["case"].astype(str).to_list(), numbers, INCHES)


def _rail_axis(axes: Axes, outages: Outages, top: float) -> None:
    """Set the axis of rail potentials, with the permanent touch voltage where they come near it."""
    named = common_limits(outages.scenario.limits, outages.scenario.supply.system, "touch_")
    limit = named.get("touch_permanent")
    near = limit is not None and top >= NEAR * limit.value
    axes.set_ylim(0.0, 1.15 * max(top, 1.0, limit.value if limit is not None and near else 0.0))
    if limit is not None and near:
        label = tr("touch voltage, {duration} ({status} value)", duration=tr("permanent"), status=recorded(limit.status))
        axes.axhline(limit.value, color=GREY, linewidth=1.0, linestyle=(0, (5, 3)), label=label)


def _draw_rulers(axes: Axes, km: Any, cases: list[str], numbers: Mapping[str, int], inches: float) -> None:
    """Draw a strip below the lines: which case rules where, by its number."""
    low, high = axes.get_xlim()
    starts = [0, *(k for k in range(1, len(cases)) if cases[k] != cases[k - 1] or km[k] - km[k - 1] > GAP_KM), len(cases)]
    for begin, end in itertools.pairwise(starts):
        left = km[begin] - 0.25 if begin == 0 or km[begin] - km[begin - 1] > GAP_KM else (km[begin - 1] + km[begin]) / 2
        right = km[end - 1] + 0.25 if end == len(km) or km[end] - km[end - 1] > GAP_KM else (km[end - 1] + km[end]) / 2
        count = numbers[cases[begin]]
        colour = (SKY, PALE, ORANGE, "#bbd9a5")[count % 4]
        axes.axvspan(left, right, 0.0, 0.095, facecolor=colour, edgecolor="white", linewidth=0.8, zorder=0.8)
        if (right - left) / (high - low) * inches > LETTER_7 * (len(str(count)) + 0.2):
            at = ((left + right) / 2, 0.045)
            style: Any = {
                "xycoords": ("data", "axes fraction"),
                "ha": "center",
                "va": "center",
                "fontsize": SMALLEST,
                "color": INK,
            }
            axes.annotate(str(count), at, **style)


def _in_columns(texts: Sequence[str]) -> tuple[int, int]:
    """Return into how many columns texts fit, and how many lines they need there."""
    longest = max(map(len, texts), default=1)
    columns = max(1, min(3, int(PAGE / (LETTER_7 * (longest + 1)))))
    return columns, -(-len(texts) // columns)


def _write_legend(figure: Any, texts: Sequence[str], columns: int, lines: int) -> None:
    """Write what the numbers of the strip mean."""
    inches = 0.25 + 0.13 * lines
    style: Any = {"va": "top", "fontsize": SMALLEST, "color": INK}
    figure.text(0.012, 1.0 - 0.02 / inches, tr("Coloured strip: the case that rules there"), fontweight="bold", **style)
    for row, text in enumerate(texts):
        figure.text(0.012 + (row // lines) / columns, 1.0 - (0.17 + 0.13 * (row % lines)) / inches, text, **style)


def outage_voltages(outages: Outages, title: str) -> Figure | None:
    """Draw the lowest voltage of each outage at each grid voltage, the lowest of them first if not all fit."""
    rows, every = _worst_outages(outages, "lowest_voltage_v", lowest=True)
    if not rows:
        return None
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.3 + ROW * len(rows))
        axes = figure.add_subplot()
        for grid in outages.grids:
            colour, marker = GRID_STYLES.get(grid, (GREY, "s"))
            points = [(_value(cases.get(grid), "lowest_voltage_v"), k) for k, (_, cases) in enumerate(rows)]
            style: Any = {"color": colour, "markersize": 4.5, "label": grid_told(grid)}
            axes.plot(*zip(*points, strict=True), marker, **style)
        volts = [_value(case, "lowest_voltage_v") for _, cases in rows for case in cases.values()]
        limit = outages.limit("u_min2")
        low = float(np.nanmin(volts))
        if limit is not None and low - limit.value < 600.0:
            low = min(low, limit.value)
        axes.set_xlim(*voltage_range(low, float(np.nanmax(volts)), 0.08))
        _upright_limits(axes, outages)
        _name_rows(axes, [first["words"] for first, _ in rows])
        axes.tick_params(axis="x", labelsize=8)
        axes.set_xlabel(tr("lowest voltage of the run [V]"), fontsize=8)
        legend_below(figure, *axes.get_legend_handles_labels())
        more = tr(", the {shown} worst of {every}", shown=len(rows), every=every) if len(rows) < every else ""
        head(figure, tr("{study}: lowest voltage in each outage", study=title) + more)
        return figure


def _upright_limits(axes: Axes, outages: Outages) -> None:
    low, high = axes.get_xlim()
    for name, shown in (("u_min2", "U_min2"), ("u_n", "U_n")):
        limit = outages.limit(name)
        if limit is not None and low <= limit.value <= high:
            axes.axvline(limit.value, color=INK, linewidth=0.9, linestyle=(0, (5, 3)))
            text = f"{shown} {number(limit.value)} V"
            axes.annotate(text, (limit.value, 1.0), (0, 2), xycoords=("data", "axes fraction"), textcoords="offset points",
                          ha="center", va="bottom", fontsize=SMALLEST, color=INK)  # fmt: skip


def _worst_outages(outages: Outages, name: str, *, lowest: bool = False) -> tuple[list[Any], int]:
    """Return the outages with a value, at most so many as fit, in their order; and how many there are."""
    groups = [(first, cases) for first, cases in outages.groups() if any(np.isfinite(_value(c, name)) for c in cases.values())]
    sign = 1.0 if lowest else -1.0
    ranked = sorted(range(len(groups)), key=lambda k: np.nanmin([sign * _value(c, name) for c in groups[k][1].values()]))
    kept = sorted({*(k for k in ranked if groups[k][0]["kind"] == "base"), *ranked[:MOST_ROWS]})
    return [groups[k] for k in kept], len(groups)


def _value(case: Mapping[str, Any] | None, name: str) -> float:
    value = None if case is None or case["status"] not in COMPUTED else case.get(name)
    return float("nan") if value is None or pd.isna(value) else float(value)


def _name_rows(axes: Axes, names: Sequence[str]) -> None:
    axes.set_yticks(range(len(names)), [shortened(name, MOST_LETTERS) for name in names], fontsize=SMALLEST)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)


def outage_delays(outages: Outages, title: str) -> Figure | None:
    """Draw what each outage adds to the lateness of every train, a dot for each, those outages that delay most."""
    trains = outages.table("case_trains")
    if trains.empty:
        return None
    trains = trains[trains["added_late_s"] > outages.tolerance_s]
    if trains.empty:
        return None
    worst = trains.groupby(trains["case"].astype(str))["added_late_s"].max().sort_values(ascending=False, kind="stable")
    kept = set(worst.head(MOST_ROWS).index)
    cases = [str(case) for case in outages.cases["case"] if case in kept]
    size, unit = (60.0, tr("min")) if worst.iloc[0] > 600.0 else (1.0, tr("s"))
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.4 + ROW * max(len(cases), 4))
        axes = figure.add_subplot()
        for k, case in enumerate(cases):
            own = trains[trains["case"] == case]
            added = own["added_late_s"].to_numpy(float) / size
            colour, _ = GRID_STYLES.get(outages.by_id[case]["grid"], (GREY, "s"))
            axes.plot(added, np.full(len(added), float(k)), "o", color=colour, alpha=0.45, markersize=4.5, markeredgewidth=0)
            most = own["train"].iloc[int(added.argmax())]
            least = tr(", at least") if own["status"].iloc[int(added.argmax())] == "stuck" else ""
            text = f"{shortened(str(most), 18)}{least}; {trn('{count} train', '{count} trains', len(own))}"
            axes.annotate(text, (added.max(), k), (6, 0), textcoords="offset points", va="center", fontsize=SMALLEST, color=INK)
        axes.set_xlim(0.0, 1.75 * worst.iloc[0] / size)
        _name_rows(axes, [outages.told(case) for case in cases])
        axes.tick_params(axis="x", labelsize=8)
        note = tr("a dot for each train; beside them the train with most and how many; at least: it stands for good")
        told_of = tr("added to the lateness at timed calls [{unit}]", unit=unit)
        axes.set_xlabel("\n".join([told_of, *in_lines(note, 58)]), fontsize=8)
        more = tr(", the {shown} worst of {every} cases", shown=len(cases), every=len(worst)) if len(cases) < len(worst) else ""
        head(figure, tr("{study}: delays that outages add", study=title) + more)
        _grid_legend(figure, outages, cases)
        return figure


def _grid_legend(figure: Figure, outages: Outages, cases: Sequence[str]) -> None:
    shown = [grid for grid in outages.grids if any(outages.by_id[case]["grid"] == grid for case in cases)]
    style: Any = {"marker": "o", "linestyle": "none"}
    handles = [Line2D([], [], color=GRID_STYLES.get(g, (GREY, ""))[0], label=grid_told(g), **style) for g in shown]
    if len(shown) > 1:
        legend_below(figure, handles, [str(handle.get_label()) for handle in handles])


def worst_utilisation(outages: Outages, title: str) -> Figure | None:
    """Draw the utilisation of devices without outage and in the worst one, which is named, those with the highest."""
    rows = outages.table("device_envelope")
    rows = rows[rows["utilisation_percent"].notna()] if len(rows) else rows
    if not len(rows):
        return None
    shown = rows.sort_values("utilisation_percent", ascending=False, kind="stable").head(MOST_ROWS)
    permitted = outages.scenario.sizing.utilisation_percent
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.4 + ROW * max(len(shown), 4))
        axes = figure.add_subplot()
        for k, row in enumerate(shown.to_dict("records")):
            base, use = float(row["base_percent"]), float(row["utilisation_percent"])
            if np.isfinite(base):
                axes.plot([base, use], [k, k], color=GREY, linewidth=1.0, zorder=1)
                axes.plot([base], [k], "o", color=BLUE, markersize=4.5, markerfacecolor="white")
            axes.plot([use], [k], "o", color=margin_colour(use, permitted), markersize=5.0)
            text = f"{number(use, 0)} %, {window_told(row['window_s'])}: {shortened(outages.told(row['case']), 54)}"
            axes.annotate(text, (use, k), (6, 0), textcoords="offset points", va="center", fontsize=SMALLEST, bbox=BARE)
        axes.axvline(permitted, color=INK, linewidth=0.9, linestyle=(0, (5, 3)))
        top = float(shown["utilisation_percent"].max())
        axes.set_xlim(0.0, 3.2 * max(top, permitted))
        _name_rows(axes, [device_told(device) for device in shown["device"]])
        tight = TIGHT_PERCENT / 100.0 * permitted
        axes.set_xticks([tick for tick in axes.get_xticks() if tick <= 1.1 * max(top, permitted)])
        axes.tick_params(axis="x", labelsize=8)
        ends = {"low": number(tight), "high": number(permitted)}
        note = tr("ring: nothing out; dot: worst case (green up to {low} %, amber to {high} %, red beyond)", **ends)
        axes.set_xlabel("\n".join([tr("utilisation of what the rating permits [%]"), *in_lines(note, 58)]), fontsize=8)
        more = tr(", the {shown} highest of {every} rated devices", shown=len(shown), every=len(rows))
        head(figure, tr("{study}: utilisation in the worst outage", study=title) + (more if len(shown) < len(rows) else ""))
        return figure
