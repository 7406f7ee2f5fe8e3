"""How long one waits: for the help text, for an import, for the first compilation of all kernels."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from report import goal, table
from timing import Action, Times, take_turns

STUDY = "two-substations"
HELP_GOAL_S, COMPILE_GOAL_S = 0.6, 45.0
LONGEST_S = 600.0
ACTIONS = {
    "`python -m tractionpower --help`": ["-m", "tractionpower", "--help"],
    "`import tractionpower`": ["-c", "import tractionpower"],
    "the interpreter alone": ["-c", "pass"],
}


@dataclass(frozen=True)
class Startup:
    """Times of whole processes; of a small study with an empty and with a filled cache, or why there are none.

    The study's times are pairs: on the clock, of the processor [s].
    """

    processes: dict[str, Times]
    study: tuple[tuple[float, float], ...] = ()
    failure: str = ""


def measure(rounds: int) -> Startup:
    """Time whole processes."""
    processes = take_turns({name: _action(arguments) for name, arguments in ACTIONS.items()}, rounds)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            study = tuple(_run_study(folder, f"out{k}") for k in range(2))
        except subprocess.CalledProcessError as error:
            reason = (error.stderr.strip().splitlines() or ["no message"])[-1].replace(name, "...")
            return Startup(processes, failure=f"the study ended with exit code {error.returncode}: {reason}")
        except subprocess.TimeoutExpired:
            return Startup(processes, failure=f"the study took longer than {LONGEST_S:g} s")
        if len(list((folder / "cache").iterdir())) != 1:
            return Startup(processes, failure="the kernels were changed meanwhile")
    return Startup(processes, study)


def _action(arguments: list[str]) -> Action:
    def action() -> None:
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True, timeout=LONGEST_S)

    return action


def _run_study(folder: Path, out: str) -> tuple[float, float]:
    environment = os.environ | {"TRACTIONPOWER_CACHE_DIR": str(folder / "cache")}
    command = [sys.executable, "-m", "tractionpower", "run", STUDY, "--no-reports", "--out", str(folder / out)]
    start, used = perf_counter(), _processor_s()
    subprocess.run(command, check=True, capture_output=True, text=True, cwd=folder, env=environment, timeout=LONGEST_S)
    return perf_counter() - start, _processor_s() - used


def _processor_s() -> float:
    """Return the processor time of all processes that were started and have ended [s]."""
    times = os.times()
    return times.children_user + times.children_system


def describe(startup: Startup) -> str:
    """Return the times as markdown."""
    rows = []
    for name, times in startup.processes.items():
        verdict = f"{HELP_GOAL_S:g}: {goal(times.median, HELP_GOAL_S)}" if "help" in name else ""
        rows.append([name, f"{times.least:.2f}", f"{times.median:.2f}", "", verdict])
    caches = ("empty cache: all kernels compiled", COMPILE_GOAL_S), ("kernels in the cache", None)
    for (what, limit), (clock, processor) in zip(caches, startup.study, strict=False):
        verdict = f"{limit:g}: {goal(clock, limit)}" if limit is not None else ""
        rows.append([f"study `{STUDY}`, {what}", f"{clock:.1f}", "", f"{processor:.1f}", verdict])
    text = "### Start\n\n" + table(["whole process", "seconds, least", "median", "of the processor", "goal [s]"], rows)
    return text + (f"\n\nThe first compilation is not timed: {startup.failure}." if startup.failure else "")
