"""How long a search may go on: until its wall time is over, or Ctrl-C; what was done by then is kept."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

T = TypeVar("T")


class Allowance:
    """Wall time for work that is done in pieces.

    Parameters
    ----------
    seconds
        After this nothing new is begun [s].
    """

    def __init__(self, seconds: float = math.inf) -> None:
        self._until = time.monotonic() + seconds
        self._stop = threading.Event()

    @property
    def stopped(self) -> bool:
        """Whether Ctrl-C came."""
        return self._stop.is_set()

    @property
    def over(self) -> bool:
        """Whether nothing new may begin."""
        return self.stopped or time.monotonic() > self._until

    def stop(self) -> None:
        """Let nothing new begin."""
        self._stop.set()

    def run_all(self, tasks: Sequence[Callable[[], T]], workers: int) -> list[T | None]:
        """Run tasks, several at a time, and return what came of each; None where Ctrl-C came before or in it.

        Tasks that are under way when Ctrl-C comes are waited for, others are not begun.
        """
        pool = ThreadPoolExecutor(workers)
        futures: list[Future[T]] = []

        def begin(task: Callable[[], T]) -> T:
            if self.stopped:
                raise KeyboardInterrupt
            return task()

        try:
            futures += [pool.submit(begin, task) for task in tasks]
            for future in futures:
                future.result()
        except KeyboardInterrupt:
            self.stop()
        finally:
            pool.shutdown(cancel_futures=True)
        futures += [Future() for _ in tasks[len(futures) :]]
        return [future.result() if _is_good(future) else None for future in futures]


def _is_good(future: Future[Any]) -> bool:
    if not future.done() or future.cancelled():
        return False
    error = future.exception()
    return error is None or not isinstance(error, KeyboardInterrupt)
