"""Distributions of a run of train dynamics: how much of the time was spent at which level, speed, force, acceleration.

A run counts every step in classes that are the same for all cases. Where few of them are used, or where the units of the case
are others, the recorded rows are counted in classes that suit both; each row stands for the time until the next one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData
from tractionpower.reporting.texts import tr

Array = NDArray[Any]

LEAST_SHARE = 1e-6
"""A bin in which a smaller part of the time was spent is empty."""

WISHED, WISHED_SPEEDS = 20, 10
"""Classes that are wished for: of forces and accelerations, and of speeds."""

LEAST_ROWS = 200
"""Recorded rows from which on they are counted."""

NICE = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Widths of classes, times a power of ten."""

QUANTITIES = {"drive_speed": "speed", "brake_speed": "speed", "coupler_force": "force", "acceleration": "acceleration"}
"""What is classed, by the name of the distribution."""


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint distribution in the unit of the case.

    Attributes
    ----------
    levels
        Levels at which time was spent, rising.
    share
        Shares of the time at a level (rows) and in a class of speed (columns); none: not a number.
    edges
        Edges of the classes of speed.
    of_rows
        Whether recorded rows were counted instead of steps.
    """

    levels: list[int]
    share: Array
    edges: Array
    of_rows: bool


@dataclass(frozen=True, slots=True)
class Histogram:
    """Shares of the time in classes between edges, in the unit of the case.

    Attributes
    ----------
    edges
        Edges of the classes; those that are open are closed by the width of their neighbours.
    share
        Share of each class.
    open_low, open_high
        Whether the first and the last class have no end.
    of_rows
        Whether recorded rows were counted instead of steps.
    """

    edges: Array
    share: Array
    open_low: bool
    open_high: bool
    of_rows: bool


def nice_edges(low: float, high: float, classes: int) -> Array:
    """Return round edges that hold a range in about so many classes.

    >>> nice_edges(-3.1, 9.6, 10).tolist()
    [-4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    """
    wide = max(high - low, 1e-9) / classes
    power = 10.0 ** np.floor(np.log10(wide))
    step = power * next((each for each in NICE if power * each >= wide * (1.0 - 1e-9)), NICE[-1])
    first, last = np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9)
    return np.asarray(step * np.arange(first, max(last, first + 1.0) + 1.0))


def histogram_of(data: ChainData, which: str) -> Histogram | None:
    """Return how often which force or acceleration was, None where that was not recorded."""
    rows = rows_of(data, which)
    used = rows[rows["frequency"] > LEAST_SHARE] if len(rows) else rows
    if used.empty:
        return None
    per = data.units[QUANTITIES[which]].per
    values = None if _suit(used, per, WISHED // 2) else _recorded(data, which)
    if values is None:
        inner = rows.loc[used.index[0] : used.index[-1]]
        ends = np.append(inner["begin"].to_numpy(float), float(inner["end"].iloc[-1])) * per
        is_open = bool(np.isnan(inner["lowest"].iloc[0])), bool(np.isnan(inner["highest"].iloc[-1]))
        return Histogram(ends, inner["frequency"].to_numpy(float), *is_open, of_rows=False)
    edges = nice_edges(float(values.min()) * per, float(values.max()) * per, WISHED)
    share, _ = np.histogram(values * per, edges, weights=_durations(data.times))
    return Histogram(edges, share, open_low=False, open_high=False, of_rows=True)


def joint_of(data: ChainData, which: str) -> Joint | None:
    """Return a joint distribution of levels and speeds, as far as time was spent; None where none was."""
    rows = rows_of(data, which)
    used = rows[rows["frequency"] > LEAST_SHARE] if len(rows) else rows
    if used.empty:
        return None
    per = data.units[QUANTITIES[which]].per
    speed = None if _suit(used, per, WISHED_SPEEDS // 2) else _recorded(data, which)
    if speed is None:
        return _joint_of_steps(rows, used, per)
    level = data.control(which.removesuffix("_speed"))
    at = np.clip(np.searchsorted(data.control("time_s"), data.times + 1e-9, side="right") - 1, 0, len(level) - 1)
    own = level[at].astype(int)
    levels, row = np.unique(own, return_inverse=True)
    edges = nice_edges(float(speed.min()) * per, float(speed.max()) * per, WISHED_SPEEDS)
    classes = np.clip(np.searchsorted(edges, speed * per, side="right") - 1, 0, len(edges) - 2)
    share = np.zeros((len(levels), len(edges) - 1))
    np.add.at(share, (row, classes), _durations(data.times))
    share[share <= LEAST_SHARE] = np.nan
    spent = np.isfinite(share).any(axis=1)  # the last row of all lasts no time
    return Joint([int(each) for each in levels[spent]], share[spent], edges, of_rows=True)


def counted_told(*, of_rows: bool) -> str:
    """Return what a distribution was counted from."""
    return tr("counted from the recorded rows") if of_rows else tr("counted in every step")


def rows_of(data: ChainData, which: str) -> pd.DataFrame:
    """Return the bins of one distribution; `begin` and `end` close those that are open by the width of their neighbours."""
    rows = data.table("distributions")
    if rows.empty:
        return rows
    own = rows[rows["of"].astype(str) == which].reset_index(drop=True)
    own = own.astype({"lowest": float, "highest": float})
    width = float((own["highest"] - own["lowest"]).median()) if len(own) else 0.0
    own["begin"] = own["lowest"].fillna(own["highest"] - width)
    own["end"] = own["highest"].fillna(own["lowest"] + width)
    return own


def _joint_of_steps(rows: pd.DataFrame, used: pd.DataFrame, per: float) -> Joint:
    low, high = float(used["begin"].min()), float(used["end"].max())
    inner = rows[(rows["begin"] >= low - 1e-6) & (rows["end"] <= high + 1e-6)]
    begins, column = np.unique(inner["begin"].to_numpy(float).round(6), return_inverse=True)
    levels = sorted({int(each) for each in used["level"]})
    number_of = {level: k for k, level in enumerate(levels)}
    share = np.full((len(levels), len(begins)), np.nan)
    for level, k, frequency in zip(inner["level"].astype(int), column, inner["frequency"].astype(float), strict=True):
        if frequency > LEAST_SHARE:
            share[number_of[level], k] = frequency
    return Joint(levels, share, np.append(begins, round(high, 6)) * per, of_rows=False)


def _suit(used: pd.DataFrame, per: float, least: int) -> bool:
    """Return whether the classes of the run show a range well: in their own unit, and enough of them."""
    width = float((used["end"] - used["begin"]).median())
    classes = (float(used["end"].max()) - float(used["begin"].min())) / max(width, 1e-9)
    return per == 1.0 and classes >= least - 0.5


def _recorded(data: ChainData, which: str) -> Array | None:
    """Return the recorded values of what is classed, in the unit of the tables; None where there are too few to count."""
    table, column = {"coupler_force": ("couplings", "force_kn"), "acceleration": ("vehicles", "acceleration_mps2")}.get(
        which, ("vehicles", "speed_kmh")
    )
    if not data.has("vehicles", "controls", table) or len(data.times) < LEAST_ROWS:
        return None
    values = (data.of_couplings if table == "couplings" else data.of_vehicles)(column)[:, 0]
    return values if len(values) == len(data.times) and np.isfinite(values).all() else None


def _durations(times: Array) -> Array:
    """Return the share of the time that each row stands for: until the next one."""
    lasting = np.append(np.diff(times), 0.0)
    return np.asarray(lasting / max(float(lasting.sum()), 1e-12))
