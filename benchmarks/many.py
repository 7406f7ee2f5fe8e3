"""Many runs: days of the real line with something out, on one worker, on more, on a Dask cluster; what the runner adds."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

import tractionpower as tp
from report import goal, table
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.io.library import shipped_library
from tractionpower.model.change import apply_changes
from tractionpower.model.scenario import Scenario
from tractionpower.results.windows import WINDOWS_S, SlidingWindows
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.outages import outages
from tractionpower.studies.runner.case import Case
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore

LINES = Path(__file__).resolve().parent.parent / "lines"
KINDS = ("unit", "substation", "section_cabin")
ALL_GOAL_S, SCALING_GOAL, OVERHEAD_GOAL_S = 360.0, 1.7, 0.2
PATIENCE_S = 60.0

Row = tuple[str, str, str]


def study() -> tuple[Scenario, tuple[Case, ...]]:
    """Return the day of the real line, its rails one conductor, with its base case and single outages at the normal grid."""
    scenario = tp.load(LINES / "cmk" / "study-common-return.yaml")
    bounds = scenario.contingency.model_copy(update={"kinds": KINDS, "grid_voltages": ("normal",)})
    scenario = scenario.model_copy(update={"contingency": bounds})
    return scenario, outages(scenario)


def timed(scenario: Scenario, cases: tuple[Case, ...], **how: object) -> float:
    """Return the wall time of cases that no store knows [s], the start of workers included."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        run = run_cases(scenario, shipped_library(), cases, measure, CaseStore(Path(folder)), **how)
        seconds = time.perf_counter() - started
    bad = [row for row in run.rows if row["status"] != "complete"]
    if bad or run.run != len(cases):
        raise SystemExit(f"{len(bad)} of {len(cases)} cases did not complete: {bad[:1]}")
    return seconds


@contextmanager
def cluster(workers: int) -> Iterator[str]:
    """Start a Dask scheduler and workers of one thread each on the loopback, and yield its address."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
        processes = [subprocess.Popen([*command, "--no-dashboard", "--scheduler-file", str(file)], stderr=subprocess.DEVNULL)]
        try:
            _wait_for(file)
            command = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--no-dashboard"]
            command += ["--nthreads", "1", "--nworkers", "1", "--local-directory", folder, "--host", "127.0.0.1"]
            processes += [subprocess.Popen(command, stderr=subprocess.DEVNULL) for _ in range(workers)]
            from distributed import Client  # noqa: PLC0415

            with Client(scheduler_file=str(file), timeout=PATIENCE_S) as client:
                client.wait_for_workers(workers, timeout=PATIENCE_S)
                address = client.scheduler.address
            yield address
        finally:
            for process in reversed(processes):
                process.terminate()
                process.wait(PATIENCE_S)


def _wait_for(file: Path) -> None:
    until = time.monotonic() + PATIENCE_S
    while not file.exists():
        if time.monotonic() > until:
            raise SystemExit("the scheduler does not start")
        time.sleep(0.1)


def overhead(scenario: Scenario, case: Case) -> tuple[float, float]:
    """Return the processor times of one case with all that the runner does, and of its steps alone [s]."""
    whole, steps = [], []
    for k in range(3):
        changed = replace(case, changes=(*case.changes, f"seed={k + 2}"))
        with tempfile.TemporaryDirectory() as folder:
            started = time.process_time()
            run_cases(scenario, shipped_library(), [changed], _steps_only, CaseStore(Path(folder)))
            whole.append(time.process_time() - started)
        run = QuietRun(apply_changes(scenario, changed.changes))
        started = time.process_time()
        run.execute()
        steps.append(time.process_time() - started)
    return min(whole), min(steps)


def _steps_only(scenario: Scenario) -> object:
    from tractionpower.studies.runner.case import CaseResult  # noqa: PLC0415

    QuietRun(scenario).execute()
    return CaseResult({})


def windows(rows: int) -> float:
    """Return the time that the sliding windows take for a row of ten series [ns]."""
    values = np.random.default_rng(1).uniform(0.0, 3000.0, (rows, 10))
    time_s = np.arange(rows, dtype=float)
    SlidingWindows(10, 1.0, WINDOWS_S, squares=True).add(time_s[:100], values[:100])
    seconds = []
    for _ in range(3):
        found = SlidingWindows(10, 1.0, WINDOWS_S, squares=True)
        started = time.process_time()
        found.add(time_s, values)
        seconds.append(time.process_time() - started)
    return 1e9 * min(seconds) / rows


def scaling(scenario: Scenario, cases: tuple[Case, ...], most: int) -> list[tuple[str, int, float]]:
    """Return how, on how many workers, and in what time cases are run [s]."""
    found = [("one process", 1, timed(scenario, cases))]
    found += [("local processes", n, timed(scenario, cases, workers=n)) for n in range(2, most + 1)]
    for n in (1, 2):
        with cluster(n) as address:
            found.append(("Dask on the loopback", n, timed(scenario, cases, scheduler=address)))
    return found


def measure_all(quick: bool) -> list[Row]:
    """Measure everything."""
    scenario, cases = study()
    few = cases[:4] if quick else cases[:12]
    timed(scenario, cases[:1])  # kernels are compiled
    rows: list[Row] = []
    known: dict[tuple[str, int], float] = {}
    for how, workers, seconds in scaling(scenario, few, 2):
        known[how, workers] = seconds
        rows.append((f"{len(few)} days on {workers} worker{'s' * (workers > 1)}, {how}", f"{seconds:.1f} s", ""))
    ratio = known["one process", 1] / known["local processes", 2]
    rows.append(("two processes, times one", f"{ratio:.2f}", f"{SCALING_GOAL}: {goal(ratio, SCALING_GOAL, at_least=True)}"))
    whole, steps = overhead(scenario, cases[1])
    rows.append(
        ("what the runner adds to a case", f"{whole - steps:.3f} s", f"{OVERHEAD_GOAL_S}: {goal(whole - steps, OVERHEAD_GOAL_S)}")
    )
    short, long = windows(8640), windows(86_400)
    rows.append(("sliding windows, ten series, a row of a day of 10 s and of 1 s steps", f"{short:.0f} and {long:.0f} ns", ""))
    if not quick:
        seconds = timed(scenario, cases, workers=2)
        rows.append((f"all {len(cases)} single outages of units, substations, cabins, two processes", f"{seconds:.0f} s",
                     f"{ALL_GOAL_S:g}: {goal(seconds, ALL_GOAL_S)}"))  # fmt: skip
    return rows


def describe(rows: list[Row]) -> str:
    """Return the results as markdown."""
    return "### Many runs\n\n" + table(["a day of `cmk`, common return", "measured", "goal"], rows)


def plot(path: Path, most: int) -> None:
    """Draw cases an hour over workers into `path`."""
    from matplotlib.figure import Figure  # noqa: PLC0415

    scenario, cases = study()
    few = cases[:12]
    timed(scenario, cases[:1])
    found = scaling(scenario, few, most)
    for how, workers, seconds in found:
        print(f"{len(few)} days, {how}, {workers}: {seconds:.1f} s")
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    axes = figure.subplots()
    one = 3600.0 * len(few) / found[0][2]
    axes.plot([1, most], [one, one * most], color="0.7", linestyle="--", label="as many times as workers")
    local = [(n, 3600.0 * len(few) / s) for how, n, s in found if "Dask" not in how]
    dask = [(n, 3600.0 * len(few) / s) for how, n, s in found if "Dask" in how]
    axes.plot(*zip(*local, strict=True), marker="o", label="processes of this machine")
    axes.plot(*zip(*dask, strict=True), marker="s", label="Dask, scheduler and workers on this machine")
    axes.set(xlabel="workers (two cores)", ylabel="days of the line an hour", xticks=range(1, most + 1), ylim=(0, None))
    axes.set_title("Outages of lines/cmk, 24 h in steps of 1 s, against workers", loc="left", fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Draw cases against workers.")
    parser.add_argument("path", type=Path)
    parser.add_argument("--most", type=int, default=4)
    given = parser.parse_args()
    plot(given.path, given.most)
