"""Figures of theoretical journeys as files: one for each train, and the train graph."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from tractionpower.alignment.routes import stop_distance
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import Journey
from tractionpower.reporting.journey_figures import journey_figure
from tractionpower.reporting.style import png_names, save
from tractionpower.reporting.train_graph import GraphPlaces, TrainLine, broken_where_it_jumps, train_graph
from tractionpower.studies.journeys import JourneyOutcome, end_of, route_in_words, stations_on


def write_journey_figures(outcome: JourneyOutcome, scenario: Scenario, folder: Path, shown: Sequence[str]) -> list[Path]:
    """Write the train graph, and a figure of each train that is `shown`; return their paths.

    Figures of trains that an earlier run left there go.
    """
    line, volts = scenario.line, f"theoretical journey at {outcome.voltage_v:g} V"
    journeys = outcome.journeys
    places = GraphPlaces(stations_of_all(journeys, line))
    title = f"{scenario.name}: {volts}".lstrip(": ")
    graph = train_graph([line_of(journey) for journey in journeys], planned_times(journeys), places, title)
    paths = [save(graph, folder / "train_graph.png")]
    names = png_names(journey.run.id for journey in journeys)
    for journey in journeys:
        name = journey.run.id
        if name in shown:
            title = f"train {name}, {route_in_words(journey, line)}: {volts}"
            paths.append(save(journey_figure(journey, stations_on(journey, line), title), folder / f"train-{names[name]}"))
    for stale in set(folder.glob("train-*.png")) - set(paths):
        with suppress(OSError):
            stale.unlink()
    return paths


def line_of(journey: Journey) -> TrainLine:
    """Return a journey as a line of the train graph."""
    rows = journey.rows
    place = np.append(rows["s_m"], end_of(journey))
    leg, km = journey.path.places(place)
    time_s = np.append(rows["time_s"], journey.finished_s)
    return TrainLine(journey.run.id, time_s, broken_where_it_jumps(km, place, leg), journey.status == "complete")


def planned_times(journeys: Sequence[Journey]) -> list[tuple[float, float]]:
    """Return planned times [s] and places [km] of all calls."""
    return [
        (float(planned), journey.path.place(call.at_m)[1])
        for journey in journeys
        for call in journey.calls
        for planned in (call.planned_arrival_s, call.planned_departure_s)
        if planned is not None
    ]


def stations_of_all(journeys: Sequence[Journey], line: Line) -> list[tuple[float, str, bool]]:
    """Return kilometre [km] and name of the stations that one of the trains passes, and whether one stops there."""
    stops = {call.station for journey in journeys for call in journey.calls if call.kind == "stop"}
    passed = [s for s in line.stations if any(stop_distance(journey.path, s) is not None for journey in journeys)]
    return sorted((station.km, station.name or station.id, station.id in stops) for station in passed)
