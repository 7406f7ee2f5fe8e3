"""Extracts of table substations: load curves, sliding means of the most loaded substation, load duration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from tractionpower.reporting.facts.series import interval
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.run.drawn import SHARE, TIME, Array, Drawn, period_in_words

PERIODS_S, MOST_PERIODS = (10, 60, 300, 900, 3600), 150
"""Lengths of the means of load curves [s]; the first with no more rows than this is taken."""

FINE_S, MOST_FINE = (1, 10, 60, 300), 1500
"""Lengths of the means that sliding ones are made of [s]."""

WINDOWS_S = (900, 3600, 7200)
"""Windows of the sliding means [s]; those that the run is shorter than are left out."""

PRINTED = 22
"""Rows of an extract that are printed."""

NOISE_KW = 1e-5
"""Power below this is zero [kW]: the solver leaves microamperes, which at 3 kV are some milliwatts, in devices that block."""

FIELDS = ("time_s", "substation", "power_kw")
POWER = mark("power [kW]")

Series = dict[str, tuple[Array, Array]]
"""Times [s] and powers [kW] of substations by name."""


def add(book: Book, drawn: Drawn) -> None:
    """Add the sheets; none if no substation has rows."""
    facts = book.facts
    frame = facts.table("substations", FIELDS)
    if frame.empty:
        return
    names = [each.id for each in sorted(facts.scenario.supply.substations, key=lambda each: (each.km, each.id))]
    series = {name: pair for name, pair in _series(frame).items() if name in names and pair[0].size}
    series = {name: series[name] for name in names if name in series}
    if not series:
        return
    seconds = max(float(time_s[-1] - time_s[0]) for time_s, _ in series.values())
    drawn.period_s = period_of(seconds)
    drawn.numbers = {name: number for number, name in enumerate(series)}
    heaviest = {name: _heaviest(*pair, drawn.period_s) for name, pair in series.items()}
    drawn.substations = tuple(sorted(series, key=lambda name: -heaviest[name]))
    drawn.spans["power"] = min(power.min() for _, power in series.values()), max(power.max() for _, power in series.values())
    _curves(book, series, drawn)
    _most_loaded(book, series[drawn.substations[0]], drawn)
    page = book.page("Load duration", "Load duration of the substations")
    page.note("Power at the busbars that is reached or exceeded in a share of the time, from the means of the stored steps.")
    share = np.linspace(0.0, 1.0, 101)
    values = [np.quantile(power, 1.0 - share) for _, power in series.values()]
    columns = [Column(SHARE, "0", key="share"), *_power_columns(drawn.numbers)]
    drawn.blocks["duration"] = page.table(columns, zip(share * 100.0, *values, strict=True), frozen=True, printed=PRINTED)


def period_of(seconds: float) -> int:
    """Return the length of the means [s] that suits a run."""
    return next((period for period in PERIODS_S if seconds / period <= MOST_PERIODS), PERIODS_S[-1])


def power_key(number: int) -> str:
    """Return the key of the column of a substation's power, by its number along the line."""
    return f"power {number}"


def mean_key(window_s: int) -> str:
    """Return the key of the column of a sliding mean."""
    return f"mean {window_s}"


def _curves(book: Book, series: Series, drawn: Drawn) -> None:
    period = drawn.period_s
    page = book.page("Extract loads", "Extract of table substations: load curves")
    page.note(
        tr(
            "Extract: means of {period} by the clock, each named by its start; table substations has every step.",
            period=period_in_words(period),
        )
    )
    first = min(int(time_s[0] // period) for time_s, _ in series.values())
    last = max(int(time_s[-1] // period) for time_s, _ in series.values())
    means = [_means(time_s, power, period, first, last) for time_s, power in series.values()]
    start = np.arange(first, last + 1) * float(period)
    drawn.spans["loads"] = float(start[0]), float(start[-1])
    columns = [Column(TIME, "time", key="time"), *_power_columns(drawn.numbers)]
    drawn.blocks["loads"] = page.table(columns, zip(start, *means, strict=True), frozen=True, printed=PRINTED)


def _most_loaded(book: Book, pair: tuple[Array, Array], drawn: Drawn) -> None:
    """Add the power of the most loaded substation with its sliding means, which are formulas on the rows above them."""
    time_s, power = pair
    seconds, stored = float(time_s[-1] - time_s[0]), interval(time_s)
    fits = [period for period in FINE_S if period >= stored and seconds / period <= MOST_FINE]
    period = next(iter(fits), FINE_S[-1])
    first, last = int(time_s[0] // period), int(time_s[-1] // period)
    means = _means(time_s, power, period, first, last)
    if np.isnan(means).any():  # rows are further apart than any of the periods
        return
    name = drawn.substation = drawn.substations[0]
    drawn.windows = tuple(window for window in WINDOWS_S if window // period <= len(means) and window % period == 0)
    page = book.page("Extract substation", "Extract of table substations: the most loaded substation")
    page.note(
        tr(
            "Extract: substation {name}, means of {period} by the clock, each named by its start. A sliding mean is that of the"
            " rows of its window, which ends with its row.",
            name=name,
            period=period_in_words(period),
        )
    )
    start = np.arange(first, last + 1) * float(period)
    drawn.spans["substation"] = float(start[0]), float(start[-1])
    columns = [Column(TIME, "time", key="time"), Column(POWER, "0", key="power")]
    told = [tr("mean of {period} [kW]", period=period_in_words(window)) for window in drawn.windows]
    columns += [Column(heading, "0", key=mean_key(window)) for heading, window in zip(told, drawn.windows, strict=True)]
    contract = next((each.contract_power_kw for each in book.facts.scenario.supply.substations if each.id == name), None)
    if contract is not None:
        columns.append(Column("contract power [kW]", "0", key="contract"))
    top = page.next + 1
    rows = [[at, mean] for at, mean in zip(start.tolist(), means.tolist(), strict=True)]
    for window in drawn.windows:
        count = window // period
        for k, row in enumerate(rows):
            first_k = k - count + 1
            # Window by window: a running sum would drift, and not come to zero after hours with load.
            mean = float(means[first_k : k + 1].mean()) if first_k >= 0 else None
            row.append(None if mean is None else Formula(f"AVERAGE(B{top + first_k}:B{top + k})", mean))
    if contract is not None:
        rows = [[*row, contract] for row in rows]
    drawn.blocks["substation"] = page.table(columns, rows, frozen=True, printed=PRINTED)


def _heaviest(time_s: Array, power: Array, period: int) -> float:
    first, last = int(time_s[0] // period), int(time_s[-1] // period)
    return float(np.nanmax(_means(time_s, power, period, first, last)))


def _power_columns(names: Sequence[str] | dict[str, int]) -> list[Column]:
    return [Column(f"{name} [kW]", "0", key=power_key(number)) for number, name in enumerate(names)]


def _series(frame: pd.DataFrame) -> Series:
    time_s, power = frame["time_s"].to_numpy(float), np.nan_to_num(frame["power_kw"].to_numpy(float))
    names = frame["substation"].astype("category")
    codes = names.cat.codes.to_numpy()
    each = ((str(name), np.flatnonzero(codes == code)) for code, name in enumerate(names.cat.categories))
    return {name: (time_s[rows], power[rows]) for name, rows in each}


def _means(time_s: Array, power: Array, period: int, first: int, last: int) -> Array:
    slot = (time_s // period).astype(int) - first
    count = np.bincount(slot, minlength=last - first + 1)
    total = np.bincount(slot, power, minlength=last - first + 1)
    mean = np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)
    return np.where(np.abs(mean) < NOISE_KW, 0.0, mean)
