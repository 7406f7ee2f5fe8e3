"""Checks of categories: a speed limit and a train that mean the same one and write it in two ways."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tractionpower.errors import Problem
from tractionpower.io.wording import did_you_mean, nearest, shown
from tractionpower.model.line import SpeedLimit
from tractionpower.model.scenario import Scenario
from tractionpower.movement.declared import declared_runs
from tractionpower.movement.telling import doubt, item_paths, listed


def check_categories(scenario: Scenario) -> list[Problem]:
    """Return warnings of categories that only speed limits or only trains name, where the other side has nearly the same.

    Without such a neighbour there is nothing to tell: other trains may run on another day.
    """
    named = _of_limits(scenario.line.speed_limits)
    trains = {train.id for train in scenario.trains}
    runs = [item.run for item in declared_runs(scenario)]
    if not named or not runs or any(run.train is not None and run.train not in trains for run in runs):
        return []
    owned = _of_trains(scenario)
    problems = []
    for name in named:
        if name not in owned and nearest(name, owned):
            found = f"{shown(name)}, a category that no train of the timetable has"
            problems.append(doubt("unused_category", named[name], found, listed(sorted(owned)), did_you_mean(name, owned)))
    for name, path in owned.items():
        if name not in named and nearest(name, named) in owned:  # else it is told at the speed limit
            found = f"{shown(name)}, a category that no row of line.speed_limits names"
            problems.append(doubt("unused_category", path, found, listed(sorted(named)), did_you_mean(name, named)))
    return problems


def _of_limits(rows: Sequence[SpeedLimit]) -> Mapping[str, str]:
    """Return the path of each category where a speed limit first names it."""
    found: dict[str, str] = {}
    for k, row in enumerate(rows):
        if row.category is not None:
            found.setdefault(row.category, f"line.speed_limits[{k}].category")
    return found


def _of_trains(scenario: Scenario) -> Mapping[str, str]:
    """Return the path of each category where a run or its train first names it."""
    paths = item_paths("trains", [train.id for train in scenario.trains])
    trains = {train.id: (train, path) for train, path in zip(scenario.trains, paths, strict=True)}
    found: dict[str, str] = {}
    for item in declared_runs(scenario):
        run = item.run
        if run.category is not None:
            found.setdefault(run.category, f"{item.path}.category")
        elif run.train is not None:
            train, of_train = trains[run.train]
            if train.category is not None:
                found.setdefault(train.category, f"{of_train}.category")
    return found
