"""Draw the figures of the README and of the pages anew: voltages, energy, coupling, delays, ratings, outages, variants, loops of
couplings between vehicles, and pages of a workbook as they are printed, where LibreOffice and Poppler are there to print them.

Not part of `make docs`: these figures change with the data that ship, the reference pages with the declarations.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import tractionpower as tp
from tractionpower.cli import main
from tractionpower.dynamics.couplings import loop
from tractionpower.dynamics.traindyn.stations_run import StationsRun
from tractionpower.io.documents import read_document
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.model.report import Document, Report
from tractionpower.reporting.facts.outages import Outages
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.style import BLUE, GREY, PAGE, STYLE, VERMILION, new_figure, save
from tractionpower.reporting.figures.delays.delay_graph import delay_graphs
from tractionpower.reporting.figures.many.contingency_figures import envelope_voltage
from tractionpower.reporting.figures.many.outage_map import outage_maps
from tractionpower.reporting.figures.many.sweep_figures import sweep_figures
from tractionpower.reporting.figures.stations.path_figures import distance_over_time
from tractionpower.reporting.figures.stations.topology import topology
from tractionpower.reporting.figures.supply.energy_flow import energy_flow
from tractionpower.reporting.figures.supply.ratings_figures import utilisation
from tractionpower.reporting.figures.supply.voltage_figures import voltage_along_line
from tractionpower.reporting.figures.trains.coupling_figure import compare_coupling
from tractionpower.reporting.workbook import write_workbook
from tractionpower.results.store import MemoryWriter

IMAGES = Path(__file__).parent / "images"
COUPLINGS = IMAGES.parents[1] / "rollingstock" / "couplings"

OUTAGE = (
    "name=CMK, rectifiers of Idzikowice out",
    "supply.substations[Idzikowice].state=rectifiers_out",
    "clock.start=07:00:00",
    "clock.end=07:12:00",
)
"""An express gains speed behind Idzikowice, where the next substations are some 20 km away, while trains come towards it."""
TRAIN = "EIP 1406"

SHADES = 160
"""Colours of a file: lines and text need no more, and the page loads faster."""


PAGES = {"Cover": "workbook-cover", "Acceptance": "workbook-acceptance", "Energy": "workbook-energy"}
"""Sheets of the workbook whose first page is shown, and the names of the images."""


def draw_line() -> Iterator[tuple[str, Figure]]:
    """Draw voltages along the Central Trunk Line and the flow of energy over its day, and pages of its workbook."""
    scenario = tp.load("cmk")
    results = tp.simulate(scenario)
    data = RunData(results, scenario)
    for name, draw in (("cmk-voltage-along-line.png", voltage_along_line), ("cmk-energy-flow.png", energy_flow)):
        figure = draw(data)
        assert figure is not None  # the run has a profile and ledgers
        yield name, figure
    print_pages(results, scenario)


def print_pages(results: tp.Results, scenario: tp.Scenario) -> None:
    """Write the first pages of some sheets as images."""
    office, poppler = shutil.which("soffice"), shutil.which("pdftoppm")
    if office is None or poppler is None:
        print("soffice or pdftoppm is missing: the images of workbook pages stay as they are")
        return
    document = Document(project="Supply of the Central Trunk Line", revision="A", made_by="A. Designer", checked_by="B. Checker")
    for sheet, name in PAGES.items():
        with tempfile.TemporaryDirectory() as folder:
            report = Report(company="Example Engineering", document=document, sheets=None if sheet == "Cover" else (sheet,))
            book = write_workbook(results, scenario, Path(folder) / "book.xlsx", report)
            profile = (Path(folder) / "profile").as_uri()
            convert = [
                office,
                "--headless",
                f"-env:UserInstallation={profile}",
                "--convert-to",
                "pdf",
                "--outdir",
                folder,
                str(book),
            ]
            subprocess.run(convert, check=True, capture_output=True)
            page = [poppler, "-r", "90", "-png", "-f", "1", "-l", "1", "-singlefile", str(book.with_suffix(".pdf"))]
            subprocess.run([*page, str(IMAGES / name)], check=True)
            shrink(IMAGES / f"{name}.png")


def draw_coupling() -> Figure:
    """Draw one train with currents that follow the voltage, and with currents at constant voltage."""
    full = tp.change(tp.load("cmk"), OUTAGE)
    constant = tp.change(full, ["coupling=constant_voltage"])
    return compare_coupling(tp.simulate(full), tp.simulate(constant), full, TRAIN)


def draw_curves(train: str) -> None:
    """Draw effort and current of a train over its speed, as the command does."""
    with tempfile.TemporaryDirectory() as folder:
        main(["curves", train, "--out", folder])
        shutil.copy(Path(folder) / f"{train}.png", IMAGES)
    shrink(IMAGES / f"{train}.png")


def keep(figure: Figure, name: str) -> None:
    """Write a figure with few colours."""
    shrink(save(figure, IMAGES / name))


def shrink(path: Path) -> None:
    """Write a picture again with few colours."""
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(SHADES)
    small.save(path, optimize=True)
    print(f"{path}: {path.stat().st_size / 1000.0:.0f} kB")


def draw_delays() -> Figure:
    """Draw the train graph of the study with a weak substation, late trains by cause."""
    scenario = tp.load("two-substations/weak.yaml")
    return delay_graphs(RunData(tp.feasibility(scenario), scenario))["delay_graph"]


def draw_future() -> Iterator[tuple[str, Figure]]:
    """Draw the study that docs/sizing.md sizes: ratings, outages, and what another unit at each end does; some minutes."""
    loaded = load_scenario(IMAGES.parents[1] / "lines" / "cmk" / "study-2040.yaml")
    scenario = loaded.scenario
    utilised = utilisation(RunData(tp.size(scenario), scenario))
    assert utilised is not None  # the study has ratings
    yield "cmk-2040-utilisation.png", utilised
    outages = Outages(tp.contingency(scenario, workers=2), scenario)
    title = "CMK 2040"
    envelope = envelope_voltage(outages, title)
    assert envelope is not None
    yield "cmk-2040-envelope.png", envelope
    maps = dict(outage_maps(outages, title))
    yield "cmk-2040-outages.png", maps["outages_by_km"]
    out = tp.change(scenario, ["name=CMK 2040, Zawiercie bypassed", "supply.substations[Zawiercie].state=bypassed"])
    vary = {
        "supply.substations[Gora Wlodowska].units": [2, 3, 4],
        "supply.contact_lines[5].type": ["2C120-2C", "2C120-2C+Cu225"],
    }
    yield "cmk-2040-variants.png", sweep_figures(tp.sweep(out, vary, library=loaded.library, workers=2), out)["sweep_maps"]


LOOPS = (
    ("arshad-eq8-9", "wedge, Arshad et al., eq. 6 to 9", (0, 130, 95, 112, 60, 105, 50, -50, -130, -95, -112, -50, 0)),
    ("russian-elastic-friction", "preload, release, solid stop", (0, 60, 30, 117, 25, -25, -60, -30, -117, -25, 0)),
    ("uic-screw-coupling", "pulled: screw; pushed: buffers", (0, 80, 40, 90, 15, -15, -110, -60, -200, -15, 0)),
    ("zobory-linear", "spring and damper, Zobory and Bekefi", (0, 60, -60, 0)),
)
"""Couplings that ship, what they show, and the deflections [mm] between which they are moved."""

SPEEDS = ((0.2, BLUE, "-"), (0.01, VERMILION, (0, (4, 2))))
"""Speeds of the loops [m/s]: faster and slower than that at which friction is kinetic."""


def draw_loops() -> Figure:
    """Draw force over deflection of couplings that ship, moved to and fro fast and slowly."""
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, 4.6)
        for (name, told, ends), axes in zip(LOOPS, figure.subplots(2, 2).flat, strict=True):
            coupling = read_document(COUPLINGS / f"{name}.yaml", Coupling)
            path = np.concatenate([np.linspace(low, high, 400)[1:] for low, high in pairwise(ends)])
            for speed, colour, dashes in SPEEDS:
                axes.plot(
                    path, loop(coupling, path, speed), color=colour, linestyle=dashes, linewidth=1.0, label=f"{speed:g} m/s"
                )
            axes.set_title(f"{name}\n{told}", fontsize=8.5)
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            axes.set_xlabel("deflection [mm]; pulled: positive")
            axes.set_ylabel("force [kN]")
        figure.axes[0].legend(loc="upper left")
    return figure


def draw_stations() -> Iterator[tuple[str, Figure]]:
    """Draw trains on the three stations of TrainDyn, and their places over time."""
    case = read_document(IMAGES.parents[1] / "rollingstock" / "dynamics" / "traindyn-three-stations" / "case.yaml", StationsCase)
    writer = MemoryWriter()
    StationsRun(case, writer).execute()
    rows = writer.tables()["point_masses"].to_pandas()
    yield "traindyn-topology.png", topology(case, rows)
    yield "traindyn-distance-time.png", distance_over_time(case, rows)


if __name__ == "__main__":
    for name, drawn in draw_stations():
        keep(drawn, name)
    keep(draw_loops(), "coupling-loops.png")
    for name, drawn in draw_future():
        keep(drawn, name)
    keep(draw_delays(), "weak-delay-graph.png")
    keep(draw_coupling(), "cmk-coupling.png")
    for name, drawn in draw_line():
        keep(drawn, name)
    draw_curves("eu07-7-coaches")
