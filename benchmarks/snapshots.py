"""Snapshots of a case as general power-flow programs take them: nodes, branches with a resistance, constant powers.

Node 0 is the source, held at the no-load voltage; then the substations and cabins by kilometre, where all tracks are
tied; then the trains. Each substation hangs on the source by its internal resistance, so it conducts both ways. Number of
nodes and branches never change; resistances do in every snapshot, the ends of a branch whenever a train passes a
substation or cabin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases import CIRCUITS, NO_LOAD_V, SOURCE_OHM, Case, MovingCase
from driver import CYCLE_S, FEED_BACK_FULL_V, SPEED_MPS, TRACTION_FULL_V, cycle_share

CLEARANCE_M = 2.0
"""Trains nearer to a substation or cabin are put that far away from it, since ours lets them share its node below 1 m."""

SEARCH_S = 3600


@dataclass(frozen=True)
class Snapshots:
    """Consecutive seconds of a case.

    Attributes
    ----------
    place_m, power_w
        Of every train, shape (snapshots, trains); negative power feeds back.
    ends
        Nodes of the branches, shape (snapshots, branches, 2).
    ohm
        Resistances of the branches [ohm], shape (snapshots, branches).
    rewired
        Whether a branch of the snapshot has other ends than in the snapshot before; True for the first.
    """

    case: Case
    place_m: NDArray[np.float64]
    power_w: NDArray[np.float64]
    ends: NDArray[np.int32]
    ohm: NDArray[np.float64]
    rewired: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.place_m)

    @property
    def nodes(self) -> int:
        return 2 * self.case.substations + self.case.trains

    @property
    def train_nodes(self) -> NDArray[np.int64]:
        return np.arange(2 * self.case.substations, self.nodes)

    @property
    def substation_nodes(self) -> NDArray[np.int64]:
        return np.arange(1, 2 * self.case.substations, 2)

    @property
    def port_nodes(self) -> NDArray[np.int64]:
        """Nodes in the order of the ports of our solver: substations, trains."""
        return np.concatenate([self.substation_nodes, self.train_nodes])


def take_snapshots(moving: MovingCase, count: int) -> Snapshots:
    """Take the first `count` consecutive seconds of a case in which no voltage leaves the range of constant power."""
    place, power = _positions(moving, SEARCH_S)
    _, _, voltage = moving.run_snapshots(place, power, warm=True)
    trains = voltage[:, moving.spot[0] :]
    inside = (trains > TRACTION_FULL_V + 1.0).all(axis=1) & (trains < FEED_BACK_FULL_V - 1.0).all(axis=1)
    windows = np.convolve(inside, np.ones(count), "valid") == count
    if not windows.any():
        raise RuntimeError(f"no {count} seconds of case {moving.case.name} have all voltages in the range")
    start = int(np.argmax(windows))
    return _wire(moving.case, place[start : start + count], power[start : start + count])


def _positions(moving: MovingCase, seconds: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    case, trains = moving.case, moving.trains
    t = np.arange(float(seconds))[:, None]
    place = (trains.start_m + trains.direction * SPEED_MPS * t) % (1000.0 * case.length_km)
    section_m = 1000.0 * case.length_km / (2 * case.substations - 2)
    beyond = np.clip(place % section_m, CLEARANCE_M, section_m - CLEARANCE_M)
    share = np.vectorize(cycle_share)((t + trains.phase_s) % CYCLE_S)
    return np.floor(place / section_m) * section_m + beyond, trains.power_w * share


def _wire(case: Case, place: NDArray[np.float64], power: NDArray[np.float64]) -> Snapshots:
    sections = np.sort(np.concatenate([case.substation_kms, case.cabin_kms])) * 1000.0
    first_train = 1 + len(sections)
    substations = np.arange(1, first_train, 2)
    ends, ohm = [], []
    for row in place:
        pairs = [np.column_stack([np.zeros_like(substations), substations])]
        values = [np.full(len(substations), SOURCE_OHM)]
        for track in range(2):
            on_track = np.arange(track, case.trains, 2)
            x = np.concatenate([sections, row[on_track]])
            node = np.concatenate([np.arange(1, first_train), first_train + on_track])
            order = np.argsort(x)
            pairs.append(np.column_stack([node[order][:-1], node[order][1:]]))
            values.append(0.001 * sum(CIRCUITS["loop"]) * np.diff(x[order]))
        ends.append(np.concatenate(pairs))
        ohm.append(np.concatenate(values))
    wires = np.array(ends, np.int32)
    rewired = np.concatenate([[True], (wires[1:] != wires[:-1]).any(axis=(1, 2))])
    return Snapshots(case, place, power, wires, np.array(ohm), rewired)


def worst_difference(snapshots: Snapshots, voltage: NDArray[np.float64], reference: NDArray[np.float64]) -> float:
    """Return the largest difference between node voltages of a program and port voltages of ours, relative to 3600 V."""
    return float(np.abs(voltage[:, snapshots.port_nodes] - reference).max() / NO_LOAD_V)
