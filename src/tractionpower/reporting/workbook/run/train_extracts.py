"""Extracts of table trains: train graph, the train with the lowest voltage, how often which voltage was at pantographs."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from tractionpower.reporting.facts.series import peaks_kept
from tractionpower.reporting.figures.base.labels import fitting
from tractionpower.reporting.texts import number, tr
from tractionpower.reporting.workbook.common.verdicts import same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import limit_in_words
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column
from tractionpower.reporting.workbook.run.drawn import KM, SHARE, SPEED, TIME, VOLTAGE, Array, Drawn, Stretch, chosen

MOST_TRAINS, MOST_POINTS, ALL_POINTS = 40, 300, 6000
"""Trains of the train graph, points of one of them, points of all together."""

FIELDS = ("train", "track", "time_s", "position_km", "speed_kmh", "voltage_v")
"""Columns of table trains that the extracts need; all of them take half a gigabyte for a day."""

CLASSES_V, MOST_CLASSES = (10.0, 20.0, 50.0, 100.0, 200.0), 40
"""Widths of the classes of voltage to choose from [V], and how many classes there may be."""

DEAD_V = 1.0
"""A line with no more than this is dead [V]: its voltage is neither low nor high."""

MOST_STATIONS = 28
"""Names beside a train graph that do not touch each other."""

PRINTED = 22
"""Rows of an extract that are printed."""

BANDS = (("u_min2", "low"), ("u_max1", "high"))
"""Limits that classes of voltage are held against, and the key of the column of those beyond."""


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheets; none if no train ran."""
    frame = book.facts.table("trains", FIELDS)
    if frame.empty:
        return
    names = frame["train"].astype("category")
    order = np.argsort(names.cat.codes.to_numpy(), kind="stable")
    ends = np.append(0, np.cumsum(np.bincount(names.cat.codes, minlength=len(names.cat.categories))))
    times = frame["time_s"].to_numpy(float)
    runs = sorted((order[a:b] for a, b in itertools.pairwise(ends) if b > a), key=lambda rows: times[rows[0]])
    drawn.trains = len(runs)
    _graph(book, drawn, frame, runs)
    _worst(book, drawn, frame, runs)
    _histogram(book, drawn, frame)


def _graph(book: Book, drawn: Drawn, frame: pd.DataFrame, runs: Sequence[Array]) -> None:
    kept = [runs[k] for k in chosen(len(runs), MOST_TRAINS)]
    most = max(30, min(MOST_POINTS, ALL_POINTS // len(kept)))
    page = book.page("Extract trains", "Extract of table trains: points of the train graph")
    page.note(
        tr(
            "Extract: {shown} of {all} trains, at most {points} points of each, evenly spread; table trains has every step.",
            shown=len(kept),
            all=len(runs),
            points=most,
        )
    )
    columns = [
        Column("train", widest=24),
        Column(TIME, "time", key="time"),
        Column(KM, "0.000", key="km"),
        Column(SPEED, "0.0", key="speed"),
        Column(VOLTAGE, "0", key="voltage"),
    ]
    picked = [rows[chosen(len(rows), most)] for rows in kept]
    points = frame.iloc[np.concatenate(picked)]
    rows = points[["train", "time_s", "position_km", "speed_kmh", "voltage_v"]].itertuples(index=False)
    block = page.table(columns, rows, frozen=True, printed=PRINTED)
    drawn.blocks["trains"], drawn.stretches["trains"] = block, []
    times = frame["time_s"].to_numpy(float)
    begin, end = min(float(times[rows[0]]) for rows in picked), max(float(times[rows[-1]]) for rows in picked)
    drawn.spans["trains"] = begin, end
    number_of = {track: k for k, tracks in enumerate(drawn.lines) for track in tracks}
    first, km = block.first, frame["position_km"].to_numpy(float)
    for rows in picked:
        name = str(frame["train"].iat[rows[0]])
        line = np.array([number_of.get(str(track), -1) for track in frame["track"].iloc[rows]])
        # A train that changes the line is a line in the chart of each.
        cuts = [0, *(np.flatnonzero(np.diff(line)) + 1).tolist(), len(rows)]
        for a, b in itertools.pairwise(cuts):
            rising = bool(km[rows[b - 1]] >= km[rows[a]])
            drawn.stretches["trains"].append(Stretch(name, first + a, first + b - 1, rising, line=int(line[a])))
        first += len(rows)
    _spans_of_lines(drawn, block)
    page.section("Stations, as the train graph shows them")
    columns = [Column("station", widest=24), Column(TIME, "time", key="time"), Column(KM, "0.000", key="km")]
    stations = list(_stations(book, drawn))
    ends = [row for name, place, _ in stations for row in ((name, begin, place), (name, end, place))]
    drawn.blocks["stations"] = block = page.table(columns, ends)
    drawn.stretches["stations"] = [
        Stretch(name, block.first + 2 * k, block.first + 2 * k + 1, line=line) for k, (name, _, line) in enumerate(stations)
    ]


def _spans_of_lines(drawn: Drawn, block: Block) -> None:
    """Note from where to where trains run on each line [km]."""
    column = block.column("km")
    for stretch in drawn.stretches["trains"]:
        km = [block.sheet.cell(row, column).value for row in (stretch.first, stretch.last)]
        low, high = drawn.spans.get(f"graph {stretch.line}", (min(km), max(km)))
        drawn.spans[f"graph {stretch.line}"] = min(low, *km), max(high, *km)


def _stations(book: Book, drawn: Drawn) -> Iterator[tuple[str, float, int]]:
    """Yield name, kilometre and line of the stations that have room beside the train graph of their line."""
    for line, tracks in enumerate(drawn.lines):
        stations = book.facts.lines.stations(tracks)
        places = [km for km, _ in stations]
        gap = (max(places, default=0.0) - min(places, default=0.0)) / MOST_STATIONS
        for k in fitting(places, [False] * len(places), gap):
            yield stations[k][1], places[k], line


def _worst(book: Book, drawn: Drawn, frame: pd.DataFrame, runs: Sequence[Array]) -> None:
    """Add the points of the train with the lowest voltage; of each spell its lowest stays."""
    volts = frame["voltage_v"].to_numpy(float)
    lowest = [np.min(volts[rows], where=volts[rows] > DEAD_V, initial=np.inf) for rows in runs]
    worst = int(np.argmin(lowest))
    if not np.isfinite(lowest[worst]):
        return
    rows = runs[worst]
    rows = rows[peaks_kept(volts[rows], 2 * MOST_POINTS)]
    name = drawn.train = str(frame["train"].iat[rows[0]])
    page = book.page("Extract worst train", "Extract of table trains: the train with the lowest voltage")
    page.note(tr("Extract: train {train}, with each of its lowest voltages; table trains has every step.", train=name))
    columns = [
        Column(TIME, "time", key="time"),
        Column("track"),
        Column(KM, "0.000"),
        Column(SPEED, "0.0", key="speed"),
        Column(VOLTAGE, "0", key="voltage"),
    ]
    points = frame.iloc[rows][["time_s", "track", "position_km", "speed_kmh", "voltage_v"]].itertuples(index=False)
    drawn.blocks["worst"] = page.table(columns, points, frozen=True, printed=PRINTED)
    times = frame["time_s"].to_numpy(float)[rows]
    drawn.spans["worst"] = float(times[0]), float(times[-1])
    page.section("Limit, as the chart shows it")
    limit = book.facts.limit("u_min2")
    if limit:
        value = Formula(same_as("{limit_u_min2}"), limit.value)
        columns = [Column(TIME, "time", key="time"), Column(f"{limit_in_words('u_min2')} [V]", "0", key="limit")]
        drawn.blocks["worst limit"] = page.table(columns, [(at, value) for at in drawn.spans["worst"]])
    shown = [lowest[worst], float(np.nanmax(volts[rows])), *([limit.value] if limit else [])]
    drawn.spans["worst voltage"] = float(min(shown)), float(max(shown))


def _histogram(book: Book, drawn: Drawn, frame: pd.DataFrame) -> None:
    """Add the share of the time of all trains in classes of voltage, as formulas on the time in each."""
    clock = book.facts.scenario.clock
    volts = frame["voltage_v"].to_numpy(float)
    counted = (frame["time_s"].to_numpy(float) >= clock.counts_from_s) & (volts > DEAD_V)
    volts = volts[counted]
    if not volts.size:
        return
    step_h = max(clock.step_s, book.facts.scenario.output.every_s or 0.0) / 3600.0
    width = next((width for width in CLASSES_V if np.ptp(volts) / width <= MOST_CLASSES - 2), CLASSES_V[-1])
    slot = np.floor(volts / width).astype(int)
    first = int(slot.min())
    hours = np.bincount(slot - first) * step_h
    page = book.page("Voltage histogram", "Voltages at the pantographs: share of the time of all trains")
    page.note(
        "Time in which trains had a voltage of the class at the pantograph, from the stored rows; time of warm-up and without"
        " voltage is left out. A class belongs to those beyond a limit if it is so as a whole."
    )
    limits = {name: limit.value for name, _ in BANDS if (limit := book.facts.limit(name))}
    columns = [Column("class [V]", key="class"), Column("from [V]", "0", key="from"), Column("below [V]", "0", key="to")]
    columns += [Column("time of all trains [h]", "0.000", key="hours"), Column(SHARE, "0.00", key="share")]
    columns += [Column(_band(low="u_min2"), "0.00", key="low"), Column(_band("u_min2", "u_max1"), "0.00", key="within")]
    columns += [Column(_band(high="u_max1"), "0.00", key="high")]
    rows = [_class(width * (first + k), width, float(time), float(hours.sum()), limits) for k, time in enumerate(hours)]
    drawn.blocks["histogram"] = block = page.table(columns, rows, frozen=True)
    book.define("histogram_hours", page, block.cells("hours"))


def _band(within: str = "", to: str = "", *, low: str = "", high: str = "") -> str:
    if low:
        return tr("share below {limit} [%]", limit=limit_in_words(low))
    if high:
        return tr("share above {limit} [%]", limit=limit_in_words(high))
    return tr("share from {low} to {high} [%]", low=limit_in_words(within), high=limit_in_words(to))


def _class(begin: float, width: float, hours: float, total: float, limits: dict[str, float]) -> list[object]:
    """Return a row: a class of voltage, its time, its share, and the same in the column of where it lies."""
    end, share = begin + width, 100.0 * hours / total
    below, above = end <= limits.get("u_min2", -np.inf), begin >= limits.get("u_max1", np.inf)
    row: list[object] = [
        f"{number(begin, 0)}–{number(end, 0)}",
        begin,
        end,
        hours,
        Formula("100*{hours}/SUM({histogram_hours})", share),
    ]
    row.append(_if("ISNUMBER({limit_u_min2}),{to}<={limit_u_min2}", below, share) if "u_min2" in limits else 0.0)
    inside = 0.0 if below or above else share
    row.append(Formula("{share}-{low}-{high}", inside))
    row.append(_if("ISNUMBER({limit_u_max1}),{from}>={limit_u_max1}", above, share) if "u_max1" in limits else 0.0)
    return row


def _if(condition: str, holds: bool, share: float) -> Formula:
    return Formula(f"IF(AND({condition}),{{share}},0)", share if holds else 0.0)
