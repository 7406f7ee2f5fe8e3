"""The timed calls of one train as a chain: how late it is at each, and what lies between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tractionpower.cosimulation.calls import AT_END_M
from tractionpower.movement.alone import running_at_calls
from tractionpower.movement.compile import PlannedRun
from tractionpower.movement.journey import JourneyCall
from tractionpower.studies.feasibility.alone import AloneTimes
from tractionpower.studies.feasibility.parts import ON_TIME, RUNNING, Lateness, Ruled, Stage, ruled, split
from tractionpower.studies.feasibility.recording import LEAST_S, Trace

Floats = NDArray[np.float64]

START = -1
"""Number of the call where a run begins."""

KINDS = ("shortest", "limited", "recorded", "actual")
"""Running times of a section."""


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
    """From one timed call to the next: how late the train is at its end, None where it did not come; and running times [s].

    `moves` tells whether it runs between them at all.
    """

    before: Event
    event: Event
    lateness: Lateness | None
    shortest_s: float
    limited_s: float
    recorded_s: float
    actual_s: float
    planned_s: float
    moves: bool


@dataclass(frozen=True, eq=False)
class Chain:
    """The timed calls of a train in their order.

    Attributes
    ----------
    ruled, is_plain
        Times by the rules; whether it is driven flat out, and was before.
    start
        Lateness at the end of the run that it was before.
    links
        One for each timed call.
    spare
        Time by which the train could come before each timed call, flat out on the recorded voltages [s], by number of link.
    """

    ruled: Ruled
    is_plain: bool
    start: Lateness
    links: list[Link] = field(default_factory=list)
    spare: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def end(self) -> Lateness:
        """Lateness at the last timed call that the train came to."""
        return next((link.lateness for link in reversed(self.links) if link.lateness is not None), self.start)


@dataclass(frozen=True, eq=False)
class Before:
    """A run that becomes another one: what is known of it, its chain, and the shortest turn-round [s]."""

    facts: TrainFacts
    chain: Chain
    turn_s: float


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
        self._facts, self._stood = facts, float(np.nansum((np.where(np.isfinite(left), left, facts.finished_s) - arrived)[stops]))

    def between(self, kind: str, before: int, after: int) -> float:
        """Return the running time from one call to another [s]; NaN where it is not known."""
        values = self._of[kind]
        return float(values[after] - (values[before] if before != START else 0.0)) if after != START else 0.0

    def to_end(self, before: int) -> dict[str, float]:
        """Return the running times from a call to the end of the run [s], by kind."""
        facts = self._facts
        if before != START and facts.planned.route_m - facts.calls[before].at_m < AT_END_M:
            return dict.fromkeys(KINDS, 0.0)
        end = np.array([facts.planned.route_m])
        alone = {name: float(getattr(facts.alone, name).until(end)[0]) for name in ("shortest", "limited", "recorded")}
        alone["recorded"] += facts.held_until(facts.finished_s)
        whole = alone | {"actual": facts.finished_s - facts.entered_s - self._stood}
        return {kind: whole[kind] - (float(self._of[kind][before]) if before != START else 0.0) for kind in KINDS}


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


def chain_of(facts: TrainFacts, before: Sequence[Before] = ()) -> Chain:
    """Return the chain of a train; `before` are the runs that it was before, that which ends last at the end."""
    running = RunningAt(facts)
    is_plain = not facts.has_plan and all(each.chain.is_plain for each in before)
    times = ruled(_begin(facts, before), *_stages(facts, running))
    start = Event(START, "departure", facts.due_s, facts.entered_s)
    first, lateness = start, before[-1].chain.end if before else ON_TIME
    chain = Chain(times, is_plain, lateness)
    for event in timed_events(facts):
        found = None
        if np.isfinite(event.actual_s):
            late = (times.left_s if event.kind == "departure" else times.arrived_s)[event.call] - event.planned_s
            if is_plain:  # flat out on its recorded voltages is how it ran
                late = np.append(late[:-1], event.actual_s - event.planned_s)
            found = lateness = split(event.actual_s - event.planned_s, late, lateness.origins)
        chain.links.append(_link(facts, running, (first, event), found))
        first = event
    return replace(chain, spare=_spare(facts, running, chain.links))


def _begin(facts: TrainFacts, before: Sequence[Before]) -> Floats:
    """Return when a run begins, by chain [s]: not before its planned start, and when all that become it are ready."""
    if not before:
        begin = np.full(len(RUNNING), facts.entered_s)
        begin[0] = min(begin[0], facts.planned.start_s)
        return begin
    ready = [each.chain.ruled.finished_s + np.append(_planned_turn(each, facts), [each.turn_s] * 3) for each in before]
    return np.asarray(np.maximum(np.max(ready, axis=0), facts.planned.start_s))


def _planned_turn(before: Before, facts: TrainFacts) -> float:
    """Return the shortest turn-round, as far as the timetable plans it [s]."""
    last = before.facts.calls[-1] if before.facts.calls else None
    if last is None or before.facts.planned.route_m - last.at_m >= AT_END_M:
        return before.turn_s
    ends = last.planned_departure_s
    if ends is None and last.planned_arrival_s is not None:
        ends = last.planned_arrival_s + (least_dwell(before.facts, len(before.facts.calls) - 1) if last.kind == "stop" else 0.0)
    if ends is None:
        return before.turn_s
    first = facts.calls[0] if facts.calls else None
    begins = facts.planned.start_s
    if first is not None and first.kind == "stop" and first.at_m < AT_END_M and first.planned_departure_s is not None:
        begins = max(begins, first.planned_departure_s)
    return min(before.turn_s, max(begins - ends, 0.0))


def _stages(facts: TrainFacts, running: RunningAt) -> tuple[list[Stage], Floats]:
    """Return the calls as the rules see them, and the running time behind the last one by chain [s]."""
    stages = []
    for k, call in enumerate(facts.calls):
        times = filled({kind: running.between(kind, k - 1, k) for kind in KINDS}, facts.has_plan)
        dwell = None
        if call.kind == "stop":
            least = least_dwell(facts, k)
            arrival, departure = call.planned_arrival_s, call.planned_departure_s
            planned = least if arrival is None or departure is None else min(least, max(departure - arrival, 0.0))
            dwell = np.array([planned, least, least, least])
        stages.append(Stage(np.array([times[kind] for kind in RUNNING]), dwell, call.planned_departure_s))
    rest = filled(running.to_end(len(stages) - 1), facts.has_plan) if facts.is_finished else dict.fromkeys(KINDS, np.nan)
    return stages, np.array([rest[kind] for kind in RUNNING])


def _link(facts: TrainFacts, running: RunningAt, ends: tuple[Event, Event], lateness: Lateness | None) -> Link:
    first, event = ends
    dwells = [
        k for k, call in enumerate(facts.calls) if call.kind == "stop" and first.order <= 2 * k and 2 * k + 1 <= event.order
    ]
    from_m = facts.calls[first.call].at_m if first.call != START else 0.0
    moves = facts.calls[event.call].at_m - from_m >= AT_END_M
    whole = event.planned_s - first.planned_s
    planned = whole - sum(least_dwell(facts, k) for k in dwells) if moves else 0.0
    times = {kind: running.between(kind, first.call, event.call) for kind in KINDS}
    return Link(first, event, lateness, times["shortest"], times["limited"], times["recorded"], times["actual"], planned, moves)


def filled(times: Mapping[str, float], has_plan: bool) -> dict[str, float]:
    """Return running times [s] where a train alone that is stuck has the next ones; without a plan it is driven flat out."""
    actual = times["actual"]
    recorded = times["recorded"] if has_plan and np.isfinite(times["recorded"]) else actual
    limited = times["limited"] if np.isfinite(times["limited"]) else recorded
    shortest = times["shortest"] if np.isfinite(times["shortest"]) else limited
    return {"shortest": shortest, "limited": limited, "recorded": recorded, "actual": actual}


def least_dwell(facts: TrainFacts, k: int) -> float:
    """Return the shortest time at a call [s]; none where a run begins."""
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
        now += least_dwell(facts, k)
        if call.planned_departure_s is not None:
            if (n := timed.get(2 * k + 1)) is not None and call.planned_departure_s < now:
                spare[n] = call.planned_departure_s - now
            now = max(now, call.planned_departure_s)
    return spare
