"""The timed calls of one train as a chain: how late it is at each, and what lies between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.calls import AT_END_M
from tractionpower.movement.alone import running_at_calls
from tractionpower.movement.compile import PlannedRun
from tractionpower.movement.journey import JourneyCall
from tractionpower.studies.feasibility.alone import AloneTimes
from tractionpower.studies.feasibility.parts import Elapsed, Lateness, carry_on, start_lateness
from tractionpower.studies.feasibility.recording import LEAST_S, Trace

Floats = NDArray[np.float64]

START = -1
"""Number of the call where a run begins."""


@dataclass(frozen=True, eq=False)
class TrainFacts:
    """What the run with the network and those alone tell of one train.

    Attributes
    ----------
    planned, calls
        The run on its route, and its calls with the times of the run with the network.
    entered_s, due_s, reached_m
        When it came onto the line, or took the place of others [s], NaN if it did not; when it should have by its timetable
        [s]; how far it came [m].
    finished_s, is_stuck
        When it came to the end of its run [s], NaN if it did not; whether it cannot go on.
    trace, alone
        What was recorded of it, and its running times alone.
    has_plan
        Whether it is not always driven flat out.
    """

    planned: PlannedRun
    calls: tuple[JourneyCall, ...]
    entered_s: float
    due_s: float
    reached_m: float
    finished_s: float
    is_stuck: bool
    trace: Trace
    alone: AloneTimes
    has_plan: bool

    @property
    def name(self) -> str:
        """Identifier of the run."""
        return self.planned.run.id

    @property
    def is_finished(self) -> bool:
        """Whether it came to the end of its run."""
        return bool(np.isfinite(self.finished_s))

    @cached_property
    def held_s(self) -> Floats:
        """For how long it stood on its way since effort or voltage lacked, by step of its trace [s]."""
        stops = [
            (call.arrival_s, call.departure_s if np.isfinite(call.departure_s) else np.inf)
            for call in self.calls
            if call.kind == "stop" and np.isfinite(call.arrival_s)
        ]
        return self.trace.held([*stops, *([(self.finished_s, np.inf)] if self.is_finished else [])])

    def held_until(self, time_s: float) -> float:
        """Return for how long it had stood on its way by a time [s]."""
        return float(self.held_s[self.trace.begins_s < time_s - LEAST_S].sum())


@dataclass(frozen=True, slots=True)
class Event:
    """A timed arrival, departure or passing; `call` is its number, `START` the start of the run. Times in s."""

    call: int
    kind: str
    planned_s: float
    actual_s: float

    @property
    def order(self) -> int:
        """Place in the order of all arrivals and departures."""
        return 2 * self.call + (self.kind == "departure")


@dataclass(frozen=True, slots=True)
class Link:
    """From one timed call to the next: what lies between, and how late the train is at its end; None where it did not come."""

    before: Event
    event: Event
    elapsed: Elapsed | None
    lateness: Lateness | None
    shortest_s: float
    limited_s: float
    recorded_s: float
    planned_s: float
    moves: bool


@dataclass(frozen=True, eq=False)
class Chain:
    """The timed calls of a train in their order.

    Attributes
    ----------
    start
        Lateness at the start of the run.
    links
        One for each timed call.
    spare
        Time by which the train could come before each timed call, flat out on the recorded voltages [s], by number of link.
    """

    start: Lateness
    links: list[Link] = field(default_factory=list)
    spare: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def end(self) -> Lateness:
        """Lateness at the last timed call that the train came to."""
        return next((link.lateness for link in reversed(self.links) if link.lateness is not None), self.start)


class RunningAt:
    """Running times of a train until its calls, and until the start of its run."""

    def __init__(self, facts: TrainFacts) -> None:
        calls, alone = facts.calls, facts.alone
        arrived = np.array([call.arrival_s for call in calls])
        stops = np.array([call.kind == "stop" for call in calls], bool)
        left = np.array([call.departure_s for call in calls])
        actual = running_at_calls(facts.entered_s, stops, arrived, left)
        held = np.array([facts.held_until(time_s) if np.isfinite(time_s) else 0.0 for time_s in arrived])
        come = np.isfinite(actual)
        recorded = np.where(come, alone.recorded.at_calls_s + held, np.nan)  # what it stood for want of voltage is lost to it
        self._of = {
            "actual": actual, "recorded": recorded, "limited": alone.limited.at_calls_s, "shortest": alone.shortest.at_calls_s,
        }  # fmt: skip

    def between(self, kind: str, before: int, after: int) -> float:
        """Return the running time from one call to another [s]; NaN where it is not known."""
        values = self._of[kind]
        return float(values[after] - (values[before] if before != START else 0.0)) if after != START else 0.0


def timed_events(facts: TrainFacts) -> Iterator[Event]:
    """Yield the arrivals, departures and passings of a train that the timetable has a time for, but no arrival at its start."""
    for k, call in enumerate(facts.calls):
        arrival, departure = call.planned_arrival_s, call.planned_departure_s
        if call.kind == "pass":
            planned = arrival if arrival is not None else departure
            if planned is not None:
                yield Event(k, "pass", planned, call.arrival_s)
            continue
        if arrival is not None and call.at_m >= AT_END_M:
            yield Event(k, "arrival", arrival, call.arrival_s)
        if departure is not None:
            yield Event(k, "departure", departure, call.departure_s)


def chain_of(facts: TrainFacts, inherited: Mapping[str, float]) -> Chain:
    """Return the chain of a train; `inherited` are the origins of the delay at the end of the run that it comes from [s]."""
    events = list(timed_events(facts))
    start = Event(START, "departure", facts.due_s, facts.entered_s)
    late = facts.entered_s - facts.due_s if np.isfinite(facts.entered_s) else 0.0
    lateness: Lateness | None = start_lateness(late, _origins_of_start(late, inherited))
    assert lateness is not None
    chain, running, before = Chain(lateness), RunningAt(facts), start
    for event in events:
        link = _link(facts, running, (before, event), lateness)
        chain.links.append(link)
        before, lateness = event, link.lateness
    return Chain(chain.start, chain.links, _spare(facts, running, chain.links))


def _origins_of_start(late_s: float, inherited: Mapping[str, float]) -> dict[str, float]:
    """Return why a run starts late [s]: by what the train brings along, the rest by its turn-round."""
    brought = sum(inherited.values())
    share = min(1.0, max(late_s, 0.0) / brought) if brought > 0.0 else 0.0
    origins = {name: share * value for name, value in inherited.items()}
    return origins | {"dwell": origins.get("dwell", 0.0) + max(late_s, 0.0) - share * brought}


def _link(facts: TrainFacts, running: RunningAt, ends: tuple[Event, Event], before: Lateness | None) -> Link:
    first, event = ends
    dwells = [
        k for k, call in enumerate(facts.calls) if call.kind == "stop" and first.order <= 2 * k and 2 * k + 1 <= event.order
    ]
    from_m = facts.calls[first.call].at_m if first.call != START else 0.0
    moves = facts.calls[event.call].at_m - from_m >= AT_END_M
    whole = event.planned_s - first.planned_s
    planned_dwell = sum(_least_dwell(facts, k) for k in dwells) if moves else whole
    planned = whole - planned_dwell
    times = {kind: running.between(kind, first.call, event.call) for kind in ("shortest", "limited", "recorded", "actual")}
    elapsed = lateness = None
    if np.isfinite(event.actual_s) and before is not None:
        dwell = event.actual_s - first.actual_s - times["actual"]
        elapsed = Elapsed(planned, *_filled(times, facts.has_plan), planned_dwell, dwell)
        lateness = carry_on(before, elapsed)
    return Link(first, event, elapsed, lateness, times["shortest"], times["limited"], times["recorded"], planned, moves)


def _filled(times: Mapping[str, float], has_plan: bool) -> tuple[float, float, float, float]:
    """Return shortest, limited, recorded and actual running time [s]; where a train alone is stuck, the next one counts."""
    actual = times["actual"]
    recorded = times["recorded"] if has_plan and np.isfinite(times["recorded"]) else actual  # flat out: no loss by driving
    limited = times["limited"] if np.isfinite(times["limited"]) else recorded
    return times["shortest"] if np.isfinite(times["shortest"]) else limited, limited, recorded, actual


def _least_dwell(facts: TrainFacts, k: int) -> float:
    return facts.planned.calls[k].call.min_dwell_s if facts.calls[k].at_m >= AT_END_M else 0.0


def _spare(facts: TrainFacts, running: RunningAt, links: list[Link]) -> Floats:
    """Return how much earlier the train could come than planned at each timed call [s], flat out on the recorded voltages.

    It leaves no stop before its planned departure, and stands for its shortest dwell.
    """
    timed = {link.event.order: n for n, link in enumerate(links)}
    spare, now, last = np.full(len(links), np.nan), facts.entered_s, START
    for k, call in enumerate(facts.calls):
        now += running.between("recorded", last, k)
        last = k
        n = timed.get(2 * k)
        if n is not None:
            spare[n] = links[n].event.planned_s - now
        if call.kind != "stop":
            continue
        now += _least_dwell(facts, k)
        if call.planned_departure_s is not None:
            if (n := timed.get(2 * k + 1)) is not None and call.planned_departure_s < now:
                spare[n] = call.planned_departure_s - now
            now = max(now, call.planned_departure_s)
    return spare
