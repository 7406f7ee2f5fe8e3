"""Checks of routes against the supply: a train needs a contact line all along its way."""

from __future__ import annotations

from collections.abc import Sequence

from tractionpower.alignment.path import RoutePath
from tractionpower.alignment.routes import name_stretches
from tractionpower.cosimulation.tables import lay_ways
from tractionpower.errors import Problem
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.scenario import Scenario
from tractionpower.movement.compile import plan_runs
from tractionpower.supply.compile import Stretch, compile_network


def check_contact_lines(scenario: Scenario) -> list[Problem]:
    """Return one problem for each route that leaves the contact lines, of a scenario that is otherwise in order."""
    runs = scenario.timetable.trains
    if not runs:
        return []
    stretches = compile_network(scenario.supply, scenario.line, scenario.limits).stretches
    problems, known = [], set[int]()
    for index, planned in enumerate(plan_runs(scenario, runs)):
        path = planned.path
        if id(path) in known:  # told of the first train that takes it
            continue
        known.add(id(path))
        gaps = find_gaps(path, planned.route_m, stretches)
        if gaps:
            found = f"no contact line on {'; '.join(name_stretches(path, gaps))}"
            remedy = "add it to supply.contact_lines and supply.return_circuit, or let the route begin and end on a contact line"
            where = f"timetable.trains[{index}].route"
            problems.append(Problem("route_without_contact_line", where, found, "a contact line all along", remedy))
    return problems


def find_gaps(path: RoutePath, end_m: float, stretches: Sequence[Stretch]) -> list[tuple[float, float]]:
    """Return where a route has no contact line up to `end_m` [m], as distances (from, to) [m]."""
    gaps, here = [], 0.0
    for from_m, to_m in covered(path, stretches):
        if from_m - here > SHARED_NODE_M:
            gaps.append((here, from_m))
        here = max(here, to_m)
    if end_m - here > SHARED_NODE_M:
        gaps.append((here, end_m))
    return [(low, min(high, end_m)) for low, high in gaps if low < end_m]


def covered(path: RoutePath, stretches: Sequence[Stretch]) -> list[tuple[float, float]]:
    """Return the parts of a route that lie within spans, as distances (from, to) [m], in order."""
    return [(way.from_m, way.to_m) for way in lay_ways(path, stretches)]
