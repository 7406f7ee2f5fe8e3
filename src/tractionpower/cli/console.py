"""Tables on the terminal, and the word of warning before the kernels compile."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

WIDTH = 110
"""Columns of a table at least; narrower terminals wrap [characters]."""

PIPE_WIDTH = 250
"""Columns of a table at most where no window limits it [characters]."""


def new_console() -> Console:
    """Return a console on stdout that prints names of users as they are."""
    from tractionpower.cli.closed_pipes import PatientConsole

    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # a pipe on Windows may lack letters of a name
    console = PatientConsole(highlight=False, markup=False, emoji=False, soft_wrap=True)
    # A narrow window shall not break the table, and a pipe has no width at all.
    console.width = max(console.width, WIDTH) if console.is_terminal else PIPE_WIDTH
    return console


def new_table(texts: Sequence[str], numbers: Sequence[str]) -> Table:
    """Return a table with columns of text first, then columns of numbers."""
    from rich.table import Table

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for heading in texts:
        table.add_column(heading, overflow="fold", vertical="bottom")
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True, vertical="bottom")
    return table


def warn_of_compilation(kernel: str) -> None:
    """Say that the first run of a kernel on a machine takes a while."""
    from tractionpower.cli.messages import tell
    from tractionpower.kernels.jit import is_compiled

    if not is_compiled(kernel):
        tell("first run on this machine: compiling the kernels, one to two minutes; later starts use the cache")
