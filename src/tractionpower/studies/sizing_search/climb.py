"""The search itself: build more where a limit is missed, then less where that leaves all limits kept.

What is tried is run on few cases: more on those that miss a limit, less on those in which it is used most. What is found is
run on all cases; one that misses a limit then is among those on which less is tried from then on, and the search goes on.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from tractionpower.studies.sizing_search.items import Design, Item, cost_of
from tractionpower.studies.sizing_search.shortfalls import CaseFacts, Shortfall

MOST_LOADED = 3
"""Cases in which an item is used most: less of it is tried on these."""

BETTER = 1e-6
"""A step that lessens what is missed by no more than this does not help."""


class StoppedError(Exception):
    """The search was stopped while cases were run, so that nothing can be said of the design."""


class Evaluator(Protocol):
    """Runs designs."""

    def evaluate(self, design: Design, only: Collection[str] | None = None) -> dict[str, CaseFacts]:
        """Return the facts of all cases, or of some, by name; of cases that a design does not have nothing.

        Raises
        ------
        StoppedError
            If not all of them were run.
        """

    def helps(self, shortfall: Shortfall) -> Sequence[str]:
        """Return the items of which more may lessen a shortfall, the nearest first."""

    @property
    def spent(self) -> bool:
        """Whether nothing more may be tried."""


@dataclass(frozen=True, slots=True)
class Step:
    """A step of the search: what was changed, from what to what, and why."""

    item: str
    before: str
    after: str
    why: str


@dataclass(slots=True)
class Climb:
    """A search in the making.

    Attributes
    ----------
    items
        What may be varied.
    evaluator
        Runs designs.
    design
        What has been found.
    steps
        How.
    facts
        Facts of the cases, each of the design with which it was run last.
    verified
        Whether `facts` are those of all cases.
    stuck
        Shortfalls that no step lessens.
    """

    items: Mapping[str, Item]
    evaluator: Evaluator
    design: dict[str, int] = field(default_factory=dict)
    steps: list[Step] = field(default_factory=list)
    facts: dict[str, CaseFacts] = field(default_factory=dict)
    verified: bool = False
    stuck: tuple[Shortfall, ...] = ()
    _betrayed: set[str] = field(default_factory=set)  # cases that missed a limit when all were run again
    _kept: set[str] = field(default_factory=set)  # items of which less has been refused since something was built

    def run(self) -> None:
        """Search until the design holds and nothing can be saved, or nothing more may be tried."""
        try:
            self._search()
        except StoppedError:
            self.verified = False

    def _search(self) -> None:
        self._verify()
        while not self.evaluator.spent and not self.stuck:
            if self.shortfalls:
                self._repair()
            elif not self._lessen():
                if self.verified:
                    return
                self._verify()
        if not self.verified:  # what is told of a design that was left in the middle is told of all cases, too
            self._verify()

    @property
    def shortfalls(self) -> tuple[Shortfall, ...]:
        """What the design misses, the worst first."""
        found = [item for facts in self.facts.values() for item in facts.shortfalls]
        return tuple(sorted(found, key=lambda item: (-item.excess, item.case, item.subject)))

    @property
    def cost(self) -> float:
        """Cost of the design, in points."""
        return cost_of(self.items, self.design)

    def _verify(self) -> None:
        is_again = bool(self.facts)
        self.facts = self.evaluator.evaluate(self.design)
        self.verified = True
        if is_again:
            self._betrayed |= self._missing

    @property
    def _missing(self) -> set[str]:
        """Cases that miss a limit."""
        return {case for case, facts in self.facts.items() if facts.shortfalls}

    # -- more ----------------------------------------------------------------------------------------------------

    def _repair(self) -> None:
        """Lessen the worst shortfall that some step lessens, by the step that does most for its cost."""
        for shortfall in self.shortfalls:
            best = max(self._trials(shortfall), key=lambda trial: trial[0], default=None)
            if best is not None and best[0] > 0.0:
                self._take(best[1], best[2], shortfall.words)
                self._kept.clear()  # with more here, less may do elsewhere
                return
        self.stuck = self.shortfalls

    def _trials(self, shortfall: Shortfall) -> Iterator[tuple[float, str, int]]:
        """Yield what each step that may help saves of the shortfall's case for each point, its item and the new rung."""
        case = shortfall.case
        before = self.facts[case].excess
        for name in self.evaluator.helps(shortfall):
            item = self.items[name]
            rung = self._next_rung(item, shortfall)
            if rung is None or self.evaluator.spent:
                continue
            facts = self.evaluator.evaluate({**self.design, name: rung}, (case,))
            saved = before - facts[case].excess if case in facts else 0.0
            cost = max(item.rungs[rung].cost - item.at(self.design).cost, BETTER)
            if saved > BETTER:
                yield saved / cost, name, rung

    def _next_rung(self, item: Item, shortfall: Shortfall) -> int | None:
        """Return the rung that should do, None where there is none above."""
        now = self.design.get(item.name, item.declared)
        if now + 1 >= len(item.rungs):
            return None
        if shortfall.what != "device" or item.kind == "contact_line":
            return now + 1
        needed = item.rungs[now].cost * (1.0 + shortfall.excess)  # units and cables share the current evenly
        return next((k for k in range(now + 1, len(item.rungs)) if item.rungs[k].cost >= needed - BETTER), len(item.rungs) - 1)

    def _take(self, name: str, rung: int, why: str) -> None:
        """Go over to another rung of an item and run the cases that miss a limit."""
        facts = self.evaluator.evaluate({**self.design, name: rung}, self._missing)
        self._adopt(name, rung, why)
        self.facts |= facts

    def _adopt(self, name: str, rung: int, why: str) -> None:
        item = self.items[name]
        self.steps.append(Step(name, item.at(self.design).words, item.rungs[rung].words, why))
        self.design[name] = rung
        self.verified = False

    # -- less ----------------------------------------------------------------------------------------------------

    def _lessen(self) -> bool:
        """Take the dearest item one rung down that the cases which load it most do without; tell whether there was one."""
        wasted = [item for item in self.items.values() if self._may_lessen(item)]
        for item in sorted(wasted, key=lambda item: (-self._saving(item), self._use(item), item.name)):
            if self.evaluator.spent:
                return False
            rung = self.design.get(item.name, item.declared) - 1
            less = {**self.design, item.name: rung}
            facts = self.evaluator.evaluate(less, {*self._betrayed, *self._worst_cases(item)})
            if any(found.shortfalls for found in facts.values()):
                self._kept.add(item.name)
                continue
            self._adopt(item.name, rung, "all limits are kept with less")
            self.facts |= facts
            return True
        return False

    def _may_lessen(self, item: Item) -> bool:
        """Tell whether less of an item has not been refused; whether it does is not reckoned, since its neighbours help out."""
        now = self.design.get(item.name, item.declared)
        return now > 0 and item.name not in self._kept and item.kind != "contact_line"

    def _saving(self, item: Item) -> float:
        now = self.design.get(item.name, item.declared)
        return item.rungs[now].cost - item.rungs[now - 1].cost

    def _devices(self, item: Item) -> tuple[str, ...]:
        return (f"{item.station} unit",) if item.kind == "units" else (item.name.removeprefix("cables of "),)

    def _use(self, item: Item) -> float:
        """Return the highest utilisation of an item in the cases that are known [%]."""
        devices = self._devices(item)
        return max((facts.utilisation.get(device, 0.0) for facts in self.facts.values() for device in devices), default=0.0)

    def _worst_cases(self, item: Item) -> list[str]:
        devices = self._devices(item)
        used = {case: max(facts.utilisation.get(device, 0.0) for device in devices) for case, facts in self.facts.items()}
        return sorted(used, key=lambda case: (-used[case], case))[:MOST_LOADED]
