"""Rail potentials of a run: along the line, over time at the worst places, and both at once as a map."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.limits import Limit, common_limits
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import interval, peaks_kept
from tractionpower.reporting.figures.base.axes import clock_label, panels_of_lines, set_clock, with_margin
from tractionpower.reporting.figures.base.labels import fitting, shortened
from tractionpower.reporting.figures.base.style import (
    BLUE,
    COLOURS,
    DASHES,
    GREEN,
    GREY,
    INK,
    PAGE,
    SKY,
    SMALLEST,
    STYLE,
    VERMILION,
    new_figure,
)
from tractionpower.reporting.figures.supply.km_axis import MOST_LETTERS, ROW, name_devices, name_stations
from tractionpower.reporting.figures.supply.panels import head, legend_below, once
from tractionpower.reporting.texts import number, recorded, tr

INCHES = PAGE - 1.4
"""Width of a panel [inches]."""

MOST_TRACKS = 4
"""With more return conductors, those with the highest potentials are shown."""

NEAR = 0.5
"""A limit is drawn when the potential comes to this share of it."""

PERMANENT, SHORTER = "touch_permanent", "touch_300s"
POINTS = 3000
COLUMNS = 1500
"""Points of a line, and columns of a map, at most."""

APART_KM = 5.0
"""Places that are drawn over time are at least so far apart [km]; other rails only if their potential differs."""
ALIKE = 0.05
"""Share by which highest potentials differ at least."""

_AT_TRAIN = re.compile(r"train .*, track (.+), km (-?[\d.]+)")


def rail_potential_along_line(data: RunData) -> Figure | None:
    """Draw lowest, mean and highest rail potential along the line, a panel for each return conductor, with touch voltages."""
    profile = data.table("rail_profile")
    if profile is None or not np.isfinite(profile["highest_potential_v"].to_numpy(float)).any():
        return None
    lines = data.places.by_line(
        _chosen(profile.assign(peak=profile[["lowest_potential_v", "highest_potential_v"]].abs().max(axis=1)), "peak")
    )
    tracks = [track for line in lines for track in line]
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 1.4 + 0.9 * len(lines) + (2.6 if len(tracks) == 1 else 2.0) * len(tracks))
        panels = dict(zip(tracks, panels_of_lines(figure, lines), strict=True))
        for track, axes in panels.items():
            _draw_profile(axes, profile[profile["track"] == track].sort_values("km", kind="stable"))
            axes.tick_params(labelsize=8)
            axes.set_ylabel(tr("{tracks}\nrail potential [V]", tracks=_told(track)), fontsize=8)
        low, high = float(profile["lowest_potential_v"].min()), float(profile["highest_potential_v"].max())
        peaks = _peaks_under_trains(data)
        low, high = min([low, *(value for *_, value in peaks)]), max([high, *(value for *_, value in peaks)])
        panels[tracks[0]].set_ylim(*_room(low, high, _limits(data)))
        for line in lines:
            panels[line[0]].set_xlim(*with_margin(*data.places.span(profile, line)))
            for track in line:
                _draw_limits(panels[track], _limits(data))
                name_devices(panels[track], _devices(data, track), INCHES, names=track == line[0])
                _mark_peaks(panels[track], peaks, track)
            name_stations(panels[line[-1]], data.places.stations(_tracks(line)), INCHES)
        head(figure, tr("{study}: rail potential along the line", study=data.title) + _outside(data, low, high))
        legend_below(figure, *once(panels.values()), 3)
        return figure


def _draw_profile(axes: Axes, rows: pd.DataFrame) -> None:
    km = rows["km"].to_numpy(float)
    low, mean, high = (rows[f"{which}_potential_v"].to_numpy(float) for which in ("lowest", "mean", "highest"))
    axes.axhline(0.0, color=INK, linewidth=0.7, zorder=1.2)
    axes.fill_between(km, low, high, color=SKY, alpha=0.22, lw=0)
    axes.plot(km, high, color=VERMILION, linewidth=1.3, label=tr("highest"))
    dashes: Any = (0, (4, 2))
    axes.plot(km, mean, color=GREEN, linewidth=1.3, linestyle=dashes, label=tr("mean over the run"))
    axes.plot(km, low, color=BLUE, linewidth=1.3, label=tr("lowest"))


def _limits(data: RunData) -> list[tuple[str, Limit]]:
    """Return the touch voltages that steps of a second can meet, with their duration in words."""
    named = common_limits(data.scenario.limits, data.scenario.supply.system, "touch_")
    return [(words, named[name]) for name, words in ((PERMANENT, tr("permanent")), (SHORTER, "300 s")) if name in named]


def _room(low: float, high: float, limits: Sequence[tuple[str, Limit]]) -> tuple[float, float]:
    """Return the range of an axis for potentials from `low` to `high` [V]; a limit that they come near is in it."""
    margin = 0.18 * max(high - low, 1.0)
    bottom, top = min(low, 0.0) - margin, max(high, 0.0) + margin
    for _, limit in limits:
        if high >= NEAR * limit.value:
            top = max(top, 1.08 * limit.value)
        if -low >= NEAR * limit.value:
            bottom = min(bottom, -1.08 * limit.value)
    return bottom, top


def _draw_limits(axes: Axes, limits: Sequence[tuple[str, Limit]]) -> None:
    bottom, top = axes.get_ylim()
    # The two are often near each other: the text of the lower one stands below its line.
    looks = (((0, (6, 3)), "top", "bottom"), ((0, (2, 2)), "bottom", "top"))
    for (words, limit), (dashes, above, below) in zip(limits, looks, strict=False):
        for sign in (1.0, -1.0):
            value = sign * limit.value
            if bottom < value < top:
                style: Any = {"color": GREY, "linewidth": 1.0, "linestyle": dashes, "zorder": 1.5}
                axes.axhline(value, label=_limit_told(words, limit), **style)
                axes.annotate(
                    f"{_volts(value, 0)}, {words}", (1.0, value), (3, 0), xycoords=("axes fraction", "data"),
                    textcoords="offset points", ha="left", va=above if sign > 0 else below, color=INK, fontsize=7,
                )  # fmt: skip


def _limit_told(words: str, limit: Limit) -> str:
    return tr("touch voltage, {duration} ({status} value)", duration=words, status=recorded(limit.status))


def _volts(value: float, digits: int = 1) -> str:
    return f"{number(value, digits, bare=False)} V".replace("-", "\N{MINUS SIGN}")


def _outside(data: RunData, low: float, high: float) -> str:
    """Return in words that the permanent limit is beyond the axis, where it is."""
    limit = next((limit for _, limit in _limits(data) if limit.name == PERMANENT), None)
    if limit is None or max(high, -low) >= NEAR * limit.value:
        return ""
    return tr(" (permanent touch voltage, ±{volts} V, lies outside)", volts=number(limit.value))


def _peaks_under_trains(data: RunData) -> list[tuple[str, float, str, float]]:
    """Return track, kilometre, words and value [V] of the extremes of the run that were under a train."""
    found = []
    for name in ("lowest_rail_potential_v", "highest_rail_potential_v"):
        for (key, place), entry in data.key_figures.items():
            match = _AT_TRAIN.fullmatch(place)
            if key == name and match and entry["value"] is not None:
                train = shortened(recorded(place.split(", track")[0]), MOST_LETTERS + 8)
                words = f"{_volts(entry['value'])}, {train}, {entry['time']}"
                found.append((match[1], float(match[2]), words, float(entry["value"])))
    return found


def _mark_peaks(axes: Axes, peaks: Sequence[tuple[str, float, str, float]], tracks: str) -> None:
    for track, km, words, volts in peaks:
        if track in tracks.split():
            left = km < sum(axes.get_xlim()) / 2
            axes.plot(km, volts, "D", color=INK, markersize=4, zorder=4, linestyle="none", label=tr("extreme, under a train"))
            axes.annotate(
                words, (km, volts), (4 if left else -4, 6 if volts > 0 else -6), textcoords="offset points",
                ha="left" if left else "right", va="bottom" if volts > 0 else "top", fontsize=SMALLEST, color=INK, zorder=5,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85},
            )  # fmt: skip


def rail_potential_over_time(data: RunData) -> Figure | None:
    """Draw the rail potential over time at the worst places, and as a map of time and kilometre for each return conductor."""
    rails = data.table("rails")
    if rails is None or rails["time_s"].nunique() < 2 or not np.isfinite(rails["potential_v"].to_numpy(float)).any():
        return None
    lines = data.places.by_line(_chosen(rails.assign(peak=rails["potential_v"].abs()), "peak"))
    maps = {track: grid for line in lines for track in line if len(grid := _grid(rails, track)) > 1}
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 3.2 + 1.9 * len(maps))
        ratios = [1.25, *([1.0] * len(maps))]
        panels = list(figure.subplots(1 + len(maps), sharex=True, squeeze=False, height_ratios=ratios)[:, 0])
        _draw_worst(panels[0], data, rails)
        if maps:
            _draw_maps(figure, panels[1:], data, maps)
        times = rails["time_s"]
        set_clock(panels[0], float(times.min()), float(times.max()), 7)
        panels[0].set_xlim(float(times.min()), float(times.max()))
        panels[-1].set_xlabel(clock_label(panels[0]), fontsize=8)
        every = interval(np.unique(times))
        for axes in panels:
            axes.tick_params(labelsize=8)
        head(figure, tr("{study}: rail potential over time, one step in every {every} s", study=data.title, every=number(every)))
        return figure


def worst_places(rails: pd.DataFrame, number_of: Callable[[str], int] = lambda _: 0, most: int = 3) -> list[tuple[str, float]]:
    """Return track and kilometre of the places with the highest and the lowest potential, and then others.

    They lie apart from each other, or on rails that bonds do not hold at the same potential; `number_of` tells the line of
    a track: kilometres of different lines are not near each other.
    """
    groups = rails.groupby(["track", "km"], observed=True)["potential_v"]
    reach = groups.agg(lambda volts: float(volts.abs().max())).sort_values(ascending=False, kind="stable")
    found: list[tuple[str, float]] = []
    for track, km in (groups.max().idxmax(), groups.min().idxmin(), *reach.index):
        if len(found) == most:
            break
        near = [other for other in found if number_of(other[0]) == number_of(track) and abs(other[1] - km) < APART_KM]
        beside = [reach.get((other, km), reach[other, at]) for other, at in near]
        differs = all(abs(volts - reach[track, km]) > ALIKE * reach[track, km] for volts in beside)
        if differs and track not in [other for other, _ in near]:
            found.append((str(track), float(km)))
    return found


def _draw_worst(axes: Axes, data: RunData, rails: pd.DataFrame) -> None:
    low = high = 0.0
    axes.axhline(0.0, color=INK, linewidth=0.7)
    for row, (track, km) in enumerate(worst_places(rails, data.places.number_of)):
        own = rails[(rails["track"] == track) & (rails["km"] == km)].sort_values("time_s", kind="stable")
        volts = own["potential_v"].to_numpy(float)
        shown = peaks_kept(volts, POINTS)
        style: Any = {"color": COLOURS[row], "linestyle": DASHES[row], "linewidth": 1.0}
        ends = {"lowest": _volts(float(np.nanmin(volts))), "highest": _volts(float(np.nanmax(volts)))}
        label = tr("{tracks}, km {km}: {lowest} to {highest}", tracks=_told(track), km=number(km, 2, bare=False), **ends)
        axes.plot(own["time_s"].to_numpy()[shown], volts[shown], label=label, **style)
        low, high = min(low, float(np.nanmin(volts))), max(high, float(np.nanmax(volts)))
    axes.set_ylim(*_room(low, high, _limits(data)))
    _draw_limits(axes, _limits(data))
    axes.set_ylabel(tr("rail potential [V]\nat the worst places"), fontsize=8)
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    axes.legend(unique.values(), unique.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=SMALLEST)


def _grid(rails: pd.DataFrame, track: str) -> pd.DataFrame:
    """Return potentials [V] of a return conductor by kilometre (rows) and time (columns)."""
    own = rails[rails["track"] == track]
    grid = own.pivot_table(index="km", columns="time_s", values="potential_v", aggfunc="first")
    return grid.iloc[:, :: max(1, -(-grid.shape[1] // COLUMNS))]


def _draw_maps(figure: Figure, panels: Sequence[Axes], data: RunData, maps: dict[str, pd.DataFrame]) -> None:
    most = max(float(np.nanmax(np.abs(grid.to_numpy()))) for grid in maps.values()) or 1.0
    drawn: Any = None
    for axes, (track, grid) in zip(panels, maps.items(), strict=True):
        drawn = axes.pcolormesh(
            grid.columns.to_numpy(float), grid.index.to_numpy(float), grid.to_numpy(float),
            cmap="RdBu_r", vmin=-most, vmax=most, shading="nearest", rasterized=True,
        )  # fmt: skip
        axes.grid(visible=False)
        axes.set_ylabel(tr("{tracks}\nkilometre [km]", tracks=_told(track)), fontsize=8)
        axes.set_ylim(float(grid.index[0]), float(grid.index[-1]))
        _name_devices(axes, _devices(data, track))
    bar = figure.colorbar(drawn, ax=list(panels), location="bottom", shrink=0.5, aspect=45, pad=0.02)
    bar.set_label(tr("rail potential against remote earth [V]"), fontsize=8)
    bar.ax.tick_params(labelsize=8)


def _name_devices(axes: Axes, devices: Sequence[tuple[float, str, bool]]) -> None:
    """Draw lines at substations and section cabins of a map and name substations right of it."""
    low, high = axes.get_ylim()
    inside = [device for device in devices if low <= device[0] <= high]
    shown = fitting([at for at, _, _ in inside], [station for *_, station in inside], 1.05 * ROW * (high - low) / 1.5)
    for at in (at for at, _, substation in inside if substation):
        axes.axhline(at, color=INK, linewidth=0.4, alpha=0.5)
    for k in shown:
        at, name, substation = inside[k]
        axes.annotate(
            f"{'▲' if substation else '■'} {shortened(name, 14)}", (1.0, at), (3, 0), xycoords=("axes fraction", "data"),
            textcoords="offset points", ha="left", va="center", fontsize=7, color=INK,
        )  # fmt: skip


def _chosen(rows: pd.DataFrame, column: str) -> list[str]:
    """Return the return conductors to show, by name: those with the highest values."""
    highest = rows.groupby("track", observed=True)[column].max().sort_values(ascending=False, kind="stable")
    return sorted(str(track) for track in highest.index[:MOST_TRACKS])


def _told(tracks: str) -> str:
    return told(tracks.split())


def _devices(data: RunData, tracks: str) -> list[tuple[float, str, bool]]:
    return data.places.devices(_tracks([tracks]))


def _tracks(conductors: Sequence[str]) -> set[str]:
    """Return the tracks of return conductors, each named by its tracks."""
    return {*conductors, *(track for conductor in conductors for track in conductor.split())}
