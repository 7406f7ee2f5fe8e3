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
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.facts.series import interval, peaks_kept
from tractionpower.reporting.figures.base.axes import clock_label, mark_devices, panels_of_lines, set_clock, with_margin
from tractionpower.reporting.figures.base.labels import LETTER, LINE, fitting
from tractionpower.reporting.figures.base.style import BLUE, COLOURS, DASHES, GREEN, GREY, INK, SKY, STYLE, VERMILION, new_figure

WIDTH = 10.5
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
        figure = new_figure(WIDTH, 1.2 + len(lines) + (3.2 if len(tracks) == 1 else 2.5) * len(tracks))
        panels = dict(zip(tracks, panels_of_lines(figure, lines), strict=True))
        for track, axes in panels.items():
            _draw_profile(axes, profile[profile["track"] == track].sort_values("km", kind="stable"))
            axes.set_ylabel(f"{_told(track)}\nrail potential [V]")
        low, high = float(profile["lowest_potential_v"].min()), float(profile["highest_potential_v"].max())
        peaks = _peaks_under_trains(data)
        low, high = min([low, *(value for *_, value in peaks)]), max([high, *(value for *_, value in peaks)])
        panels[tracks[0]].set_ylim(*_room(low, high, _limits(data)))
        for line in lines:
            panels[line[0]].set_xlim(*with_margin(*data.places.span(profile, line)))
            for track in line:
                _draw_limits(panels[track], _limits(data))
                mark_devices(panels[track], _devices(data, track), WIDTH - 1.4, names=track == line[0])
                _mark_peaks(panels[track], peaks, track)
            _name_stations(panels[line[-1]], data, line).set_xlabel("kilometre of the line [km]")
        figure.suptitle(f"{data.title}: rail potential along the line{_outside(data, low, high)}", x=0.01, ha="left", fontsize=11)
        figure.legend(*_once(list(panels.values())), loc="outside lower center", ncols=4, fontsize=8)
        return figure


def _draw_profile(axes: Axes, rows: pd.DataFrame) -> None:
    km = rows["km"].to_numpy(float)
    low, mean, high = (rows[f"{which}_potential_v"].to_numpy(float) for which in ("lowest", "mean", "highest"))
    axes.axhline(0.0, color=INK, linewidth=0.7, zorder=1.2)
    axes.fill_between(km, low, high, color=SKY, alpha=0.22, lw=0)
    axes.plot(km, high, color=VERMILION, linewidth=1.3, label="highest")
    dashes: Any = (0, (4, 2))
    axes.plot(km, mean, color=GREEN, linewidth=1.3, linestyle=dashes, label="mean over the run")
    axes.plot(km, low, color=BLUE, linewidth=1.3, label="lowest")


def _limits(data: RunData) -> list[tuple[str, Limit]]:
    """Return the touch voltages that steps of a second can meet, with their duration in words."""
    named = common_limits(data.scenario.limits, data.scenario.supply.system, "touch_")
    return [(words, named[name]) for name, words in ((PERMANENT, "permanent"), (SHORTER, "300 s")) if name in named]


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
                axes.axhline(value, label=f"touch voltage, {words} ({limit.status} value)", **style)
                axes.annotate(
                    f"{_volts(value, 0)}, {words}", (1.0, value), (3, 0), xycoords=("axes fraction", "data"),
                    textcoords="offset points", ha="left", va=above if sign > 0 else below, color=INK, fontsize=7,
                )  # fmt: skip


def _volts(value: float, digits: int = 1) -> str:
    return f"{round(value, digits) + 0.0:.{digits}f} V".replace("-", "\N{MINUS SIGN}")


def _outside(data: RunData, low: float, high: float) -> str:
    """Return in words that the permanent limit is beyond the axis, where it is."""
    limit = dict(_limits(data)).get("permanent")
    if limit is None or max(high, -low) >= NEAR * limit.value:
        return ""
    return f" (permanent touch voltage, ±{limit.value:g} V, lies outside)"


def _peaks_under_trains(data: RunData) -> list[tuple[str, float, str, float]]:
    """Return track, kilometre, words and value [V] of the extremes of the run that were under a train."""
    found = []
    for name in ("lowest_rail_potential_v", "highest_rail_potential_v"):
        for (key, place), told in data.key_figures.items():
            match = _AT_TRAIN.fullmatch(place)
            if key == name and match and told["value"] is not None:
                words = f"{_volts(told['value'])}, {place.split(', track')[0]}, {told['time']}"
                found.append((match[1], float(match[2]), words, float(told["value"])))
    return found


def _mark_peaks(axes: Axes, peaks: Sequence[tuple[str, float, str, float]], tracks: str) -> None:
    for track, km, words, volts in peaks:
        if track in tracks.split():
            left = km < sum(axes.get_xlim()) / 2
            axes.plot(km, volts, "D", color=INK, markersize=4, zorder=4, linestyle="none", label="extreme, under a train")
            axes.annotate(
                words, (km, volts), (4 if left else -4, 6 if volts > 0 else -6), textcoords="offset points",
                ha="left" if left else "right", va="bottom" if volts > 0 else "top", fontsize=7.5, color=INK, zorder=5,
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
        figure = new_figure(WIDTH, 4.6 + 2.3 * len(maps))
        ratios = [1.25, *([1.0] * len(maps))]
        panels = list(figure.subplots(1 + len(maps), sharex=True, squeeze=False, height_ratios=ratios)[:, 0])
        _draw_worst(panels[0], data, rails)
        if maps:
            _draw_maps(figure, panels[1:], data, maps)
        times = rails["time_s"]
        set_clock(panels[0], float(times.min()), float(times.max()))
        panels[0].set_xlim(float(times.min()), float(times.max()))
        panels[-1].set_xlabel(clock_label(panels[0]))
        every = interval(np.unique(times))
        figure.suptitle(f"{data.title}: rail potential over time, one step in every {every:g} s", x=0.01, ha="left", fontsize=11)
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
    for number, (track, km) in enumerate(worst_places(rails, data.places.number_of)):
        own = rails[(rails["track"] == track) & (rails["km"] == km)].sort_values("time_s", kind="stable")
        volts = own["potential_v"].to_numpy(float)
        shown = peaks_kept(volts, POINTS)
        style: Any = {"color": COLOURS[number], "linestyle": DASHES[number], "linewidth": 1.1}
        label = f"{_told(track)}, km {km:.2f}: {_volts(np.nanmin(volts))} to {_volts(np.nanmax(volts))}"
        axes.plot(own["time_s"].to_numpy()[shown], volts[shown], label=label, **style)
        low, high = min(low, float(np.nanmin(volts))), max(high, float(np.nanmax(volts)))
    axes.set_ylim(*_room(low, high, _limits(data)))
    _draw_limits(axes, _limits(data))
    axes.set_ylabel("rail potential [V]\nat the worst places")
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    axes.legend(unique.values(), unique.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=8)


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
        axes.set_ylabel(f"{_told(track)}\nkilometre [km]")
        axes.set_ylim(float(grid.index[0]), float(grid.index[-1]))
        _name_devices(axes, _devices(data, track))
    bar = figure.colorbar(drawn, ax=list(panels), location="bottom", shrink=0.5, aspect=45, pad=0.02)
    bar.set_label("rail potential against remote earth [V]", fontsize=8)
    bar.ax.tick_params(labelsize=8)


def _name_devices(axes: Axes, devices: Sequence[tuple[float, str, bool]]) -> None:
    """Draw lines at substations and section cabins of a map and name substations right of it."""
    low, high = axes.get_ylim()
    inside = [device for device in devices if low <= device[0] <= high]
    shown = fitting([at for at, _, _ in inside], [station for *_, station in inside], LINE * (high - low) / 1.9)
    for at in (at for at, _, substation in inside if substation):
        axes.axhline(at, color=INK, linewidth=0.4, alpha=0.5)
    for k in shown:
        at, name, substation = inside[k]
        axes.annotate(
            f"{'▲' if substation else '■'} {name}", (1.0, at), (3, 0), xycoords=("axes fraction", "data"),
            textcoords="offset points", ha="left", va="center", fontsize=7, color=INK,
        )  # fmt: skip


def _name_stations(axes: Axes, data: RunData, line: Sequence[str]) -> Any:
    """Name the stations below the axes and return what stands lowest; names that would overlap stand upright, and some go."""
    low, high = axes.get_xlim()
    stations = [each for each in data.places.stations(_tracks(line)) if low <= each[0] <= high]
    if not stations:
        return axes
    per_inch, places = (high - low) / (WIDTH - 1.4), [km for km, _ in stations]
    level = fitting(places, [False] * len(places), [(len(name) + 2) * LETTER * per_inch for _, name in stations])
    upright = len(level) < len(stations)
    shown = fitting(places, [False] * len(places), LINE * per_inch) if upright else level
    bottom = axes.secondary_xaxis(0.0)
    bottom.set_xticks([places[k] for k in shown], [stations[k][1] for k in shown], rotation=90 if upright else 0)
    bottom.tick_params(direction="in", length=5, pad=17, labelsize=7.5, colors=INK, color=INK)
    bottom.spines["bottom"].set_visible(False)
    return bottom


def _chosen(rows: pd.DataFrame, column: str) -> list[str]:
    """Return the return conductors to show, by name: those with the highest values."""
    highest = rows.groupby("track", observed=True)[column].max().sort_values(ascending=False, kind="stable")
    return sorted(str(track) for track in highest.index[:MOST_TRACKS])


def _told(tracks: str) -> str:
    return f"track{'s' if ' ' in tracks else ''} {tracks.replace(' ', ', ')}"


def _devices(data: RunData, tracks: str) -> list[tuple[float, str, bool]]:
    return data.places.devices(_tracks([tracks]))


def _tracks(conductors: Sequence[str]) -> set[str]:
    """Return the tracks of return conductors, each named by its tracks."""
    return {*conductors, *(track for conductor in conductors for track in conductor.split())}


def _once(panels: Sequence[Axes]) -> tuple[list[Any], list[str]]:
    """Return handles and labels of all panels, each once."""
    found: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    return list(found.values()), list(found)
