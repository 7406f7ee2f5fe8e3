"""Progress of many cases on the terminal, with the remaining time."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tractionpower.studies.runner.case import CasesProgress


@contextmanager
def cases_bar(total: int) -> Iterator[Callable[[CasesProgress], None]]:
    """Show a bar while cases are run; it is moved by what the runner tells."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from tractionpower.cli.closed_pipes import PatientConsole

    bar = Progress(
        TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.fields[left]}"),
        console=PatientConsole(stderr=True), transient=True,
    )  # fmt: skip
    with bar:
        task = bar.add_task("running cases", total=total, left="")

        def update(now: CasesProgress) -> None:
            failed = f", {now.failed} failed" if now.failed else ""
            left = "" if now.remaining_s is None else f"some {_duration(now.remaining_s)} left"
            bar.update(task, completed=now.done, description=f"{now.done} of {now.all} cases{failed}", left=left)

        yield update


def _duration(seconds: float) -> str:
    """Return a time as people say it.

    >>> _duration(42.0), _duration(150.0), _duration(7300.0)
    ('42 s', '3 min', '2.0 h')
    """
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"
