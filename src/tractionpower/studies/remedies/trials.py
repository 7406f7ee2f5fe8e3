"""Trial runs of a search: counted, bounded in number and time, each kept so that none is run twice or lost."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.model.remedies import RemedySearch
from tractionpower.model.scenario import Clock, Scenario
from tractionpower.results.disk import failures_told, read_json, write_json
from tractionpower.results.versions import versions
from tractionpower.studies.remedies.allowance import Allowance

FILE = "remedies.json"
"""File in which trials are kept, where a folder is given."""

Lateness = Callable[[Scenario], Mapping[str, float]]
"""Greatest lateness over the calls of each train in a run with the network [s]."""

Progress = Callable[[int, int], None]


class SpentError(Exception):
    """The wall time of the search is over, or it was stopped."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A trial run.

    Attributes
    ----------
    late
        Lateness of the trains that are late [s].
    excess_s
        Sum of what they are late beyond the tolerance [s]; infinite where the change is refused.
    worst_s
        Greatest lateness of all trains [s].
    is_partial
        Whether only a glance was run: the trains that are late without the change and were not seen are taken as before.
    """

    late: dict[str, float]
    excess_s: float
    worst_s: float
    is_partial: bool = False

    @property
    def holds(self) -> bool:
        """Whether no train is late."""
        return not self.late and math.isfinite(self.excess_s)


REFUSED = Trial({}, math.inf, math.inf)
"""A change that the model or the checks refuse."""


@dataclass(frozen=True, slots=True)
class Glance:
    """A short part of the clock in which trains are late without changes.

    A change that leaves one of them late there does not suffice, so the rest need not be run.

    Attributes
    ----------
    clock
        The part.
    seen
        Trains that are late in it without changes.
    beyond
        Lateness of the other late trains without changes [s].
    """

    clock: Clock
    seen: frozenset[str]
    beyond: Mapping[str, float]


class Trials:
    """Runs of changed scenarios.

    Parameters
    ----------
    base
        The scenario that is changed.
    tolerance_s
        Lateness up to which a train is on time [s].
    lateness
        What runs a scenario.
    folder
        Where trials are kept as they come; a search that is started again takes from there what it has.
    progress
        Called with the runs done, and the most that there can be.
    glance
        What is run first, if anything.
    allowance
        How long runs may begin; left out: for the wall time of the bounds from now on.
    """

    def __init__(
        self,
        base: Scenario,
        tolerance_s: float,
        lateness: Lateness,
        folder: Path | None = None,
        progress: Progress | None = None,
        allowance: Allowance | None = None,
        glance: Glance | None = None,
    ) -> None:
        self.base, self.tolerance_s = base, tolerance_s
        self._lateness, self._folder, self._progress, self._glance = lateness, folder, progress, glance
        self._known: dict[str, dict[str, float]] = {} if folder is None else _read(folder / FILE)
        self._lock = threading.Lock()
        self._allowance = Allowance(base.remedies.wall_time_s) if allowance is None else allowance
        self._used: set[str] = set()
        self._run_now: set[str] = set()
        self.planned = 0

    @property
    def tried(self) -> int:
        """Number of different changed timetables that were run, now or in an earlier search whose trials are kept."""
        return len(self._used)

    @property
    def reused(self) -> int:
        """Number of those that an earlier search had run."""
        return len(self._used - self._run_now)

    @property
    def over(self) -> bool:
        """Whether nothing more may be tried."""
        return self._allowance.over

    def run(self, changes: Iterable[str]) -> Trial:
        """Return how late trains are with changes.

        Raises
        ------
        SpentError
            If nothing more may be tried.
        """
        if self.over:
            raise SpentError
        try:
            changed = apply_changes(self.base, changes)
            key = _key(changed)
            trial = self._glanced(changed, key) or judged(self._late(changed, key, key), self.tolerance_s)
        except InputError:
            return REFUSED
        with self._lock:
            is_new = key not in self._used
            self._used.add(key)
            if is_new and self._progress is not None:
                self._progress(self.tried, max(self.planned, self.tried))
        return trial

    def _glanced(self, changed: Scenario, key: str) -> Trial | None:
        """Return the trial of a change that leaves a train late in the glance, None where the whole has to be run."""
        glance = self._glance
        if glance is None or key in self._known:
            return None
        short = changed.model_copy(update={"clock": glance.clock})
        late = self._late(short, _key(short), key)
        if judged(late, self.tolerance_s).late.keys().isdisjoint(glance.seen):
            return None
        return replace(judged({**late, **glance.beyond}, self.tolerance_s), is_partial=True)

    def _late(self, scenario: Scenario, key: str, of: str) -> dict[str, float]:
        """Return how late trains are in a run [s], from memory if it has been made; `of` is the key of the changed study."""
        with self._lock:
            known = self._known.get(key)
        if known is not None:
            return known
        late = {name: float(value) for name, value in self._lateness(scenario).items()}
        self._keep(key, late, of)
        return late

    def _keep(self, key: str, late: dict[str, float], of: str) -> None:
        with self._lock:
            self._known[key] = late
            self._run_now.add(of)
            if self._folder is not None:
                with failures_told(self._folder, what="trials of the search"):
                    self._folder.mkdir(parents=True, exist_ok=True)
                    write_json(self._folder / FILE, {"format": 1, "trials": _told(self._known)})


def judged(late: Mapping[str, float], tolerance_s: float) -> Trial:
    """Return a trial of how late trains are [s]; a train without a lateness has no planned times and is not judged."""
    given = {name: value for name, value in late.items() if not math.isnan(value)}
    beyond = {name: value for name, value in given.items() if value > tolerance_s}
    excess = math.fsum(value - tolerance_s for value in beyond.values())
    return Trial(dict(sorted(beyond.items())), excess, max(0.0, *given.values(), 0.0))


def _key(scenario: Scenario) -> str:
    # Bounds of the search do not change a run.
    plain = scenario.model_copy(update={"remedies": RemedySearch()})
    return f"{versions()['tractionpower']} {plain.input_hash}"


def _told(known: dict[str, dict[str, float]]) -> dict[str, dict[str, float | str]]:
    """Return trials as JSON can hold them: a train that never comes is infinitely late, one without times has none."""
    return {
        key: {name: value if math.isfinite(value) else str(value) for name, value in late.items()}
        for key, late in sorted(known.items())
    }


def _read(file: Path) -> dict[str, dict[str, float]]:
    content = read_json(file) if file.is_file() else None
    trials = (content or {}).get("trials")
    if not isinstance(trials, dict):  # not written by a search: it is written anew
        return {}
    return {key: {name: float(value) for name, value in late.items()} for key, late in trials.items() if isinstance(late, dict)}
