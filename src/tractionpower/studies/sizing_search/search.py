"""Find the least equipment with which a study meets its limits, and say how it was found and what remains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.model.library import Library
from tractionpower.model.scenario import Scenario
from tractionpower.studies.runner.store import CaseStore
from tractionpower.studies.sizing_search.climb import Climb, Step
from tractionpower.studies.sizing_search.items import Item, changes_of, cost_of, items_of
from tractionpower.studies.sizing_search.shortfalls import Shortfall
from tractionpower.studies.sizing_search.trials import Told, Trials


@dataclass(frozen=True, slots=True)
class Chosen:
    """One item of the design that was found."""

    item: str
    declared: str
    found: str
    why: str


@dataclass(frozen=True, slots=True)
class SizingFound:
    """What the search came to.

    Attributes
    ----------
    holds
        Whether the design meets all limits in all cases.
    verified
        Whether all cases were run with the design as it is.
    design
        Items that differ from what is declared, or that were varied.
    changes
        The design as changes by path, as for ``--set``.
    cost_declared, cost_found
        Costs of all items, in points.
    remaining
        Limits that are missed, the worst first.
    steps
        How it was found.
    rounds, runs
        Designs looked at, and runs made for them.
    cases
        Cases that a design is held against.
    interrupted
        Whether Ctrl-C ended the search.
    """

    holds: bool
    verified: bool
    design: tuple[Chosen, ...]
    changes: tuple[str, ...]
    cost_declared: float
    cost_found: float
    remaining: tuple[Shortfall, ...]
    steps: tuple[Step, ...]
    rounds: int
    runs: int
    cases: int
    interrupted: bool

    def notes(self) -> dict[str, Any]:
        """Return what ``run.json`` says of the search."""
        names = ("holds", "verified", "cost_declared", "cost_found", "rounds", "runs", "cases", "interrupted")
        return {
            **{name: getattr(self, name) for name in names},
            "changes": list(self.changes),
            "design": [{"item": c.item, "declared": c.declared, "found": c.found, "why": c.why} for c in self.design],
            "remaining": [{"case": item.case, "words": item.words} for item in self.remaining],
            "steps": [{"item": s.item, "from": s.before, "to": s.after, "why": s.why} for s in self.steps],
        }


def varied_items(scenario: Scenario) -> dict[str, Item]:
    """Return what a search varies, by name.

    Raises
    ------
    UsageError
        If there is nothing.
    """
    items = items_of(scenario)
    if not items:
        remedy = "give substations units and a unit_resistance_ohm, feeders cables, or name contact lines in sizing.search"
        raise UsageError(f"the search has nothing to vary; {remedy}")
    return items


def search(
    scenario: Scenario,
    library: Library,
    store: CaseStore | None = None,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Told | None = None,
) -> SizingFound:
    """Search for the least equipment that meets the limits.

    More is built where a limit is missed, by the step that does most for its cost; then less, where all limits are kept with
    less. The ratings of all devices and the lowest voltage hold in every case (normal operation, and with
    ``sizing.search.outages`` every single outage), the mean useful voltage in normal operation. The design that is returned
    is run in all cases before it is called verified. Of that design no single item could be lessened by one rung; another
    combination may be cheaper.

    Parameters
    ----------
    scenario, library
        What is sized, within the bounds ``sizing.search``, and the tables of equipment.
    store
        Keeps what was run, so that a search that was stopped goes on; left out: in memory.
    workers, scheduler
        As of `tractionpower.studies.runner.run.run_cases`.
    progress
        Called whenever a case has ended, with what is being run.

    Raises
    ------
    InputError
        If the scenario has errors; all of them are told.
    UsageError
        If there is nothing to vary.
    """
    items = varied_items(scenario)
    trials = Trials(
        scenario, library, items, CaseStore() if store is None else store, workers=workers, scheduler=scheduler, progress=progress
    )
    climb = Climb(items, trials)
    climb.run()
    last = {step.item: step.why for step in climb.steps}
    moved = [name for name in sorted(climb.design) if climb.design[name] != items[name].declared]
    design = tuple(Chosen(name, items[name].at({}).words, items[name].at(climb.design).words, last[name]) for name in moved)
    return SizingFound(
        holds=not climb.shortfalls and climb.verified and not trials.interrupted,
        verified=climb.verified and not trials.interrupted,
        design=design,
        changes=changes_of(items, climb.design),
        cost_declared=cost_of(items, {}),
        cost_found=climb.cost,
        remaining=climb.shortfalls,
        steps=tuple(climb.steps),
        rounds=trials.rounds,
        runs=trials.runs,
        cases=len(climb.facts),
        interrupted=trials.interrupted,
    )
