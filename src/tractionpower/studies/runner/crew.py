"""Who runs cases: what all kinds have in common, and the simplest, this process."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import Protocol

from tractionpower.studies.runner.bench import Bench, Reply, Task


class Crew(Protocol):
    """Takes tasks and gives replies, in any order.

    Attributes
    ----------
    workers
        Cases that are run at a time.
    most
        Tasks that are worth being handed out at a time.
    """

    workers: int
    most: int

    def start(self, task: Task) -> None:
        """Take a task."""

    def finished(self) -> Iterable[tuple[int, Reply]]:
        """Wait until a reply is there, a second at most, and yield all that are, by number."""

    def close(self, *, is_stopped: bool) -> None:
        """Let the workers go; those that are busy are ended if that `is_stopped`."""


class SoloCrew:
    """Runs cases in this process, one after the other."""

    workers = 1
    most = 1

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._tasks: deque[Task] = deque()

    def start(self, task: Task) -> None:
        """Take a task."""
        self._tasks.append(task)

    def finished(self) -> Iterable[tuple[int, Reply]]:
        """Run a task."""
        task = self._tasks.popleft()
        yield task.number, self._bench.run(task)

    def close(self, *, is_stopped: bool) -> None:
        """Do nothing."""
