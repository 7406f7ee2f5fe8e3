"""The train graph of a run: the trains of its tables, the whole time, and finer where most of them run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from tractionpower.alignment.routes import stop_distance
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.facts.run_data import SAME_S, RunData
from tractionpower.reporting.figures.trains.train_graph import (
    MOST_NAMES,
    GraphPanel,
    GraphPlaces,
    TrainLine,
    split_by_line,
    train_graph,
)
from tractionpower.reporting.texts import tr

POINTS = 4000
"""Points of a line that runs over the whole width of a figure."""

FINE_S = 2 * 3600.0
"""Length of the part that the fine graph shows [s]."""

FINE_STEP_S = 900.0
"""The part of the fine graph begins at a multiple of this [s]."""


def run_graphs(data: RunData) -> dict[str, Figure]:
    """Return the train graph of a run, by name; with many trains also that of the two hours with most of them."""
    trains = data.table("trains")
    if trains is None:
        return {}
    parts = train_lines(data)
    if not parts:
        return {}
    begin, end = float(trains["time_s"].min()), max(float(line.time_s[-1]) for _, line in parts)
    graphs = {"train_graph": _graph(data, parts, begin, end, tr("train graph"))}
    if len({line.name for _, line in parts}) > MOST_NAMES and end - begin > FINE_S:
        first, last = busiest(trains["time_s"])
        inside = [(number, part) for number, line in parts if (part := line.between(first, last)) is not None]
        graphs["train_graph_fine"] = _graph(data, inside, first, last, tr("train graph, the two busiest hours"))
    return graphs


def train_lines(data: RunData) -> list[tuple[int, TrainLine]]:
    """Return the parts of the runs of all trains, each with the number of its line of tracks."""
    numbers = {track: number for number, tracks in enumerate(data.places.lines) for track in tracks}
    ran = {name: rows for name, rows in data.rows_of("trains", "train") if name in data.planned}
    return [part for name, rows in ran.items() for part in _lines(data, name, rows, numbers)]


def _graph(data: RunData, parts: Sequence[tuple[int, TrainLine]], begin: float, end: float, title: str) -> Figure:
    """Draw what runs between two times [s], each part of a train's run in the panel of its line."""
    panels = []
    for number, tracks in enumerate(data.places.lines):
        shown = [thinned(line, (end - begin) / POINTS) for at, line in parts if at == number]
        if shown:
            inside = [point for point in planned_times(data, tracks) if begin <= point[0] <= end]
            panels.append(GraphPanel(told(tracks), shown, inside, places_of(data, tracks)))
    return train_graph(panels, f"{data.title}: {title}")


def busiest(time_s: pd.Series) -> tuple[float, float]:
    """Return begin and end of the two hours [s] in which the rows of trains are most."""
    first = np.floor(time_s.min() / FINE_STEP_S) * FINE_STEP_S
    bins = max(1, int(np.ceil((time_s.max() - first + 1e-9) / FINE_STEP_S)))
    counts, _ = np.histogram(time_s, bins=bins, range=(first, first + bins * FINE_STEP_S))
    width = min(bins, round(FINE_S / FINE_STEP_S))
    begin = first + FINE_STEP_S * float(np.convolve(counts, np.ones(width), mode="valid").argmax())
    return begin, begin + FINE_S


def thinned(line: TrainLine, interval_s: float) -> TrainLine:
    """Return a line with a point at most every `interval_s` [s]; its ends and where it is broken stay."""
    steps = np.floor((line.time_s - line.time_s[0]) / max(interval_s, 1e-9))
    kept = np.append(True, np.diff(steps) > 0)
    kept |= ~np.isfinite(line.km)
    kept[-1] = True
    return replace(line, time_s=line.time_s[kept], km=line.km[kept])


def planned_times(data: RunData, tracks: Sequence[str] | None = None) -> list[tuple[float, float]]:
    """Return planned times [s] and places [km] of all calls of the trains that ran; `tracks` leaves out other tracks."""
    ran = {name for name, _ in data.rows_of("trains", "train")}
    found = []
    for name, planned in data.planned.items():
        for placed in planned.calls if name in ran else ():
            track, km = planned.path.place(placed.at_m)
            times = (placed.call.arrival, placed.call.departure) if tracks is None or track in tracks else ()
            found += [(float(when), km) for when in times if when is not None and data.places.holds(km)]
    return found


def places_of(data: RunData, tracks: Sequence[str] | None = None) -> GraphPlaces:
    """Return the stations that a train passes, and the devices of the supply on tracks of trains, all or some of `tracks`."""
    runs = list(data.planned.values())
    stops = {placed.call.station for planned in runs for placed in planned.calls if placed.call.stops}
    paths = list({id(planned.path): planned.path for planned in runs}.values())
    passed = [s for s in data.scenario.line.stations if any(stop_distance(path, s, tracks=tracks) is not None for path in paths)]
    stations = sorted((s.km, s.name or s.id, s.id in stops) for s in passed if data.places.holds(s.km))
    used = {leg.axis.track for path in paths for leg in path.legs}
    return GraphPlaces(stations, data.places.devices(used if tracks is None else used.intersection(tracks)))


def _lines(data: RunData, name: str, rows: pd.DataFrame, numbers: Mapping[str, int]) -> list[tuple[int, TrainLine]]:
    """Return the parts of a train's run with the numbers of their lines."""
    way, planned = data.ways.get(name, {}), data.planned[name]
    time_s, place = (rows[column].to_numpy(float) for column in ("time_s", "distance_m"))
    if way.get("status") == "left" and 0.0 < way["finished_s"] - time_s[-1] <= data.interval_s + SAME_S:
        time_s, place = np.append(time_s, way["finished_s"]), np.append(place, planned.route_m)
    cuts = [0, *(np.flatnonzero(np.diff(time_s) > data.interval_s + SAME_S) + 1).tolist(), len(time_s)]
    parts = []
    for first, last in pairwise(cuts):  # more than one where it left what is selected, and came back
        piece = TrainLine(name, time_s[first:last], place[first:last], way.get("status") != "stuck")
        parts += split_by_line(piece, planned.path, place[first:last], numbers)
    return parts
