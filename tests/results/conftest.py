"""Rows, writers and finished folders of a tiny made-up run."""

import itertools
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from tractionpower.results.store import RunWriter
from tractionpower.results.tables import loads_table

FIGURES = [
    {"name": "lowest_voltage_v", "value": 3000.0, "place": "km 1"},
    {"name": "energy_kwh", "value": 1.0, "place": "substation A"},
    {"name": "energy_kwh", "value": 2.0, "place": "substation B"},
]


@pytest.fixture
def rows():
    """Return a function that makes rows of table ``loads`` for some steps."""

    def make(first: int, end: int, voltage: float = 3000.0) -> pa.Table:
        time_s = np.arange(first, end, dtype=float)
        voltages = voltage + np.stack([time_s, -time_s], axis=1)
        return loads_table(time_s, ["x", "y"], voltages, np.full_like(voltages, 100.0))

    return make


@pytest.fixture
def folder(tmp_path) -> Path:
    return tmp_path / "reports" / "study"


@pytest.fixture
def write_run(folder, rows):
    """Return a function that writes a run, cut into parts anywhere, and says what ``run.json`` holds."""

    def write(cuts=(0, 10), voltage=3000.0, study="study", **more):
        writer = RunWriter(folder, study, "c0ffee" * 10, **more)
        for first, end in itertools.pairwise(cuts):
            writer.append("loads", rows(first, end, voltage))
        return writer.finish({"format": 1, "status": "complete", "study": study, "steps": cuts[-1]}, FIGURES)

    return write
