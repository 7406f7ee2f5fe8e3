"""Draw the figures of the README anew: voltages of a day on the real line, full coupling beside constant voltage, delays.

Not part of `make docs`: these figures change with the data that ship, the reference pages with the declarations.
"""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

import tractionpower as tp
from tractionpower.reporting.coupling_figure import compare_coupling
from tractionpower.reporting.delay_graph import delay_graphs
from tractionpower.reporting.run_data import RunData
from tractionpower.reporting.style import save
from tractionpower.reporting.voltage_figures import voltage_along_line

IMAGES = Path(__file__).parent / "images"

OUTAGE = (
    "name=CMK, rectifiers of Idzikowice out",
    "supply.substations[Idzikowice].state=rectifiers_out",
    "clock.start=07:00:00",
    "clock.end=07:12:00",
)
"""An express gains speed behind Idzikowice, where the next substations are some 20 km away, while trains come towards it."""
TRAIN = "EIP 1406"

SHADES = 64
"""Colours of a file: lines and text need no more, and the page loads faster."""


def draw_line() -> Figure:
    """Draw the voltages along the Central Trunk Line over its day."""
    scenario = tp.load("cmk")
    figure = voltage_along_line(RunData(tp.simulate(scenario), scenario))
    assert figure is not None  # the run has a profile
    return figure


def draw_coupling() -> Figure:
    """Draw one train with currents that follow the voltage, and with currents at constant voltage."""
    full = tp.change(tp.load("cmk"), OUTAGE)
    constant = tp.change(full, ["coupling=constant_voltage"])
    return compare_coupling(tp.simulate(full), tp.simulate(constant), full, TRAIN)


def keep(figure: Figure, name: str) -> None:
    """Write a figure with few colours."""
    path = save(figure, IMAGES / name)
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(SHADES)
    small.save(path, optimize=True)
    print(f"{path}: {path.stat().st_size / 1000.0:.0f} kB")


def draw_delays() -> Figure:
    """Draw the train graph of the study with a weak substation, late trains by cause."""
    scenario = tp.load("two-substations/weak.yaml")
    return delay_graphs(RunData(tp.feasibility(scenario), scenario))["delay_graph"]


if __name__ == "__main__":
    keep(draw_delays(), "weak-delay-graph.png")
    keep(draw_coupling(), "cmk-coupling.png")
    keep(draw_line(), "cmk-voltage-along-line.png")
