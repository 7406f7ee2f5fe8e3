"""Currents of breakers and switches: where a closed link has no resistance, the balance of one of its sides gives them.

Closed links without resistance make their ends one node of the network. Between the nodes that they merge they form
trees (loops are refused by the checks): what flows through a link is what everything on its far side takes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.tables import EDGE_CURRENT, LEFT_END, LINK, PORT_CURRENT, RIGHT_END, TERM
from tractionpower.supply.topology import Link, Topology

Term = tuple[int, int, float]
"""Kind, index, sign: a current that leaves a node."""


def link_tables(topology: Topology, edges: Sequence[int], ports: Mapping[str, int]) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return the links and their terms, record arrays of `LINK` and `TERM`.

    Parameters
    ----------
    topology
        The graph.
    edges
        For each of `topology.edges` its number in the table of edges, -1 where both ends are one node.
    ports
        Port of each substation in service, by identifier.
    """
    own = _terms_of_nodes(topology, edges, ports)
    found: list[list[Term]] = [[] for _ in topology.links]
    edge = iter(edges)
    for number, link in enumerate(topology.links):
        if link.closed and not link.merges and (at := next(edge)) >= 0:
            found[number] = [(EDGE_CURRENT, at, 1.0)]
    for cluster in _clusters(topology):
        _follow(topology, cluster, own, found)
    links = np.zeros(len(found), LINK)
    links["terms"] = [len(terms) for terms in found]
    links["first_term"] = np.cumsum(links["terms"]) - links["terms"]
    return links, np.array([term for terms in found for term in terms], TERM)


def _terms_of_nodes(topology: Topology, edges: Sequence[int], ports: Mapping[str, int]) -> dict[int, list[Term]]:
    """Return the currents that leave each node that plain joins make one, links without resistance apart."""
    at, terms, conductor = topology.plain.find, defaultdict[int, list[Term]](list), 0
    for span in topology.spans:
        for wire in span.conductors:
            terms[at(wire.left)].append((LEFT_END, conductor, 1.0))
            terms[at(wire.right)].append((RIGHT_END, conductor, 1.0))
            conductor += 1
    for number, (first, second, _) in zip(edges, topology.edges(), strict=True):
        if number >= 0:
            terms[at(first)].append((EDGE_CURRENT, number, 1.0))
            terms[at(second)].append((EDGE_CURRENT, number, -1.0))
    for station, port in ports.items():
        busbar = topology.busbars[station]
        terms[at(busbar.positive)].append((PORT_CURRENT, port, 1.0))
        terms[at(busbar.negative)].append((PORT_CURRENT, port, -1.0))
    return terms


def _clusters(topology: Topology) -> list[dict[int, list[tuple[int, int]]]]:
    """Return the trees of links without resistance: for each node its (link, node at the other end)."""
    at = topology.plain.find
    beside: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for number, link in enumerate(topology.links):
        first, second = at(link.first), at(link.second)
        if link.merges and first != second:
            beside[first].append((number, second))
            beside[second].append((number, first))
    groups: dict[int, dict[int, list[tuple[int, int]]]] = defaultdict(dict)
    for node, others in beside.items():
        groups[topology.find(node)][node] = others
    return list(groups.values())


def _follow(
    topology: Topology, tree: dict[int, list[tuple[int, int]]], own: Mapping[int, list[Term]], found: list[list[Term]]
) -> None:
    """Fill in the terms of the links of one tree, whose root is the node with most links."""
    root = max(tree, key=lambda node: (len(tree[node]), -node))
    way: list[tuple[int, int, int]] = []  # link, node, node before, from the root outwards
    seen, queue = {root}, [root]
    while queue:
        node = queue.pop()
        for number, other in tree[node]:
            if other not in seen:
                seen.add(other)
                way.append((number, other, node))
                queue.append(other)
    beyond: dict[int, list[Term]] = {node: list(own.get(node, ())) for node in tree}
    for number, node, before in reversed(way):
        link: Link = topology.links[number]
        sign = 1.0 if topology.plain.find(link.first) == before else -1.0
        found[number] = [(kind, index, sign * s) for kind, index, s in beyond[node]]
        beyond[before] += beyond[node]
