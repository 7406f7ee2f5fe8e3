"""The figures of a run as files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from matplotlib.figure import Figure

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.style import png_names, save
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
from tractionpower.reporting.figures.supply.rail_figures import rail_potential_along_line, rail_potential_over_time
from tractionpower.reporting.figures.supply.ratings_figures import demand, device_load_duration, sharing, utilisation
from tractionpower.reporting.figures.supply.substation_figures import load_duration, substation_currents, substation_loads
from tractionpower.reporting.figures.supply.useful_figures import useful_voltage_zones
from tractionpower.reporting.figures.supply.voltage_figures import voltage_along_line, voltage_histogram
from tractionpower.reporting.figures.trains.run_graph import run_graphs
from tractionpower.reporting.figures.trains.train_figures import chosen_trains, train_figures
from tractionpower.results.results import Results

SINGLE = {
    "voltage_along_line": voltage_along_line,
    "voltage_histogram": voltage_histogram,
    "substation_currents": substation_currents,
    "substation_loads": substation_loads,
    "load_duration": load_duration,
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

TRAINS = "trains"
"""Folder of the figures of single trains."""


def write_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write all figures of a run as PNG into `folder` and return their paths.

    A figure whose table the run has not written is left out. Figures that an earlier run left there and this one does not
    have go; other files stay.
    """
    data = RunData(results, scenario)
    paths = [save(figure, folder / f"{name}.png") for name, figure in _figures(data)]
    for name in {*SINGLE, *GRAPHS} - {path.stem for path in paths}:
        _remove(folder / f"{name}.png")
    chosen = chosen_trains(data)
    names = png_names(chosen)
    paths += [save(figure, folder / TRAINS / names[train]) for train, figure in train_figures(data, chosen)]
    for stale in set((folder / TRAINS).glob("*.png")) - set(paths):
        _remove(stale)
    return paths


def write_outage_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write all figures of a study of outages as PNG into `folder` and return their paths.

    Those of an earlier study that this one does not have go; other files stay.
    """
    outages = Outages(results, scenario)
    title = scenario.name or str(results.run.get("study", ""))
    paths = []
    for name, draw in OUTAGES.items():
        figure = draw(outages, title)
        paths += [save(figure, folder / f"{name}.png")] if figure is not None else []
    paths += [save(figure, folder / f"{name}.png") for name, figure in outage_maps(outages, title)]
    for stale in {*folder.glob(f"{MAP}*.png"), *(folder / f"{name}.png" for name in OUTAGES)} - {*paths}:
        _remove(stale)
    return paths


def _figures(data: RunData) -> Iterator[tuple[str, Figure]]:
    yield from run_graphs(data).items()
    yield from delay_graphs(data).items()
    for name, draw in SINGLE.items():
        figure = draw(data)
        if figure is not None:
            yield name, figure


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()
