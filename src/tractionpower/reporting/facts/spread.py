"""Distributions of a run of train dynamics: how much of the time was spent at which level, speed, force, acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.reporting.facts.chain_data import ChainData

Array = NDArray[Any]

LEAST_SHARE = 1e-6
"""A bin in which a smaller part of the time was spent is empty."""


@dataclass(frozen=True, slots=True)
class Joint:
    """Shares of the time at a level (rows) and in a class of speed (columns) with these edges [km/h]; none: not a number."""

    share: Array
    edges: Array


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


def joint_of(data: ChainData, which: str) -> Joint | None:
    """Return a joint distribution of levels and speeds, as far as time was spent; None where none was."""
    rows = rows_of(data, which)
    used = rows[rows["frequency"] > LEAST_SHARE] if len(rows) else rows
    if used.empty:
        return None
    low, high = float(used["begin"].min()), float(used["end"].max())
    inner = rows[(rows["begin"] >= low - 1e-6) & (rows["end"] <= high + 1e-6)]
    begins, column = np.unique(inner["begin"].to_numpy(float).round(6), return_inverse=True)
    levels = inner["level"].to_numpy(float).astype(int)
    share = np.full((int(used["level"].max()) + 1, len(begins)), np.nan)
    kept = (levels < len(share)) & (inner["frequency"].to_numpy(float) > LEAST_SHARE)
    share[levels[kept], column[kept]] = inner["frequency"].to_numpy(float)[kept]
    return Joint(share, np.append(begins, round(high, 6)))
