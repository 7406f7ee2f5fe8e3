"""Extracts of long series, as sheets that the charts draw from: never more than some thousand rows."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.reporting.facts.places import LinePlaces
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import limit_in_words
from tractionpower.reporting.workbook.frame.page import Block, Column, Page, heading_of

MOST_TRAINS, MOST_POINTS, ALL_POINTS = 40, 300, 6000
"""Trains of the train graph, points of one of them, points of all together."""

PERIODS_S, MOST_PERIODS = (10, 60, 300, 900, 3600), 150
"""Lengths of the means of load curves [s]; the first with no more rows than this is taken."""

TIME, KM, SPEED, VOLTAGE = "time of day", "place [km]", "speed [km/h]", "voltage [V]"
LOWEST, MEAN, HIGHEST = (heading_of(f"{which}_voltage_v") for which in ("lowest", "mean", "highest"))
SHARE = "share of the time [%]"
PANTOGRAPH = "pantograph"

LIMITS = ("u_min2", "u_n", "u_max1")
"""Limits of the voltage that are drawn."""

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Stretch:
    """Consecutive rows of a sheet that belong together: a train on a line, or a track; `line` is the number of the line."""

    name: str
    first: int
    last: int
    rising: bool = True
    where: str = ""
    line: int = 0


@dataclass
class Drawn:
    """What there is to draw: the blocks by kind, their stretches, the tracks of each line, from where to where the axes go."""

    blocks: dict[str, Block] = field(default_factory=dict)
    stretches: dict[str, list[Stretch]] = field(default_factory=dict)
    trains: int = 0
    spans: dict[str, tuple[float, float]] = field(default_factory=dict)
    period_s: int = 0
    substations: tuple[str, ...] = ()
    lines: tuple[tuple[str, ...], ...] = ()


def add(book: Book) -> Drawn:
    """Add the sheets of extracts and return where they stand."""
    drawn = Drawn(lines=book.facts.lines.lines)
    _trains(book, drawn)
    _profile(book, drawn)
    _loads(book, drawn)
    return drawn


def chosen(count: int, most: int) -> Array:
    """Return at most `most` of `count` indices, evenly spread, with the first and the last."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def period_of(seconds: float) -> int:
    """Return the length of the means [s] that suits a run."""
    return next((period for period in PERIODS_S if seconds / period <= MOST_PERIODS), PERIODS_S[-1])


def _trains(book: Book, drawn: Drawn) -> None:
    frame = book.facts.table("trains")
    if frame.empty:
        return
    names = frame["train"].astype("category")
    order = np.argsort(names.cat.codes.to_numpy(), kind="stable")
    ends = np.append(0, np.cumsum(np.bincount(names.cat.codes, minlength=len(names.cat.categories))))
    runs = [order[a:b] for a, b in itertools.pairwise(ends) if b > a]
    times = frame["time_s"].to_numpy(float)
    runs.sort(key=lambda rows: times[rows[0]])
    kept = [runs[k] for k in chosen(len(runs), MOST_TRAINS)]
    most = max(30, min(MOST_POINTS, ALL_POINTS // len(kept)))
    page = book.page("Extract trains", "Extract of table trains: points of the train graph")
    page.note(f"{len(kept)} of {len(runs)} trains, at most {most} points of each; table trains has every step.")
    columns = [Column("train", widest=24), Column(TIME, "time"), Column(KM, "0.000"), Column(SPEED, "0.0"), Column(VOLTAGE, "0")]
    picked = [rows[chosen(len(rows), most)] for rows in kept]
    fields = ["train", "time_s", "position_km", "speed_kmh", "voltage_v"]
    block = page.table(columns, frame[fields].iloc[np.concatenate(picked)].itertuples(index=False), frozen=True)
    drawn.blocks["trains"], drawn.trains = block, len(runs)
    drawn.stretches["trains"] = []
    drawn.spans["trains"] = min(float(times[rows[0]]) for rows in picked), max(float(times[rows[-1]]) for rows in picked)
    number = {track: k for k, tracks in enumerate(drawn.lines) for track in tracks}
    first, km, tracks = block.first, frame["position_km"].to_numpy(float), frame["track"].astype(str).to_numpy()
    for rows in picked:
        name = str(frame["train"].iat[rows[0]])
        line = np.array([number.get(track, -1) for track in tracks[rows]])
        # A train that changes the line is a line in the chart of each.
        cuts = [0, *(np.flatnonzero(np.diff(line)) + 1).tolist(), len(rows)]
        for a, b in itertools.pairwise(cuts):
            rising = bool(km[rows[b - 1]] >= km[rows[a]])
            drawn.stretches["trains"].append(Stretch(name, first + a, first + b - 1, rising, line=int(line[a])))
        first += len(rows)


def _profile(book: Book, drawn: Drawn) -> None:
    frame = book.facts.table("profile")
    if frame.empty:
        return
    frame = frame.copy()
    for name in ("where", "track"):
        frame[name] = frame[name].astype(str)
    frame = frame.sort_values(["where", "track", "km"], kind="stable")
    page = book.page("Voltage profile", "Voltages along the line")
    page.note(
        "A cross-section is a fixed place, of which every step counts; a pantograph is a stretch of the line, of which the trains"
        " in it count. The count is that of the values."
    )
    columns = [
        Column("where"),
        Column("track"),
        Column(KM, "0.000"),
        Column(LOWEST, "0"),
        Column(MEAN, "0"),
        Column(HIGHEST, "0"),
    ]
    fields = ["where", "track", "km", "lowest_voltage_v", "mean_voltage_v", "highest_voltage_v", "count"]
    limits = {limit_heading(name): limit.value for name in LIMITS if (limit := book.facts.limit(name))}
    columns += [Column("count", "0"), *(Column(heading, "0") for heading in limits)]
    rows = ([str(row[0]).replace("_", " "), *row[1:], *limits.values()] for row in frame[fields].itertuples(index=False))
    block = page.table(columns, rows, frozen=True)
    drawn.blocks["profile"] = block
    for number, tracks in enumerate(drawn.lines):
        if frame["track"].isin(tracks).any():
            drawn.spans[km_span(number)] = book.facts.lines.span(frame, tracks)
    voltages = [*limits.values(), float(frame["lowest_voltage_v"].min()), float(frame["mean_voltage_v"].max())]
    drawn.spans["voltage"] = min(voltages), max(voltages)
    drawn.stretches["profile"] = _stretches(frame, block, book.facts.lines)


def km_span(line: int) -> str:
    """Return the name of the span of kilometres of a line."""
    return f"km of line {line}"


def _stretches(frame: pd.DataFrame, block: Block, lines: LinePlaces) -> list[Stretch]:
    keys = list(zip(frame["where"], frame["track"], strict=True))
    starts = [k for k in range(len(keys)) if k == 0 or keys[k] != keys[k - 1]]
    ends = [*starts[1:], len(keys)]
    return [
        Stretch(keys[a][1], block.first + a, block.first + b - 1, where=keys[a][0], line=lines.number_of(keys[a][1]))
        for a, b in zip(starts, ends, strict=True)
    ]


def _loads(book: Book, drawn: Drawn) -> None:
    facts = book.facts
    frame = facts.table("substations")
    if frame.empty:
        return
    names = [s.id for s in sorted(facts.scenario.supply.substations, key=lambda s: (s.km, s.id))]
    series = {name: _series(frame, name) for name in names}
    series = {name: pair for name, pair in series.items() if pair[0].size}
    if not series:
        return
    seconds = max(float(time_s[-1] - time_s[0]) for time_s, _ in series.values())
    period = period_of(seconds)
    drawn.period_s, drawn.substations = period, tuple(series)
    page = book.page("Extract loads", "Extract of table substations: load curves")
    _curves(page, series, drawn)
    drawn.spans["power"] = min(power.min() for _, power in series.values()), max(power.max() for _, power in series.values())
    page = book.page("Load duration", "Load duration of the substations")
    page.note("Power at the busbars that is reached or exceeded in a share of the time, from the means of the stored steps.")
    share = np.linspace(0.0, 1.0, 101)
    values = [np.quantile(power, 1.0 - share) for _, power in series.values()]
    columns = [Column(SHARE, "0"), *_power_columns(series)]
    drawn.blocks["duration"] = page.table(columns, zip(share * 100.0, *values, strict=True), frozen=True)


def _curves(page: Page, series: dict[str, tuple[Array, Array]], drawn: Drawn) -> None:
    period = drawn.period_s
    page.note(f"Means of {period_in_words(period)} by the clock, each named by its start; table substations has every step.")
    first = min(int(time_s[0] // period) for time_s, _ in series.values())
    last = max(int(time_s[-1] // period) for time_s, _ in series.values())
    means = [_means(time_s, power, period, first, last) for time_s, power in series.values()]
    start = np.arange(first, last + 1) * float(period)
    drawn.spans["loads"] = float(start[0]), float(start[-1])
    columns = [Column(TIME, "time"), *_power_columns(series)]
    drawn.blocks["loads"] = page.table(columns, zip(start, *means, strict=True), frozen=True)


def period_in_words(seconds: int) -> str:
    """Return the length of a period as one says it."""
    return f"{seconds} s" if seconds < 60 else f"{seconds // 60} min"


def power_heading(substation: str) -> str:
    """Return the heading of the column of a substation's power."""
    return f"{substation} [kW]"


def limit_heading(name: str) -> str:
    """Return the heading of the column of a limit."""
    return f"{limit_in_words(name)} [V]"


def _power_columns(names: Iterable[str]) -> list[Column]:
    return [Column(power_heading(name), "0") for name in names]


def _series(frame: pd.DataFrame, name: str) -> tuple[Array, Array]:
    rows = (frame["substation"] == name).to_numpy()
    power = frame["power_kw"].to_numpy(float)[rows]
    return frame["time_s"].to_numpy(float)[rows], np.nan_to_num(power)


def _means(time_s: Array, power: Array, period: int, first: int, last: int) -> Array:
    slot = (time_s // period).astype(int) - first
    count = np.bincount(slot, minlength=last - first + 1)
    total = np.bincount(slot, power, minlength=last - first + 1)
    return np.asarray(np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0))
