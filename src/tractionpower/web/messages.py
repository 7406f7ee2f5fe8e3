"""The messages that the page reads, as JSON: a greeting, frames, statistics, notices and the end.

JSON knows no number that is not finite, and a browser refuses it: such a number is sent as null.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from tractionpower.web.quantities import CHARTS, FIRST_AND_LAST

RAINFLOW_BINS = 24
"""Bins of the ranges of rainflow cycles on the page."""

_NOTHING: Mapping[str, Any] = {"lowest": 0.0, "width": 1.0, "bars": []}

_DECIMALS = 6  # of what is sent: below a pixel, and half the length of all digits


def message(kind: str, content: Mapping[str, Any]) -> str:
    """Return a message as JSON.

    >>> message("notice", {"text": "x", "value": float("nan")})
    '{"kind":"notice","text":"x","value":null}'
    """
    return json.dumps(_plain({"kind": kind, **content}), separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def frame_message(content: Mapping[str, Any]) -> str:
    """Return a frame: what is the case, with pairs of first and last vehicle as numbers of their own."""
    snapshot = dict(content["snapshot"])
    for name in FIRST_AND_LAST:
        if name in snapshot:
            stem, unit = name.rsplit("_", 1)
            first, last = snapshot.pop(name)
            snapshot |= {f"{stem}_first_{unit}": first, f"{stem}_last_{unit}": last}
    return message("frame", {**content, "snapshot": snapshot})


def chart_point(snapshot: Mapping[str, Any], peaks_kn: tuple[float, float]) -> list[Any]:
    """Return what the rolling diagrams need: the time, then their quantities in order.

    `peaks_kn` are least and greatest force of the first coupling in the steps since the point before: a blow lasts shorter than
    the time between two points.
    """
    least, greatest = peaks_kn
    told = {**snapshot, "first_coupling_least_kn": least, "first_coupling_greatest_kn": greatest}
    names = ("time_s", *(name for chart in CHARTS for name in chart))
    return [_plain(told.get(name)) for name in names]


def statistics_message(statistics: Mapping[str, Any]) -> str:
    """Return the statistics of a session.

    `statistics` holds ``drive_speed`` and ``brake_speed`` (frequencies: a row for each level, a column for each bin of
    ``speed_edges_kmh`` and one more at either end), ``force`` and ``acceleration`` (frequencies likewise, over
    ``force_edges_kn`` and ``acceleration_edges_mps2``), and ``rainflow``: rows of range [kN], mean [kN] and number of cycles
    of the first coupling.
    """
    content = {
        "drive_speed": _heat(statistics["drive_speed"], statistics["speed_edges_kmh"]),
        "brake_speed": _heat(statistics["brake_speed"], statistics["speed_edges_kmh"]),
        "force": _histogram(statistics["force"], statistics["force_edges_kn"]),
        "acceleration": _histogram(statistics["acceleration"], statistics["acceleration_edges_mps2"]),
        "rainflow": _rainflow(statistics.get("rainflow", ())),
    }
    return message("statistics", content)


def _heat(frequencies: Any, edges: Any) -> dict[str, Any]:
    """Return a joint distribution over the speeds that have occurred; what lies beyond the bins is added to the outer ones."""
    inner = _inner(np.asarray(frequencies, dtype=np.float64))
    last = int(np.max(np.nonzero(inner.any(axis=0))[0], initial=0))
    return {"lowest": float(edges[0]), "width": float(edges[1] - edges[0]), "rows": np.round(inner[:, : last + 1], 6).tolist()}


def _histogram(frequencies: Any, edges: Any) -> dict[str, Any]:
    """Return a distribution from the first to the last bin that has something."""
    inner = _inner(np.asarray(frequencies, dtype=np.float64))
    filled = np.nonzero(inner)[0]
    if not filled.size:
        return dict(_NOTHING)
    first, last = int(filled[0]), int(filled[-1])
    return {
        "lowest": float(edges[first]),
        "width": float(edges[1] - edges[0]),
        "bars": np.round(inner[first : last + 1], 6).tolist(),
    }


def _inner(frequencies: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    inner = frequencies[..., 1:-1].copy()
    inner[..., 0] += frequencies[..., 0]
    inner[..., -1] += frequencies[..., -1]
    return inner


def _rainflow(cycles: Iterable[Sequence[float]]) -> dict[str, Any]:
    """Return how many cycles there were by range, in equal bins up to the greatest."""
    rows = np.asarray([*cycles], dtype=np.float64).reshape(-1, 3)
    greatest = float(rows[:, 0].max(initial=0.0))
    if greatest <= 0.0:
        return dict(_NOTHING)
    width = greatest / RAINFLOW_BINS
    bars, _ = np.histogram(rows[:, 0], bins=RAINFLOW_BINS, range=(0.0, greatest), weights=rows[:, 2])
    return {"lowest": 0.0, "width": width, "bars": bars.tolist()}


def _plain(value: Any) -> Any:
    """Return a value with finite numbers, rounded, or null; all else as it is."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float):
        return round(value, _DECIMALS) if math.isfinite(value) else None
    return value
