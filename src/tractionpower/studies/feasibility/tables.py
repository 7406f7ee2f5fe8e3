"""The tables ``delays``, ``sections`` and ``lost_time``, and what ``run.json`` and key figures say of the verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from tractionpower.results.columns import TABLES
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.outcome import Writer
from tractionpower.results.tables import make_table
from tractionpower.studies.feasibility.judgement import (
    INFEASIBLE,
    NOT_FINISHED,
    CallDelay,
    LostTime,
    SectionVerdict,
    TrainVerdict,
)

Row = CallDelay | SectionVerdict | LostTime

NOTICED_S = 0.05
"""A train that loses less in an area is not counted there [s]."""


def write_tables(
    writer: Writer, delays: Sequence[CallDelay], sections: Sequence[SectionVerdict], lost: Sequence[LostTime]
) -> None:
    """Give the three tables to a writer; one without rows is left out."""
    rows: dict[str, Sequence[Row]] = {"delays": delays, "sections": sections, "lost_time": lost}
    for table, items in rows.items():
        if items:
            writer.append(table, make_table(table, _columns(table, items)))


def _columns(table: str, rows: Sequence[Row]) -> dict[str, Any]:
    columns: dict[str, Any] = {}
    for column in TABLES[table]:
        values = [getattr(row, column.name) for row in rows]
        if column.kind == "text":
            names = sorted(set(values))
            codes = {name: code for code, name in enumerate(names)}
            columns[column.name] = ([codes[value] for value in values], names)
        else:
            columns[column.name] = values
    return columns


def feasibility_notes(trains: Sequence[TrainVerdict], lost: Sequence[LostTime], overall: dict[str, Any]) -> dict[str, Any]:
    """Return what ``run.json`` says under ``feasibility``; `overall` has the verdict, reserve and tolerance."""
    late = [train for train in trains if train.verdict in (INFEASIBLE, NOT_FINISHED)]
    notes = {
        **{key: _plain(value) for key, value in overall.items()},
        "late_trains": len(late),
        "first": _first(late),
        "trains": [{key: _plain(value) for key, value in asdict(train).items()} for train in trains],
        "lost_by_area": _lost_by_area(lost),
    }
    return notes


def _first(late: Sequence[TrainVerdict]) -> dict[str, Any] | None:
    """Return the train that is latest, of equal ones the first by name; one that does not come counts before those that do."""
    order = sorted(late, key=lambda train: (train.verdict != NOT_FINISHED, -np.nan_to_num(train.late_s), train.train))
    worst = order[0] if order else None
    if worst is None:
        return None
    return {
        "train": worst.train,
        "station": worst.worst_station,
        "late_s": _plain(worst.late_s),
        "cause": worst.cause,
        "area": worst.lost_area,
        "why": worst.why,
    }


def _lost_by_area(lost: Sequence[LostTime]) -> list[dict[str, Any]]:
    """Return seconds lost by area, gains left out, and how many trains lose there noticeably; the worst area first."""
    sums: dict[str, dict[str, float]] = {}
    for row in lost:
        if row.lost_s > 0.0:
            trains = sums.setdefault(row.area, {})
            trains[row.train] = trains.get(row.train, 0.0) + row.lost_s
    rows = [
        {"area": area, "lost_s": math.fsum(trains.values()), "trains": sum(s >= NOTICED_S for s in trains.values())}
        for area, trains in sums.items()
    ]
    return sorted(rows, key=lambda row: (-row["lost_s"], row["area"]))


def key_figures(trains: Sequence[TrainVerdict], lost: Sequence[LostTime], reserve_left_s: float) -> list[dict[str, Any]]:
    """Return the key figures of the verdict as they are written."""
    late = sum(train.verdict in (INFEASIBLE, NOT_FINISHED) for train in trains)
    seconds = math.fsum(row.lost_s for row in lost if row.lost_s > 0.0)
    definition = "of all trains, against themselves at nominal voltage; where they gain left out"
    figures = [
        KeyFigure("late_trains", float(late), definition="trains later than the tolerance at a timed call, or not there"),
        KeyFigure("lost_to_low_voltage_s", seconds, definition=definition),
    ]
    if math.isfinite(reserve_left_s):
        tightest = min(trains, key=lambda train: np.nan_to_num(train.reserve_left_s, nan=np.inf))
        place = f"train {tightest.train}, {tightest.reserve_left_at}"
        definition = "least time by which a train could come earlier than planned, flat out on the recorded voltages"
        figures.append(KeyFigure("least_reserve_left_s", reserve_left_s, place, definition=definition))
    return [figure.as_dict() for figure in figures]


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value
