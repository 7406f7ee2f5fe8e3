"""The figures of a case of stations as files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.reporting.figures.base.drawing import files_of, remove_files, wanted
from tractionpower.reporting.figures.base.style import save_as
from tractionpower.reporting.figures.stations.path_figures import distance_over_time, speed_over_distance
from tractionpower.reporting.figures.stations.topology import topology
from tractionpower.results.results import Results

FIGURES: dict[str, Callable[[StationsCase, pd.DataFrame], Figure]] = {
    "station_topology": topology,
    "station_distance_time": distance_over_time,
    "station_speed_distance": speed_over_distance,
}
"""Figures of a case of stations by name."""

NAMES = tuple(FIGURES)

COLUMNS = ("time_s", "train", "station_track", "position_m", "speed_kmh", "state")


def write_station_figures(results: Results, case: StationsCase, folder: Path) -> list[Path]:
    """Write the figures of a case of stations into `folder`, as the template says, and return their paths.

    Figures that an earlier run left there go; other files stay.
    """
    rows = results.table("point_masses", COLUMNS) if "point_masses" in results.tables else None
    paths = []
    for name, draw in FIGURES.items():
        if rows is not None and len(rows) and wanted(name):
            paths += save_as(draw(case, rows), folder, name)
    remove_files(files_of(folder, NAMES) - {*paths})
    return paths
