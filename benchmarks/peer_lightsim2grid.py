"""lightsim2grid: a purely resistive AC network with loads of pure active power obeys the DC equations.

The grid is filled by its low-level functions, without another program in front. Resistances and powers are replaced in
place; only when a train passes a substation or cabin, the grid is made anew. Each solution starts from the one before.
"""

from __future__ import annotations

import numpy as np
from lightsim2grid.network import LSGrid
from numpy.typing import NDArray

from cases import NO_LOAD_V
from peer import Peer
from snapshots import Snapshots

SOLVER = "NR_KLU"
"""The fastest of its Newton solvers here; its default, NR_SparseLU, takes twice the time."""

TOLERANCE_MVA = 1e-8
ITERATIONS = 10
BASE_KV = 0.001 * NO_LOAD_V


class _Grid:
    def __init__(self, snapshots: Snapshots, rebuild: bool = False) -> None:
        self.snapshots, self.rebuild = snapshots, rebuild
        self.resistance = snapshots.ohm / BASE_KV**2  # per unit of 1 MVA
        self.power_mw = snapshots.power_w / 1e6
        self.power_single = self.power_mw.astype(np.float32)
        self.all_loads = np.ones(snapshots.case.trains, np.bool_)
        self.zero = np.zeros(snapshots.ohm.shape[1])
        self.no_shunt = self.zero.astype(np.complex128)
        self.seconds = 0.0

    def _make(self, k: int) -> LSGrid:
        snapshots, nodes = self.snapshots, self.snapshots.nodes
        grid = LSGrid()
        grid.set_sn_mva(1.0)
        grid.set_init_vm_pu(1.0)
        grid.init_bus(nodes, 1, np.full(nodes, BASE_KV), len(self.zero), 0)
        grid.init_bus_status()
        i, j = np.ascontiguousarray(snapshots.ends[k].T)
        grid.init_powerlines(self.resistance[k], self.zero, self.no_shunt, i, j)
        grid.init_loads(self.power_mw[k], np.zeros(snapshots.case.trains), snapshots.train_nodes.astype(np.int32))
        grid.init_generators(np.zeros(1), np.ones(1), np.full(1, -1e4), np.full(1, 1e4), np.zeros(1, np.int32))
        grid.add_gen_slackbus(0, 1.0)
        grid.change_algorithm(SOLVER)
        grid.deactivate_result_computation()
        return grid

    def __call__(self) -> NDArray[np.float64]:
        voltage = np.empty((len(self.snapshots), self.snapshots.nodes))
        v = np.ones(self.snapshots.nodes, np.complex128)
        self.seconds = 0.0
        for k in range(len(self.snapshots)):
            if self.rebuild or self.snapshots.rewired[k]:
                grid = self._make(k)
            else:
                grid.update_powerlines_parameters(self.resistance[k], self.zero, self.no_shunt, self.no_shunt)
                grid.update_loads_p(self.all_loads, self.power_single[k])
            v = grid.ac_pf(v, ITERATIONS, TOLERANCE_MVA)
            self.seconds += grid.get_computation_time()
            voltage[k] = np.abs(v) * NO_LOAD_V
        return voltage


PEERS = (
    Peer("lightsim2grid", f"grid made anew, {SOLVER}", lambda snapshots: _Grid(snapshots, rebuild=True)),
    Peer("lightsim2grid", f"lines and loads replaced in place, {SOLVER}", _Grid, aim=50.0),
    Peer("lightsim2grid", f"the same, its solver alone by its own clock, {SOLVER}", _Grid, own_clock=True),
)
