"""Record types of the tables that kernels work on, and the few bundles of tables that travel together.

All quantities are SI: m, ohm, V, A, W, s. Node indices are positions in the elimination order of the skeleton; the
index one past the last node is *ground*, the rail node that serves as reference, whose potential is zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SHARED_NODE_M = 1.0
"""Two devices closer than this share a node [m]."""

BLOCKED_CONDUCTANCE_S = 1e-9
"""Conductance of a blocked rectifier, which keeps a network defined whose rectifiers all block [S]."""

SPAN = np.dtype(
    [
        ("length_m", "f8"),
        ("first_conductor", "i8"),
        ("conductors", "i8"),
        ("fronts", "i8"),  # conductors with resistance, which have a front slot each
        ("first_terminal", "i8"),  # into `Network.terminals`
        ("right_terminals", "i8"),  # nodes of the right end that are not among those of the left end
        ("left_terminals", "i8"),  # distinct skeleton nodes at the left end
        ("first_scatter", "i8"),  # into `Network.scatter`: lower triangle of the terminals, row by row
    ]
)
"""A span: w conductors side by side between two neighbouring fixed cross-sections."""

CONDUCTOR = np.dtype(
    [
        ("ohm_per_m", "f8"),  # zero: both ends are one node
        ("siemens_per_m", "f8"),  # leakage to earth, which is ground then
        ("whole_s", "f8"),  # pi-element of the whole conductor: from end to end, and to earth at either end
        ("whole_shunt_s", "f8"),
        ("left_node", "i8"),
        ("right_node", "i8"),
        ("coupling", "i8"),  # place of the pair of its ends in the skeleton's values
        ("left_slot", "i8"),
        ("front_slot", "i8"),  # NO_SLOT without resistance
        ("right_slot", "i8"),
    ]
)
"""One conductor of one span. Slots are its rows in the frontal matrix of the span sweep."""

NO_SLOT = -1

PORT = np.dtype(
    [
        ("span", "i8"),  # -1: between two skeleton nodes
        ("positive", "i8"),  # conductor of the span, or skeleton node
        ("negative", "i8"),
        ("coupling", "i8"),  # skeleton port: place of the pair in the skeleton's values
        ("x_m", "f8"),  # distance from the left end of the span
        ("first_segment", "i8"),
        ("segments", "i8"),
        ("scale", "f8"),  # factor on the current: 0 switches a port off
        ("start_v", "f8"),  # highest no-load voltage, from which a cold solution starts
        ("demand", "?"),  # a load or train, no source: the common load factor scales it
        ("floor_v", "f8"),  # outside floor and ceiling the demand cannot be served; floor 0: any voltage will do
        ("ceiling_v", "f8"),
    ],
    align=True,
)
"""Whatever feeds or draws: I(U) from the positive to the negative conductor, by segments."""

SEGMENT = np.dtype([("from_v", "f8"), ("a", "f8"), ("b", "f8"), ("c", "f8")])
"""A piece of a port's characteristic from `from_v` up to the next segment: I(U) = a + b U + c/U."""

PORT_WORK = np.dtype(
    [
        ("u", "f8"),  # port voltage
        ("before_v", "f8"),  # of the solution before
        ("i", "f8"),  # current that the linear network carries at u
        ("g", "f8"),  # slope of the characteristic
        ("j", "f8"),  # current of the linearised port at zero voltage
        ("u_next", "f8"),
        ("i_next", "f8"),
        ("lowest_v", "f8"),  # range of a warm solution, outside which it is refused
        ("highest_v", "f8"),
        ("full_scale", "f8"),  # scale before the demand was cut
    ]
)

SIDE_WORK = np.dtype(
    [
        ("conductor", "i8"),
        ("slot", "i8"),  # where the port connects in the frontal matrix
        ("insertion", "i8"),  # one of SHARED, FIRST, NEXT
        ("conductance_s", "f8"),  # from the node before
        ("shunt_s", "f8"),  # to earth, at both ends of that element
        ("node_v", "f8"),  # potential of the last linear solution
    ]
)
"""How one side of a span port hangs on its conductor."""

SHARED, FIRST, NEXT = 0, 1, 2
"""Insertion of a port into a conductor: at a node that exists, the first node behind the left end, a further node."""

CONDUCTOR_WORK = np.dtype(
    [
        ("last_m", "f8"),  # where the front stands
        ("nodes", "i8"),  # inserted by ports
        ("end_s", "f8"),  # conductance from the front to the right end
        ("end_shunt_s", "f8"),  # to earth, at both ends of that element
        ("earth_a", "f8"),  # goes into earth
        ("leaked_a", "f8"),  # leaves for earth where the potential is positive
        ("left_a", "f8"),  # current that leaves the left end into the span
        ("right_a", "f8"),
        ("front_v", "f8"),
        ("front_a", "f8"),
        ("open", "?"),  # whether the front has left the left end
    ],
    align=True,
)

EDGE = np.dtype([("first", "i8"), ("second", "i8"), ("conductance_s", "f8")])
"""A fixed resistance between two skeleton nodes: a feeder, a return feeder."""

LINK = np.dtype([("first_term", "i8"), ("terms", "i8")])
"""A breaker or switch; its current is a sum of terms, none where it is open."""

TERM = np.dtype([("kind", "i8"), ("index", "i8"), ("sign", "f8")])
"""A current: of an end of a conductor into its span, of an edge, of a port between skeleton nodes."""

LEFT_END, RIGHT_END, EDGE_CURRENT, PORT_CURRENT = 0, 1, 2, 3
"""Kinds of terms."""

SPAN_WORK = np.dtype(
    [
        ("first_port", "i8"),
        ("ports", "i8"),
        ("first_row", "i8"),
        ("stale", "?"),  # whether a port has changed since the span was condensed
    ],
    align=True,
)


class Network(NamedTuple):
    """A network compiled for the solver.

    Attributes
    ----------
    spans, conductors, ports, segments
        Record arrays of `SPAN`, `CONDUCTOR`, `PORT`, `SEGMENT`.
    terminals
        Skeleton nodes at the ends of the spans.
    scatter
        Places of the condensed spans in the skeleton's values.
    column_start, row, target
        Structure of the skeleton's factor: rows below the diagonal by column, and where each product of two entries
        of a column goes.
    base
        Values of the skeleton without ports [S]: the diagonal, a dummy for ground, the entries below the diagonal by
        column; shape (n + 1 + m,).
    """

    spans: NDArray[np.void]
    conductors: NDArray[np.void]
    ports: NDArray[np.void]
    segments: NDArray[np.void]
    terminals: NDArray[np.int64]
    scatter: NDArray[np.int64]
    column_start: NDArray[np.int64]
    row: NDArray[np.int64]
    target: NDArray[np.int64]
    base: NDArray[np.float64]

    @property
    def nodes(self) -> int:
        """Number of skeleton nodes without ground."""
        return len(self.column_start) - 1


class Work(NamedTuple):
    """What a solution leaves for the next one, and scratch memory. Made by `new_work`."""

    ports: NDArray[np.void]
    sides: NDArray[np.void]  # shape (ports, 2)
    conductors: NDArray[np.void]
    spans: NDArray[np.void]
    order: NDArray[np.int64]  # ports by span and place, those between skeleton nodes first; those not in service last
    in_service: NDArray[np.int64]  # how many of `order` are in service, and how many of `active` count; shape (2,)
    active: NDArray[np.int64]  # spans that carry ports
    step_base: NDArray[np.float64]  # skeleton values without the conductors that ports stand on
    value: NDArray[np.float64]
    node_v: NDArray[np.float64]  # potentials of the skeleton nodes, ground last
    front: NDArray[np.float64]  # frontal matrix of the span sweep, one dummy row for ground
    front_b: NDArray[np.float64]
    condensed: NDArray[np.float64]  # of each span, laid out like `Network.scatter`
    condensed_b: NDArray[np.float64]  # like `Network.terminals`
    row: NDArray[np.float64]  # eliminated rows: coefficients by slot, then the constant


def new_work(network: Network) -> Work:
    """Return cleared work memory for `network`."""
    nodes, ports = network.nodes, len(network.ports)
    slots = 1
    if len(network.spans):
        spans = network.spans
        slots = int(np.max(spans["left_terminals"] + spans["right_terminals"] + spans["fronts"])) + 1
    rows = 2 * ports + len(network.conductors) + 1
    work = Work(
        ports=np.zeros(ports, PORT_WORK),
        sides=np.zeros((ports, 2), SIDE_WORK),
        conductors=np.zeros(len(network.conductors), CONDUCTOR_WORK),
        spans=np.zeros(len(network.spans), SPAN_WORK),
        order=np.argsort(network.ports["span"], kind="stable").astype(np.int64),
        in_service=np.array([ports, 0], np.int64),
        active=np.zeros(len(network.spans), np.int64),
        step_base=network.base.copy(),
        value=network.base.copy(),
        node_v=np.zeros(nodes + 1),
        front=np.zeros((slots, slots)),
        front_b=np.zeros(slots),
        condensed=np.zeros(len(network.scatter)),
        condensed_b=np.zeros(len(network.terminals)),
        row=np.zeros((rows, slots + 1)),
    )
    work.ports["u"] = network.ports["start_v"]
    return work
