"""Figures of theoretical journeys as files: one for each train, and the train graph."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from tractionpower.alignment.routes import stop_distance
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import Journey
from tractionpower.reporting.journey_figures import journey_figure
from tractionpower.reporting.style import png_names, save
from tractionpower.reporting.train_graph import train_graph
from tractionpower.studies.journeys import JourneyOutcome, route_in_words, stations_on


def write_journey_figures(outcome: JourneyOutcome, scenario: Scenario, folder: Path, shown: Sequence[str]) -> list[Path]:
    """Write the train graph, and a figure of each train that is `shown`; return their paths.

    Figures of trains that an earlier run left there go.
    """
    line, volts = scenario.line, f"theoretical journey at {outcome.voltage_v:g} V"
    graph = train_graph(outcome.journeys, stations_of_all(outcome.journeys, line), f"{scenario.name}: {volts}".lstrip(": "))
    paths = [save(graph, folder / "train_graph.png")]
    names = png_names(journey.run.id for journey in outcome.journeys)
    for journey in outcome.journeys:
        name = journey.run.id
        if name in shown:
            title = f"train {name}, {route_in_words(journey, line)}: {volts}"
            paths.append(save(journey_figure(journey, stations_on(journey, line), title), folder / f"train-{names[name]}"))
    for stale in set(folder.glob("train-*.png")) - set(paths):
        with suppress(OSError):
            stale.unlink()
    return paths


def stations_of_all(journeys: Sequence[Journey], line: Line) -> list[tuple[float, str, bool]]:
    """Return kilometre [km] and name of the stations that one of the trains passes, and whether one stops there."""
    stops = {call.station for journey in journeys for call in journey.calls if call.kind == "stop"}
    passed = [s for s in line.stations if any(stop_distance(journey.path, s) is not None for journey in journeys)]
    return sorted((station.km, station.name or station.id, station.id in stops) for station in passed)
