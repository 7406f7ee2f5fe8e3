"""Checks of where and when the mean useful voltage is told."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.alignment.axis import compile_axes
from tractionpower.alignment.checks import check_tracks
from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.model.limits import USEFUL_NAMES, useful_limit
from tractionpower.model.scenario import Scenario

_PATH = "sizing.useful_voltage"


def check_useful_voltage(scenario: Scenario) -> list[Problem]:
    """Return the problems of zones and windows, and of a class of the line that has no limit."""
    return [*_check_zones(scenario), *_check_windows(scenario), *_check_class(scenario)]


def _check_zones(scenario: Scenario) -> Iterator[Problem]:
    axes, seen = compile_axes(scenario.line), set[str]()
    for number, zone in enumerate(scenario.sizing.useful_voltage.zones):
        path = f"{_PATH}.zones[{number}]"
        if zone.id in seen:
            yield Problem("duplicate_id", f"{path}.id", f"zone {zone.id} is there already", remedy="give it another name")
        seen.add(zone.id)
        unknown = check_tracks(f"{path}.tracks", zone.tracks, axes)
        yield from unknown
        tracks = [track for track in axes if zone.tracks is None or track in zone.tracks]
        if not unknown and not any(axes[track].stretch_m(zone.from_km, zone.to_km) for track in tracks):
            extents = ", ".join(f"track {track}: km {axes[track].from_km:g} to {axes[track].to_km:g}" for track in tracks)
            found = f"km {zone.from_km:g} to {zone.to_km:g} lies on none of its tracks"
            yield Problem("off_track", path, found, extents, "correct the kilometres or the tracks")


def _check_windows(scenario: Scenario) -> Iterator[Problem]:
    clock = scenario.clock
    begin = clock.counts_from_s
    allowed = f"{format_time(begin)} to {format_time(clock.end)}, what counts of the run"
    for number, window in enumerate(scenario.sizing.useful_voltage.windows):
        if begin <= window.from_ and window.to <= clock.end:
            continue
        lies = "lies outside the run" if window.to <= begin or window.from_ >= clock.end else "lies partly outside the run"
        found = f"{format_time(window.from_)} to {format_time(window.to)} {lies}"
        remedy = "nothing is told of it" if "partly" not in lies else "only the part in the run is told"
        yield Problem("window_outside_clock", f"{_PATH}.windows[{number}]", found, allowed, remedy, "warning")


def _check_class(scenario: Scenario) -> Iterator[Problem]:
    wanted, system = scenario.sizing.useful_voltage.line_class, scenario.supply.system
    if wanted != "conventional" and useful_limit(scenario.limits, system, wanted) is None:
        found = f"{wanted}, of which the limits table knows no lowest mean useful voltage for {system}"
        remedy = f"add a row {system},{USEFUL_NAMES[wanted]} to a limits table of your own; nothing is judged without it"
        yield Problem("no_limit", f"{_PATH}.line_class", found, "", remedy, "warning")
