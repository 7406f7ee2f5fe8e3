"""LDL^T of the skeleton, with a structure that was made beforehand and no search while solving."""

from __future__ import annotations

from tractionpower.kernels.jit import njit


@njit
def factor_and_solve(column_start, row, target, value, potential):
    """Factor the symmetric matrix in `value` in place and solve for `potential`, which holds the right-hand side.

    Parameters
    ----------
    column_start, row, target
        Structure, see `tables.Network`; shapes (n + 1,), (m,), (products,).
    value
        Diagonal, dummy, entries below the diagonal [S], shape (n + 1 + m,).
    potential
        In: currents into the nodes [A]; out: node potentials [V]; ground last, shape (n + 1,).

    Returns
    -------
    bool
        Whether the matrix is positive definite. If not, `potential` is not a solution.
    """
    n = column_start.shape[0] - 1
    below = value[n + 1 :]
    t = 0
    for k in range(n):
        d = value[k]
        if not d > 0.0:
            return False
        inverse = 1.0 / d
        b = potential[k]
        start, end = column_start[k], column_start[k + 1]
        for p in range(start, end):
            factor = below[p] * inverse
            for q in range(p, end):
                value[target[t]] -= factor * below[q]
                t += 1
            potential[row[p]] -= factor * b
        potential[k] = b * inverse
        value[k] = inverse
    potential[n] = 0.0
    for k in range(n - 1, -1, -1):
        x = 0.0
        for p in range(column_start[k], column_start[k + 1]):
            x += below[p] * potential[row[p]]
        potential[k] -= value[k] * x
    return True
