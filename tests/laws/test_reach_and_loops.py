"""What the checks say of a supply before it is compiled is what the compiled network is: live stretches, loops of no resistance.

The checks look at a graph of stretches and busbars of their own; the network is built from spans, whose ends meet in nodes.
"""

from collections import Counter

import numpy as np
import pytest
from random_networks import Draw
from small_supplies import LIMITS

from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.checks import check_supply
from tractionpower.supply.compile import compile_network
from tractionpower.supply.loops import find_loops
from tractionpower.supply.merging import Merger
from tractionpower.supply.reach import ContactGraph
from tractionpower.supply.site import survey
from tractionpower.supply.wiring import build_topology

ALL_LIMITS = (
    *LIMITS,
    *(Limit(system="dc1500", name=limit.name, value=limit.value / 2.0, unit="V") for limit in LIMITS),
)
SEEDS = range(200)


def draw_switched(seed):
    """Return a random supply with feeders, switches and connections added, and its line."""
    draw, rng = Draw(seed, 77), np.random.default_rng([seed, 5])
    supply, main = draw.supply(), draw.parts[0]
    stations = [*supply.substations, *supply.section_cabins]
    some = lambda items: items[rng.integers(len(items))]  # noqa: E731

    def end():
        if rng.random() < 0.2:
            return {"busbar": some(stations).id}
        side = some([None, "low_km", "high_km"])
        km = some(stations).km if rng.random() < 0.6 else some(main.grid)  # near busbars, so that loops come about
        return {"track": some(main.tracks), "km": km} | ({"side": side} if side else {})

    rows = {}
    for _ in range(rng.integers(0, 6)):
        row = {"at": some(stations).id, "track": some(main.tracks), "side": some(["low_km", "high_km"])}
        row |= {"state": some(["open", "closed"]), "resistance_ohm": some([0.0, 0.01])}
        rows[row["at"], row["track"], row["side"]] = row
    if rng.random() < 0.3:  # a station that meets a track elsewhere
        row = {"at": some(stations).id, "track": some(main.tracks), "side": "high_km", "km": some(main.grid[1:-1])}
        rows = {key: item for key, item in rows.items() if key[:2] != (row["at"], row["track"])} | {0: row}
    switches = []
    for k in range(rng.integers(0, 6)):
        state, ohm = some(["open", "closed", "closed"]), some([0.0, 0.0, 0.0, 0.01])
        switches.append({"id": f"Q{k}", "from": end(), "to": end(), "resistance_ohm": ohm, "state": state})
    for k in range(rng.integers(0, 3)):  # by-passes
        across = {"track": some(main.tracks), "km": some(stations).km}
        switches.append({"id": f"B{k}", "from": across | {"side": "low_km"}, "to": across | {"side": "high_km"}})
    place = lambda: {"track": some(main.tracks), "km": some(main.grid)}  # noqa: E731
    connections = [{"from": place(), "to": place()} for _ in range(rng.integers(0, 3))]
    plain = supply.model_dump() | {"feeders": [*rows.values()], "switches": switches}
    line = Line.model_validate(draw.line.model_dump() | {"connections": connections})
    return Supply.model_validate(plain), line


def faults_of(supply, line):
    return [problem for problem in check_supply(supply, line, ALL_LIMITS) if problem.severity == "error"]


def without_faults(supply, line, *but):
    """Return the supply without what its checks refuse, but for some codes: feeders that feed nothing, switches of no use."""
    for _ in range(3):
        bad = {problem.path.split(".")[1] for problem in faults_of(supply, line) if problem.code not in but}
        supply = supply.model_copy(
            update={
                "feeders": tuple(row for k, row in enumerate(supply.feeders) if f"feeders[{k}]" not in bad),
                "switches": tuple(item for item in supply.switches if f"switches[{item.id}]" not in bad),
            }
        )
    return supply


def loops_of_network(supply, line):
    """Count the links without resistance whose ends are one node without them."""
    topology = build_topology(supply, line)
    nodes = Merger(len(topology.nodes), topology.joins)
    return sum(not nodes.join(link.first, link.second) for link in topology.links if link.merges)


def test_checks_and_network_agree():
    seen = Counter()
    for seed in SEEDS:
        supply, line = draw_switched(seed)
        supply = without_faults(supply, line, "zero_resistance_loop")
        faults = {problem.code for problem in faults_of(supply, line)}
        if faults <= {"zero_resistance_loop"}:
            found = find_loops(ContactGraph(survey(supply, line)))
            assert len(found) == loops_of_network(supply, line), seed
            assert bool(found) == bool(faults), seed
            seen["loops"] += bool(found)
        supply = without_faults(supply, line)
        if faults_of(supply, line):
            continue
        graph = ContactGraph(survey(supply, line))
        tables = compile_network(supply, line, ALL_LIMITS)
        for stretch in tables.stretches:
            middle = stretch.track, 0.5 * (stretch.from_m + stretch.to_m)
            (around,) = [item for item in graph.stretches if item.touches(middle)]
            assert around.live == (stretch.no_load_v > 0.0), (seed, stretch)
            seen["live" if around.live else "dead"] += 1
        seen["switches"] += len(supply.switches)
        seen["feeders"] += len(supply.feeders)
        seen["connections"] += len(line.connections)
    assert min(seen[what] for what in ("loops", "live", "dead", "switches", "feeders", "connections")) >= 30, seen


@pytest.mark.parametrize("seed", [3, 11])
def test_a_draw_is_a_function_of_its_seed(seed):
    assert draw_switched(seed) == draw_switched(seed)
