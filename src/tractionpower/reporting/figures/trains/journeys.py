"""Figures of theoretical journeys as files: one for each train, and the train graph."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from tractionpower.alignment.lines import tracks_by_line
from tractionpower.alignment.routes import stop_distance
from tractionpower.model.line import Line
from tractionpower.model.report import ReportFigures
from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import Journey
from tractionpower.reporting.facts.places import told
from tractionpower.reporting.figures.base.drawing import drawing
from tractionpower.reporting.figures.base.route_axis import route_in_words
from tractionpower.reporting.figures.base.style import png_names, save
from tractionpower.reporting.figures.trains.journey_figures import journey_figure
from tractionpower.reporting.figures.trains.train_graph import GraphPanel, GraphPlaces, TrainLine, split_by_line, train_graph
from tractionpower.reporting.texts import number, tr
from tractionpower.studies.journeys import JourneyOutcome, end_of, route_end, stations_on


def write_journey_figures(outcome: JourneyOutcome, scenario: Scenario, folder: Path, shown: Sequence[str]) -> list[Path]:
    """Write the train graph, and a figure of each train that is `shown`; return their paths.

    Figures of trains that an earlier run left there go.
    """
    volts = tr("theoretical journey at {voltage} V", voltage=number(outcome.voltage_v))
    with drawing(ReportFigures(), tr("inputs {hash}", hash=scenario.input_hash[:12])):
        paths = [save(figure, folder / name) for name, figure in _figures(outcome.journeys, scenario, shown, volts)]
    for stale in set(folder.glob("train-*.png")) - set(paths):
        with suppress(OSError):
            stale.unlink()
    return paths


def _figures(journeys: Sequence[Journey], scenario: Scenario, shown: Sequence[str], volts: str) -> Iterator[tuple[str, Figure]]:
    line = scenario.line
    study = f"{scenario.name}: " if scenario.name else ""
    yield "train_graph.png", train_graph(panels_of(journeys, line, tracks_by_line(line, scenario.supply)), f"{study}{volts}")
    names = png_names(journey.run.id for journey in journeys)
    for journey in journeys:
        name = journey.run.id
        if name in shown:
            route = route_in_words(journey.path, route_end(journey), line)
            title = tr("train {train}, {route}: {what}", train=name, route=route, what=volts)
            yield f"train-{names[name]}", journey_figure(journey, stations_on(journey, line), f"{study}{title}")


def panels_of(journeys: Sequence[Journey], line: Line, lines: Sequence[Sequence[str]]) -> list[GraphPanel]:
    """Return the panels of the train graph: one for each of `lines`, told by their tracks, that a journey comes to."""
    numbers = {track: k for k, tracks in enumerate(lines) for track in tracks}
    parts = [part for journey in journeys for part in lines_of(journey, numbers)]
    panels = []
    for k, tracks in enumerate(lines):
        shown = [part for at, part in parts if at == k]
        if shown:
            places = GraphPlaces(stations_of_all(journeys, line, tracks))
            panels.append(GraphPanel(told(tracks), shown, planned_times(journeys, tracks), places))
    return panels


def lines_of(journey: Journey, numbers: Mapping[str, int]) -> list[tuple[int, TrainLine]]:
    """Return a journey as lines of the train graph, with the numbers of the lines of tracks that they are on."""
    place = np.append(journey.rows["s_m"], end_of(journey))
    time_s = np.append(journey.rows["time_s"], journey.finished_s)
    whole = TrainLine(journey.run.id, time_s, place, journey.status == "complete")
    return split_by_line(whole, journey.path, place, numbers)


def planned_times(journeys: Sequence[Journey], tracks: Collection[str]) -> list[tuple[float, float]]:
    """Return planned times [s] and places [km] of all calls on some tracks."""
    places = [(call, *journey.path.place(call.at_m)) for journey in journeys for call in journey.calls]
    return [
        (float(planned), km)
        for call, track, km in places
        for planned in (call.planned_arrival_s, call.planned_departure_s)
        if planned is not None and track in tracks
    ]


def stations_of_all(journeys: Sequence[Journey], line: Line, tracks: Collection[str]) -> list[tuple[float, str, bool]]:
    """Return kilometre [km] and name of the stations on some tracks that a train passes, and whether one stops there."""
    stops = {call.station for journey in journeys for call in journey.calls if call.kind == "stop"}
    paths = [journey.path for journey in journeys]
    passed = [s for s in line.stations if any(stop_distance(path, s, tracks=tracks) is not None for path in paths)]
    return sorted((station.km, station.name or station.id, station.id in stops) for station in passed)
