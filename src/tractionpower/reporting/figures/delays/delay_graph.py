"""The train graph of delays: every train, late ones in the colour of the cause; finer where most seconds are lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from tractionpower.reporting.facts.places import told
from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.figures.base.labels import shortened
from tractionpower.reporting.figures.delays.delay_layer import DelayedStretch, DelayLabel, DelayLayer
from tractionpower.reporting.figures.delays.delay_styles import main_origin
from tractionpower.reporting.figures.trains.run_graph import (
    FINE_S,
    FINE_STEP_S,
    POINTS,
    places_of,
    planned_times,
    thinned,
    train_lines,
)
from tractionpower.reporting.figures.trains.train_graph import MOST_NAMES, GraphPanel, TrainLine, train_graph
from tractionpower.reporting.texts import tr

Parts = Sequence[tuple[int, TrainLine]]

MOST_NAME_LETTERS = 20
"""Letters of a train's name in a label."""

CARRIED_SHARE = 0.5
"""A stretch carries delay on if knock-on is more than this share of it."""


def delay_graphs(data: RunData) -> dict[str, Figure]:
    """Return the train graph of delays, by name; with many trains also that of two hours. None without a late train."""
    told_of = data.results.run.get("feasibility")
    delays, trains = data.table("delays"), data.table("trains")
    if told_of is None or delays is None or trains is None:
        return {}
    parts = train_lines(data)
    late = delays[delays["delay_s"] > told_of["tolerance_s"]]
    if late.empty or not parts:
        return {}
    begin, end = float(trains["time_s"].min()), max(float(line.time_s[-1]) for _, line in parts)
    graphs = {"delay_graph": _graph(data, parts, delays, (begin, end), tr("train graph, late trains by cause"))}
    if len({line.name for _, line in parts}) > MOST_NAMES and end - begin > FINE_S:
        window = worst_hours(late, begin, end)
        graphs["delay_graph_fine"] = _graph(data, parts, delays, window, tr("the two hours in which trains are latest, by cause"))
    return graphs


def worst_hours(late: pd.DataFrame, begin: float, end: float) -> tuple[float, float]:
    """Return begin and end of the two hours [s] with most seconds of delay at calls."""
    first = np.floor(begin / FINE_STEP_S) * FINE_STEP_S
    bins = max(1, int(np.ceil((end - first + 1e-9) / FINE_STEP_S)))
    seconds, _ = np.histogram(late["actual_s"], bins, (first, first + bins * FINE_STEP_S), weights=late["delay_s"])
    width = min(bins, round(FINE_S / FINE_STEP_S))
    at = first + FINE_STEP_S * float(np.convolve(seconds, np.ones(width), mode="valid").argmax())
    return at, at + FINE_S


def _graph(data: RunData, parts: Parts, delays: pd.DataFrame, window: tuple[float, float], title: str) -> Figure:
    """Draw what runs within a window of time [s], each part of a train's run in the panel of its line."""
    begin, end = window
    inside = [(number, part) for number, line in parts if (part := line.between(begin, end)) is not None]
    rows = {str(name): own for name, own in delays.groupby("train", observed=True, sort=True)}
    many = len({line.name for _, line in inside}) > MOST_NAMES
    panels = []
    for number, tracks in enumerate(data.places.lines):
        own = [line for at, line in inside if at == number]
        if not own:
            continue
        layer = _layer(data, own, rows, named=many)
        planned = [point for point in planned_times(data, tracks) if begin <= point[0] <= end]
        shown = [thinned(line, (end - begin) / POINTS) for line in own]
        panels.append(GraphPanel(told(tracks), shown, planned, places_of(data, tracks), layer))
    return train_graph(panels, f"{data.title}: {title}")


def _layer(data: RunData, lines: Sequence[TrainLine], rows: Mapping[str, pd.DataFrame], *, named: bool) -> DelayLayer:
    """Return the late stretches of the trains of a panel, and labels of how late they are; with many trains with their names."""
    tolerance = float(data.results.run["feasibility"]["tolerance_s"])
    stretches, labels = [], []
    for line in lines:
        own = rows.get(line.name)
        if own is None:
            continue
        stretches += late_stretches(line, own, tolerance)
        label = _label(line, own, tolerance, named=named)
        labels += [label] if label is not None else []
    return DelayLayer(stretches, labels, many=named)


def late_stretches(line: TrainLine, rows: pd.DataFrame, tolerance_s: float) -> list[DelayedStretch]:
    """Return the parts of a train's line at whose end it is later than the tolerance, each from the timed call before.

    Parameters
    ----------
    line
        The line.
    rows
        Rows of table ``delays`` of the train, in the order of its run.
    tolerance_s
        Lateness that is accepted [s].
    """
    reached = rows[np.isfinite(rows["actual_s"].to_numpy(float))]
    times = [float(line.time_s[0]), *reached["actual_s"].tolist()]
    found = []
    for (begin, end), (_, row) in zip(pairwise(times), reached.iterrows(), strict=True):
        cause = main_origin(row) if row["delay_s"] > tolerance_s else ""
        own = _cut(line, begin, end) if cause and end > begin else None
        if own is not None:
            carried = bool(row["knock_on_s"] > CARRIED_SHARE * row["delay_s"])
            found.append(DelayedStretch(own.time_s, own.km, cause, carried))
    return found


def _cut(line: TrainLine, begin_s: float, end_s: float) -> TrainLine | None:
    """Return a line between two times [s], with a point at both where it has one before and behind."""
    inside = (line.time_s > begin_s) & (line.time_s < end_s)
    ends = np.clip(np.array([begin_s, end_s]), line.time_s[0], line.time_s[-1])
    if ends[1] <= ends[0]:
        return None
    known = np.isfinite(line.km)
    at_ends = np.interp(ends, line.time_s[known], line.km[known])
    time_s = np.concatenate((ends[:1], line.time_s[inside], ends[1:]))
    return TrainLine(line.name, time_s, np.concatenate((at_ends[:1], line.km[inside], at_ends[1:])))


def _label(line: TrainLine, rows: pd.DataFrame, tolerance_s: float, *, named: bool) -> DelayLabel | None:
    late = rows[
        (rows["delay_s"] > tolerance_s) & (rows["actual_s"] >= line.time_s[0]) & (rows["actual_s"] <= line.time_s[-1] + 1.0)
    ]
    if late.empty:
        return None
    worst = late.loc[late["delay_s"].idxmax()]
    known = np.isfinite(line.km)
    km = float(np.interp(worst["actual_s"], line.time_s[known], line.km[known]))
    seconds = float(worst["delay_s"])
    text = f"{shortened(line.name, MOST_NAME_LETTERS)} +{seconds:.0f} s" if named else f"+{seconds:.0f} s"
    return DelayLabel(float(worst["actual_s"]), km, text, seconds)
