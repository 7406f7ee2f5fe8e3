"""Reports of a day of the real line: how long workbook and figures take, what memory, how big the workbook is."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import tractionpower as tp
from report import goal, table

LINES = Path(__file__).resolve().parent.parent / "lines"
WORKBOOK_GOAL_S, FIGURES_GOAL_S, SIZE_GOAL_MB, MEMORY_GOAL_MB = 15.0, 15.0, 20.0, 1000.0

CHILD = """
import json, sys, time
from pathlib import Path
from tractionpower.reporting.reports import write_reports
from tractionpower.results.results import Results
folder, part = Path(sys.argv[1]), sys.argv[2]
start, used = time.perf_counter(), time.process_time()
results = Results.open(folder)
paths = write_reports(results, results.scenario, folder, only=frozenset({part}))
told = {"seconds": time.perf_counter() - start, "processor_s": time.process_time() - used, "paths": [str(path) for path in paths]}
try:
    import resource
except ImportError:  # Windows
    told["peak_mb"] = None
else:
    told["peak_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
print(json.dumps(told))
"""


@dataclass(frozen=True)
class Written:
    """One part of the reports: wall and processor time [s], highest memory of the process [MB], its files."""

    seconds: float
    processor_s: float
    peak_mb: float | None
    paths: tuple[Path, ...]
    size_mb: float


def measure(rounds: int) -> dict[str, Written]:
    """Run the day once, and write each part of its reports `rounds` times in a process of its own; the fastest counts."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "cmk"
        tp.simulate(tp.load(LINES / "cmk"), folder)
        return {
            part: min((_write(folder, part) for _ in range(rounds)), key=lambda one: one.seconds)
            for part in ("workbook", "figures")
        }


def _write(folder: Path, part: str) -> Written:
    done = subprocess.run([sys.executable, "-c", CHILD, str(folder), part], check=True, capture_output=True, text=True)
    told = json.loads(done.stdout)
    paths = tuple(Path(path) for path in told["paths"])
    size = sum(path.stat().st_size for path in paths) / 1e6
    return Written(told["seconds"], told["processor_s"], told["peak_mb"], paths, size)


def describe(parts: dict[str, Written]) -> str:
    """Return the measurements as markdown."""
    book, figures = parts["workbook"], parts["figures"]
    rows = [
        ("workbook", f"{book.seconds:.1f} s", _against(book.seconds, WORKBOOK_GOAL_S, "s")),
        ("its size", f"{book.size_mb:.1f} MB", _against(book.size_mb, SIZE_GOAL_MB, "MB")),
        (f"{len(figures.paths)} figures as PNG", f"{figures.seconds:.1f} s", _against(figures.seconds, FIGURES_GOAL_S, "s")),
    ]
    for words, part in (("workbook", book), ("figures", figures)):
        if part.peak_mb is not None:
            rows.append(
                (
                    f"highest memory of the process, {words}",
                    f"{part.peak_mb:.0f} MB",
                    _against(part.peak_mb, MEMORY_GOAL_MB, "MB"),
                )
            )
    return "### Reports of a day of `cmk`\n\n" + table(["results of 24 h in steps of 1 s, 152 trains", "measured", "goal"], rows)


def _against(value: float, limit: float, unit: str) -> str:
    return f"{limit:g} {unit}: {goal(value, limit)}"
