"""pandapower, as a purely resistive AC network and with its own DC elements.

Its recycling (`recycle`, used by its time series) keeps the branch matrix of the first step, so moving lines would be
ignored without a word. The way with recycling here therefore writes pandapower's internal branch matrix itself, which
nobody promises to keep; the Newton solver alone is called below its public interface, too.
"""

from __future__ import annotations

import warnings
from functools import partial
from typing import Any

import numpy as np
import pandapower as pp
from numpy.typing import NDArray
from pandapower.pf.makeYbus_numba import makeYbus
from pandapower.pypower.idx_brch import BR_R, F_BUS, T_BUS
from pandapower.pypower.newtonpf import newtonpf
from scipy.sparse import SparseEfficiencyWarning

from cases import NO_LOAD_V
from peer import Peer, Solver
from snapshots import Snapshots

BASE_KV = 0.001 * NO_LOAD_V
DEFAULTS = {"init": "flat"}  # its default start needs reactances
TUNED = {
    "init": "results",
    "numba": True,
    "lightsim2grid": False,
    "calculate_voltage_angles": False,
    "check_connectivity": False,
    "voltage_depend_loads": False,
}


def _resistive_net(snapshots: Snapshots) -> Any:
    net = pp.create_empty_network(sn_mva=1.0)
    pp.create_buses(net, snapshots.nodes, vn_kv=BASE_KV)
    pp.create_ext_grid(net, 0)
    pp.create_lines_from_parameters(
        net, *snapshots.ends[0].T, length_km=1.0, r_ohm_per_km=snapshots.ohm[0], x_ohm_per_km=0.0, c_nf_per_km=0.0, max_i_ka=1.0
    )
    pp.create_loads(net, snapshots.train_nodes, p_mw=snapshots.power_w[0] / 1e6, q_mvar=0.0)
    return net


def _prepare_runpp(snapshots: Snapshots, options: dict[str, Any]) -> Solver:
    net = _resistive_net(snapshots)
    ends = snapshots.ends.astype(np.uint32)
    pp.runpp(net, **options | {"init": "flat"})

    def solve() -> NDArray[np.float64]:
        voltage = np.empty((len(snapshots), snapshots.nodes))
        for k in range(len(snapshots)):
            net.line["from_bus"], net.line["to_bus"] = ends[k].T
            net.line["r_ohm_per_km"] = snapshots.ohm[k]
            net.load["p_mw"] = snapshots.power_w[k] / 1e6
            pp.runpp(net, **options)
            voltage[k] = net.res_bus["vm_pu"].to_numpy() * NO_LOAD_V
        return voltage

    return solve


def _prepare_dc_elements(snapshots: Snapshots) -> Solver:
    net = pp.create_empty_network(sn_mva=1.0)
    pp.create_buses(net, 2, vn_kv=BASE_KV)  # a power flow wants an AC side
    pp.create_ext_grid(net, 0)
    pp.create_line_from_parameters(net, 0, 1, length_km=1.0, r_ohm_per_km=0.1, x_ohm_per_km=0.1, c_nf_per_km=0.0, max_i_ka=1.0)
    for _ in range(snapshots.nodes):
        pp.create_bus_dc(net, vn_kv=BASE_KV)
    pp.create_source_dc(net, 0, vm_pu=1.0)
    for (i, j), ohm in zip(snapshots.ends[0].tolist(), snapshots.ohm[0].tolist(), strict=True):
        pp.create_line_dc_from_parameters(net, i, j, length_km=1.0, r_ohm_per_km=ohm, max_i_ka=1.0)
    for node, power in zip(snapshots.train_nodes.tolist(), snapshots.power_w[0].tolist(), strict=True):
        pp.create_load_dc(net, node, p_dc_mw=power / 1e6)
    ends = snapshots.ends.astype(np.uint32)
    options = TUNED | {"init": "flat"}

    def solve() -> NDArray[np.float64]:
        voltage = np.empty((len(snapshots), snapshots.nodes))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SparseEfficiencyWarning)
            for k in range(len(snapshots)):
                net.line_dc["from_bus_dc"], net.line_dc["to_bus_dc"] = ends[k].T
                net.line_dc["r_ohm_per_km"] = snapshots.ohm[k]
                net.load_dc["p_dc_mw"] = snapshots.power_w[k] / 1e6
                pp.runpp(net, **options)
                voltage[k] = net.res_bus_dc["vm_pu"].to_numpy() * NO_LOAD_V
        return voltage

    return solve


def _prepare_recycled(snapshots: Snapshots) -> Solver:
    net = _resistive_net(snapshots)
    pp.runpp(net, **TUNED | {"init": "flat"})
    recycle = {"bus_pq": True, "gen": False, "trafo": True}

    def solve() -> NDArray[np.float64]:
        voltage = np.empty((len(snapshots), snapshots.nodes))
        for k in range(len(snapshots)):
            net.load["p_mw"] = snapshots.power_w[k] / 1e6
            for branch in (net._ppc["branch"], net._ppc["internal"]["branch"]):
                _write_branches(branch, snapshots, k)
            pp.runpp(net, recycle=recycle, **TUNED)
            voltage[k] = net.res_bus["vm_pu"].to_numpy() * NO_LOAD_V
        return voltage

    return solve


def _prepare_newton(snapshots: Snapshots) -> Solver:
    net = _resistive_net(snapshots)
    pp.runpp(net, **TUNED | {"init": "flat"})
    internal = net._ppc["internal"]
    tables = {name: net._ppc[name] for name in ("bus_dc", "branch_dc", "source_dc")} | internal | {"internal": internal}
    options = net._options

    def solve() -> NDArray[np.float64]:
        voltage = np.empty((len(snapshots), snapshots.nodes))
        v, injected = np.ones(snapshots.nodes, np.complex128), np.zeros(snapshots.nodes, np.complex128)
        for k in range(len(snapshots)):
            _write_branches(tables["branch"], snapshots, k)
            admittance, _, _ = makeYbus(1.0, tables["bus"], tables["branch"])
            injected[snapshots.train_nodes] = -snapshots.power_w[k] / 1e6
            ref, pv, pq = tables["ref"], tables["pv"], tables["pq"]
            v, *_ = newtonpf(admittance, injected, v, ref, pv, pq, tables, options, makeYbus)
            voltage[k] = np.abs(v) * NO_LOAD_V
        return voltage

    return solve


def _write_branches(branch: NDArray[np.complex128], snapshots: Snapshots, k: int) -> None:
    branch[:, F_BUS], branch[:, T_BUS] = snapshots.ends[k].T
    branch[:, BR_R] = snapshots.ohm[k] / BASE_KV**2  # per unit of 1 MVA


PEERS = (
    Peer("pandapower", "runpp, defaults, flat start", partial(_prepare_runpp, options=DEFAULTS)),
    Peer("pandapower", "runpp, tuned, from the results before", partial(_prepare_runpp, options=TUNED), aim=3000.0),
    Peer("pandapower", "runpp, tuned, its DC elements, flat start", _prepare_dc_elements),
    Peer("pandapower", "runpp, recycled, internal branch matrix overwritten", _prepare_recycled),
    Peer("pandapower", "its Ybus and Newton alone, below the interface", _prepare_newton),
)
