"""Extracts over time: the train with its controls, and the forces of some couplings; a sensible number of rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.facts.series import peaks_kept
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.dynamics.chain_charts import TIME, Drawn
from tractionpower.reporting.workbook.dynamics.chain_facts import facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.page import Column, Page
from tractionpower.reporting.workbook.run.drawn import chosen

Array = NDArray[Any]

MOST_ROWS = 600
"""Rows of the extract of the train, evenly spread."""

MOST_PEAKS = 450
"""Rows that the peaks of the force of one coupling get."""

MOST_LOOP, LEAST_STEP = 2500, 0.002
"""Rows of the loop of one coupling, and how far apart they are: a part of the ranges of force and deflection."""

PRINTED = 22
"""Rows of an extract that are printed."""

CONTROLS = (
    ("drive", mark("drive control, level"), "0"),
    ("brake", mark("brake control, level"), "0"),
    ("electric_percent", mark("electric brake [%]"), "0.0"),
    ("independent_bar", mark("independent brake [bar]"), "0.00"),
    ("reduction_bar", mark("reduction of the brake pipe [bar]"), "0.00"),
)
SUMS = (
    ("tractive_force_kn", mark("tractive effort [kN]")),
    ("electric_brake_force_kn", mark("electric brakes [kN]")),
    ("brake_force_kn", mark("air brakes [kN]")),
    ("resistance_kn", mark("resistance [kN]")),
    ("grade_force_kn", mark("gradient [kN]")),
)
"""Columns of the vehicles that are summed up over the train, and their headings."""

WORKS = (
    ("traction_kwh", mark("work of traction [kWh]")),
    ("resistance_kwh", mark("taken by resistance [kWh]")),
    ("brake_kwh", mark("taken by air brakes [kWh]")),
    ("coupling_kwh", mark("taken by couplings [kWh]")),
    ("kinetic_kwh", mark("kinetic energy [kWh]")),
)


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheets, as far as the run has tables over time."""
    data = facts_of(book).data
    if data.has("vehicles", "controls"):
        _train(book, data, drawn)
    if data.has("couplings"):
        _couplings(book, data, drawn)


def _train(book: Book, data: ChainData, drawn: Drawn) -> None:
    page = book.page("Course of the train", "Extract: the train over time")
    page.spread()
    count = len(data.times)
    kept = chosen(count, MOST_ROWS)
    page.note(
        tr(
            "Extract: {shown} of {all} recorded rows, evenly spread; tables vehicles and controls have all. Forces are sums"
            " over the train.",
            shown=len(kept),
            all=count,
        )
    )
    columns, values = [Column(TIME, "0.00", key="time")], [data.times[kept]]

    def take(heading: str, style: str, key: str, series: Array) -> None:
        columns.append(Column(heading, style, key=key))
        values.append(series)

    at = np.clip(np.searchsorted(data.control("time_s"), data.times[kept] - 1e-9), 0, len(data.control("time_s")) - 1)
    for name, heading, style in CONTROLS:
        series = data.control(name)
        if name in ("drive", "brake") or series.any():
            take(heading, style, name, series[at])
    speed, pressure = data.of_vehicles("speed_kmh"), data.of_vehicles("cylinder_pressure_bar")
    for number in data.chosen_vehicles():
        take(tr("speed of {vehicle} [km/h]", vehicle=data.vehicles[number]), "0.00", f"speed{number}", speed[kept, number])
    name = data.vehicles[0]
    take(
        tr("acceleration of {vehicle} [m/s²]", vehicle=name),
        "0.000",
        "acceleration",
        data.of_vehicles("acceleration_mps2")[kept, 0],
    )
    if np.nan_to_num(pressure).any():
        for number in data.chosen_vehicles():
            words = tr("cylinder of {vehicle} [bar]", vehicle=data.vehicles[number])
            take(words, "0.00", f"cylinder{number}", pressure[kept, number])
    for column, heading in SUMS:
        series = np.nansum(data.of_vehicles(column), axis=1)
        if series.any():
            take(heading, "0.0", column, series[kept])
    for column, heading in WORKS:
        if column in data.table("controls").columns:
            take(heading, "0.000", column, data.control(column)[at])
    rows = zip(*values, strict=True)
    drawn.blocks["train"] = page.table(columns, rows, frozen=True, printed=PRINTED)
    drawn.names["vehicles"] = {number: data.vehicles[number] for number in data.chosen_vehicles()}


def _couplings(book: Book, data: ChainData, drawn: Drawn) -> None:
    page = book.page("Course of couplings", "Extract: forces of couplings over time")
    force, deflection = data.of_couplings("force_kn"), data.of_couplings("deflection_mm")
    shown = data.chosen_couplings()
    times = _times(data)
    kept = np.unique(np.concatenate([peaks_kept(force[:, number], MOST_PEAKS) for number in shown]))
    page.note(
        tr(
            "Extract: {shown} of {all} recorded rows, with the peaks of these couplings; table couplings has all. Tension is"
            " positive. Most and least are those of all couplings at that time.",
            shown=len(kept),
            all=len(times),
        )
    )
    columns, values = [Column(TIME, "0.00", key="time")], [times[kept]]
    for number in shown:
        columns.append(Column(tr("force of {coupling} [kN]", coupling=data.couplings[number]), "0.0", key=f"force{number}"))
        values.append(force[kept, number])
    for number in shown:
        words = tr("deflection of {coupling} [mm]", coupling=data.couplings[number])
        columns.append(Column(words, "0.00", key=f"deflection{number}"))
        values.append(deflection[kept, number])
    for heading, key, series in (
        (mark("most of all couplings [kN]"), "most", np.nanmax(force, axis=1)),
        (mark("least of all couplings [kN]"), "least", np.nanmin(force, axis=1)),
    ):
        columns.append(Column(heading, "0.0", key=key))
        values.append(series[kept])
    drawn.blocks["couplings"] = page.table(columns, zip(*values, strict=True), frozen=True, printed=PRINTED)
    drawn.names["couplings"] = {number: data.couplings[number] for number in shown}
    drawn.most_loaded = data.most_loaded
    _loop(page, data, times, drawn)


def _loop(page: Page, data: ChainData, times: Array, drawn: Drawn) -> None:
    """Write the loop of the most loaded coupling: rows that only keep its peaks would cut across its slack."""
    number = data.most_loaded
    force, deflection = data.of_couplings("force_kn")[:, number], data.of_couplings("deflection_mm")[:, number]
    if not (np.isfinite(force) & np.isfinite(deflection)).all():
        return
    kept = along_the_path(deflection, force, MOST_LOOP)
    page.section(tr("Coupling {name}: force over deflection, row by row", name=data.couplings[number]))
    columns = (
        Column(TIME, "0.000", key="time"),
        Column("force [kN]", "0.00", key="force"),
        Column("deflection [mm]", "0.000", key="deflection"),
    )
    rows = zip(times[kept], force[kept], deflection[kept], strict=True)
    drawn.blocks["loop"] = page.table(columns, rows)


def along_the_path(x: Array, y: Array, most: int) -> NDArray[np.intp]:
    """Return the numbers of at most some `most` points whose line follows that of all points, corners and all.

    A point is kept where it is farther from the last one kept than a small part of both ranges, with the one before it.

    >>> along_the_path(np.array([0.0, 1e-6, 2e-6, 1.0, 1.0]), np.array([0.0, 0.0, 0.0, 0.0, 5.0]), 10).tolist()
    [0, 2, 3, 4]
    """
    xs, ys = (values / max(float(np.ptp(values)), 1e-12) for values in (x, y))
    near = LEAST_STEP
    while True:
        kept, last = [0], 0
        for k in range(1, len(xs)):
            if abs(xs[k] - xs[last]) > near or abs(ys[k] - ys[last]) > near:
                kept += [k - 1, k] if k - 1 > last else [k]
                last = k
        if len(kept) <= most or near >= 1.0:
            return np.array([*dict.fromkeys([*kept, len(xs) - 1])], np.intp)
        near *= 2.0


def _times(data: ChainData) -> Array:
    """Return the times of the table of couplings."""
    return data.times if data.has("vehicles") else np.unique(data.table("couplings")["time_s"].to_numpy(float))
