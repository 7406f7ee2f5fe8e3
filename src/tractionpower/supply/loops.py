"""Loops without resistance, in which the currents of breakers would be anything."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable

from tractionpower.supply.reach import ContactGraph, LinePoint, Point, Tie
from tractionpower.supply.site import LOW
from tractionpower.supply.topology import SHORT_OHM

Loop = tuple[Tie, ...]
"""Feeders and switches of one loop; the last one closes it."""


def find_loops(graph: ContactGraph) -> list[Loop]:
    """Return one loop for each feeder or switch without resistance that closes one.

    Contact lines have resistance, so a loop leads over busbars and single places. Connections of the line alone form no
    loop: they have no breaker. A switch between the two sides of a place that is not cut there is a loop by itself.
    """
    places = _places(graph)
    joined: dict[Hashable, list[tuple[Hashable, Tie]]] = {}
    loops = []
    for tie in graph.ties:  # connections first
        if tie.ohm >= SHORT_OHM:
            continue
        first, second = (_node(graph, places, end) for end in (tie.first, tie.second))
        way = _way(joined, first, second)
        if way is None:
            joined.setdefault(first, []).append((second, tie))
            joined.setdefault(second, []).append((first, tie))
        elif tie.kind != "connection" and (first != second or lies_across(tie)):
            loops.append((*(item for item in way if item.kind != "connection"), tie))
    return loops


def lies_across(tie: Tie) -> bool:
    """Tell whether a switch leads from one side of a place to the other; between equal ends it joins nothing at all."""
    ends = tie.first, tie.second
    return all(isinstance(end, LinePoint) for end in ends) and ends[0] != ends[1]


def _places(graph: ContactGraph) -> dict[str, list[float]]:
    """Return for each track the metres of its ties, those that share a node as one."""
    metres: dict[str, set[float]] = {}
    for tie in graph.ties:
        for end in (tie.first, tie.second):
            if isinstance(end, LinePoint):
                metres.setdefault(end.track, set()).add(end.metre)
    found: dict[str, list[float]] = {}
    for track, every in metres.items():
        for metre in sorted(every):
            if not found.setdefault(track, []) or graph.near(found[track][-1:], metre) is None:
                found[track].append(metre)
    return found


def _node(graph: ContactGraph, places: dict[str, list[float]], point: Point) -> Hashable:
    if not isinstance(point, LinePoint):
        return point
    side = (point.side or LOW) if graph.is_cut((point.track, point.metre)) else None
    return point.track, graph.near(places[point.track], point.metre), side


def _way(joined: dict[Hashable, list[tuple[Hashable, Tie]]], first: Hashable, last: Hashable) -> list[Tie] | None:
    """Return the ties that lead from one node to another, or None if none do."""
    ways: dict[Hashable, list[Tie]] = {first: []}
    waiting = deque([first])
    while waiting:
        node = waiting.popleft()
        if node == last:
            return ways[node]
        for neighbour, tie in joined.get(node, ()):
            if neighbour not in ways:
                ways[neighbour] = [*ways[node], tie]
                waiting.append(neighbour)
    return None
