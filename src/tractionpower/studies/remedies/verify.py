"""Proposals verified: the whole study is run with each, and judged like the study itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.model.scenario import Scenario
from tractionpower.studies.feasibility import Judgement
from tractionpower.studies.remedies.allowance import Allowance
from tractionpower.studies.remedies.remedy import Remedy


def verify(
    remedies: Sequence[Remedy],
    scenario: Scenario,
    judgement: Judgement,
    judge: Callable[[Scenario], Judgement],
    allowance: Allowance | None = None,
) -> list[Remedy]:
    """Return remedies, the cheapest of those that hold verified and put first.

    A remedy is verified if the whole changed study is feasible, for every train, and trains do not stand or run on one
    another where they did not before.

    Parameters
    ----------
    remedies
        Those that hold in trial runs come first, by cost.
    scenario, judgement
        The study, and its judgement.
    judge
        Judges a scenario.
    allowance
        How long to go on; the first is verified even when that is over, unless Ctrl-C came.
    """
    allowance = Allowance() if allowance is None else allowance
    most = scenario.remedies.most_verified
    chosen = [remedy for remedy in remedies if remedy.feasible][:most]
    before = overlaps(judgement)

    def try_one(number: int, remedy: Remedy) -> Remedy | None:
        is_due = number == 0 and not allowance.stopped
        return _judged(remedy, scenario, before, judge) if is_due or not allowance.over else None

    tasks = [partial(try_one, number, remedy) for number, remedy in enumerate(chosen)]
    known = dict(zip(chosen, allowance.run_all(tasks, scenario.remedies.workers), strict=True))
    rows = [known.get(remedy) or (replace(remedy, verified=False) if remedy.feasible else remedy) for remedy in remedies]
    return sorted(rows, key=lambda remedy: (not (remedy.feasible and remedy.verified), not remedy.feasible))


def _judged(remedy: Remedy, scenario: Scenario, before: int, judge: Callable[[Scenario], Judgement]) -> Remedy:
    try:
        after = judge(apply_changes(scenario, remedy.changes))
    except InputError:
        return replace(remedy, feasible=False, verified=False)
    worst = max(
        [0.0, *(math.inf if row.verdict == "not finished" else row.late_s for row in after.trains if row.verdict != "not judged")]
    )
    lost = math.fsum(row.lost_s for row in after.lost)
    meet = overlaps(after) > before
    holds = after.verdict == "feasible" and not meet
    words = f"{remedy.words} But then trains run on one another." if meet else remedy.words
    return replace(
        remedy,
        words=words,
        feasible=holds,
        verified=holds,
        lateness_after_s=worst,
        lost_after_s=lost,
    )


def overlaps(judgement: Judgement) -> int:
    """Return how many pairs of trains overlap in a run."""
    return int(judgement.outcome.run.get("overlaps", {}).get("count", 0))
