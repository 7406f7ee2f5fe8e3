"""Bars on the terminal while something lasts: the steps of a run or the trials of a search, and cases that are run at once."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from rich.progress import Progress, ProgressColumn

    from tractionpower.studies.runner.case import CasesProgress


class Bar(Protocol):
    """Moves a bar."""

    def __call__(self, done: int, total: int, words: str | None = None, /) -> None:
        """Take the steps done, the steps in all, and what is being done where that changes."""


@contextmanager
def steps_bar(words: str, *, is_even: bool = True) -> Iterator[Bar]:
    """Show a bar that is moved by steps done and steps in all.

    It tells the time that is left where the steps take about the same time (`is_even`), and else the time that has passed.
    """
    from rich.progress import TextColumn, TimeElapsedColumn, TimeRemainingColumn

    share = TextColumn("{task.percentage:3.0f} %")
    with _new_bar(share, TimeRemainingColumn() if is_even else TimeElapsedColumn()) as bar:
        task = bar.add_task(words, total=None)

        def update(done: int, total: int, now: str | None = None, /) -> None:
            bar.update(task, completed=done, total=total, description=words if now is None else now)

        yield update


@contextmanager
def cases_bar(total: int) -> Iterator[Callable[[CasesProgress], None]]:
    """Show a bar while cases are run; it is moved by what the runner tells, the remaining time among it."""
    from rich.progress import TextColumn, TimeElapsedColumn

    with _new_bar(TimeElapsedColumn(), TextColumn("{task.fields[left]}")) as bar:
        task = bar.add_task("running cases", total=total, left="")

        def update(now: CasesProgress) -> None:
            failed = f", {now.failed} failed" if now.failed else ""
            left = "" if now.remaining_s is None else f"some {_duration(now.remaining_s)} left"
            bar.update(task, completed=now.done, description=f"{now.done} of {now.all} cases{failed}", left=left)

        yield update


def _new_bar(*columns: ProgressColumn) -> Progress:
    """Return a bar on stderr that goes when it is over; `columns` stand behind it."""
    from rich.progress import BarColumn, Progress, TextColumn

    from tractionpower.cli.closed_pipes import PatientConsole

    console = PatientConsole(stderr=True)
    return Progress(TextColumn("{task.description}"), BarColumn(), *columns, console=console, transient=True)


def _duration(seconds: float) -> str:
    """Return a time as people say it.

    >>> _duration(42.0), _duration(150.0), _duration(7300.0)
    ('42 s', '3 min', '2.0 h')
    """
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"
