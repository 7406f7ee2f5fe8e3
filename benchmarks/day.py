"""A whole day of trains and network in steps of 1 s: the cases M and L with trains that stop for no benchmark.

The trains of `timetables/M.csv` and `L.csv` follow each other every 218 s on both tracks, so that 30 and 150 of them are
on the line at a time, as in the cases. Every 20 km a kilometre at 60 km/h lets them brake, feed back and speed up again.
"""

from __future__ import annotations

import csv
import resource
import sys
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

from cases import CASES, Case, shipped_voltages
from report import goal, table
from timing import Times, take_turns
from tractionpower.cosimulation.start import start_state
from tractionpower.cosimulation.tables import CompiledScenario, compile_scenario
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import Buffers, new_buffers
from tractionpower.model.scenario import Scenario

TIMETABLES = Path(__file__).parent / "timetables"
START, END = "06:00", "30:00"
STEPS = 86_400
BLOCK = 600
GOALS_S = {("M", "common_return"): (3.0, 1.0), ("L", "common_return"): (15.0, 5.0), ("M", "rails_per_track"): (8.0,)}
"""Limit and wish of the time of a day [s], by case and circuit."""

Key = tuple[str, str]

VEHICLE = {
    "id": "unit",
    "kind": "multiple_unit",
    "mass_t": 200.0,
    "length_m": 150.0,
    "max_speed_kmh": 160.0,
    "rotating_mass_factor": 1.06,
    "resistance": {"a_n": 2500.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.6},
    "drive": {"kind": "inverter", "starting_effort_kn": 200.0, "power_kw": 3000.0, "efficiency": 0.87, "max_current_a": 1600.0},
    "brake": {"electric_effort_kn": 150.0, "electric_power_kw": 2400.0, "service_rate_mps2": 0.6},
    "auxiliaries": {"power_kw": 140.0},
}


def scenario(case: Case, circuit: str = "common_return") -> Scenario:
    """Return a day of a case."""
    line = case.line().model_dump(mode="json", by_alias=True, exclude_defaults=True)
    end = case.length_km
    slow = [(low, low + 1.0) for low in range(10, int(end), 20)]
    edges = [0.0, *(km for pair in slow for km in pair), end]
    line["speed_limits"] = [
        {"from_km": low, "to_km": high, "kmh": 60.0 if n % 2 else 125.0} for n, (low, high) in enumerate(pairwise(edges))
    ]
    supply = case.supply(circuit).model_copy(update={"loads": ()})
    with (TIMETABLES / f"{case.name}.csv").open(encoding="utf-8", newline="") as file:
        runs = [_run(row) for row in csv.DictReader(file)]
    return Scenario.model_validate(
        {
            "name": f"case {case.name}, a day",
            "line": line,
            "supply": supply.model_dump(mode="json", by_alias=True),
            "clock": {"start": START, "end": END, "step_s": 1.0},
            "timetable": {"trains": runs},
            "trains": [{"id": "unit", "vehicles": [{"id": "unit"}]}],
            "vehicles": [VEHICLE],
            "limits": shipped_voltages(),
        }
    )


def _run(row: dict[str, str]) -> dict[str, object]:
    leg = {"track": row["track"], "from_km": float(row["from_km"]), "to_km": float(row["to_km"])}
    return {
        "id": row["id"],
        "train": "unit",
        "route": [leg],
        "start": {"time": row["time"], "speed_kmh": float(row["speed_kmh"])},
    }


@dataclass(frozen=True)
class Result:
    """A day of one case: times, what the solver said, trains at a time, and the lowest voltage at one of them."""

    case: str
    circuit: str
    times: Times
    iterations: float
    worst_a: float
    flagged: int
    trains: float
    lowest_v: float


@cache
def _compiled(key: Key) -> CompiledScenario:
    return compile_scenario(scenario(CASES[key[0]], key[1]))


def run_day(compiled: CompiledScenario, buffers: Buffers, look=None) -> None:
    """Run a day into `buffers`, which are filled again and again; `look` is called with what each block has filled."""
    state, done = start_state(compiled), 0
    while done < STEPS:
        rows, _ = advance(compiled.block, state, buffers, STEPS)
        done += rows
        if look is not None:
            look(buffers.steps[:rows], buffers.trains[: int(buffers.steps["trains"][:rows].sum())])


def measure(rounds: int) -> list[Result]:
    """Time a day of the cases; they take turns."""
    buffers = {key: new_buffers(_compiled(key).block, BLOCK, BLOCK * 160) for key in GOALS_S}
    said = {key: _look(key, buffers[key]) for key in GOALS_S}
    times = take_turns({str(key): lambda key=key: run_day(_compiled(key), buffers[key]) for key in GOALS_S}, rounds)
    return [Result(*key, times[str(key)], *said[key]) for key in GOALS_S]


def _look(key: Key, buffers: Buffers) -> tuple[float, float, int, float, float]:
    total, worst, flagged, trains, lowest = 0, 0.0, 0, 0, 1e9

    def look(steps, rows) -> None:
        nonlocal total, worst, flagged, trains, lowest
        total += int(steps["iterations"].sum())
        worst = max(worst, float(steps["worst_a"].max()))
        flagged += int((steps["status"] != 0).sum())
        trains += len(rows)
        lowest = min(lowest, float(rows["voltage_v"].min(initial=1e9)))

    run_day(_compiled(key), buffers, look)
    return total / STEPS, worst, flagged, trains / STEPS, lowest


def describe(results: list[Result]) -> str:
    """Return the results as markdown."""
    headings = ["case, circuit", "s a day, least", "median", "µs a step", "trains at a time", "solutions a step",
                "worst residual [A]",
                "flagged steps", "lowest voltage [V]", "goal [s]"]  # fmt: skip
    rows = []
    for r in results:
        verdict = ", ".join(f"{s:g}: {goal(r.times.least, s)}" for s in GOALS_S[r.case, r.circuit])
        times = [f"{r.times.least:.2f}", f"{r.times.median:.2f}", f"{r.times.least / STEPS * 1e6:.1f}"]
        said = [f"{r.trains:.1f}", f"{r.iterations:.2f}", f"{r.worst_a:.1e}", r.flagged, f"{r.lowest_v:.0f}"]
        rows.append([f"{r.case} {r.circuit.replace('_', ' ')}", *times, *said, verdict])
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024 if sys.platform != "win32" else 0
    return (
        f"### A day of trains and network, 86 400 steps of 1 s (one core)\n\n{table(headings, rows)}\n\n"
        f"All columns of all devices and trains go into buffers. Peak memory of the process {peak} MB."
    )
