"""Cases in their order: known ones from the store, the others handed out, each outcome kept as soon as it is there."""

from __future__ import annotations

import logging
import shutil
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tractionpower.errors import InputError, UsageError
from tractionpower.io.file_names import ENDING, file_names
from tractionpower.kernels.jit import is_compiled
from tractionpower.model.change import apply_changes
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.results.disk import failures_told, read_json
from tractionpower.results.store import RUN_FILE
from tractionpower.studies.runner.bench import Bench, Reply, Task, refusal
from tractionpower.studies.runner.case import FAILED, FIGURES, LABELS, REFUSED, Case, CasesProgress, Work
from tractionpower.studies.runner.crew import Crew, SoloCrew
from tractionpower.studies.runner.identity import key_of, work_identity
from tractionpower.studies.runner.outcomes import CasesRun
from tractionpower.studies.runner.packed import row_of
from tractionpower.studies.runner.store import CaseStore

log = logging.getLogger(__name__)

KERNEL = "advance"
"""A kernel that every run needs."""

Told = Callable[[CasesProgress], None]


def run_cases(
    base: Scenario,
    library: Library,
    cases: Sequence[Case],
    work: Work,
    store: CaseStore,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Told | None = None,
) -> CasesRun:
    """Run cases; what the store keeps is not run again, and equal cases are run once.

    Parameters
    ----------
    base, library
        What is changed, and the tables of equipment that changes may name.
    cases
        The cases.
    work
        What measures a case: a function of a module, or a partial of one with plain values.
    store
        Keeps the outcomes; a call that goes on where an earlier one was stopped is given the same.
    workers
        Cases that are run at a time: 1 in this process, more in processes of their own. The tables are the same.
    scheduler
        Address of a Dask scheduler whose workers run the cases, such as ``tcp://10.0.0.1:8786``; `workers` is not used.
    progress
        Called whenever a case has ended.

    Returns
    -------
    CasesRun
        A row for every case, with its reason where it was refused or failed; after Ctrl-C, for those that had ended.

    Raises
    ------
    UsageError
        If two cases have the same identifier, or the cluster does not answer. What is kept in the store stays.
    OutputError
        If an outcome cannot be kept.
    """
    twice = sorted(name for name, count in Counter(case.id for case in cases).items() if count > 1)
    if twice:
        raise UsageError(f"more than one case is called {', '.join(map(repr, twice))}; give each a name of its own")
    if scheduler is not None and store.full_tables is not None:
        raise UsageError(
            "workers of a cluster may not see the disk of this machine: full tables are written by local workers only"
        )
    return _Runner(Bench(base, library, work), cases, store, progress).execute(workers, scheduler)


class _Runner:
    """One call of `run_cases`."""

    def __init__(self, bench: Bench, cases: Sequence[Case], store: CaseStore, progress: Told | None) -> None:
        self._bench, self._cases, self._store, self._progress = bench, tuple(cases), store, progress
        self._work = work_identity(bench.work)
        self._folders = _folders(cases, store.full_tables)
        self._ended: dict[int, dict[str, Any]] = {}
        self._keys: dict[str, str] = {}
        self._first: dict[str, int] = {}  # the first case of each key
        self._equal: dict[int, list[int]] = {}  # cases under way, and others with the same inputs
        self._key_of: dict[int, str] = {}
        self._reused = self._run = self._failed = 0
        self._run_seconds = 0.0
        self._crew: Crew | None = None

    def execute(self, workers: int, scheduler: str | None) -> CasesRun:
        """Run all cases."""
        started, is_interrupted, is_stopped = time.perf_counter(), False, True
        left = iter(range(len(self._cases)))
        self._is_fresh = (workers > 1 and scheduler is None) and not is_compiled(KERNEL)
        try:
            while self._hand_out(left, workers, scheduler):
                assert self._crew is not None
                for number, reply in self._crew.finished():
                    self._end(number, reply)
            is_stopped = False
        except KeyboardInterrupt:
            is_interrupted = True
        finally:
            if self._crew is not None:
                self._crew.close(is_stopped=is_stopped)
        rows = tuple(self._ended[number] for number in sorted(self._ended))
        seconds, used = time.perf_counter() - started, 1 if self._crew is None else self._crew.workers
        keys = {case.id: self._keys[case.id] for case in self._cases if case.id in self._keys}
        return CasesRun(self._cases, rows, keys, self._store, self._reused, self._run, is_interrupted, seconds, used)

    def _hand_out(self, left: Any, workers: int, scheduler: str | None) -> bool:
        """Hand out cases while there is room for them; return whether some are under way."""
        while self._crew is None or len(self._equal) < self._crew.most:
            number = next(left, None)
            if number is None:
                break
            if self._is_known(number):
                continue
            task = Task(number, self._cases[number].changes, self._folders.get(number))
            if self._is_fresh:  # two workers that find no compiled kernels would both compile them
                reply = self._bench.run(task)
                self._is_fresh = reply.refused
                self._end(number, reply)
                continue
            if self._crew is None:
                self._crew = new_crew(self._bench, min(workers, len(self._cases) - number), scheduler)
            self._crew.start(task)
        return bool(self._equal) and self._crew is not None

    def _is_known(self, number: int) -> bool:
        """End a case that need not be run; note any other as under way."""
        case = self._cases[number]
        try:
            scenario = apply_changes(self._bench.base, case.changes, self._bench.library)
        except InputError as error:
            self._enter(number, refusal(error).figures)
            return True
        key = self._key_of[number] = key_of(scenario, self._work)
        first = self._first.setdefault(key, number)
        if first in self._equal:
            self._equal[first].append(number)
        elif first != number:
            self._enter_equal(number, first)
        elif self._store.has(key) and self._has_results(number, scenario, row_of(self._store.get(key))):
            self._reused += 1
            self._keep(number, row_of(self._store.get(key)))
        else:
            self._equal[number] = []
            return False
        return True

    def _has_results(self, number: int, scenario: Scenario, row: dict[str, Any]) -> bool:
        """Return whether the whole results of a case are there, where they are wanted and it can have some."""
        folder = self._folders.get(number)
        if folder is None or row["status"] == REFUSED:
            return True
        file = folder / RUN_FILE
        return file.is_file() and (read_json(file) or {}).get("input_hash") == scenario.input_hash

    def _end(self, number: int, reply: Reply) -> None:
        """Keep the outcome of a case that was run, and enter it with all that are equal to it."""
        self._run += 1
        self._run_seconds += reply.seconds
        if reply.data is None:
            log.error("case %s failed: %s\n%s", self._cases[number].id, reply.reason, reply.trace)
            self._enter(number, {"status": FAILED, "reason": reply.reason})
        else:
            self._store.put(self._key_of[number], reply.data)
            self._keep(number, row_of(reply.data))
        for other in self._equal.pop(number):
            self._enter_equal(other, number)

    def _keep(self, number: int, row: dict[str, Any]) -> None:
        """Enter a case whose outcome is in the store."""
        self._keys[self._cases[number].id] = self._key_of[number]
        self._enter(number, row)

    def _enter_equal(self, number: int, first: int) -> None:
        """Enter a case whose inputs are those of an earlier one."""
        row, one = self._ended[first], self._cases[first].id
        reason = f"{row['reason']}; same inputs as case {one}" if row["reason"] else f"same inputs as case {one}"
        if one in self._keys:
            self._keys[self._cases[number].id] = self._keys[one]
        source, target = self._folders.get(first), self._folders.get(number)
        if source is not None and target is not None and (source / RUN_FILE).is_file():
            with failures_told(target):
                shutil.rmtree(target, ignore_errors=True)
                shutil.copytree(source, target)
        self._enter(number, {**row, "reason": reason})

    def _enter(self, number: int, row: dict[str, Any]) -> None:
        """Enter the row of a case and tell how far all is."""
        case = self._cases[number]
        figures = {name: row.get(name) for name in ("status", "reason", *FIGURES)}
        self._ended[number] = {"case": case.id, **{name: getattr(case, name) for name in LABELS}, **figures}
        self._failed += row["status"] == FAILED
        if self._progress is not None:
            done, total = len(self._ended), len(self._cases)
            self._progress(CasesProgress(done, total, self._reused, self._failed, self._remaining_s()))

    def _remaining_s(self) -> float | None:
        """Return an estimate of the time to the end [s]: those under way are half done on the average."""
        if not self._run:
            return None
        workers = 1 if self._crew is None else self._crew.workers
        left = len(self._cases) - len(self._ended)
        return self._run_seconds / self._run * max(0.0, left - min(left, workers) / 2) / workers


def new_crew(bench: Bench, workers: int, scheduler: str | None) -> Crew:
    """Return who runs the cases.

    Raises
    ------
    UsageError
        If a cluster does not answer, or is not of the same versions.
    """
    if scheduler is not None:
        try:
            from tractionpower.studies.runner.cluster import ClusterCrew  # noqa: PLC0415 - Dask is optional
        except ImportError as error:
            told = 'a scheduler needs Dask, which is not installed: pip install "tractionpower[cluster]"'
            raise UsageError(f"{told} ({error})") from error
        return ClusterCrew(bench, scheduler)
    if workers > 1:
        from tractionpower.studies.runner.processes import ProcessCrew  # noqa: PLC0415 - not needed by one worker

        return ProcessCrew(bench, workers)
    return SoloCrew(bench)


def _folders(cases: Sequence[Case], folder: Path | None) -> dict[int, Path]:
    """Return where the whole results of each case go, where they are wanted."""
    if folder is None:
        return {}
    names = file_names(case.id for case in cases)
    return {number: folder / names[case.id].removesuffix(ENDING) for number, case in enumerate(cases)}
