"""Figures of a sweep: curves over one input, maps over two, bars of differences and clouds over many."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tractionpower.model.scenario import Scenario
from tractionpower.reporting.facts.sweep_data import WORDS, SweepData
from tractionpower.reporting.figures.base.axes import draw_limits
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.base.style import (
    BLUE,
    COLOURS,
    GREY,
    INK,
    PAGE,
    SMALLEST,
    STYLE,
    VERMILION,
    new_figure,
    save_all,
)
from tractionpower.reporting.figures.many.compare_figures import lowest_along_line
from tractionpower.reporting.figures.supply.panels import LETTER_7, head, legend_below, once
from tractionpower.reporting.texts import decimal, number, tr
from tractionpower.results.results import Results
from tractionpower.studies.sweep.cases import number_of
from tractionpower.studies.sweep.differences import HIGHER_IS_BETTER, NOT_JUDGED

MOST_PANELS = 4
"""Figures that are drawn, one in each panel."""

MOST_BARS = 25
"""Cases with bars; with more, those that differ most from the base."""

MOST_LETTERS = 40
"""Letters of a name of a case or an input."""

MOST_IN_LEGEND = 70
"""Letters of a case in a legend."""

MARKS = ("o", "s", "^", "D", "v", "P", "X")
"""What tells lines apart without colour."""

MOST_VALUE = 20
"""Letters of a value below an axis."""

MOST_CELLS = 150
"""Cells of a map beyond which the values are not written into them."""

MOST_KEYS = 5
"""Inputs over which clouds are drawn."""

FEWEST_POINTS = 8
"""Cases from which on a cloud of points says something."""

VOLTAGES = ("lowest_voltage_v",)
"""Figures that limits of the voltage are drawn with."""


MOST_LINES = 7
"""Values of a second input that have lines of their own."""

MOST_PROFILES, MOST_OF_END = 7, 3
"""Cases whose voltages are laid over each other; with more, the base and so many of the lowest and of the highest."""

NAMES = ("sweep_curves", "sweep_maps", "sweep_voltage", "sweep_differences", "sweep_scatter")


def write_sweep_figures(results: Results, scenario: Scenario, folder: Path) -> list[Path]:
    """Write the figures of a sweep as PNG into `folder` and return their paths."""
    return save_all(sweep_figures(results, scenario), folder, NAMES)


def sweep_figures(results: Results, scenario: Scenario) -> dict[str, Figure]:
    """Return the figures of a sweep by name; nothing where no figure differs between cases."""
    data = SweepData(results, scenario)
    if not data.figures(1):
        return {}
    with mpl.rc_context(STYLE):
        drawn = {name: figure for name, figure in _drawn(data) if figure is not None}
    voltage = _voltage(data)
    return drawn if voltage is None else drawn | {"sweep_voltage": voltage}


def _drawn(data: SweepData) -> Iterator[tuple[str, Figure | None]]:
    """Yield names and figures: over one input or two, else differences from the base and clouds."""
    sets, paths = data.changes.notna().sum(axis=1), data.paths
    if len(paths) == 1:
        yield "sweep_curves", _curves(data, paths[0])
        return
    is_grid = len(paths) == 2 and bool((sets == 2).all()) and not data.changes.duplicated().any()
    if is_grid and len(data.changes) == np.prod([len(values) for values in data.keys.values()]):
        along, across = sorted(paths, key=lambda path: (not _is_numeric(data.keys[path]), -len(data.keys[path])))
        yield "sweep_maps", _maps(data)
        if _is_numeric(data.keys[along]) and len(data.keys[across]) <= MOST_LINES:
            yield "sweep_curves", _curves(data, along, across)
    yield "sweep_differences", None if data.base is None else _bars(data)
    if is_grid:
        return
    numeric = [path for path in paths if _is_numeric(data.changes[path].dropna())]
    if numeric and len(data.changes) >= FEWEST_POINTS:
        yield "sweep_scatter", _clouds(data, numeric[:MOST_KEYS])


def _is_numeric(values: Iterable[str]) -> bool:
    return all(number_of(value) is not None for value in values)


def _voltage(data: SweepData) -> Figure | None:
    """Draw the lowest voltages along the line of the cases over each other."""
    if "case_profile" not in data.results.tables:
        return None
    order = data.measured.sort_values("lowest_voltage_v", kind="stable")["case"].tolist()
    base = [] if data.base is None else [str(data.base["case"])]
    others = [case for case in order if case not in base]
    if len(base) + len(others) > MOST_PROFILES:
        others = [*others[:MOST_OF_END], *others[-MOST_OF_END:]]
    profile = data.results.table("case_profile").rename(columns={"case": "folder"}).assign(where="pantograph")
    words = {
        case: tr("base") if case in base else f"{case}: {data.subject(case, short=True)}" for case in [*base, *sorted(others)]
    }
    names = {case: shortened(text, MOST_IN_LEGEND) for case, text in words.items()}
    return lowest_along_line(profile.astype({"track": str, "folder": str}), data.scenario, names, data.title)


def _curves(data: SweepData, path: str, across: str = "") -> Figure:
    """Draw figures over the values of one input, a line for each value of another; the base is a dashed line."""
    values = data.keys[path]
    numbers = [number_of(value) for value in values]
    is_numeric = all(each is not None for each in numbers)
    at = dict(zip(values, numbers if is_numeric else range(len(values)), strict=True))
    shown = data.figures(MOST_PANELS)
    figure = new_figure(PAGE, 1.4 + 1.5 * len(shown))
    panels = list(np.atleast_1d(figure.subplots(len(shown), 1, sharex=True)))
    rows = data.measured.set_index("case").join(data.changes, how="inner")
    rows = rows.assign(_at=[float(at[value] or 0.0) for value in rows[path]]).sort_values("_at", kind="stable")
    lines = [(data.setting(across, value), rows[rows[across] == value]) for value in data.keys[across]] if across else []
    for axes, name in zip(panels, shown, strict=True):
        for row, (words, own) in enumerate(lines or [(tr("variants"), rows)]):
            colour = COLOURS[row % len(COLOURS)] if across else BLUE
            style: Any = {"marker": MARKS[row % len(MARKS)], "markersize": 4.5, "linewidth": 1.5 if is_numeric else 0.0}
            axes.plot(own["_at"], own[name], color=colour, label=words, **style)
        if data.base is not None and pd.notna(data.base[name]):
            colour = INK if across else VERMILION
            axes.axhline(float(data.base[name]), color=colour, linestyle=(0, (5, 3)), linewidth=1.3, label=tr("base"))
        axes.tick_params(labelsize=8)
        axes.set_ylabel(tr(WORDS[name]), fontsize=8)
        if name in VOLTAGES:
            draw_limits(axes, data.scenario)
    _mark_missing(panels, data, path, at)
    if not is_numeric or len(values) <= 12:
        texts = [_value(value) for value in values]
        wide = LETTER_7 * (sum(map(len, texts)) + 2 * len(texts)) > PAGE - 1.0
        turned: Any = {"rotation": 45, "ha": "right", "rotation_mode": "anchor"} if wide else {}
        panels[-1].set_xticks([float(at[value] or 0.0) for value in values], [decimal(text) for text in texts], **turned)
    panels[-1].set_xlabel(shortened(data.names[path], 90), fontsize=8)
    if across:
        both = {"first": shortened(data.names[path], 60), "second": shortened(data.names[across], 60)}
        head(figure, tr("{study}: {first} and {second}", study=data.title, **both))
    else:
        head(figure, f"{data.title}: {shortened(data.names[path], 90)}")
    legend_below(figure, *once(panels))
    return figure


def _value(value: str) -> str:
    """Return a value of an input below an axis."""
    return shortened(value, MOST_VALUE)


def _mark_missing(panels: list[Axes], data: SweepData, path: str, at: dict[str, Any]) -> None:
    """Mark at the bottom where a case has no figures."""
    missing = data.cases[~data.cases["case"].isin(data.measured["case"])].set_index("case").join(data.changes, how="inner")
    if len(missing):
        x = [float(at[value] or 0.0) for value in missing[path]]
        style: Any = {"color": INK, "transform": panels[-1].get_xaxis_transform(), "clip_on": False}
        panels[-1].plot(x, [0.03] * len(x), "x", label=tr("refused or failed"), **style)


def _maps(data: SweepData) -> Figure:
    """Draw a map for each figure over the two inputs that are varied, darker where it is worse."""
    across, down = data.paths
    if len(data.keys[down]) > len(data.keys[across]):
        across, down = down, across
    columns, rows = data.keys[across], data.keys[down]
    shown = data.figures(MOST_PANELS)
    wide = 2 if len(shown) > 1 and len(columns) <= 7 else 1
    high = -(-len(shown) // wide)
    figure = new_figure(PAGE, 1.0 + high * max(2.0, 0.3 * len(rows) + 1.1), between=0.06)
    found = data.changes.join(data.measured.set_index("case"))
    for place, name in enumerate(shown, 1):
        axes = figure.add_subplot(high, wide, place)
        grid = found.pivot_table(index=down, columns=across, values=name, aggfunc="first").reindex(index=rows, columns=columns)
        _draw_map(axes, grid.to_numpy(float), name, figure)
        axes.set_title(tr(WORDS[name]).replace("\n", " "), loc="left", fontsize=SMALLEST)
        crowded = LETTER_7 * (max(map(len, columns)) + 2) * len(columns) > (PAGE - 1.5) / wide - 1.0
        turned: Any = {"rotation": 45, "ha": "right", "rotation_mode": "anchor"} if crowded else {}
        axes.set_xticks(range(len(columns)), [decimal(_value(text)) for text in columns], fontsize=SMALLEST, **turned)
        axes.set_yticks(range(len(rows)), [decimal(_value(text)) for text in rows], fontsize=SMALLEST)
        axes.set_xlabel(shortened(data.names[across], MOST_LETTERS), fontsize=SMALLEST)
        axes.set_ylabel(shortened(data.names[down], MOST_LETTERS), fontsize=SMALLEST)
    both = {"first": shortened(data.names[across], 60), "second": shortened(data.names[down], 60)}
    head(figure, tr("{study}: {first} and {second}", study=data.title, **both))
    return figure


def _draw_map(axes: Axes, values: np.ndarray, name: str, figure: Figure) -> None:
    """Draw one map; a cell without a value is hatched."""
    axes.grid(visible=False)
    axes.set_facecolor("#eeeeee")
    colours = mpl.colormaps["Blues" if name in NOT_JUDGED else "YlOrRd_r" if name in HIGHER_IS_BETTER else "YlOrRd"]
    image = axes.imshow(values, aspect="auto", cmap=colours)
    figure.colorbar(image, ax=axes, pad=0.02).ax.tick_params(labelsize=SMALLEST)
    for row, column in np.argwhere(np.isnan(values)):
        axes.text(column, row, tr("none"), ha="center", va="center", fontsize=SMALLEST, color=GREY)
    if values.size > MOST_CELLS:
        return
    digits = _digits(values)
    for row, column in np.argwhere(~np.isnan(values)):
        red, green, blue, _ = image.cmap(image.norm(values[row, column]))
        ink = INK if 0.3 * red + 0.6 * green + 0.1 * blue > 0.5 else "white"
        axes.text(
            column, row, number(values[row, column], digits, bare=False), ha="center", va="center", fontsize=SMALLEST, color=ink
        )


def _digits(values: np.ndarray) -> int:
    """Return how many decimals tell the values of a map apart."""
    spread = float(np.nanmax(values) - np.nanmin(values)) if np.isfinite(values).any() else 0.0
    return 0 if spread >= 20.0 else 1 if spread >= 2.0 else 2


def _bars(data: SweepData) -> Figure:
    """Draw differences from the base, a bar for each case: those that differ most, the worst above."""
    shown = data.figures(MOST_PANELS)
    rows = data.results.table("differences").astype({"case": str, "figure": str})
    wide = rows[rows["figure"].isin(shown)].pivot_table(index="case", columns="figure", values="difference", aggfunc="first")
    spans = wide.abs().max().replace(0.0, np.nan)
    kept = (wide.abs() / spans).max(axis=1).sort_values(ascending=False, kind="stable").index[:MOST_BARS]
    first = shown[0]
    order = wide.loc[kept].sort_values(first, ascending=first not in HIGHER_IS_BETTER, kind="stable")
    labels, told = _labels(data, list(order.index))
    figure = new_figure(PAGE, 1.5 + 0.19 * len(order))
    panels = list(np.atleast_1d(figure.subplots(1, len(shown), sharey=True)))
    for axes, name in zip(panels, shown, strict=True):
        sign = -1.0 if name in HIGHER_IS_BETTER else 1.0
        worse = sign * order[name].fillna(0.0) > 0.0
        neutral = name in NOT_JUDGED
        colours = [GREY if neutral else VERMILION if bad else BLUE for bad in worse]
        axes.barh(range(len(order)), order[name].fillna(0.0), color=colours, height=0.7)
        axes.axvline(0.0, color=INK, linewidth=0.8)
        axes.set_xlabel(tr("{figure}\nless that of the base", figure=tr(WORDS[name])), fontsize=SMALLEST)
        axes.tick_params(axis="x", labelsize=SMALLEST)
        axes.xaxis.set_major_locator(mpl.ticker.MaxNLocator(3))
        axes.grid(visible=False, axis="y")
        axes.set_axisbelow(True)
    panels[0].set_yticks(range(len(order)), labels, fontsize=SMALLEST)
    left = len(wide) - len(order)
    more = tr("; {count} cases that differ less are not drawn", count=left) if left else ""
    title = tr("{study}: differences from the base (red: worse, blue: better)", study=data.title) + more
    head(figure, f"{title}; {told}" if told != tr("case") else title)
    return figure


def _labels(data: SweepData, cases: list[str]) -> tuple[list[str], str]:
    """Return labels of cases and what is said of all of them: their values alone where all set the same inputs."""
    changes = data.changes.loc[cases]
    if changes.notna().all(axis=None):
        texts = [", ".join(decimal(_short(str(value))) for value in changes.loc[case]) for case in cases]
        told = tr("case: {inputs}", inputs=", ".join(data.short_names))
    else:
        texts, told = [data.subject(case, short=True) for case in cases], tr("case")
    labels = [f"{case}: {text}" for case, text in zip(cases, texts, strict=True)]
    return [shortened(text, MOST_LETTERS) for text in labels], told


def _short(value: str) -> str:
    found = number_of(value)
    return value if found is None else f"{found:.4g}"


def _clouds(data: SweepData, paths: list[str]) -> Figure:
    """Draw each figure over each input, a point for each case."""
    shown = data.figures(MOST_PANELS)
    figure = new_figure(PAGE, 1.0 + 1.5 * len(shown))
    grid = figure.subplots(len(shown), len(paths), sharey="row", sharex="col", squeeze=False)
    rows = data.changes.join(data.measured.set_index("case"), how="inner")
    for line, name in zip(grid, shown, strict=True):
        for axes, path in zip(line, paths, strict=True):
            own = rows.dropna(subset=[path, name])
            x = [number_of(value) for value in own[path]]
            axes.plot(x, own[name], "o", color=BLUE, markersize=3.5, alpha=0.7, markeredgewidth=0.0)
            if data.base is not None and pd.notna(data.base[name]):
                axes.axhline(float(data.base[name]), color=VERMILION, linestyle=(0, (5, 3)), linewidth=1.2)
        line[0].set_ylabel(tr(WORDS[name]), fontsize=8)
    for axes, path in zip(grid[-1], paths, strict=True):
        axes.set_xlabel(shortened(data.names[path], int(PAGE / len(paths) / LETTER_7)), fontsize=SMALLEST)
        axes.xaxis.set_major_locator(mpl.ticker.MaxNLocator(4))
    for axes in grid.ravel():
        axes.tick_params(labelsize=SMALLEST)
    head(figure, tr("{study}: figures of {count} cases over what is varied (dashed: base)", study=data.title, count=len(rows)))
    return figure
