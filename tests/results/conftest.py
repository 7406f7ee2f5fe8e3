"""Rows, writers and finished folders of a tiny made-up run."""

import errno
import itertools
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter
from tractionpower.results.tables import loads_table, make_table, substations_table

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


@pytest.fixture
def hold_open(monkeypatch):
    """Return a function after which a file cannot be replaced, as when Excel has it open on Windows."""
    replace = Path.replace

    def hold(held: Path) -> None:
        def refuse(self, target):
            if Path(target) == held:
                raise PermissionError(errno.EACCES, "held open by another program")
            return replace(self, target)

        monkeypatch.setattr(Path, "replace", refuse)

    return hold


TRICKY = ["=1+1", "+48", "-5", "@x", "#REF!", "plain", 'a "b", c', "<&>", "Łódź \U0001f686", " blanks ", "two\nlines", "L" * 300]
"""Texts that a file format may spoil."""


@pytest.fixture
def make_events():
    """Return a function that makes table ``events`` of texts and values; a missing message in the first row."""

    def make(texts: list[str], values: np.ndarray) -> pa.Table:
        codes = np.arange(len(texts))
        numbers = {name: values for name in ("position_km", "value", "limit")} | {"time_s": codes / 3.0}
        words = {name: (codes, texts) for name in ("kind", "subject", "track")}
        return make_table("events", numbers | words | {"message": (pa.array([None, *codes[1:]], pa.int32()), texts)})

    return make


@pytest.fixture
def results(rows, make_events) -> Results:
    """Return results in memory with three tables: numbers, true and false, missing values, tricky texts, no rows."""
    values = np.linspace(0.1, 1e9, len(TRICKY)) * np.where(np.arange(len(TRICKY)) % 2, -1.0, 1e-12)
    values[3] = np.nan
    voltage = np.array([[3600.1, np.nan], [3700.0, 3333.3]])
    stations = substations_table(
        np.array([0.0, 1.0]), ["A", "Łódź"], np.array([3600.0, np.nan]), np.array([0.1, np.nan]), voltage, voltage * 0.0
    )
    tables = {"events": make_events(TRICKY, values), "substations": stations, "loads": rows(0, 0)}
    return Results({"study": "Łódź", "input_hash": "c0ffee"}, [], tables)
