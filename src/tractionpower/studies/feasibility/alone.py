"""Every train alone: flat out at nominal voltage, with its current limits, and on the voltages that it got."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.train_tables import POINT, TrainTables
from tractionpower.model.scenario import Scenario
from tractionpower.movement.alone import RunningTimes, leave_at, run_alone
from tractionpower.movement.compile import compile_trains
from tractionpower.studies.feasibility.recording import Trace

Floats = NDArray[np.float64]

WORKERS = 2
"""Threads; kernels hold no lock."""

_NEVER_THE_SAME = 1e-6
_OF_THE_RUN = ("start_s", "first_stop", "first_turn", "turns", "waits", "takes_over")


@dataclass(frozen=True, eq=False)
class AloneTimes:
    """Running times of one run alone.

    Attributes
    ----------
    shortest
        At nominal voltage, flat out, without current limits of line and run.
    limited
        The same with these limits.
    recorded
        The same on the voltages that the run with the network recorded over its way.
    """

    shortest: RunningTimes
    limited: RunningTimes
    recorded: RunningTimes


def flat_out(scenario: Scenario, *, limits: bool) -> Scenario:
    """Return a scenario in which all trains are driven flat out, with or without current limits of line and runs."""
    freed: dict[str, Any] = {"driving": None} | ({} if limits else {"max_current_a": None, "max_power_kw": None})
    given = scenario.timetable
    timetable = given.model_copy(
        update={
            "driving": None,
            "trains": tuple(run.model_copy(update=freed) for run in given.trains),
            "services": tuple(service.model_copy(update=freed) for service in given.services),
        }
    )
    line = scenario.line if limits else scenario.line.model_copy(update={"train_current_limits": ()})
    return scenario.model_copy(update={"timetable": timetable, "line": line})


def has_limits(scenario: Scenario) -> bool:
    """Tell whether the line or a run limits the current of trains."""
    trips = (*scenario.timetable.trains, *scenario.timetable.services)
    capped = any(trip.max_current_a is not None or trip.max_power_kw is not None for trip in trips)
    return capped or bool(scenario.line.train_current_limits)


def run_all_alone(scenario: Scenario, entered_s: Floats, left_s: Floats, traces: Sequence[Trace]) -> list[AloneTimes]:
    """Return the times alone of all runs, by number; equal runs at nominal voltage are computed once.

    Each leaves its stops when it did with the network, if it can: then steps begin at the same times, and what differs are
    not their roundings.

    Parameters
    ----------
    scenario
        What was run with the network.
    entered_s
        When each train entered [s]; NaN: by its timetable.
    left_s
        When each left its calls [s], by row of the stops.
    traces
        What was recorded of each, for the voltages.
    """
    limited = compile_trains(flat_out(scenario, limits=True))
    free = compile_trains(flat_out(scenario, limits=False)) if has_limits(scenario) else limited
    entered_s = np.where(np.isfinite(entered_s), entered_s, [planned.start_s for planned in limited.runs])
    step, nominal_v = scenario.clock.step_s, limited.voltages.u_n
    starts = scenario.clock.start + np.floor((entered_s - scenario.clock.start) / step) * step
    nominal = np.array([(0.0, nominal_v)], POINT)
    coupled_v = scenario.coupling_voltage_v or nominal_v
    own = [trace.voltages(nominal_v) for trace in traces]
    if scenario.coupling != "full":  # the voltages that the trains cause do not limit them
        own = [np.array([(0.0, coupled_v)], POINT)] * len(traces)
    with ThreadPoolExecutor(WORKERS) as threads:
        tables = leave_at(limited, entered_s, left_s)
        shares = _Shared(tables, starts, step, nominal, threads.submit)
        capped = [shares.run(k) for k in range(len(starts))]
        if free is not limited:
            shares = _Shared(leave_at(free, entered_s, left_s), starts, step, nominal, threads.submit)
        shortest = [shares.run(k) for k in range(len(starts))]
        recorded = [threads.submit(run_alone, tables, k, (starts[k], step), own[k]) for k in range(len(starts))]
        return [AloneTimes(a.result(), b.result(), c.result()) for a, b, c in zip(shortest, capped, recorded, strict=True)]


class _Shared:
    """Runs at nominal voltage, equal ones once: equal train, way, and times after the start of its first step."""

    def __init__(
        self, tables: TrainTables, starts: Floats, step: float, voltage: NDArray[np.void], submit: Callable[..., Any]
    ) -> None:
        self._tables, self._starts, self._step, self._voltage, self._submit = tables, starts, step, voltage, submit
        self._known: dict[tuple[Any, ...], Any] = {}

    def run(self, k: int) -> Any:
        """Return the future of the running times of train `k`."""
        key = self._key(k)
        if key not in self._known:
            self._known[key] = self._submit(run_alone, self._tables, k, (self._starts[k], self._step), self._voltage)
        return self._known[key]

    def _key(self, k: int) -> tuple[Any, ...]:
        train = self._tables.trains[k].copy()
        stops = self._tables.stops[train["first_stop"] : train["first_stop"] + train["stops"]].copy()
        after = np.round((np.append(stops["departure_s"], train["start_s"]) - self._starts[k]) / _NEVER_THE_SAME)
        stops["departure_s"] = 0.0
        for name in _OF_THE_RUN:
            train[name] = 0
        return train.item(), tuple(stops.tolist()), after.tobytes()
