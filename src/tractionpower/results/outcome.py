"""What every run has in common, whatever it computes: who takes its rows, how it tells its progress, how it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import pyarrow as pa

from tractionpower.errors import Problem

Progress = Callable[[int, int], None]
"""Called with the steps done and the steps in all."""


class Writer(Protocol):
    """Takes the rows of the tables."""

    def append(self, table: str, rows: pa.Table) -> None:
        """Take `rows` of `table`."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run ended.

    Attributes
    ----------
    run
        What ``run.json`` says, without the files.
    key_figures
        What ``key_figures.json`` holds.
    warnings
        Warnings of the checks.
    """

    run: dict[str, Any]
    key_figures: list[dict[str, Any]]
    warnings: tuple[Problem, ...]

    @property
    def flagged(self) -> bool:
        """Whether it did not reach its end, a step did not converge or could not be served, or a ledger does not close."""
        return bool(self.run["status"] != "complete")
