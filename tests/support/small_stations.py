"""Small cases of trains on a line with stations, made in a line, and what comes of them."""

from __future__ import annotations

from typing import Any

import pandas as pd
from point_trains import RUNNING

from tractionpower.dynamics.traindyn.stations_run import StationsRun
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.results.outcome import Outcome
from tractionpower.results.store import MemoryWriter

TRAIN: dict[str, Any] = {
    "locomotive_mass_t": 80.0, "hauled_mass_t": 400.0, "braking_mps2": 0.5, "max_speed_kmh": 120.0, "starting_effort_kn": 270.0,
    "power_kw": 2220.0, "resistance": RUNNING, "rotating_mass_factor": 1.06,
}  # fmt: skip

CASE: dict[str, Any] = {
    "kind": "stations",
    "name": "small",
    "trains": [{"id": "t", "length_m": 200.0, "characteristics": TRAIN}],
    "traffic": {"trains": 2, "headway_s": 200.0, "distribution": "constant", "speed_kmh": 60.0},
    "length_m": 8000.0,
    "speed_kmh": 90.0,
    "stations": [
        {"id": "A", "from_m": 2000.0, "to_m": 2600.0, "tracks": ["1", "2", "3"], "choice": "random", "stops": True,
         "dwell_s": 60.0, "speed_kmh": 40.0},
        {"id": "B", "from_m": 5000.0, "to_m": 5600.0, "tracks": ["1", "2"]},
    ],
    "run": {"duration_s": 3600.0},
}  # fmt: skip


def make_case(**more: Any) -> StationsCase:
    """Return the small case with other values; those of `traffic` and `run` are put over its own."""
    merged = {key: CASE[key] | value if key in ("traffic", "run") else value for key, value in more.items()}
    return StationsCase.model_validate(CASE | merged)


def compute(case: StationsCase, **more: Any) -> tuple[pd.DataFrame, pd.DataFrame, Outcome]:
    """Return rows and events of a case, and the outcome."""
    writer = MemoryWriter()
    outcome = StationsRun(case, writer, "small").execute(**more)
    tables = writer.tables()
    texts = {"train": str, "kind": str, "station_track": str}
    rows = tables["point_masses"].to_pandas().astype(texts | {"state": str})
    return rows, tables["station_events"].to_pandas().astype(texts | {"station": str}), outcome
