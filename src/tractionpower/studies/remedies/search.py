"""The search for the smallest change that makes a timetable feasible."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice, zip_longest
from pathlib import Path

from tractionpower.model.remedies import KINDS
from tractionpower.model.scenario import Scenario
from tractionpower.movement.telling import listed
from tractionpower.studies import feasibility
from tractionpower.studies.feasibility import Judgement
from tractionpower.studies.remedies.allowance import Allowance
from tractionpower.studies.remedies.candidate import Candidate, combined, touch_the_same
from tractionpower.studies.remedies.caps import caps
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.drivings import drivings
from tractionpower.studies.remedies.headways import headways
from tractionpower.studies.remedies.ladder import most_trials, smallest
from tractionpower.studies.remedies.observe import watch
from tractionpower.studies.remedies.remedy import Remedies, Remedy, Sensitivity, costs_in_words
from tractionpower.studies.remedies.reserves import reserves
from tractionpower.studies.remedies.sensitivities import Judge, lost_seconds, sensitivities
from tractionpower.studies.remedies.shifts import shifts
from tractionpower.studies.remedies.trials import REFUSED, Glance, Lateness, Progress, SpentError, Trial, Trials, judged
from tractionpower.studies.remedies.verify import verify
from tractionpower.studies.remedies.window import reaches_all, window

GLANCE_SHARE = 0.5
"""A glance at the latest train is worth its run if it takes at most this share of the clock of a trial."""

SOURCES: dict[str, Callable[[Case], Iterator[Candidate]]] = {
    "departure_shift": shifts,
    "current_cap": lambda case: caps(case, "current_cap"),
    "power_cap": lambda case: caps(case, "power_cap"),
    "headway": headways,
    "reserve": reserves,
    "driving": drivings,
}

CTRL_C = "Ctrl-C"
TRIAL_SHARE = 0.6
"""Share of the wall time in which trial runs begin; the rest is for verifying and sensitivities."""

SHOWN = 12
"""Names that a note shows."""

FIRSTS, SECONDS = 2, 4
"""Where no change alone suffices: how many of those that come nearest are fixed, and what is tried on top of each."""


def search(
    scenario: Scenario,
    judgement: Judgement,
    progress: Progress | None = None,
    *,
    folder: str | Path | None = None,
    lateness: Lateness | None = None,
    judge: Judge | None = None,
) -> Remedies:
    """Search for the smallest change that makes a timetable feasible, verify it by running it, and tell sensitivities.

    Every kind of change is made on the trains whose demand causes the loss, at growing sizes, until no train of the study
    is late; the smallest size of each is found by halving, in runs of the part of the clock around the late trains. The
    cheapest are then verified by runs of the whole study. Where none suffices, two are joined. Ctrl-C and the wall time
    of the bounds end the search with what it has found. Same inputs give the same answer, unless the wall time runs out.

    Parameters
    ----------
    scenario
        The study; `scenario.remedies` holds the bounds.
    judgement
        Its judgement.
    progress
        Called with the runs done and the most that there can be.
    folder
        Where the results of trial runs are kept as they come; a search that is started again uses what is there.
    lateness, judge
        What runs and what judges a scenario, in place of those of the study of feasibility.
    """
    if judgement.verdict != "infeasible":
        return Remedies((), 0, notes=("The timetable holds as it is; nothing was searched.",))
    try:
        work = _Search(
            scenario,
            judgement,
            lateness or feasibility.lateness,
            judge or partial(feasibility.judge, tolerance_s=judgement.tolerance_s),
            Path(folder) if folder is not None else None,
            progress,
        )
        return work.execute()
    except KeyboardInterrupt:  # before there was anything to keep, or again while runs under way were waited for
        return Remedies((), 0, notes=(f"The search was ended by {CTRL_C}.",), interrupted=True, stopped=True)


class _Search:
    # One search: what it knows, what it has tried, what it tells.

    def __init__(
        self,
        scenario: Scenario,
        judgement: Judgement,
        lateness: Lateness,
        judge: Judge,
        folder: Path | None,
        progress: Progress | None,
    ) -> None:
        self.scenario, self.judgement, self.judge = scenario, judgement, judge
        self.bounds = scenario.remedies
        self.notes: list[str] = [costs_in_words(self.bounds.costs)]
        self.interrupted = False
        wall_s = self.bounds.wall_time_s
        self.allowance, self.for_trials = Allowance(wall_s), Allowance(TRIAL_SHARE * wall_s)
        self.attempts: dict[Candidate, dict[int, Trial]] = {}
        self.room = self.bounds.most_runs
        late = late_trains(judgement)
        watcher = watch(scenario, late)
        self.case = Case(scenario, judgement.tolerance_s, late, delays_by_call(judgement), watcher.culprits(), watcher.peaks)
        self.base = _window_that_shows(scenario, self.case, lateness)
        glance = _glance(scenario, self.base, self.case, lateness)
        self.lateness, self.folder, self.progress = lateness, folder, progress
        self.trials = self._new_trials(glance)

    @property
    def is_whole(self) -> bool:
        """Whether trials run the whole study."""
        return self.base is self.scenario

    def execute(self) -> Remedies:
        """Search, verify, and tell sensitivities; Ctrl-C ends it with what there is."""
        found = self._find()
        if not self.is_whole and not self.interrupted and self._any_holds() and not any(each.feasible for each in found):
            self.notes.append("What saves the part of the clock around the late trains does not save the whole: searched again.")
            spent = self.trials.tried
            self.base, self.attempts = self.scenario, {}
            self.trials = self._new_trials(None)
            self.room = self.bounds.most_runs - spent
            found = self._find()
        rows: tuple[Sensitivity, ...] = ()
        if not self.interrupted and not self.allowance.over:
            rows = sensitivities(self.case, self.base, self.judgement, self.judge, self.allowance)
        if self.allowance.over and not self.interrupted:
            self._break_off(CTRL_C if self.allowance.stopped else self._wall_time)
        return Remedies(
            tuple(found), self.trials.tried, rows, tuple(self.notes), self.interrupted, self.allowance.stopped, self.trials.reused
        )

    def _new_trials(self, glance: Glance | None) -> Trials:
        tolerance_s = self.judgement.tolerance_s
        return Trials(self.base, tolerance_s, self.lateness, self.folder, self.progress, self.for_trials, glance)

    def _find(self) -> list[Remedy]:
        """Search in runs of the base, and verify what holds there."""
        self._explore(self._affordable(self._candidates()))
        if not self.interrupted and not self._any_holds():
            self.room = self.bounds.most_runs - self.trials.tried  # most of the first runs were spared
            self._explore(self._affordable(self._pairs()))
        found = self._remedies()
        return found if self.allowance.stopped else verify(found, self.scenario, self.judgement, self.judge, self.allowance)

    @property
    def _wall_time(self) -> str:
        return f"its wall time, {self.bounds.wall_time_s:g} s"

    def _candidates(self) -> list[Candidate]:
        kinds = [kind for kind in KINDS if kind in self.bounds.kinds]
        missing = missing_alone(self.judgement)
        if missing:
            names = listed([f"{train} ({seconds:.0f} s)" for train, seconds in missing.items()], SHOWN)
            self.notes.append(
                f"Late even alone at nominal voltage, since the timetable gives less than running, dwells and turn-rounds need:"
                f" {names}. No change of supply or of other trains helps them; only later planned times were searched."
            )
            kinds = [kind for kind in kinds if kind == "reserve"]
        turns = [list(SOURCES[kind](self.case)) for kind in kinds]
        # One of each kind in turn, so that the wall time leaves none out.
        mixed = [candidate for row in zip_longest(*turns) for candidate in row if candidate is not None]
        near = [candidate for candidate in mixed if reaches_all(self.case, candidate)]
        if len(near) < len(mixed):
            names = ", ".join(dict.fromkeys(f"{each.kind} of {each.subject}" for each in mixed if each not in near))
            self.notes.append(f"Not tried, since they are not running when all of the late trains are: {names}.")
        return near

    def _affordable(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return those whose runs the bounds have room for, even if each needs as many as it can."""
        taken: list[Candidate] = []
        left: list[Candidate] = []
        for candidate in candidates:
            runs = most_trials(candidate.most)
            if runs > self.room:
                left.append(candidate)
                continue
            taken.append(candidate)
            self.room -= runs
        if left:
            names = ", ".join(f"{each.kind} of {each.subject}" for each in left)
            self.notes.append(f"Not tried, beyond most_runs of {self.bounds.most_runs}: {names}.")
        self.trials.planned += sum(most_trials(candidate.most) for candidate in taken)
        return taken

    def _explore(self, candidates: Sequence[Candidate]) -> None:
        """Look for the smallest size of each candidate, several at a time."""
        for candidate in candidates:
            self.attempts[candidate] = {}
        ended = self.for_trials.run_all([partial(self._climb, candidate) for candidate in candidates], self.bounds.workers)
        if self.for_trials.stopped:
            self.allowance.stop()
            self._break_off(CTRL_C)
        elif not all(ended):
            self._break_off(self._wall_time)

    def _climb(self, candidate: Candidate) -> bool:
        """Look for the smallest size of a candidate; tell whether there was time for that."""
        tried = self.attempts[candidate]

        def trial(steps: int) -> Trial:
            if steps not in tried:
                tried[steps] = self.trials.run(candidate.change(candidate.size(steps)))
            return tried[steps]

        def enough(steps: int) -> bool:
            return math.isfinite(trial(steps).excess_s) and self.case.late.keys().isdisjoint(trial(steps).late)

        try:
            smallest(candidate.most, lambda steps: trial(steps).holds, enough)
        except SpentError:
            return False
        return True

    def _break_off(self, reason: str) -> None:
        self.interrupted = True
        self.notes.append(f"The search was ended by {reason}; what it had found by then is told.")

    def _any_holds(self) -> bool:
        return any(trial.holds for tried in self.attempts.values() for trial in tried.values())

    def _pairs(self) -> list[Candidate]:
        """Return what to try on top of the single changes that come nearest."""
        ranked = sorted(
            ((trial.excess_s, number, steps, candidate)
             for number, (candidate, tried) in enumerate(self.attempts.items())
             for steps, trial in [_nearest(tried)]
             if math.isfinite(trial.excess_s)),
            key=lambda row: row[:3],
        )  # fmt: skip
        pairs = []
        for _, _, steps, first in ranked[:FIRSTS]:
            others = (second for *_, second in ranked if second is not first and not touch_the_same(first, second))
            pairs += [combined(first, steps, second) for second in islice(others, SECONDS)]
        return pairs

    def _remedies(self) -> list[Remedy]:
        """Return the smallest size that holds of each candidate, by cost; then the nearest of the others, by what is left."""
        rows: list[tuple[bool, float, int, Remedy]] = []
        before = lost_seconds(self.judgement)
        for candidate, tried in self.attempts.items():
            steps, trial = _nearest(tried)
            if not math.isfinite(trial.excess_s):
                continue
            size = candidate.size(steps)
            remedy = Remedy(
                candidate.kind, candidate.subject, size, candidate.unit, candidate.tell(size), candidate.change(size),
                trial.holds, False,
                math.nan if trial.is_partial else trial.worst_s, before, math.nan, round(candidate.cost(size), 6),
            )  # fmt: skip
            rows.append((not trial.holds, remedy.cost if trial.holds else trial.excess_s, len(rows), remedy))
        return [row[-1] for row in sorted(rows, key=lambda row: row[:3])]


def _nearest(tried: Mapping[int, Trial]) -> tuple[int, Trial]:
    """Return the smallest number of steps that holds, or else that which leaves the least."""
    rows = [(not trial.holds, trial.excess_s, steps) for steps, trial in tried.items()]
    if not rows:
        return 0, REFUSED
    steps = min(rows)[-1]
    return steps, tried[steps]


def late_trains(judgement: Judgement) -> dict[str, float]:
    """Return how late the trains are for which the timetable does not hold [s]; infinite for one that does not get there."""
    late = {row.train: row.late_s for row in judgement.trains if row.verdict in {"infeasible", "not finished"}}
    return {train: seconds if math.isfinite(seconds) else math.inf for train, seconds in sorted(late.items())}


def delays_by_call(judgement: Judgement) -> dict[tuple[str, str, str], tuple[float, ...]]:
    """Return the delays at calls by run, station and kind, in the order of the route [s]."""
    delays: dict[tuple[str, str, str], tuple[float, ...]] = {}
    for row in judgement.delays:
        key = (row.train, row.station, row.kind)
        delays[key] = (*delays.get(key, ()), row.delay_s)
    return delays


def missing_alone(judgement: Judgement) -> dict[str, float]:
    """Return how late trains are even alone at nominal voltage: they run, or stop, shorter by plan than they can [s]."""
    missing: dict[str, float] = {}
    for row in judgement.delays:
        alone_s = sum(seconds for seconds in (row.origin_timetable_s, row.origin_dwell_s) if math.isfinite(seconds))
        if alone_s > judgement.tolerance_s:
            missing[row.train] = max(missing.get(row.train, 0.0), alone_s)
    return dict(sorted(missing.items(), key=lambda item: (-item[1], item[0])))


def _glance(scenario: Scenario, base: Scenario, case: Case, lateness: Lateness) -> Glance | None:
    """Return the part of the clock around the latest train, where trials run much more and it is late there, too."""
    worst = max(case.late, key=lambda run: (case.late[run], run))
    short = window(scenario, {worst: case.late[worst]})
    if short is scenario or _length(short) > GLANCE_SHARE * _length(base):
        return None
    seen = judged(lateness(short), case.tolerance_s).late
    if not _agree(seen.get(worst, 0.0), case, worst):
        return None
    both = frozenset(seen).intersection(case.late)
    return Glance(short.clock, both, {run: late for run, late in case.late.items() if run not in both})


def _length(scenario: Scenario) -> float:
    return scenario.clock.end - scenario.clock.start


def _agree(seen_s: float, case: Case, run: str) -> bool:
    return math.isclose(seen_s, case.late[run], rel_tol=0.1, abs_tol=case.tolerance_s + 1.0)


def _window_that_shows(scenario: Scenario, case: Case, lateness: Lateness) -> Scenario:
    """Return the study with a narrowed clock if a run of that shows the lateness of the whole, else the study itself."""
    narrow = window(scenario, case.late)
    if narrow is scenario:
        return scenario
    seen = judged(lateness(narrow), case.tolerance_s).late
    agrees = seen.keys() == case.late.keys() and all(_agree(seen[run], case, run) for run in seen)
    return narrow if agrees else scenario
