"""Trial runs of a search: counted, bounded in number and time, each kept so that none is run twice or lost."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.model.remedies import RemedySearch
from tractionpower.model.scenario import Scenario
from tractionpower.results.disk import failures_told, read_json, write_json
from tractionpower.results.versions import versions

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
    """

    late: dict[str, float]
    excess_s: float
    worst_s: float

    @property
    def holds(self) -> bool:
        """Whether no train is late."""
        return not self.late and math.isfinite(self.excess_s)


REFUSED = Trial({}, math.inf, math.inf)
"""A change that the model or the checks refuse."""


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
    """

    def __init__(
        self,
        base: Scenario,
        tolerance_s: float,
        lateness: Lateness,
        folder: Path | None = None,
        progress: Progress | None = None,
    ) -> None:
        self.base, self.tolerance_s = base, tolerance_s
        self._lateness, self._folder, self._progress = lateness, folder, progress
        self._known: dict[str, dict[str, float]] = {} if folder is None else _read(folder / FILE)
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._until = time.monotonic() + base.remedies.wall_time_s
        self._used: set[str] = set()
        self.planned = 0

    @property
    def tried(self) -> int:
        """Number of different changed timetables that were run, now or in an earlier search whose trials are kept."""
        return len(self._used)

    @property
    def over(self) -> bool:
        """Whether nothing more may be tried."""
        return self._stop.is_set() or time.monotonic() > self._until

    def stop_if(self, over: bool) -> None:
        """Let no further run begin if all is over."""
        if over:
            self._stop.set()

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
            with self._lock:
                late = self._known.get(key)
            if late is None:
                late = {name: float(value) for name, value in self._lateness(changed).items()}
                self._keep(key, late)
        except InputError:
            return REFUSED
        self._used.add(key)
        return judged(late, self.tolerance_s)

    def _keep(self, key: str, late: dict[str, float]) -> None:
        with self._lock:
            self._known[key] = late
            self._used.add(key)
            if self._folder is not None:
                with failures_told(self._folder, what="trials of the search"):
                    self._folder.mkdir(parents=True, exist_ok=True)
                    write_json(self._folder / FILE, {"format": 1, "trials": _told(self._known)})
            if self._progress is not None:
                self._progress(self.tried, max(self.planned, self.tried))


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
