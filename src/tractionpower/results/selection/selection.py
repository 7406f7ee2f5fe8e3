"""What of a run is selected, and which rows belong to it."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.model.scenario import ROUNDING_S, Scenario

PLACES = ("position_km", "km")
"""Columns of tables that hold places on tracks [km]."""

STATIONS = {"substations": "substation", "feeders": "substation", "cabins": "section_cabin", "loads": "load"}
"""Tables of devices that stand at one place, and the columns of their names."""


@dataclass(frozen=True, slots=True)
class Selection:
    """A part of a run; what is left out selects everything.

    Attributes
    ----------
    trains, tracks
        Identifiers; none: all.
    from_s, to_s
        Window of time [s after midnight]; a step belongs to it that begins in it, the end left out.
    from_km, to_km
        Range of places [km], both ends belong to it. On several lines with kilometres of their own it is taken on each.
    """

    trains: tuple[str, ...] = ()
    tracks: tuple[str, ...] = ()
    from_s: float = -math.inf
    to_s: float = math.inf
    from_km: float = -math.inf
    to_km: float = math.inf

    @property
    def is_everything(self) -> bool:
        """Whether nothing is left out."""
        return self == Selection()

    @property
    def has_window(self) -> bool:
        """Whether it has a window of time."""
        return math.isfinite(self.from_s) or math.isfinite(self.to_s)

    @property
    def has_places(self) -> bool:
        """Whether it has a range of places or tracks."""
        return bool(self.tracks) or math.isfinite(self.from_km) or math.isfinite(self.to_km)

    def as_dict(self) -> dict[str, Any]:
        """Return it as ``run.json`` tells it; what is not selected by is left out."""
        told: dict[str, Any] = {"trains": list(self.trains), "tracks": list(self.tracks)}
        told |= {name: format_time(getattr(self, name)) for name in ("from_s", "to_s") if math.isfinite(getattr(self, name))}
        told |= {name: getattr(self, name) for name in ("from_km", "to_km") if math.isfinite(getattr(self, name))}
        return {name.removesuffix("_s"): value for name, value in told.items() if value != []}


def check_selection(selection: Selection, scenario: Scenario) -> list[Problem]:
    """Return what a selection asks for and the study does not have."""
    clock = scenario.clock
    problems = [
        *_unknown("--train", selection.trains, [run.id for run in scenario.runs]),
        *_unknown("--track", selection.tracks, [track.id for track in scenario.line.tracks]),
    ]
    if max(selection.from_s, clock.start) >= min(selection.to_s, clock.end):
        begin, end = (format_time(at) if math.isfinite(at) else "..." for at in (selection.from_s, selection.to_s))
        found = f"{begin} to {end}"
        allowed = f"a part of {format_time(clock.start)} to {format_time(clock.end)}, the time of the run"
        problems.append(Problem("selection", "--from, --to", found, allowed, "choose times within it"))
    lowest, highest = (
        pick(getattr(track, name) for track in scenario.line.tracks) for pick, name in ((min, "from_km"), (max, "to_km"))
    )
    if selection.from_km > selection.to_km or selection.from_km > highest or selection.to_km < lowest:
        begin, end = (f"{km:g}" if math.isfinite(km) else "..." for km in (selection.from_km, selection.to_km))
        found = f"{begin} to {end} km"
        allowed = f"a rising range that meets km {lowest:g} to {highest:g}"
        problems.append(Problem("selection", "--from-km, --to-km", found, allowed, "choose kilometres of the line"))
    return problems


def selected_rows(table: str, rows: pa.Table, selection: Selection, scenario: Scenario) -> pa.Table:
    """Return the rows of a table over time that belong to a selection."""
    names = rows.schema.names
    keep = np.ones(rows.num_rows, bool)
    if "train" in names and selection.trains:
        keep &= _is_in(rows, "train", selection.trains)
    if table == "events" and selection.trains:
        own = {run.id for run in scenario.runs} - {*selection.trains}
        keep &= ~_is_in(rows, "subject", own)
    if "track" in names and selection.tracks:
        keep &= _is_on(rows, selection.tracks, {track.id for track in scenario.line.tracks})
    if table in STATIONS and selection.has_places:
        keep &= _is_in(rows, STATIONS[table], _devices(selection, scenario))
    keep &= _in_window(table, rows, selection)
    place = next((name for name in PLACES if name in names), None)
    if place is not None:
        km = _numbers(rows, place)
        keep &= np.isnan(km) | ((km >= selection.from_km) & (km <= selection.to_km))
    elif table == "calls" and selection.has_places:
        keep &= _is_in(rows, "station", _stations(selection, scenario))
    return rows if keep.all() else rows.filter(pa.array(keep))


def _in_window(table: str, rows: pa.Table, selection: Selection) -> Any:
    if table == "calls":
        actual, planned = _numbers(rows, "actual_s"), _numbers(rows, "planned_s")
        time_s = np.where(np.isnan(actual), planned, actual)
    elif "time_s" in rows.schema.names:
        time_s = _numbers(rows, "time_s")
    else:
        return np.ones(rows.num_rows, bool)
    if not selection.has_window:
        return np.ones(rows.num_rows, bool)
    return (time_s >= selection.from_s - ROUNDING_S) & (time_s < selection.to_s - ROUNDING_S)


def _numbers(rows: pa.Table, name: str) -> Any:
    return rows.column(name).to_numpy().astype(float)


def _is_in(rows: pa.Table, name: str, values: Collection[str]) -> Any:
    texts = rows.column(name).cast(pa.string())
    return pc.is_in(texts, pa.array(sorted(values), pa.string())).to_numpy(zero_copy_only=False)


def _is_on(rows: pa.Table, tracks: Collection[str], every: Collection[str]) -> Any:
    """Return which rows are on one of the tracks; a return conductor names several by blanks, what belongs to none no track."""
    told = rows.column("track").cast(pa.string()).to_pylist()
    names = {text: [text] if text in every else str(text or "").split() for text in set(told)}
    known = {text: not own or not {*own}.isdisjoint(tracks) for text, own in names.items()}
    return np.array([known[text] for text in told], bool)


def _devices(selection: Selection, scenario: Scenario) -> set[str]:
    supply = scenario.supply
    found = {each.id for each in supply.substations if _meets(selection, each.km, each.tracks or ())}
    found |= {each.id for each in supply.section_cabins if _meets(selection, each.km, each.tracks or ())}
    return found | {load.id for load in supply.loads if _meets(selection, load.km, (load.track,))}


def _stations(selection: Selection, scenario: Scenario) -> set[str]:
    return {each.id for each in scenario.line.stations if _meets(selection, each.km, each.tracks or ())}


def _meets(selection: Selection, km: float, tracks: Collection[str]) -> bool:
    on_track = not selection.tracks or not tracks or not {*tracks}.isdisjoint(selection.tracks)
    return on_track and selection.from_km <= km <= selection.to_km


def _unknown(option: str, wanted: Collection[str], known: Collection[str]) -> list[Problem]:
    missing = [each for each in wanted if each not in known]
    shown = ", ".join(sorted(known)[:12]) + (", ..." if len(known) > 12 else "")
    return [
        Problem("selection", option, repr(each), f"one of {shown or 'none: the study has none'}", "see sheet Trains")
        for each in missing
    ]
