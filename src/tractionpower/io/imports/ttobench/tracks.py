"""Tracks and journeys of TTOBench: a line with one track, and the run of one train."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from tractionpower.errors import Problem
from tractionpower.io.imports import foreign as f
from tractionpower.io.imports.imported import Notes
from tractionpower.io.imports.study_texts import START_S
from tractionpower.io.imports.ttobench.files import Curvatures, JourneyFile, Point, TimingPoints, TrackFile, TrainFile, Tunnels
from tractionpower.model.base import format_time
from tractionpower.model.line import Line

TRACK = "1"
DWELL_S = 30.0
TIGHTEST_M = 55.0
BETWEEN_M2 = 32.0
"""Cross section between tunnels of one and of two tracks, where no train's file tells them apart (assumed)."""


def line_of(file: TrackFile, train: TrainFile | None, notes: Notes, *, repair: bool, place: str) -> dict[str, Any] | None:
    """Return the keys of ``line.yaml``, or None where the track has errors."""
    before = len(notes.problems)
    stops = [
        f.converted(at, file.stops.unit, "km")
        for (at,) in _ordered([(at,) for at in file.stops.values], "stops", notes, repair, place)
    ]
    ends = (stops[0], stops[-1])
    limits = _pieces(file.speed_limits.values, "speed limits", ends, file.speed_limits.units.position, notes, (repair, place))
    unit = file.speed_limits.units.velocity
    data: dict[str, Any] = {
        "name": file.metadata.id.replace("_", " "),
        "source": f"{file.metadata.version}, {file.metadata.license}, by {file.metadata.created_by}",
        "tracks": [{"id": TRACK, "from_km": ends[0], "to_km": ends[1]}],
        "stations": [{"id": f"Stop {k}", "km": km} for k, km in enumerate(stops, 1)],
        "speed_limits": [{**piece, "kmh": f.converted(row[1], unit, "km/h")} for piece, row in limits],
    }
    if file.gradients is not None:
        slopes = _pieces(file.gradients.values, "gradients", ends, file.gradients.units.position, notes, (repair, place))
        slope = file.gradients.units.slope
        data["gradients"] = [{**piece, "permille": f.converted(row[1], slope, "permil")} for piece, row in slopes]
    if file.curvatures is not None:
        data["curves"] = _curves(file.curvatures, ends, notes, (repair, place))
    if file.tunnels is not None:
        data["tunnels"] = _tunnels(file.tunnels, train, ends, notes)
    counts = {key: len(rows) for key, rows in data.items() if isinstance(rows, list) and key != "tracks"}
    notes.read.append(
        f"track {file.metadata.id}: " + ", ".join(f"{count} {key.replace('_', ' ')}" for key, count in counts.items())
    )
    return data if len(notes.problems) == before else None


def _ordered(rows: Any, path: str, notes: Notes, repair: bool, place: str) -> list[tuple[Any, ...]]:
    return f.rising(rows, path if path == "stops" else f"{path}.values", notes, repair=repair, place=place)


def _pieces(
    rows: Sequence[tuple[Any, ...]], path: str, ends: tuple[float, float], unit: str, notes: Notes, how: tuple[bool, str]
) -> list[tuple[dict[str, float], tuple[Any, ...]]]:
    """Return each row with the stretch for which it holds: from its position to the next row's, between the ends."""
    repair, place = how
    ordered = _ordered(rows, path, notes, repair, place)
    starts = [f.converted(row[0], unit, "km") for row in ordered]
    if starts[0] > ends[0]:
        found, remedy = f"begins at km {starts[0]:.10g}", "extend the first row, or import with repair"
        if repair:
            notes.repaired.append(f"{path}: the first row, which {found}, extended to km {ends[0]:.10g}")
            starts[0] = ends[0]
        else:
            allowed = f"km {ends[0]:.10g}, where the first stop is"
            notes.problems.append(Problem("gap", f"{path}.values[0]", found, allowed, remedy, place=place))
    stretches = zip(starts, [*starts[1:], ends[1]], ordered, strict=True)
    inside = [(max(low, ends[0]), min(high, ends[1]), row) for low, high, row in stretches]
    kept = [({"from_km": low, "to_km": high}, row) for low, high, row in inside if low < high]
    if len(kept) < len(ordered):
        notes.ignored.append(f"{path}: {len(ordered) - len(kept)} rows before the first or behind the last stop")
    return kept


def _curves(given: Curvatures, ends: tuple[float, float], notes: Notes, how: tuple[bool, str]) -> list[dict[str, float]]:
    units, curves, transitions = given.units, [], 0
    for piece, row in _pieces(given.values, "curvatures", ends, units.position, notes, how):
        radii = [f.converted(abs(row[1]), units.at_start, "m"), f.converted(abs(row[2]), units.at_end, "m")]
        # Along a clothoid the curvature changes evenly, so its mean is that of its ends; a change of side passes through zero.
        ends_of = [1.0 / radius if radius else 0.0 for radius in radii]
        crosses = row[1] * row[2] < 0.0
        mean = (ends_of[0] ** 2 + ends_of[1] ** 2) / (2.0 * sum(ends_of)) if crosses else sum(ends_of) / 2.0
        transitions += row[1] != row[2]
        if mean > 0.0:
            curves.append({**piece, "radius_m": round(1.0 / mean, 1)})
            if 1.0 / mean <= TIGHTEST_M:
                path, found = f"curvatures at km {piece['from_km']:.10g}", f"a radius of {1.0 / mean:.4g} m"
                notes.problems.append(Problem("out_of_bounds", path, found, f"more than {TIGHTEST_M:g} m", place=how[1]))
    if transitions:
        notes.assumed.append(f"{transitions} transition curves as circular ones with their mean curvature")
    notes.assumed.append("resistance in curves by Röckl: the source gives radii and no formula")
    return curves


def _tunnels(given: Tunnels, train: TrainFile | None, ends: tuple[float, float], notes: Notes) -> list[dict[str, Any]]:
    units, tunnels = given.units, []
    table = train.tunnel_resistance if train is not None else None
    sections = sorted(section for section, _ in table.values) if table is not None else []
    between = (sections[0] + sections[-1]) / 2.0 if len(sections) > 1 else BETWEEN_M2
    for at, length, section in given.values:
        low = max(f.converted(at, units.position, "km"), ends[0])
        high = min(f.tidy(f.converted(at, units.position, "km") + f.converted(length, units.length, "km")), ends[1])
        if low < high:
            tunnels.append({"from_km": low, "to_km": high, "kind": "single_track" if section < between else "double_track"})
    if len(tunnels) < len(given.values):
        notes.ignored.append(f"tunnels: {len(given.values) - len(tunnels)} before the first or behind the last stop")
    notes.assumed.append(f"tunnels narrower than {between:g} m² have one track, others two; their cross sections are not kept")
    if table is None and tunnels:
        notes.assumed.append("tunnels add 2 N/kN (one track) or 1 N/kN (two): the train has no tunnel resistance of its own")
    return tunnels


def calls_at_stops(line: Line, notes: Notes) -> list[dict[str, Any]]:
    """Return the calls of a run that stops at every stop."""
    *between, last = [station.id for station in line.stations][1:]
    first = {"station": line.stations[0].id, "departure": format_time(START_S)}
    notes.assumed.append(f"one train stops everywhere for {DWELL_S:g} s, starting at {format_time(START_S)}; no times on the way")
    return [first, *({"station": name, "min_dwell_s": DWELL_S} for name in between), {"station": last}]


def calls_of_journey(file: JourneyFile, line: dict[str, Any], notes: Notes, place: str) -> list[dict[str, Any]]:
    """Return the calls of a journey; places that are no stops become stations of `line`."""
    points, units = file.points.values, file.points.units
    names = {station["km"]: station["id"] for station in line["stations"]}
    grouped: dict[float, list[Point]] = {}
    for k, row in enumerate(points):
        if k and row[0] < points[k - 1][0]:
            found = f"{row[0]:.10g} behind {points[k - 1][0]:.10g}"
            problem = Problem("not_rising", f"timing points.values[{k}]", found, "positions in the order of the run", place=place)
            notes.problems.append(problem)
        grouped.setdefault(f.converted(row[0], units.position, "km"), []).append(row)
    low, high = line["tracks"][0]["from_km"], line["tracks"][0]["to_km"]
    calls = []
    for k, (km, rows) in enumerate(grouped.items()):
        if not low <= km <= high:
            found, allowed = f"km {km:.10g}", f"km {low:.10g} to {high:.10g}, the track"
            notes.problems.append(Problem("off_track", "timing points", found, allowed, place=place))
        if km not in names:
            names[km] = f"Point {km:.10g}"
            line["stations"].append({"id": names[km], "km": km})
        calls.append({"station": names[km], **_call(rows, file.points, k == 0, k == len(grouped) - 1)})
    line["stations"].sort(key=lambda station: float(station["km"]))
    _tell_windows(points, notes)
    return calls


def _call(rows: list[Point], points: TimingPoints, is_first: bool, is_last: bool) -> dict[str, Any]:
    arrival, departure = rows[0], rows[-1]
    stops = arrival[4] == 0.0
    call: dict[str, Any] = {} if stops else {"stops": False}
    if not is_first and arrival[2] is not None:
        call["arrival"] = _time(arrival[2], points.units.latest)
    if is_first or (stops and len(rows) > 1):
        call["departure"] = _time(departure[1] or 0.0, points.units.earliest)
    elif stops and not is_last:
        call["min_dwell_s"] = DWELL_S
    return call


def _time(value: float, unit: str) -> str:
    return format_time(START_S + f.converted(value, unit, "s"))


def _tell_windows(points: Sequence[Point], notes: Notes) -> None:
    notes.read.append(f"{len(points)} timing points; planned arrivals and passing times are the latest allowed,"
        " departures the earliest")  # fmt: skip
    notes.assumed.append(f"time 0 of the journey is {format_time(START_S)}")
    early = sum(row[1] is not None for row in points[1:])
    paired = sum(before[0] == after[0] for before, after in pairwise(points))
    if early > paired:
        notes.ignored.append(f"earliest times of {early - paired} arrivals and passings: no train waits to be on time there")
    speeds = sum(any(speed for speed in row[3:]) for row in points)
    if speeds:
        notes.ignored.append(f"speed constraints at {speeds} timing points that are no stops")
