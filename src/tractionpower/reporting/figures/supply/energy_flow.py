"""Energy flow of a run as a Sankey diagram: from the substations to the wheels, and what braking gives back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Polygon
from numpy.typing import NDArray

from tractionpower.reporting.facts.energy_flow import ON_BOARD, RETURNED, Flow, Stage, energy_stages
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.style import GREEN, INK, ORANGE, PAGE, PALE, PURPLE, SKY, SMALLEST, STYLE, new_figure
from tractionpower.reporting.figures.supply.panels import head, in_lines, legend_below
from tractionpower.reporting.texts import number, tr

Array = NDArray[Any]

KINDS = {"electric": SKY, "mechanical": GREEN, "heat": ORANGE, "drop": "#b3b3b3", "recovered": PURPLE}

WIDEST = 1.35
"""Width of the widest stream [inches]."""

TEXT, STREAM_RIGHT, TIP = 1.72, 3.92, 4.22
"""Where the column of texts at the left ends, the stream stands at its start, and the arrows to the right end [inches]."""

GAP = 0.3
"""Between what goes back up and the stream [inches]."""

BEND, BETWEEN = 0.05, 0.07
"""Inner radius of bends, and space between rows and between streams that go back [inches]."""

LINE = 0.125
"""Height of a line of text [inches]."""

LETTERS = {"left": 30, "right": 34}
"""Letters of a line of text at both sides."""

LEAST_KWH = 1e-6


@dataclass(frozen=True, slots=True)
class Band:
    """A flow as it is drawn, to scale: its way from corner to corner, and its width [inches], downwards."""

    name: str
    kwh: float
    colour: str
    width: float
    corners: tuple[tuple[float, float], ...]
    tip: bool = False


@dataclass(frozen=True, slots=True)
class Words:
    """A text beside a band: its middle, whether it stands left of the stream, and its lines."""

    x: float
    y: float
    left: bool
    lines: tuple[str, ...]
    bold: bool = False


@dataclass(slots=True)
class Layout:
    """Where everything of the diagram stands, in inches from its upper left corner, downwards."""

    scale: float
    bands: list[Band] = field(default_factory=list)
    words: list[Words] = field(default_factory=list)
    parts: list[tuple[float, float, float, float, str]] = field(default_factory=list)
    stripes: list[float] = field(default_factory=list)
    joins: list[tuple[str, float, float, float]] = field(default_factory=list)
    leaders: list[tuple[float, float, float]] = field(default_factory=list)
    height: float = 0.0


def energy_flow(data: RunData) -> Figure | None:
    """Draw where the energy of the run goes: widths are to scale, shares are of all that the substations give."""
    stages = energy_stages(data)
    if not stages:
        return None
    layout = lay_out(stages)
    with mpl.rc_context(STYLE):
        figure = new_figure(PAGE, layout.height + 0.75)
        axes = figure.add_subplot()
        axes.set_axis_off()
        axes.set_xlim(0.0, PAGE)
        axes.set_ylim(layout.height, 0.0)
        _draw(axes, layout)
        head(figure, tr("{study}: energy flow", study=data.title))
        kinds = {
            "electric": tr("electric energy"),
            "mechanical": tr("mechanical work"),
            "heat": tr("heat"),
            "recovered": tr("recovered by braking"),
            "drop": tr("voltage drop without heat, differences"),
        }
        used = {band.colour for band in layout.bands} | {part[4] for part in layout.parts}
        handles = [Patch(color=KINDS[kind], label=words) for kind, words in kinds.items() if KINDS[kind] in used]
        legend_below(figure, handles, [str(handle.get_label()) for handle in handles], 3)
        return figure


def lay_out(stages: Sequence[Stage]) -> Layout:
    """Return where the streams and texts of stages stand: each has rows of its own, so that no text lies on another."""
    streams, arriving, now = [], [], 0.0
    for stage in stages:
        arriving.append(now)
        now += sum(flow.kwh for flow in stage.gains)
        streams.append(now)
        now -= sum(flow.kwh for flow in stage.spends)
    whole = arriving[0] = _first(stages[0]) or max(streams)
    layout = Layout(WIDEST / max(*streams, LEAST_KWH))
    tell = _teller(max(streams), whole)
    left = STREAM_RIGHT - layout.scale * _first(stages[0])
    right, y = STREAM_RIGHT, 0.0
    for number_of, stage in enumerate(stages):
        left, right, y = _stage(layout, stage, (left, right, y, arriving[number_of]), tell, first=number_of == 0)
    if right - left > layout.scale * LEAST_KWH and layout.joins:
        y = _give_back(layout, (left, right, y), tell)
    layout.height = y + 0.1
    return layout


def _first(stage: Stage) -> float:
    """Return what enters the first stage from above [kWh]."""
    return sum(flow.kwh for flow in stage.gains if flow.name not in (RETURNED, ON_BOARD))


def _teller(highest: float, whole: float) -> Any:
    """Return what puts an energy into words, in kWh or MWh, with its share."""
    large = highest >= 10_000.0

    def tell(kwh: float) -> str:
        size, unit = (1000.0, "MWh") if large and kwh >= 100.0 else (1.0, "kWh")
        digits = 1 if size > 1.0 or highest < 1000.0 else 0
        percent = 100.0 * kwh / whole
        share = f"< {number(0.1)}" if percent < 0.05 else number(percent, 1, bare=False)
        return tr("{energy} {unit}, {percent} %", energy=number(kwh / size, digits, bare=False), unit=unit, percent=share)

    return tell


def _stage(
    layout: Layout, stage: Stage, at: tuple[float, float, float, float], tell: Any, *, first: bool
) -> tuple[float, float, float]:
    """Lay out a stage at the left and right edge of the stream and a height; return those after it."""
    left, right, y, stream = at
    colour = KINDS[stage.kind]
    layout.stripes.append(y)
    lines = tuple(in_lines(stage.words, 24))
    top = y
    y += 0.1 + LINE * (len(lines) + 1)
    layout.words.append(Words(0.0, (top + y) / 2, True, (*lines, tell(stream)), bold=True))
    if first:  # what enters from above
        y += 0.04
    layout.parts.append((left, right, top + (0.06 if first else 0.0), y, colour))
    for flow in stage.gains:
        if first and flow.name not in (RETURNED, ON_BOARD):
            continue
        left, y = _gain(layout, flow, (left, right, y), colour, tell)
    for flow in stage.spends:
        right, y = _spend(layout, flow, (left, right, y), colour, tell)
    return left, right, y


def _row(flow: Flow, layout: Layout, side: str, told: str) -> tuple[float, float, tuple[str, ...]]:
    """Return the width of a flow, the height of its row, and its lines of text."""
    width = layout.scale * flow.kwh
    lines = (*in_lines(flow.words, LETTERS[side]), told)
    return width, max(width + BEND, LINE * len(lines)) + BETWEEN, lines


def _gain(layout: Layout, flow: Flow, at: tuple[float, float, float], colour: str, tell: Any) -> tuple[float, float]:
    """Lay out a flow that joins from the left; return the new left edge and the end of its row."""
    left, right, y = at
    width, height, lines = _row(flow, layout, "left", tell(flow.kwh))
    middle = y + BETWEEN / 2 + max((height - BETWEEN) / 2, width / 2)
    bottom = max(y + height, middle + width / 2 + BEND + 0.02)
    layout.words.append(Words(0.0, middle, True, lines))
    into = left - width / 2
    if flow.name in (RETURNED, ON_BOARD):
        layout.joins.append((flow.name, flow.kwh, middle, into))
        layout.bands.append(Band(flow.name, flow.kwh, KINDS[flow.kind], width, ((into, bottom), (into, bottom))))
        layout.leaders.append((TEXT, middle, 0.0))
    else:
        corners = ((left - width - 0.22, middle), (into, middle), (into, bottom))
        layout.bands.append(Band(flow.name, flow.kwh, KINDS[flow.kind], width, corners))
        layout.leaders.append((TEXT, middle, left - width - 0.24))
    layout.parts.append((left, right, y, bottom, colour))
    return left - width, bottom


def _spend(layout: Layout, flow: Flow, at: tuple[float, float, float], colour: str, tell: Any) -> tuple[float, float]:
    """Lay out a flow that leaves to the right; return the new right edge and the end of its row."""
    left, right, y = at
    width, height, lines = _row(flow, layout, "right", tell(flow.kwh))
    middle = y + BETWEEN / 2 + max((height - BETWEEN) / 2, width / 2 + BEND)
    bottom = max(y + height, middle + width / 2 + BETWEEN)
    out = right - width / 2
    layout.bands.append(Band(flow.name, flow.kwh, KINDS[flow.kind], width, ((out, y), (out, middle), (TIP, middle)), tip=True))
    layout.words.append(Words(TIP + 0.24, middle, False, lines))
    layout.parts.append((left, right - width, y, bottom, colour))
    return right - width, bottom


def _give_back(layout: Layout, at: tuple[float, float, float], tell: Any) -> float:
    """Lay out what is recovered: from the end of the stream around its left side up to where it joins; return the end."""
    left, right, y = at
    lines = (tr("recovered by braking"), tell((right - left) / layout.scale))
    # The nearest join is the innermost: no stream crosses another.
    lane = min([band.corners[0][0] - band.width / 2 for band in layout.bands if band.name in (RETURNED, ON_BOARD)])
    lane -= GAP
    down, x = y + BEND, left
    for name, kwh, join, into in reversed(layout.joins):
        width = layout.scale * kwh
        down += width / 2
        start = x + width / 2
        end = next(band.corners[0] for band in layout.bands if band.name == name)
        corners = ((start, y - 0.02), (start, down), (lane - width / 2, down), (lane - width / 2, join), (into, join), end)
        layout.bands = [band for band in layout.bands if band.name != name]
        layout.bands.append(Band(name, kwh, KINDS["recovered"], width, corners))
        down += width / 2 + BETWEEN
        lane, x = lane - width - BETWEEN, x + width
    layout.leaders = [(x0, at_y, lane + 0.0 if x1 == 0.0 else x1) for x0, at_y, x1 in layout.leaders]
    middle = max(y + LINE, (y + down) / 2)
    layout.words.append(Words(right + 0.1, middle, False, lines))
    return max(down, middle + LINE)


def ribbon(corners: Sequence[tuple[float, float]], width: float) -> Array:
    """Return the outline of a band of a width along upright and level lines, with round corners; shape (points, 2)."""
    points = [np.asarray(corner, float) for corner in corners]
    middle, normals = [points[0]], [_normal(points[1] - points[0])]
    radius = width / 2 + BEND
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        into, out = _unit(corner - before), _unit(after - corner)
        centre = corner - radius * into + radius * out
        for angle in np.linspace(0.0, np.pi / 2, 16):
            middle.append(centre + np.sin(angle) * (radius * into) - np.cos(angle) * (radius * out))
            normals.append(_normal(np.cos(angle) * into + np.sin(angle) * out))
    middle.append(points[-1])
    normals.append(_normal(points[-1] - points[-2]))
    line, side = np.array(middle), np.array(normals) * width / 2
    return np.concatenate((line + side, (line - side)[::-1]))


def _unit(way: Array) -> Array:
    length = float(np.hypot(*way))
    return way / length if length > 0.0 else np.array([0.0, 1.0])


def _normal(way: Array) -> Array:
    x, y = _unit(way)
    return np.array([-y, x])


def _draw(axes: Axes, layout: Layout) -> None:
    for y in layout.stripes[1:]:
        axes.plot([0.0, PAGE], [y, y], color=PALE, linewidth=0.8, zorder=0.5)
    for left, right, top, bottom, colour in layout.parts:
        if right - left > 0.0:
            box = [(left, top), (right, top), (right, bottom), (left, bottom)]
            axes.add_patch(Polygon(box, facecolor=colour, edgecolor=colour, linewidth=0.4, zorder=1.0))
    for band in layout.bands:
        style: Mapping[str, Any] = {"facecolor": band.colour, "edgecolor": band.colour, "linewidth": 0.6, "joinstyle": "round"}
        outline = Polygon(ribbon(band.corners, band.width), zorder=2.0, gid=band.name, **style)
        axes.add_patch(outline)
        if band.tip:
            x, y = band.corners[-1]
            half = band.width / 2 + 0.05
            axes.add_patch(Polygon([(x, y - half), (x + 0.16, y), (x, y + half)], zorder=2.0, **style))
        elif len(band.corners) > 3:  # which way what is recovered goes
            x, y = band.corners[2][0], (band.corners[2][1] + band.corners[3][1]) / 2
            half = band.width / 2 + 0.04
            axes.add_patch(Polygon([(x - half, y), (x, y - 0.14), (x + half, y)], zorder=2.1, **style))
    for start, y, end in layout.leaders:
        if end > start:
            axes.plot([start, end], [y, y], color=INK, linewidth=0.5, linestyle=(0, (1, 2)), zorder=0.8)
    for words in layout.words:
        axes.text(
            words.x, words.y, "\n".join(words.lines), ha="left", va="center", fontsize=SMALLEST, color=INK, linespacing=1.1,
            fontweight="bold" if words.bold else "normal", zorder=3.0,
        )  # fmt: skip
