"""The figures of a run as files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.drawing import FORMATS, current_drawing, files_of, remove_files, wanted
from tractionpower.reporting.figures.base.style import save_as, stems
from tractionpower.reporting.figures.delays.delay_graph import delay_graphs
from tractionpower.reporting.figures.delays.lost_figures import delays_by_cause, lost_time
from tractionpower.reporting.figures.many.contingency_figures import (
    envelope_rails,
    envelope_voltage,
    outage_delays,
    outage_voltages,
    worst_utilisation,
)
from tractionpower.reporting.figures.many.outage_map import MAP, outage_maps
from tractionpower.reporting.figures.supply.energy_flow import energy_flow
from tractionpower.reporting.figures.supply.power_figures import substation_currents, substation_power
from tractionpower.reporting.figures.supply.rail_figures import rail_potential_along_line, rail_potential_over_time
from tractionpower.reporting.figures.supply.ratings_figures import demand, device_load_duration, sharing, utilisation
from tractionpower.reporting.figures.supply.substation_figures import load_duration, substation_loads
from tractionpower.reporting.figures.supply.useful_figures import useful_voltage_zones
from tractionpower.reporting.figures.supply.voltage_figures import voltage_along_line, voltage_histogram
from tractionpower.reporting.figures.trains.curve_figures import CURVES, run_curves
from tractionpower.reporting.figures.trains.run_graph import run_graphs
from tractionpower.reporting.figures.trains.train_figures import chosen_trains, train_figures
from tractionpower.results.results import Results

SINGLE = {
    "voltage_along_line": voltage_along_line,
    "voltage_histogram": voltage_histogram,
    "substation_power": substation_power,
    "substation_currents": substation_currents,
    "substation_loads": substation_loads,
    "load_duration": load_duration,
    "energy_flow": energy_flow,
    "delays_by_cause": delays_by_cause,
    "lost_time": lost_time,
    "rail_potential": rail_potential_along_line,
    "rail_potential_time": rail_potential_over_time,
    "utilisation": utilisation,
    "device_load_duration": device_load_duration,
    "sharing": sharing,
    "demand": demand,
    "useful_voltage_zones": useful_voltage_zones,
}
"""Figures of which a run has one, by name; each is left out where its table is missing."""

GRAPHS = ("train_graph", "train_graph_fine", "delay_graph", "delay_graph_fine")
OUTAGES = {
    "envelope_voltage": envelope_voltage,
    "envelope_rails": envelope_rails,
    "outage_voltages": outage_voltages,
    "outage_delays": outage_delays,
    "worst_utilisation": worst_utilisation,
}
"""Figures of a study of outages, by name, beside the maps by kilometre."""

GROUPED = (CURVES,)
"""Beginnings of the names of figures of which a run has several."""

TRAINS = "trains"
"""Folder of the figures of single trains."""


def write_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write the figures of a run into `folder`, as the template says, and return their paths.

    A figure whose table the run has not written is left out. Figures that an earlier run left there and this one does not
    have go; other files stay.
    """
    data = RunData(results, scenario)
    paths = [path for name, figure in _figures(data) for path in save_as(figure, folder, name)]
    paths += _write_curves(data, folder)
    remove_files(files_of(folder, (*SINGLE, *GRAPHS, *GROUPED)) - {*paths})
    chosen = _trains_to_draw(data)
    names = stems(chosen)
    drawn = [path for train, figure in train_figures(data, chosen) for path in save_as(figure, folder / TRAINS, names[train])]
    remove_files({path for path in (folder / TRAINS).glob("*.*") if path.suffix[1:] in FORMATS} - {*drawn})
    return paths + drawn


def write_outage_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write the figures of a study of outages into `folder`, as the template says, and return their paths.

    Those of an earlier study that this one does not have go; other files stay.
    """
    outages = Outages(results, scenario)
    title = scenario.name or str(results.run.get("study", ""))
    drawn = ((name, draw(outages, title)) for name, draw in OUTAGES.items() if wanted(name))
    paths = [path for name, figure in drawn if figure is not None for path in save_as(figure, folder, name)]
    paths += [path for name, figure in outage_maps(outages, title) if wanted(name) for path in save_as(figure, folder, name)]
    remove_files(files_of(folder, (*OUTAGES, MAP)) - {*paths})
    return paths


def _trains_to_draw(data: RunData) -> list[str]:
    """Return the trains that get a figure: those that the template names, or those of most interest."""
    named = [name.removeprefix(f"{TRAINS}/") for name in current_drawing().names or () if name.startswith(f"{TRAINS}/")]
    usual = [name for name in chosen_trains(data) if wanted(f"{TRAINS}/{name}")]
    return sorted({*usual, *(name for name in named if name in data.planned)})


def _write_curves(data: RunData, folder: Path) -> list[Path]:
    names = {name: stem for name, stem in stems(f"{CURVES}_{kind}" for kind in data.kinds).items() if wanted(name)}
    return [path for name, figure in run_curves(data) for path in save_as(figure, folder, names[name])]


def _figures(data: RunData) -> Iterator[tuple[str, Figure]]:
    """Yield the figures that are wanted and that the run has tables for, each drawn when it is its turn."""
    for several, names in ((run_graphs, GRAPHS[:2]), (delay_graphs, GRAPHS[2:])):
        if any(wanted(name) for name in names):
            yield from ((name, figure) for name, figure in several(data).items() if wanted(name))
    for name, draw in SINGLE.items():
        figure = draw(data) if wanted(name) else None
        if figure is not None:
            yield name, figure
