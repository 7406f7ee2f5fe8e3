"""The nodes of the skeleton by number: what is ground, what floats, in which order nodes are eliminated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tractionpower.model.supply import Substation
from tractionpower.supply.characteristics import no_load_voltage
from tractionpower.supply.merging import Merger
from tractionpower.supply.ordering import Structure, order_nodes
from tractionpower.supply.topology import Topology

Pair = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Numbering:
    """Numbers of the nodes.

    Attributes
    ----------
    structure
        Elimination order and fill-in of the skeleton.
    number
        Rank in the elimination of each node that stands for itself and others; ground is one past the last.
    floating
        Number of one node of each part that no source and no conductor joins with ground.
    no_load_v
        Highest no-load voltage that sources put on each node's conductors; nodes without a source are left out [V].
    earthed
        Nodes that conductors or sources join with remote earth: they have a potential against it.
    """

    structure: Structure
    number: dict[int, int]
    floating: tuple[int, ...]
    no_load_v: dict[int, float]
    earthed: frozenset[int]


def find_returning(topology: Topology) -> set[str]:
    """Return the substations whose busbars are in the network and whose return feeders can bring a current back."""
    wires = [(c.left, c.right) for span in topology.spans for c in span.conductors]
    wired = Merger(len(topology.nodes), [(topology.find(a), topology.find(b)) for a, b in wires])
    for a, b, _ in topology.edges():
        wired.join(topology.find(a), topology.find(b))
    for span in topology.spans:
        if topology.earth is not None and span.rail.siemens_per_m > 0.0:
            wired.join(topology.find(span.rail.left), topology.earth)
    rails = {wired.find(topology.find(span.rail.left)) for span in topology.spans}
    return {name for name, busbar in topology.busbars.items() if wired.find(topology.find(busbar.negative)) in rails}


def number_nodes(topology: Topology, sources: Sequence[Substation]) -> Numbering:
    """Give numbers to the nodes of a topology whose sources in service are `sources`, ordered by identifier."""
    find, earth = topology.find, topology.earth
    wires = [(find(c.left), find(c.right)) for span in topology.spans for c in span.conductors]
    wires += [(find(a), find(b)) for a, b, _ in topology.edges()]
    if earth is not None:
        leaky = [span.rail for span in topology.spans if span.rail.siemens_per_m > 0.0]
        wires += [(find(node), earth) for rail in leaky for node in (rail.left, rail.right)]
    busbars = {name: (find(bus.positive), find(bus.negative)) for name, bus in topology.busbars.items()}
    nodes = sorted({node for pair in (*wires, *busbars.values()) for node in pair})
    feeding = [busbars[source.id] for source in sources]
    grounds = _grounds(topology, nodes, wires + feeding, [negative for _, negative in feeding])
    free = [node for node in nodes if node not in grounds]
    rank = {node: k for k, node in enumerate(free)} | dict.fromkeys(grounds, len(free))
    cliques = [[rank[find(n)] for c in span.conductors for n in (c.left, c.right)] for span in topology.spans]
    cliques += [[rank[a], rank[b]] for a, b in (*wires, *busbars.values())]
    structure = order_nodes(len(free), cliques)
    number = {free[old]: new for new, old in enumerate(structure.order)} | dict.fromkeys(grounds, len(free))
    count = len(topology.nodes)
    islands = Merger(count, wires + feeding).sets(nodes)
    floating = tuple(min(number[node] for node in island) for island in islands if grounds.isdisjoint(island))
    earthed = frozenset(node for island in islands if earth is not None and earth in island for node in island)
    wired = Merger(count, [pair for pair in wires if earth not in pair]).sets(nodes)
    return Numbering(structure, number, floating, _no_load_voltages(wired, feeding, sources), earthed)


def _grounds(topology: Topology, nodes: list[int], joined: list[Pair], negatives: list[int]) -> set[int]:
    """Return one node of every part that conductors, sources or ports can join: earth, else a negative busbar, else a rail."""
    find = topology.find
    rails = {find(span.rail.left) for span in topology.spans}
    ports = [(find(c.left), find(span.rail.left)) for span in topology.spans for c in span.conductors[:-1]]
    grounds, first_negative = set(), {node: k for k, node in reversed([*enumerate(negatives)])}
    for part in Merger(len(topology.nodes), joined + ports).sets(nodes):
        of_sources = sorted((node for node in part if node in first_negative), key=lambda node: first_negative[node])
        if topology.earth is not None and topology.earth in part:
            grounds.add(topology.earth)
        else:
            grounds.add((of_sources or [node for node in part if node in rails] or part)[0])
    return grounds


def _no_load_voltages(wired: list[list[int]], feeding: Sequence[Pair], sources: Sequence[Substation]) -> dict[int, float]:
    """Return the highest no-load voltage of each part that wires alone join: a busbar cut off has its own."""
    highest: dict[int, float] = {}
    for source, (positive, _) in zip(sources, feeding, strict=True):
        highest[positive] = max(highest.get(positive, 0.0), no_load_voltage(source))
    voltages: dict[int, float] = {}
    for part in wired:
        found = [highest[node] for node in part if node in highest]
        if found:
            voltages |= dict.fromkeys(part, max(found))
    return voltages
