"""Cases on the cores of this machine: processes of one worker each, so that it is known which case ended one that died."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
from collections import Counter, deque
from collections.abc import Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.results.disk import uninterrupted
from tractionpower.studies.runner.bench import Bench, Reply, Task

WAIT_S = 1.0
"""How long is waited at a time: on Windows Ctrl-C comes through between waits only [s]."""

DEATHS = 2
"""Deaths of workers during the same case after which it is not tried again."""

START_FAILURES = 2
"""Workers that end before they are ready, one after the other, after which no more are started."""

DIED = "the worker process died twice; it may have run out of memory"

_bench: Bench | None = None
_sent = b""


class ProcessCrew:
    """Runs cases in processes of this machine.

    Parameters
    ----------
    bench
        What is the same in all cases; each process is sent it once.
    workers
        Number of processes.
    """

    def __init__(self, bench: Bench, workers: int) -> None:
        self.workers, self.most = workers, 2 * workers
        self._sent = pickle.dumps(bench)
        self._backlog: deque[Task] = deque()
        self._staff: list[_Worker] = []
        self._deaths: Counter[int] = Counter()
        self._start_failures = 0

    def start(self, task: Task) -> None:
        """Take a task."""
        self._backlog.append(task)
        self._assign()

    def finished(self) -> Iterable[tuple[int, Reply]]:
        """Wait until a reply is there, a second at most, and return all that are, by number."""
        wait([worker.future for worker in self._staff if worker.future is not None], WAIT_S, FIRST_COMPLETED)
        replies = []
        for worker in [each for each in self._staff if each.future is not None and each.future.done()]:
            reply = self._attend(worker)
            if reply is not None:
                replies.append(reply)
        self._assign()  # before the replies are kept, so that no worker waits for it
        return replies

    def close(self, *, is_stopped: bool) -> None:
        """Let the workers go; those that are busy are ended if that `is_stopped`."""
        for worker in self._staff:
            worker.close(is_stopped=is_stopped)
        self._staff.clear()

    def _attend(self, worker: _Worker) -> tuple[int, Reply] | None:
        """Look at what a worker has come to; return its reply, if it is one."""
        assert worker.future is not None
        task, future, worker.task, worker.future = worker.task, worker.future, None, None
        try:
            result = future.result()
        except BrokenProcessPool:
            worker.close(is_stopped=True)
            self._staff.remove(worker)
            return self._mourn(task)
        self._start_failures = 0
        if task is None:
            worker.pid = result
            return None
        return task.number, result

    def _mourn(self, task: Task | None) -> tuple[int, Reply] | None:
        """Have a case run again whose worker has died, unless that was not the first one."""
        if task is None:
            self._start_failures += 1
            if self._start_failures >= START_FAILURES:
                raise UsageError(
                    "worker processes end before they are ready. A script that starts them must do so below"
                    ' `if __name__ == "__main__":`; or run with one worker'
                )
            return None
        self._deaths[task.number] += 1
        if self._deaths[task.number] >= DEATHS:
            return task.number, Reply(None, DIED)
        self._backlog.appendleft(task)
        return None

    def _assign(self) -> None:
        """Give tasks to workers that have none; start workers while there are tasks for them."""
        idle = [worker for worker in self._staff if worker.future is None]
        starting = sum(worker.task is None for worker in self._staff) - len(idle)
        while self._backlog and idle:
            worker = idle.pop()
            try:
                worker.give(self._backlog[0])
            except BrokenProcessPool:  # it has died while it had nothing to do
                worker.close(is_stopped=True)
                self._staff.remove(worker)
            else:
                self._backlog.popleft()
        while starting < len(self._backlog) and len(self._staff) < self.workers:
            self._staff.append(_Worker(self._sent))
            starting += 1


class _Worker:
    """One process with at most one task; without a task and with a future it is starting."""

    def __init__(self, sent: bytes) -> None:
        context = multiprocessing.get_context("spawn")
        self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=_begin, initargs=(sent,))
        self.task: Task | None = None
        self.pid: int | None = None
        with uninterrupted():  # Ctrl-C goes to all processes of a terminal; the workers leave it to this one from the start
            self.future: Future[Any] | None = self._pool.submit(_prepare)

    def give(self, task: Task) -> None:
        self.task, self.future = task, self._pool.submit(_run, task)

    def close(self, *, is_stopped: bool) -> None:
        if is_stopped and self.pid is not None:
            with suppress(OSError):  # it has ended by itself
                os.kill(self.pid, signal.SIGTERM)
        self._pool.shutdown(wait=not is_stopped or self.pid is not None, cancel_futures=True)


def _begin(sent: bytes) -> None:
    """Begin a worker: Ctrl-C is for the process that hands out, and without that process there is nothing to do."""
    global _sent  # noqa: PLW0603 - what a worker process has
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _sent = sent


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _prepare() -> int:
    """Get ready for tasks; return the number of the process."""
    global _bench  # noqa: PLW0603
    _bench = pickle.loads(_sent)
    return os.getpid()


def _run(task: Task) -> Reply:
    assert _bench is not None
    return _bench.run(task)
