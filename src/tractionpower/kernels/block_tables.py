"""Record types and bundles of the block of steps: devices, trains in the network, state, buffers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.tables import Network, Work, new_work
from tractionpower.kernels.train_port import BREAKS
from tractionpower.kernels.train_tables import TRAIN_ROW, TrainState, TrainTables, new_train_state

SOURCE = np.dtype([("port", "i8"), ("positive", "i8"), ("negative", "i8"), ("no_load_v", "f8")])
"""A substation; its port is -1 when its rectifiers are out, its nodes are -1 when its busbars are not in the network."""

LOAD = np.dtype([("port", "i8"), ("from_s", "f8"), ("to_s", "f8"), ("first_step", "i8"), ("steps", "i8")])
"""A fixed load, the times of day between which it is on, and the steps of its demand."""

LOAD_STEP = np.dtype([("time_s", "f8"), ("factor", "f8")])
"""From when [s after midnight] which part of its characteristic a load takes, until the next step; before the first none."""

SECTION = np.dtype([("contact", "i8"), ("rail", "i8"), ("port", "i8")])
"""A place whose voltage is recorded: two skeleton nodes, or a port in a span (else -1); neither where nothing feeds."""

GAUGE = np.dtype([("conductor", "i8"), ("right", "?")], align=True)
"""An end of a conductor whose current into it is recorded."""

OVERCURRENT, RAIL_POTENTIAL = 0, 1
"""What a trigger watches: the current of a link, the potential of a node against earth, both regardless of their sign."""

TRIGGER = np.dtype([("kind", "i8"), ("index", "i8"), ("above", "f8"), ("delay_s", "f8")])
"""A threshold; the trigger fires when it has been passed for `delay_s`. Infinite: it does not watch."""

WAY = np.dtype(
    [
        ("from_m", "f8"),  # distance from the start of the route
        ("span", "i8"),
        ("positive", "i8"),  # conductors
        ("negative", "i8"),
        ("x_m", "f8"),  # place in the span at `from_m`
        ("sign", "f8"),  # -1 where the train runs towards the left end of the span
        ("length_m", "f8"),  # of the span
        ("start_v", "f8"),  # highest no-load voltage there
        ("earthed", "?"),  # whether the rails there have a potential against earth
    ],
    align=True,
)
"""A stretch of a route within one span: where the front of a train stands in the network."""

FLEET = np.dtype(
    [
        ("port", "i8"),
        ("room", "i8"),  # segments that its port may have
        ("first_way", "i8"),
        ("ways", "i8"),
    ]
)
"""A train in the network."""

DONE, BUFFER_FULL, TRIGGERED = 0, 1, 2
"""Why `advance` came back."""


class BlockTables(NamedTuple):
    """All that a block of steps reads.

    Attributes
    ----------
    network
        The compiled network; `ports.scale` is written by the devices.
    edges, sources, loads, load_steps
        Record arrays of `EDGE`, `SOURCE`, `LOAD`, `LOAD_STEP`.
    links, terms
        Breakers and switches whose currents are recorded, record array of `LINK`, and their terms, of `TERM`.
    rails
        Places whose rail potential is recorded, record array of `RAIL`.
    earth
        Edge of each connection with earth, -1 where it is open, shape (connections,).
    triggers
        Thresholds that end a block, record array of `TRIGGER`.
    sections
        Places whose voltage is recorded, record array of `SECTION`.
    gauges
        Ends of contact lines and rails whose current is recorded, record array of `GAUGE`.
    clock
        Start [s after midnight], step [s], voltage of the constant-voltage coupling or 0 [V]; shape (3,).
    trains
        Trains and their routes.
    fleet, ways
        The same trains in the network, record array of `FLEET`, and the stretches of their routes, of `WAY`.
    entries
        Trains in the order of their starts, without those that others become.
    """

    network: Network
    edges: NDArray[np.void]
    sources: NDArray[np.void]
    loads: NDArray[np.void]
    load_steps: NDArray[np.void]
    links: NDArray[np.void]
    terms: NDArray[np.void]
    rails: NDArray[np.void]
    earth: NDArray[np.int64]
    triggers: NDArray[np.void]
    sections: NDArray[np.void]
    gauges: NDArray[np.void]
    clock: NDArray[np.float64]
    trains: TrainTables
    fleet: NDArray[np.void]
    ways: NDArray[np.void]
    entries: NDArray[np.int64]


PROGRESS = np.dtype(
    [
        ("step", "i8"),
        ("solved", "?"),  # whether a solution is at hand
        ("stale", "?"),  # whether ports have come or gone since
        ("active", "i8"),  # trains on the line
        ("entered", "i8"),  # trains that have come onto the line, of `BlockTables.entries`
        ("turning", "?"),  # whether all have finished that become a train which has not come onto the line yet
    ],
    align=True,
)

STEP_RESULT = np.dtype(
    [
        ("status", "i8"),
        ("iterations", "i8"),
        ("worst_a", "f8"),  # largest imbalance of a node
        ("factor", "f8"),  # by which all demand was cut
        ("port", "i8"),  # that cannot be served, or -1
        ("source_w", "f8"),  # sum of E I
        ("regulation_w", "f8"),  # sum of (E - U) I
        ("load_w", "f8"),
        ("train_w", "f8"),
        ("conductor_w", "f8"),  # heat in contact lines, rails, feeders
        ("gross_w", "f8"),  # sum of the absolute values of what is exchanged
        ("leaked_a", "f8"),  # leaves the rails for earth
        ("trains", "i8"),  # on the line
    ]
)
"""What is known of the solution of a step as a whole."""


class State(NamedTuple):
    """All that one step leaves for the next; made by `new_state`, copied by `copy_state`."""

    work: Work
    progress: NDArray[np.void]  # one record of PROGRESS
    load_scale: NDArray[np.float64]  # part of its characteristic that each load takes, 0 when it is off
    load_step: NDArray[np.int64]  # step of its demand that each load has reached, -1 before the first
    balance: NDArray[np.float64]
    result: NDArray[np.void]  # one record of STEP_RESULT
    trains: TrainState
    since_s: NDArray[np.float64]  # for each trigger: from when its threshold has been passed without a break, else infinite
    fired: NDArray[np.bool_]  # triggers that ended the block
    active: NDArray[np.int64]  # trains on the line, rising
    way: NDArray[np.int64]  # stretch of its route that each train is on
    breaks: NDArray[np.float64]  # scratch


class Buffers(NamedTuple):
    """Room for the rows of a number of steps; row k belongs to the k-th step since the last call."""

    steps: NDArray[np.void]  # STEP_RESULT
    source_v: NDArray[np.float64]  # busbar voltages, NaN where there is no busbar; shape (rows, sources)
    source_a: NDArray[np.float64]
    load_v: NDArray[np.float64]
    load_a: NDArray[np.float64]
    link_a: NDArray[np.float64]
    rail_v: NDArray[np.float64]  # NaN where there is no potential
    earth_a: NDArray[np.float64]  # into earth
    section_v: NDArray[np.float64]
    gauge_a: NDArray[np.float64]
    trains: NDArray[np.void]  # TRAIN_ROW, one after the other: as many of each step as `steps` says


def new_state(tables: BlockTables) -> State:
    """Return the state before the first step."""
    trains, network = len(tables.fleet), tables.network
    work = new_work(network)
    fixed = len(network.ports) - trains
    work.order[:] = np.arange(len(network.ports))
    work.in_service[0] = fixed
    return State(
        work=work,
        progress=np.zeros(1, PROGRESS),
        load_scale=np.zeros(len(tables.loads)),
        load_step=np.full(len(tables.loads), -1, np.int64),
        balance=np.zeros(network.nodes + 1),
        result=np.zeros(1, STEP_RESULT),
        trains=new_train_state(tables.trains),
        since_s=np.full(len(tables.triggers), np.inf),
        fired=np.zeros(len(tables.triggers), np.bool_),
        active=np.zeros(trains, np.int64),
        way=np.zeros(trains, np.int64),
        breaks=np.zeros(BREAKS),
    )


def rewired_state(state: State, before: BlockTables, after: BlockTables) -> State:
    """Return a state for tables of the same ports whose network is another one: it is solved anew, all else goes on.

    The trains stay where they are; `state` must not be used any more.
    """
    work, trains = new_work(after.network), len(after.fleet)
    work.order[:] = state.work.order
    work.in_service[:] = state.work.in_service
    first = len(after.network.ports) - trains
    kept = ["span", "positive", "negative", "x_m", "scale"]
    for name in kept:
        after.network.ports[name][first:] = before.network.ports[name][first:]
    state.progress["solved"], state.progress["stale"] = False, True
    return state._replace(work=work, balance=np.zeros(after.network.nodes + 1))


def copy_state(state: State) -> State:
    """Return an independent copy, from which the run can be resumed."""
    work = Work(*(array.copy() for array in state.work))
    trains = TrainState(*(array.copy() for array in state.trains))
    rest = {name: array.copy() for name, array in state._asdict().items() if name not in ("work", "trains")}
    return State(work=work, trains=trains, **rest)


def new_buffers(tables: BlockTables, rows: int, train_rows: int | None = None) -> Buffers:
    """Return buffers for `rows` steps and `train_rows` rows of trains, at least one for each train; left out: enough for all."""
    sources, loads, trains = len(tables.sources), len(tables.loads), len(tables.fleet)
    widths = (
        sources,
        sources,
        loads,
        loads,
        len(tables.links),
        len(tables.rails),
        len(tables.earth),
        len(tables.sections),
        len(tables.gauges),
    )
    room = rows * trains if train_rows is None else max(train_rows, trains)
    return Buffers(np.zeros(rows, STEP_RESULT), *(np.zeros((rows, width)) for width in widths), trains=np.zeros(room, TRAIN_ROW))


def take_rows(buffers: Buffers, rows: slice | NDArray[np.bool_]) -> Buffers:
    """Return some rows of all buffers; of the trains those of the same steps."""
    if not isinstance(rows, slice) and rows.all():
        return buffers
    counts = buffers.steps["trains"]
    if isinstance(rows, slice):
        start, stop, _ = rows.indices(len(counts))
        ends = np.concatenate(([0], np.cumsum(counts[:stop])))
        trains = buffers.trains[ends[start] : ends[stop]]
    else:
        trains = buffers.trains[: int(counts.sum())][np.repeat(rows, counts)]
    return Buffers(*(array[rows] for array in buffers[:-1]), trains=trains)
