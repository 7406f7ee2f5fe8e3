"""Newton's method on the node voltages with SciPy's sparse LU factorisation in every iteration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from cases import NO_LOAD_V
from peer import Peer, Solver
from snapshots import Snapshots

TOLERANCE_A = 1e-6
ITERATIONS = 20


def _prepare_plain(snapshots: Snapshots) -> Solver:
    """Assemble every snapshot with `scipy.sparse`, warm from the one before."""
    nodes = snapshots.nodes
    power = _node_powers(snapshots)

    def solve() -> NDArray[np.float64]:
        voltage = np.full((len(snapshots), nodes), NO_LOAD_V)
        v = np.full(nodes - 1, NO_LOAD_V)
        for k in range(len(snapshots)):
            g, (i, j) = 1.0 / snapshots.ohm[k], snapshots.ends[k].T
            entries = np.concatenate([g, g, -g, -g])
            rows, columns = np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i])
            whole = sparse.coo_matrix((entries, (rows, columns)), shape=(nodes, nodes)).tocsc()
            matrix, source = whole[1:, 1:], whole[1:, 0].toarray().ravel() * NO_LOAD_V
            for _ in range(ITERATIONS):
                residual = matrix @ v + source + power[k] / v
                if np.abs(residual).max() <= TOLERANCE_A:
                    break
                v = v - splu(matrix - sparse.diags(power[k] / v**2, format="csc")).solve(residual)
            voltage[k, 1:] = v
        return voltage

    return solve


def _prepare_kept(snapshots: Snapshots) -> Solver:
    """Keep the pattern of the matrix until a train passes a substation or cabin, and write its values in place."""
    n = snapshots.nodes - 1
    power = _node_powers(snapshots)

    def solve() -> NDArray[np.float64]:
        voltage = np.full((len(snapshots), n + 1), NO_LOAD_V)
        v = np.full(n, NO_LOAD_V)
        for k in range(len(snapshots)):
            if snapshots.rewired[k]:
                matrix, jacobian, place, diagonal = _pattern(snapshots.ends[k], n)
                feeds = snapshots.ends[k, :, 0] == 0
                fed = snapshots.ends[k, feeds, 1] - 1
            g = 1.0 / snapshots.ohm[k]
            matrix.data[:] = np.bincount(place, np.concatenate([g, g, -g, -g]), matrix.nnz + 1)[:-1]
            source = np.zeros(n)
            source[fed] = -g[feeds] * NO_LOAD_V
            for _ in range(ITERATIONS):
                current = power[k] / v
                residual = matrix @ v + source + current
                if np.abs(residual).max() <= TOLERANCE_A:
                    break
                jacobian.data[:] = matrix.data
                jacobian.data[diagonal] -= current / v
                v = v - splu(jacobian).solve(residual)
            voltage[k, 1:] = v
        return voltage

    return solve


def _pattern(
    ends: NDArray[np.int32], n: int
) -> tuple[sparse.csc_matrix, sparse.csc_matrix, NDArray[np.int64], NDArray[np.int64]]:
    """Return two matrices of one pattern, the places of the branches' four entries (last: none) and of the diagonal."""
    i, j = ends.T.astype(np.int64) - 1
    rows, columns = np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i])
    inside = (rows >= 0) & (columns >= 0)
    key, diagonal = columns * n + rows, np.arange(n) * (n + 1)
    kept = np.unique(np.concatenate([key[inside], diagonal]))
    place = np.where(inside, np.searchsorted(kept, key), len(kept))
    start = np.searchsorted(kept, n * np.arange(n + 1)).astype(np.int32)
    matrix = sparse.csc_matrix((np.zeros(len(kept)), (kept % n).astype(np.int32), start), shape=(n, n))
    return matrix, matrix.copy(), place, np.searchsorted(kept, diagonal)


def _node_powers(snapshots: Snapshots) -> NDArray[np.float64]:
    power = np.zeros((len(snapshots), snapshots.nodes - 1))
    power[:, snapshots.train_nodes - 1] = snapshots.power_w
    return power


PEERS = (
    Peer("SciPy", "Newton, sparse assembly and splu in every iteration", _prepare_plain, aim=150.0),
    Peer("SciPy", "the same, pattern kept and values written in place", _prepare_kept),
)
