"""The train graph of a run: the trains of its tables, the whole time, and finer where most of them run."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from tractionpower.alignment.routes import stop_distance
from tractionpower.model.supply import SectionCabin, Substation
from tractionpower.reporting.run_data import RunData
from tractionpower.reporting.train_graph import MOST_NAMES, GraphPlaces, TrainLine, broken_where_it_jumps, train_graph

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
    lines = [_line(data, name, rows) for name, rows in data.rows_of("trains", "train")]
    planned, places = planned_times(data), places_of(data)
    begin, end = float(trains["time_s"].min()), max(float(line.time_s[-1]) for line in lines)
    shown = [thinned(line, (end - begin) / POINTS) for line in lines]
    inside = [point for point in planned if begin <= point[0] <= end]
    graphs = {"train_graph": train_graph(shown, inside, places, f"{data.title}: train graph")}
    if len(lines) > MOST_NAMES and end - begin > FINE_S:
        first, last = busiest(trains["time_s"])
        parts = [part for line in lines if (part := line.between(first, last)) is not None]
        inside = [point for point in planned if first <= point[0] <= last]
        title = f"{data.title}: train graph of the two hours with most trains"
        graphs["train_graph_fine"] = train_graph([thinned(part, FINE_S / POINTS) for part in parts], inside, places, title)
    return graphs


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
    return TrainLine(line.name, line.time_s[kept], line.km[kept], line.arrives)


def planned_times(data: RunData) -> list[tuple[float, float]]:
    """Return planned times [s] and places [km] of all calls of the trains that ran."""
    ran = {name for name, _ in data.rows_of("trains", "train")}
    return [
        (float(when), planned.path.place(placed.at_m)[1])
        for name, planned in data.planned.items()
        if name in ran
        for placed in planned.calls
        for when in (placed.call.arrival, placed.call.departure)
        if when is not None
    ]


def places_of(data: RunData) -> GraphPlaces:
    """Return the stations that a train passes, and the devices of the supply on tracks of trains."""
    line, supply, runs = data.scenario.line, data.scenario.supply, list(data.planned.values())
    stops = {placed.call.station for planned in runs for placed in planned.calls if placed.call.stops}
    paths = list({id(planned.path): planned.path for planned in runs}.values())
    passed = [s for s in line.stations if any(stop_distance(path, s) is not None for path in paths)]
    stations = sorted((s.km, s.name or s.id, s.id in stops) for s in passed)
    used = {leg.axis.track for path in paths for leg in path.legs}
    devices: tuple[Substation | SectionCabin, ...] = (*supply.substations, *supply.section_cabins)
    near = [each for each in devices if each.tracks is None or used.intersection(each.tracks)]
    return GraphPlaces(stations, sorted((each.km, each.id, isinstance(each, Substation)) for each in near))


def _line(data: RunData, name: str, rows: pd.DataFrame) -> TrainLine:
    time_s, place, km = (rows[column].to_numpy(float) for column in ("time_s", "distance_m", "position_km"))
    track = rows["track"].cat.codes.to_numpy() if hasattr(rows["track"], "cat") else pd.factorize(rows["track"])[0]
    way, planned = data.ways.get(name, {}), data.planned.get(name)
    km = broken_where_it_jumps(km, place, track)
    if planned is not None and way.get("status") == "left" and way["finished_s"] > time_s[-1]:
        time_s, km = np.append(time_s, way["finished_s"]), np.append(km, planned.path.place(planned.route_m)[1])
    return TrainLine(name, time_s, km, way.get("status") != "stuck")
