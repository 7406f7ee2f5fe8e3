"""Make the synthetic measurement of lines/two-substations: a finer run of a changed supply, with noise, another clock, a gap.

Run from the root of the repository: ``python docs/make_measurement.py``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tractionpower.cosimulation.simulate import simulate
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.base import format_time

LINE = Path(__file__).parents[1] / "lines" / "two-substations"
CHANGES = (
    "clock.step_s=0.1",
    "supply.substations[*].no_load_voltage_v=3580",
    "supply.contact_lines[0].resistance_ohm_per_km=0.052",
)
EVERY = 5
"""Steps that are averaged to a row: 0.5 s."""

AHEAD_S = 37.3
"""How far the clock of the measurement is ahead [s]."""

GAP_S = (250.0, 262.0)
"""Rows that are lost [s]."""

TRAIN, STATION = "2", "A"
HEAD = (
    "# Synthetic: made by docs/make_measurement.py from a simulation, not measured\n"
    "Recorder 1, train 2 and substation A\n"
    "time;U [kV];I [A];v [km/h];I substation [A]\n"
    "hh:mm:ss;kV;A;km/h;A\n"
)


def main() -> None:
    """Write the file."""
    results = simulate(load_scenario(LINE).changed(CHANGES))
    train, station = results.table("trains"), results.table("substations")
    train = train[train["train"] == TRAIN].sort_values("time_s")
    station = station[station["substation"] == STATION].sort_values("time_s")
    rows = len(train) // EVERY
    draw = np.random.default_rng(1)

    def means(values: np.ndarray, noise: float) -> np.ndarray:
        return values[: rows * EVERY].reshape(rows, EVERY).mean(axis=1) + draw.normal(0.0, noise, rows)

    time_s = train["time_s"].to_numpy()[: rows * EVERY : EVERY]
    voltage = means(train["voltage_v"].to_numpy(float), 4.0) / 1000.0
    current = means(train["current_a"].to_numpy(float), 8.0)
    speed = np.maximum(means(train["speed_kmh"].to_numpy(float), 0.3), 0.0)
    fed = means(station["current_a"].to_numpy(float), 10.0)
    lines = []
    for k in range(rows):
        if not GAP_S[0] <= time_s[k] < GAP_S[1]:
            clock = format_time(round(time_s[k] + AHEAD_S, 1))
            lines.append(f"{clock};{voltage[k]:.4f};{current[k]:.1f};{speed[k]:.1f};{fed[k]:.0f}".replace(".", ","))
    (LINE / "measured.csv").write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
