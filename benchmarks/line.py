"""The real line that ships: a day from the command line to the last byte, a week, a day with all reports; time and memory."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from report import goal, table
from timing import Times

STUDY = "cmk"
DAY_GOALS_S, REPORTS_GOAL_S, MEMORY_GOAL_MB = (8.0, 4.0), 60.0, 700.0
LONGEST_S = 900.0
DAYS = 7

MEASURED = """
import json, resource, sys, time
from tractionpower.cli import main
code = main(json.loads(sys.argv[1]))
print(json.dumps([code, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))
"""
WEEK = """
import json, resource, sys
import tractionpower as tp
day = tp.load(sys.argv[2])
days, length = int(sys.argv[3]), 86400.0
runs = [
    run.model_copy(update={
        "id": f"{run.id} day {n}",
        "start": run.start and run.start.model_copy(update={"time": run.start.time + n * length}),
        "calls": tuple(
            call.model_copy(update={
                name: time + n * length for name in ("arrival", "departure") if (time := getattr(call, name)) is not None
            })
            for call in run.calls
        ),
    })
    for n in range(days) for run in day.timetable.trains
]
clock = day.clock.model_copy(update={"end": day.clock.start + days * length})
week = day.model_copy(update={"timetable": day.timetable.model_copy(update={"trains": tuple(runs)}), "clock": clock})
results = tp.simulate(week, sys.argv[1])
print(json.dumps([0 if results.run["status"] == "complete" else 3, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))
"""


@dataclass(frozen=True)
class Result:
    """One way of running the line: times of whole processes, greatest memory of one [MB], rows of trains, exit code."""

    what: str
    times: Times
    memory_mb: float
    goal_s: tuple[float, ...]
    code: int


def measure(rounds: int) -> list[Result]:
    """Run everything in processes of its own; kernels are compiled before."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bare = json.dumps(["run", STUDY, "--no-reports", "--out", str(folder / "day")])
        whole = json.dumps(["run", STUDY, "--out", str(folder / "reports")])
        _run(MEASURED, bare)
        day = [_run(MEASURED, bare) for _ in range(rounds)]
        reports = [_run(MEASURED, whole)]
        week = [_run(WEEK, str(folder / "week"), STUDY, str(DAYS))]
    return [
        _result("a day, `--no-reports`", day, DAY_GOALS_S),
        _result("a day with figures and workbook", reports, (REPORTS_GOAL_S,)),
        _result(f"{DAYS} days, tables only", week, ()),
    ]


def _run(script: str, *arguments: str) -> tuple[float, float, int]:
    """Return wall time [s], greatest memory [MB], exit code of a process."""
    start = perf_counter()
    ran = subprocess.run(
        [sys.executable, "-c", script, *arguments], check=True, capture_output=True, text=True, timeout=LONGEST_S,
        env=os.environ | {"PYTHONWARNINGS": "ignore"},
    )  # fmt: skip
    seconds = perf_counter() - start
    code, memory = json.loads(ran.stdout.strip().splitlines()[-1])
    return seconds, memory, code


def _result(what: str, runs: list[tuple[float, float, int]], goals: tuple[float, ...]) -> Result:
    seconds, memory, codes = zip(*runs, strict=True)
    return Result(what, Times(tuple(seconds)), max(memory), goals, max(codes))


def describe(results: list[Result]) -> str:
    """Return the results as markdown."""
    headings = ["the whole process", "seconds, least", "median", "goal [s]", "greatest memory [MB]", "goal [MB]", "exit code"]
    rows = []
    for r in results:
        verdict = ", ".join(f"{s:g}: {goal(r.times.least, s)}" for s in r.goal_s)
        memory = f"{MEMORY_GOAL_MB:g}: {goal(r.memory_mb, MEMORY_GOAL_MB)}" if "no-reports" in r.what else ""
        rows.append([r.what, f"{r.times.least:.1f}", f"{r.times.median:.1f}", verdict, f"{r.memory_mb:.0f}", memory, r.code])
    return (
        f"### The line `{STUDY}` (224 km, 13 substations, 152 trains a day, 86 400 steps of 1 s)\n\n{table(headings, rows)}\n\n"
        "From the start of the process to the last byte of the last file; rows are recorded on a second core where there is one."
    )
