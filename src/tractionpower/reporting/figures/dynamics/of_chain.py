"""The figures of a run of train dynamics as files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from tractionpower.model.dynamics.case import DynamicsScenario
from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.figures.base.drawing import current_drawing, files_of, remove_files, wanted
from tractionpower.reporting.figures.base.style import save_as
from tractionpower.reporting.figures.dynamics import arshad_figures, coupling_figures, over_time, spread_figures
from tractionpower.reporting.figures.dynamics.stopping_figure import stopping
from tractionpower.results.results import Results

Draw = Callable[[ChainData], Figure | None]

SINGLE: dict[str, Draw] = {
    "dynamics_controls": over_time.controls,
    "dynamics_speeds": over_time.speeds,
    "coupling_forces": coupling_figures.forces_along_train,
    "coupling_extremes": coupling_figures.extremes,
    "coupling_loops": coupling_figures.loops,
    "coupling_first": coupling_figures.first_coupling,
    "brake_cylinders": over_time.cylinders,
    "dynamics_efforts": over_time.efforts,
    "relative_positions": over_time.relative_positions,
    "stopping": stopping,
    "drive_and_speed": spread_figures.drive_and_speed,
    "brake_and_speed": spread_figures.brake_and_speed,
    "coupling_histogram": spread_figures.coupling_histogram,
    "acceleration_histogram": spread_figures.acceleration_histogram,
    "coupling_cycles": spread_figures.rainflow,
    "dynamics_energies": over_time.energies,
}
"""Figures of which a run has one, by name; each is left out where its table is missing."""

NAMES = (*SINGLE, *arshad_figures.FIGURES)
"""Names of all figures of train dynamics."""


def write_chain_figures(results: Results, scenario: DynamicsScenario, folder: Path) -> list[Path]:
    """Write the figures of a run of train dynamics into `folder`, as the template says, and return their paths.

    Figures that an earlier run left there and this one does not have go; other files stay.
    """
    data = ChainData(results, scenario)
    draws = dict(SINGLE)
    if arshad_figures.is_of_arshad(data) and data.has("vehicles"):
        named = current_drawing().names or ()
        draws = {name: draw for name, draw in SINGLE.items() if name not in arshad_figures.TWICE or name in named}
        draws |= arshad_figures.FIGURES
    paths = []
    for name, draw in draws.items():
        figure = draw(data) if wanted(name) else None
        if figure is not None:
            paths += save_as(figure, folder, name)
    remove_files(files_of(folder, NAMES) - {*paths})
    return paths
