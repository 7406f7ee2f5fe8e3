"""All figures by name: who draws those of a kind of results, which names there are, and which files an earlier command left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.scenario import Scenario
from tractionpower.reporting.figures import of_run
from tractionpower.reporting.figures.base.drawing import FORMATS, files_of, remove_files, stands_for
from tractionpower.reporting.figures.dynamics import of_chain
from tractionpower.reporting.figures.many import compare_figures, sweep_figures
from tractionpower.reporting.figures.many.outage_map import MAP
from tractionpower.reporting.figures.stations import of_stations
from tractionpower.results.results import Results

FigureWriter = Callable[[Results, Any, Path], list[Path]]
"""Takes results, what they are results of, which is of their kind, and the folder."""


def figure_writer(kind: str) -> FigureWriter:
    """Return what writes the figures of results of a kind, as `run.json` tells it; of a run where none is told."""
    writers: dict[str, FigureWriter] = {
        "contingency": of_run.write_outage_figures,
        "sweep": sweep_figures.write_sweep_figures,
        "compare": compare_figures.write_compare_figures,
        "dynamics": of_chain.write_chain_figures,
        "stations": of_stations.write_station_figures,
    }
    return writers.get(kind, of_run.write_figures)


def figure_names() -> tuple[str, ...]:
    """Return the names of all figures; those of groups and folders stand for more than one."""
    of_many = (*of_run.OUTAGES, MAP, *sweep_figures.NAMES, *compare_figures.NAMES)
    return (*of_run.GRAPHS, *of_run.SINGLE, *of_run.GROUPED, of_run.TRAINS, *of_many, *of_chain.NAMES, *of_stations.NAMES)


def unknown_names(chosen: Sequence[str], scenario: Scenario | DynamicsScenario | StationsCase) -> list[str]:
    """Return which of the chosen names of figures no figure has; `trains/ID` needs such a train in the timetable."""
    trains = [f"{of_run.TRAINS}/{run.id}" for run in scenario.runs] if isinstance(scenario, Scenario) else []
    known = figure_names()
    return [name for name in chosen if name not in trains and not any(_is_of(name, each) for each in known)]


def remove_others(folder: Path, written: set[Path]) -> None:
    """Remove the figures that another command left in a folder of figures; files that no command writes stay."""
    trains = folder / of_run.TRAINS
    ours = files_of(folder, figure_names()) | {path for path in trains.glob("*.*") if path.suffix[1:] in FORMATS}
    remove_files(ours - written)
    with suppress(OSError):  # unless something is in it
        trains.rmdir()


def _is_of(name: str, figure: str) -> bool:
    return name == figure or (figure != of_run.TRAINS and stands_for(figure, name))
