"""Runs in memory with known series, and measured files that are made of known functions."""

from pathlib import Path

import numpy as np
import pyarrow as pa

from tractionpower.results.results import Results
from tractionpower.results.tables import substations_table

START = 6 * 3600.0
STEP = 1.0
COUNT = 1200


def current_at(time_s):
    """A current that is nowhere like itself at another time [A]."""
    t = np.asarray(time_s, float) - START
    return 900.0 + 600.0 * np.sin(2 * np.pi * t / 310.0) + 300.0 * np.sin(2 * np.pi * (t / 137.0) ** 1.3 * np.sign(t))


def voltage_at(time_s):
    return 3600.0 - 0.12 * current_at(time_s)


def step_means(function, count=COUNT, step=STEP, start=START):
    """Return means of a function over steps, by a fine midpoint rule."""
    fine = start + step * (np.arange(count * 20) + 0.5) / 20.0
    return function(np.maximum(fine, START)).reshape(count, 20).mean(axis=1)


def make_run(voltage=None, current=None, step=STEP) -> Results:
    """Return a run with the substations A and Łódź."""
    count = COUNT if current is None else len(current)
    current = step_means(current_at, count, step) if current is None else current
    voltage = step_means(voltage_at, count, step) if voltage is None else voltage
    time_s = START + step * np.arange(count)
    both = [np.stack([values, 0.5 * values], axis=1) for values in (voltage, current)]
    nothing = np.full(2, np.nan)
    tables: dict[str, pa.Table] = {"substations": substations_table(time_s, ["A", "Łódź"], np.full(2, 3600.0), nothing, *both)}
    return Results({"study": "known", "name": "Known", "step_s": step, "input_hash": "c0ffee"}, [], tables)


MAP = """format: 1
time: {column: t}
series:
  - {column: U, of: substation A, quantity: voltage_v}
  - {column: I, of: substation A, quantity: current_a}
"""


def write_pair(folder: Path, rows: str, text: str = MAP, name: str = "m.csv") -> tuple[Path, Path]:
    """Write a measured file and its map."""
    (folder / name).write_text(rows, encoding="utf-8")
    (folder / "map.yaml").write_text(text, encoding="utf-8")
    return folder / name, folder / "map.yaml"


def rows_of(shift_s=0.0, every=1.0, noise=0.0, first=30.0, last=1150.0, factor=1.0, sign=".", separator=","):
    """Return a measured file whose clock needs `shift_s` to be added, with instant values."""
    time_s = START + np.arange(first, last, every)
    draw = np.random.default_rng(3)
    lines = [separator.join(("t", "U", "I"))]
    for t, *true in zip(time_s, voltage_at(time_s), current_at(time_s), strict=True):
        noisy = [factor * (value + noise * draw.normal()) for value in true]
        cells = [f"{t - shift_s:.3f}", *(f"{value:.6g}" for value in noisy)]
        lines.append(separator.join(cells).replace(".", sign))
    return "\n".join(lines) + "\n"
