"""What is switched while a run lasts: by the time of day, by trips and reclosures, by voltage-limiting devices.

Nothing switches inside a step. What is due at a time takes effect in the first step that starts then; what a step sets
off takes effect in the next one. A supply in other states is compiled like any other (`supply.states.with_states`), and
each set of states once; trains and whatever else the state of a run holds go on.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np

from tractionpower.cosimulation.tables import CompiledScenario, assemble
from tractionpower.kernels.block_tables import Buffers, State, rewired_state
from tractionpower.model.scenario import ROUNDING_S, Scenario
from tractionpower.model.supply import Supply
from tractionpower.model.switchgear import Protection
from tractionpower.supply.compile import SupplyTables
from tractionpower.supply.protection import Trigger, protections
from tractionpower.supply.states import Change, change_of, find_list, normal_value, with_states
from tractionpower.supply.stretches import Stretch

NOT_YET = 2**62

MOST_KNOWN = 64
"""So many sets of states are kept compiled."""


@dataclass(order=True)
class _Due:
    """A change of one device that is due at a time [s]."""

    time_s: float
    number: int
    device: str = field(compare=False)
    change: Change = field(compare=False)
    cause: str = field(compare=False)  # order, reclosure, reopening
    version: int = field(compare=False, default=0)  # of the device when it was planned


@dataclass
class _Breaker:
    """How often a breaker has closed by itself, and when it was closed last."""

    reclosures: int = 0
    closed_s: float = -math.inf


class Switchboard:
    """The supply in its present states.

    Parameters
    ----------
    scenario, compiled
        What runs, with all devices in their normal states.
    state
        State before the first step.

    Attributes
    ----------
    compiled
        Tables of the present states.
    state
        State that belongs to them.
    rows
        Events so far.
    """

    def __init__(self, scenario: Scenario, compiled: CompiledScenario, state: State) -> None:
        self.scenario, self.compiled, self.state = scenario, compiled, state
        self.rows: list[dict[str, Any]] = []
        self._number = count()
        self._changes: dict[str, dict[str, str | int]] = {}
        self._version: dict[str, int] = {}
        self._known = {frozenset[tuple[str, str, str | int]](): compiled}
        self._breakers: dict[str, _Breaker] = {}
        self._protections: dict[str, Protection] = protections(scenario.supply, compiled.supply.links)
        self._devices = {device.id: device for device in scenario.supply.voltage_limiting_devices}
        self._queue = [
            _Due(event.time, next(self._number), event.device, change_of(event), "order")
            for event in sorted(scenario.supply.switch_events, key=lambda event: (event.time, event.device))
        ]
        heapq.heapify(self._queue)
        clock = scenario.clock
        self._start_s, self._step_s = clock.start, clock.step_s
        self._dead_since: dict[tuple[str, float], float] = {}
        self._note_stretches(clock.start, None, compiled.supply)

    # -- what is due ----------------------------------------------------------------------------------------------

    @property
    def next_step(self) -> int:
        """The first step before which something is due."""
        return self._step_at(self._queue[0].time_s) if self._queue else NOT_YET

    def _step_at(self, time_s: float) -> int:
        return max(0, math.ceil((time_s - self._start_s - ROUNDING_S) / self._step_s))

    def move(self, step: int) -> None:
        """Do what is due before `step`; what an order before the clock has set is the state at the start."""
        moved = False
        while self._queue and self._step_at(self._queue[0].time_s) <= step:
            due = heapq.heappop(self._queue)
            if due.cause == "order" or due.version == self._version.get(due.device, 0):
                self._do(due, max(due.time_s, self._start_s))
                moved = True
        if moved:
            self._rewire(self._start_s + step * self._step_s)

    def _do(self, due: _Due, time_s: float) -> None:
        name, value = due.change
        self._changes.setdefault(due.device, {})[name] = value
        if due.cause == "order":
            self._version[due.device] = self._version.get(due.device, 0) + 1  # a planned reclosure is off
            self._breakers.pop(due.device, None)
        if due.device in self._protections and value == "closed":
            self._breakers.setdefault(due.device, _Breaker()).closed_s = time_s
        self._note("switched", due.device, time_s, change=due.change, cause=due.cause)

    # -- what a step sets off -------------------------------------------------------------------------------------

    def react(self, step: int, last: int, buffers: Buffers) -> None:
        """Do what the triggers ask for that row `last` of `buffers` has fired; `step` is the next one."""
        time_s = self._start_s + step * self._step_s
        supply, done = self.compiled.supply, set()
        for k in np.flatnonzero(self.state.fired).tolist():
            watched, trigger = supply.watched[k], supply.triggers[k]
            if watched.device in done:
                continue
            done.add(watched.device)
            if watched.kind == "overcurrent":
                self._trip(watched, time_s, float(buffers.link_a[last, trigger["index"]]))
            else:
                self._limit(watched, time_s, float(buffers.rail_v[last, trigger["index"]]))
        self._rewire(time_s)

    def _trip(self, watched: Trigger, time_s: float, current_a: float) -> None:
        settings, breaker = self._protections[watched.device], self._breakers.setdefault(watched.device, _Breaker())
        if time_s - breaker.closed_s > settings.reclaim_s:
            breaker.reclosures = 0
        self._changes.setdefault(watched.device, {})["state"] = "open"
        again = settings.reclose_after_s
        stays = again is None or breaker.reclosures >= settings.reclosures
        if again is not None and not stays:
            breaker.reclosures += 1
            self._plan(time_s + again, watched.device, ("state", "closed"), "reclosure")
        number = 0 if stays else breaker.reclosures
        self._note("tripped", watched.device, time_s, value=current_a, limit=watched.above, again_s=again, number=number)

    def _limit(self, watched: Trigger, time_s: float, potential_v: float) -> None:
        self._changes.setdefault(watched.device, {})["state"] = "closed"
        again = self._devices[watched.device].opens_after_s
        if again is not None:
            self._plan(time_s + again, watched.device, ("state", "open"), "reopening")
        self._note("vld_closed", watched.device, time_s, value=potential_v, limit=watched.above)

    def _plan(self, time_s: float, device: str, change: Change, cause: str) -> None:
        version = self._version[device] = self._version.get(device, 0) + 1
        heapq.heappush(self._queue, _Due(time_s, next(self._number), device, change, cause, version))

    # -- the network ----------------------------------------------------------------------------------------------

    def _rewire(self, time_s: float) -> None:
        """Go over to the tables of the present states."""
        before = self.compiled
        moved = ((device, name, value) for device, values in self._changes.items() for name, value in values.items())
        key = frozenset(change for change in moved if normal_value(self.scenario.supply, *change[:2]) != change[2])
        if key not in self._known:
            if len(self._known) >= MOST_KNOWN:
                del self._known[next(iter(self._known))]
            self._known[key] = assemble(self.scenario, before.movement, self.supply)
        self.compiled = self._known[key]
        self.state = rewired_state(self.state, before.block, self.compiled.block)
        self._note_stretches(time_s, before.supply, self.compiled.supply)
        self._note_returns(time_s, before.supply, self.compiled.supply)

    @property
    def supply(self) -> Supply:
        """The supply with all devices in their present states."""
        return with_states(self.scenario.supply, {device: values.items() for device, values in self._changes.items()})

    def _note_stretches(self, time_s: float, before: SupplyTables | None, after: SupplyTables) -> None:
        """Note which stretches of contact line lose their feed or get it back; at the start those that have none."""
        was = {(s.track, s.from_m): s.no_load_v > 0.0 for s in before.stretches} if before is not None else {}
        changed = [s for s in after.stretches if was.get((s.track, s.from_m), True) != (s.no_load_v > 0.0)]
        for track, from_km, to_km, live, since in _joined(self._turned(s, time_s) for s in changed):
            kind = "line_live" if live else "line_dead"
            details = {"track": track, "position_km": from_km, "to_km": to_km, "value": time_s - since if live else np.nan}
            self._note(kind, f"track {track}", time_s, **details)

    def _turned(self, stretch: Stretch, time_s: float) -> tuple[str, float, float, bool, float]:
        """Return track, ends [km], whether a stretch is live now, and since when it was or is dead [s]."""
        key, live = (stretch.track, stretch.from_m), stretch.no_load_v > 0.0
        since = self._dead_since.pop(key) if live else self._dead_since.setdefault(key, time_s)
        return stretch.track, *stretch.ends_km, live, since

    def _note_returns(self, time_s: float, before: SupplyTables, after: SupplyTables) -> None:
        """Note substations that feed no more, though they are in service: no return feeder is closed."""
        fed = (before.source_port >= 0) & (after.source_port < 0)
        for substation in (after.substations[k] for k in np.flatnonzero(fed).tolist()):
            if substation.feeds:
                self._note("switched", substation.id, time_s, change=("state", "feeds nothing"), cause="no_return")

    def _note(self, kind: str, subject: str, time_s: float, **details: Any) -> None:
        row: dict[str, Any] = {"time_s": time_s, "kind": kind, "subject": subject, "track": ""}
        row |= dict.fromkeys(("position_km", "value", "limit"), np.nan)
        if find_list(self.scenario.supply, subject) is not None:
            row |= _place(self.compiled.supply, self.scenario.supply, subject)
        self.rows.append(row | details)


Turned = tuple[str, float, float, bool, float]


def _joined(stretches: Iterator[Turned]) -> Iterator[Turned]:
    """Yield stretches (track, from km, to km, live, dead since) with neighbours joined."""
    last: Turned | None = None
    for item in sorted(stretches):
        if last is not None and (last[0], *last[3:]) == (item[0], *item[3:]) and item[1] - last[2] < 1e-3:
            last = (*last[:2], item[2], *last[3:])
            continue
        if last is not None:
            yield last
        last = item
    if last is not None:
        yield last


def _place(tables: SupplyTables, supply: Supply, device: str) -> dict[str, Any]:
    """Return track and kilometre of a device; a substation or section cabin is beside its tracks."""
    places = {point.id: (point.track, point.km) for point in supply.section_points}
    places |= {item.id: (item.track, item.km) for item in supply.voltage_limiting_devices}
    places |= {station.id: ("", station.km) for station in supply.substations}
    places |= {cabin.id: ("", cabin.km) for cabin in supply.section_cabins}
    places |= {link.id: (link.track, link.km) for link in tables.links}
    track, km = places[device]
    return {"track": track, "position_km": km}
