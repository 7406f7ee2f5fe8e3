"""What is run many times: cases as changes of a base, what is measured of each, and how it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import pyarrow as pa

from tractionpower.model.scenario import Scenario
from tractionpower.results.columns import TABLES

CASE_TABLES = ("case_devices", "case_profile", "case_rails", "case_trains")
"""Tables that a case may have rows in."""

LABELS = ("kind", "subject", "mode", "grid")
"""What a case says of itself in table ``cases``."""

FIGURES = tuple(c.name for c in TABLES["cases"] if c.name not in {"case", *LABELS, "status", "reason"})
"""What is measured of a case in table ``cases``."""

COMPLETE, FLAGGED, REFUSED, FAILED = "complete", "flagged", "refused", "failed"


@dataclass(frozen=True, slots=True)
class Case:
    """One case of a study: the base with changes.

    Attributes
    ----------
    id
        Its identifier; no two cases of a study have the same.
    changes
        Changes by path; see `tractionpower.model.change.apply_change`.
    kind, subject, mode, grid
        Columns of table ``cases``.
    base
        Whether others are compared with it.
    """

    id: str
    changes: tuple[str, ...] = ()
    kind: str = "variant"
    subject: str = ""
    mode: str = ""
    grid: str = "normal"
    base: bool = False


@dataclass(frozen=True)
class CaseResult:
    """What was measured of a case.

    Attributes
    ----------
    figures
        Values of columns of table ``cases`` (`FIGURES`), with ``status``, complete if left out, and ``reason``. What is
        left out or None has no value.
    tables
        Rows of some of `CASE_TABLES`, without the column ``case``.
    """

    figures: dict[str, Any]
    tables: dict[str, pa.Table] = field(default_factory=dict)


Work = Callable[[Scenario], CaseResult]
"""What measures a case: a function of a module, or a partial of one, so that other processes can be sent it."""


@dataclass(frozen=True, slots=True)
class CasesProgress:
    """How far the cases are.

    Attributes
    ----------
    done, all
        Cases that have a row, and all cases.
    reused, failed
        Of the done: those that an earlier call had run, and those that failed.
    remaining_s
        Estimate of the time to the end [s]; None before a case was run.
    """

    done: int
    all: int
    reused: int = 0
    failed: int = 0
    remaining_s: float | None = None
