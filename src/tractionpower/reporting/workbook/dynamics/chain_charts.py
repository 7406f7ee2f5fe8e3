"""The sheet of charts of train dynamics, drawn from the extracts and the extremes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.page import Block, Page
from tractionpower.reporting.workbook.frame.plots import COLOURS, DASHES, INK, THIN, Line, bars, draw, scatter, second_axis

TIME = mark("time [s]")
FORCE = mark("force [kN]")

LITTLE_KMH = 0.05
"""Below this a train that stops has rolled backwards by rounding alone."""


@dataclass
class Drawn:
    """What there is to draw.

    Attributes
    ----------
    blocks
        Tables by what they hold.
    names
        Names of the vehicles and couplings that have columns there, by their number.
    most_loaded
        Number of the coupling with the greatest force.
    force_unit
        Unit of the classes of force.
    """

    blocks: dict[str, Block] = field(default_factory=dict)
    names: dict[str, dict[int, str]] = field(default_factory=dict)
    most_loaded: int = 0
    force_unit: str = "kN"


def draw_all(page: Page, drawn: Drawn) -> None:
    """Fill the sheet of charts."""
    if "train" in drawn.blocks:
        _speeds(page, drawn)
    if "couplings" in drawn.blocks:
        _forces(page, drawn)
    if "extremes" in drawn.blocks:
        _extremes(page, drawn)
    if "loop" in drawn.blocks:
        _loop(page, drawn)
    if "train" in drawn.blocks:
        _cylinders(page, drawn)
        _efforts(page, drawn)
        _energies(page, drawn)
    if "force" in drawn.blocks:
        _histogram(page, drawn)


def _begin(page: Page, title: str, note: str) -> None:
    """Begin a page with its heading and what there is to say of the chart."""
    if page.sheet._charts:
        page.new_page()
    page.section(title)
    page.note(note)


def _line(block: Block, name: str, y: str, look: tuple[int, str], x: str = "time") -> Line:
    colour, dashes = look
    return Line(name, x, y, block.first, block.last, COLOURS[colour % len(COLOURS)], dashes)


def _from_the_start(chart: Any, block: Block) -> None:
    """Let the axis of time begin and end with the run."""
    last = block.sheet.cell(block.last, block.column("time")).value
    chart.x_axis.scaling.min, chart.x_axis.scaling.max = 0.0, float(last or 1.0)


def _speeds(page: Page, drawn: Drawn) -> None:
    title = tr("Speeds and controls")
    _begin(page, title, "Speeds on the left; levels of drive and brake control on the right.")
    block = drawn.blocks["train"]
    chart = scatter(title, tr(TIME), tr("speed [km/h]"))
    for k, (number, name) in enumerate(drawn.names["vehicles"].items()):
        draw(chart, block, _line(block, name, f"speed{number}", (k, DASHES[k % len(DASHES)])))
    _from_the_start(chart, block)
    levels = scatter("", "", tr("control level"))
    for y, words, colour in (("drive", tr("drive control"), "777777"), ("brake", tr("brake control"), "CC79A7")):
        draw(levels, block, Line(words, "time", y, block.first, block.last, colour, "sysDash", THIN))
    _share_nothing(chart, levels, block, [f"speed{number}" for number in drawn.names["vehicles"]])
    second_axis(chart, levels)
    page.chart(chart)


def _share_nothing(chart: Any, levels: Any, block: Block, speeds: Sequence[str]) -> None:
    """Let nothing stand at one height on both vertical axes: at the bottom, or above it where the train rolled backwards."""
    fastest, slowest = _ends(block, speeds)
    most, _ = _ends(block, ["drive", "brake"])
    high, step = _round_end(max(fastest, 1.0))
    chart.y_axis.scaling.max, chart.y_axis.majorUnit = high, step
    top = 2.0 * -(-most // 2.0) if most > 2.0 else 2.0
    below = 0.0 if slowest > -LITTLE_KMH else -(slowest // step) * step
    chart.y_axis.scaling.min = -below
    levels.y_axis.scaling.max, levels.y_axis.scaling.min = top, -below / high * top


def _ends(block: Block, keys: Sequence[str]) -> tuple[float, float]:
    """Return the greatest and the least number in columns of a block."""
    columns = [block.column(key) for key in keys]
    found = (block.sheet.cell(row, column).value for row in range(block.first, block.last + 1) for column in columns)
    values = [float(value) for value in found if value is not None]
    return max(values, default=0.0), min(values, default=0.0)


def _round_end(value: float) -> tuple[float, float]:
    """Return a round number that is not below a value, and the distance of ticks up to it.

    >>> _round_end(17.9), _round_end(60.0)
    ((18.0, 2.0), (60.0, 10.0))
    """
    power = 10.0 ** math.floor(math.log10(value / 5.0))
    step = power * next(each for each in (1.0, 2.0, 5.0, 10.0) if power * each * 10.0 >= value)
    return step * math.ceil(value / step - 1e-9), step


def _forces(page: Page, drawn: Drawn) -> None:
    title = tr("Forces of couplings over time")
    _begin(page, title, "The first, the most loaded and the last coupling. Tension is positive, compression negative.")
    block = drawn.blocks["couplings"]
    chart = scatter(title, tr(TIME), tr(FORCE))
    for k, (number, name) in enumerate(drawn.names["couplings"].items()):
        draw(chart, block, _line(block, tr("coupling {name}", name=name), f"force{number}", (k, "solid")))
    _from_the_start(chart, block)
    chart.x_axis.tickLblPos = "low"
    page.chart(chart)


def _extremes(page: Page, drawn: Drawn) -> None:
    title = tr("Greatest forces of the couplings")
    _begin(page, title, "Tension and compression as positive numbers, from the front of the train.")
    words = tr("coupling, from the front of the train")
    page.chart(bars(title, tr(FORCE), drawn.blocks["extremes"], "no.", ("tension", "compression"), x_title=words))


def _loop(page: Page, drawn: Drawn) -> None:
    name = drawn.names["couplings"][drawn.most_loaded]
    title = tr("Coupling {name}: force over deflection", name=name)
    _begin(
        page,
        title,
        "The most loaded coupling: its recorded rows one behind the other, but those close to the last.",
    )
    block = drawn.blocks["loop"]
    chart = scatter(title, tr("deflection [mm]"), tr(FORCE), legend=False)
    line = _line(block, name, "force", (0, "solid"), "deflection")
    draw(chart, block, line)
    chart.x_axis.tickLblPos = "low"
    page.chart(chart)


def _cylinders(page: Page, drawn: Drawn) -> None:
    block = drawn.blocks["train"]
    shown = {number: name for number, name in drawn.names["vehicles"].items() if f"cylinder{number}" in block.keys}
    if not shown:
        return
    title = tr("Pressures of brake cylinders")
    _begin(page, title, "The first, the middle and the last vehicle, and the reduction of the brake pipe at the driver's valve.")
    chart = scatter(title, tr(TIME), tr("pressure, gauge [bar]"))
    for k, (number, name) in enumerate(shown.items()):
        draw(chart, block, _line(block, name, f"cylinder{number}", (k, DASHES[k % len(DASHES)])))
    if "reduction_bar" in block.keys:
        draw(
            chart, block, Line(tr("reduction of the brake pipe"), "time", "reduction_bar", block.first, block.last, INK, "sysDot")
        )
    _from_the_start(chart, block)
    chart.y_axis.scaling.min = 0.0
    page.chart(chart)


def _efforts(page: Page, drawn: Drawn) -> None:
    title = tr("Efforts and resistances of the train")
    _begin(page, title, "Sums over the train; brakes, resistance and gradient act against the direction of travel.")
    _lines(page, drawn, title, tr(FORCE), {
        "tractive_force_kn": tr("tractive effort"), "electric_brake_force_kn": tr("electric brakes"),
        "brake_force_kn": tr("air brakes"), "resistance_kn": tr("resistance"), "grade_force_kn": tr("gradient"),
    })  # fmt: skip


def _energies(page: Page, drawn: Drawn) -> None:
    title = tr("Energies over time")
    _begin(page, title, "Works since the start, and the kinetic energy of the train.")
    _lines(page, drawn, title, tr("energy [kWh]"), {
        "traction_kwh": tr("work of the tractive effort"), "resistance_kwh": tr("taken by resistance"),
        "brake_kwh": tr("taken by air brakes"), "coupling_kwh": tr("taken by couplings"), "kinetic_kwh": tr("kinetic energy"),
    })  # fmt: skip


def _lines(page: Page, drawn: Drawn, title: str, words: str, lines: dict[str, str]) -> None:
    """Add a chart of columns of the extract of the train over time."""
    block = drawn.blocks["train"]
    chart = scatter(title, tr(TIME), words)
    for k, (key, name) in enumerate(lines.items()):
        if key in block.keys:
            draw(chart, block, _line(block, name, key, (k, "solid")))
    _from_the_start(chart, block)
    chart.x_axis.tickLblPos = "low"
    page.chart(chart)


def _histogram(page: Page, drawn: Drawn) -> None:
    title = tr("Force of the first coupling: how often")
    _begin(page, title, "Share of the time in classes of force, by their lower end; tension is positive.")
    words = tr("force, lower end of the class [{unit}]", unit=drawn.force_unit)
    page.chart(bars(title, tr("share of the time [%]"), drawn.blocks["force"], "from", ("share",), x_title=words))
