"""power-grid-model: a purely resistive AC network in symmetric calculation obeys the DC equations.

With line-to-line voltages and three-phase powers, P = U I' and the drop is R I' for I' = sqrt(3) I: no factor is needed.
Resistances and ends of lines cannot be updated in its batches, so the model is made anew in every snapshot. A
calculation always starts from its own linear estimate.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray
from power_grid_model import (
    CalculationMethod,
    ComponentType,
    DatasetType,
    LoadGenType,
    PowerGridModel,
    initialize_array,
)

from cases import NO_LOAD_V
from peer import Peer, Solver
from snapshots import Snapshots

STIFF_VA = 1e20
"""Short-circuit power of the source, so that it has no resistance of its own."""


def _prepare(snapshots: Snapshots, method: CalculationMethod) -> Solver:
    nodes, branches, trains = snapshots.nodes, snapshots.ohm.shape[1], snapshots.case.trains
    node = initialize_array(DatasetType.input, ComponentType.node, nodes)
    node["id"], node["u_rated"] = np.arange(nodes), NO_LOAD_V
    line = initialize_array(DatasetType.input, ComponentType.line, branches)
    line["id"] = nodes + np.arange(branches)
    line["from_status"] = line["to_status"] = 1
    line["x1"] = line["c1"] = line["tan1"] = 0.0
    line["i_n"] = 1000.0
    load = initialize_array(DatasetType.input, ComponentType.sym_load, trains)
    load["id"], load["node"], load["status"] = nodes + branches + np.arange(trains), snapshots.train_nodes, 1
    load["type"], load["q_specified"] = LoadGenType.const_power, 0.0
    source = initialize_array(DatasetType.input, ComponentType.source, 1)
    source["id"], source["node"], source["status"] = nodes + branches + trains, 0, 1
    source["u_ref"], source["sk"], source["rx_ratio"] = 1.0, STIFF_VA, 0.1
    data = {"node": node, "line": line, "sym_load": load, "source": source}

    def solve() -> NDArray[np.float64]:
        voltage = np.empty((len(snapshots), nodes))
        for k in range(len(snapshots)):
            line["from_node"], line["to_node"] = snapshots.ends[k].T
            line["r1"] = snapshots.ohm[k]
            load["p_specified"] = snapshots.power_w[k]
            model = PowerGridModel(data)
            result = model.calculate_power_flow(calculation_method=method, output_component_types=[ComponentType.node])
            voltage[k] = result["node"]["u"]
        return voltage

    return solve


PEERS = (
    Peer(
        "power-grid-model",
        "model made anew, newton_raphson",
        partial(_prepare, method=CalculationMethod.newton_raphson),
        aim=150.0,
    ),
    Peer(
        "power-grid-model",
        "model made anew, iterative_current",
        partial(_prepare, method=CalculationMethod.iterative_current),
    ),
)
