"""Trains that an outage keeps from ending their run: without a timed call nobody else would miss them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tractionpower.model.scenario import Scenario
from tractionpower.studies.cases.judgement import Check, failures
from tractionpower.studies.runner.outcomes import CasesRun


def note_unfinished(scenario: Scenario, checks: Sequence[Check], run: CasesRun) -> None:
    """Enter figure ``unfinished_trains`` of all cases into their rows, and what they violate with it.

    A train counts that ended its run in the base case at the same grid voltage, by the tolerance of lateness before the end of
    the clock, and does not within the clock in the case.

    Parameters
    ----------
    scenario, checks
        The base, and what its cases are held against.
    run
        The cases, the base cases first.
    """
    due_s = scenario.clock.end - scenario.feasibility.tolerance_s
    due: dict[str, set[str]] = {}  # by grid voltage
    for row, trains in run.case_tables("case_trains"):
        names, times = trains["train"].to_pylist(), trains["finished_s"].to_pylist()
        finished = {name: at_s for name, at_s in zip(names, times, strict=True) if at_s is not None and np.isfinite(at_s)}
        if row["kind"] == "base":
            due[row["grid"]] = {name for name, at_s in finished.items() if at_s <= due_s}
        if row["grid"] in due:
            row["unfinished_trains"] = len(due[row["grid"]] - finished.keys())
            row["fails"] = ", ".join(failures(checks, row))
