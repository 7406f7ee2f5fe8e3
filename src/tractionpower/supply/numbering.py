"""The nodes of the skeleton by number: what is ground, what floats, in which order nodes are eliminated."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tractionpower.model.supply import Substation
from tractionpower.supply.characteristics import no_load_voltage
from tractionpower.supply.ordering import Structure, order_nodes
from tractionpower.supply.topology import Merger, Node, Topology

Pair = tuple[Node, Node]


@dataclass(frozen=True, slots=True)
class Numbering:
    """Numbers of the nodes.

    Attributes
    ----------
    structure
        Elimination order and fill-in of the skeleton.
    number
        Rank of each node in the elimination; ground is one past the last.
    floating
        One node of each part that no source and no conductor joins with ground.
    no_load_v
        Highest no-load voltage that sources put on each node's conductors; nodes without a source are left out [V].
    """

    structure: Structure
    number: dict[Node, int]
    floating: tuple[int, ...]
    no_load_v: dict[Node, float]


def number_nodes(topology: Topology, sources: Sequence[Substation]) -> Numbering:
    """Give numbers to the nodes of a topology whose sources in service are `sources`, ordered by identifier."""
    find = topology.nodes.find
    wires = [(find(c.left), find(c.right)) for span in topology.spans for c in span.conductors]
    wires += [(find(a), find(b)) for a, b, _ in topology.edges]
    busbars = [(find(bus.positive), find(bus.negative)) for bus in topology.busbars.values()]
    nodes = sorted({node for pair in wires + busbars for node in pair}, key=repr)
    feeding = [(find(bus.positive), find(bus.negative)) for bus in (topology.busbars[s.id] for s in sources)]
    grounds = _grounds(topology, nodes, wires + feeding, [negative for _, negative in feeding])
    free = [node for node in nodes if node not in grounds]
    rank = {node: k for k, node in enumerate(free)} | dict.fromkeys(grounds, len(free))
    cliques = [[rank[find(n)] for c in span.conductors for n in (c.left, c.right)] for span in topology.spans]
    cliques += [[rank[a], rank[b]] for a, b in wires + busbars]
    structure = order_nodes(len(free), cliques)
    number = {free[old]: new for new, old in enumerate(structure.order)} | dict.fromkeys(grounds, len(free))
    islands = _parts(nodes, wires + feeding)
    floating = tuple(min(number[node] for node in island) for island in islands if not island & grounds)
    return Numbering(structure, number, floating, _no_load_voltages(_parts(nodes, wires), feeding, sources))


def _grounds(topology: Topology, nodes: list[Node], joined: list[Pair], negatives: list[Node]) -> set[Node]:
    """Return one node of every part that conductors, sources or ports can join: a negative busbar, else a rail."""
    find = topology.nodes.find
    rails = {find(span.conductors[-1].left) for span in topology.spans}
    ports = [
        (find(span.conductors[span.contact(track)].left), find(span.conductors[rail].left))
        for span in topology.spans
        for track, rail in span.returns.items()
    ]
    grounds = set()
    for part in _parts(nodes, joined + ports):
        wanted = [node for node in negatives if node in part] or sorted(part & rails, key=repr) or sorted(part, key=repr)
        grounds.add(wanted[0])
    return grounds


def _no_load_voltages(wired: Iterable[set[Node]], feeding: Sequence[Pair], sources: Sequence[Substation]) -> dict[Node, float]:
    """Return the highest no-load voltage of each part that wires alone join: a busbar cut off has its own."""
    voltages: dict[Node, float] = {}
    for part in wired:
        found = [no_load_voltage(s) for s, (positive, _) in zip(sources, feeding, strict=True) if positive in part]
        if found:
            voltages |= dict.fromkeys(part, max(found))
    return voltages


def _parts(nodes: Iterable[Node], pairs: Iterable[Pair]) -> list[set[Node]]:
    """Return the connected parts in the order of their first node."""
    merger = Merger()
    for a, b in pairs:
        merger.join(a, b)
    parts: dict[Node, set[Node]] = {}
    for node in nodes:
        parts.setdefault(merger.find(node), set()).add(node)
    return list(parts.values())
