"""The track under a vehicle: slope, height, resistance of curves and tunnels."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined


@inlined
def row_at(pieces, s_m, row):
    """Return the piece in which the place `s_m` lies, looked for from `row` on; the first and last piece have no end."""
    while row + 1 < pieces.shape[0] and s_m >= pieces[row + 1].from_m:
        row += 1
    while row > 0 and s_m < pieces[row].from_m:
        row -= 1
    return row


@inlined
def slope_at(slopes, row, s_m):
    """Return the slope at a place of a piece; positive rises."""
    piece = slopes[row]
    return piece.slope + piece.change_per_m * (s_m - piece.from_m)


@inlined
def height_at(slopes, row, s_m):
    """Return the height at a place of a piece [m], the integral of the slope."""
    piece = slopes[row]
    along = s_m - piece.from_m
    return piece.height_m + (piece.slope + 0.5 * piece.change_per_m * along) * along


@inlined
def bend_resistance(bends, bend, row, s_m):
    """Return the resistance of curve and tunnel at a place of a piece, by weight [N/N].

    Roeckl's formula a / (R - b) as a k / (1 - b k) of the curvature k, which is finite in a transition curve.
    """
    piece = bends[row]
    k = abs(piece.per_m + piece.change_per_m2 * (s_m - piece.from_m))
    law = bend[0]
    resistance = law.a1_m * k / (1.0 - law.b1_m * k) if k <= law.divide_per_m else law.a2_m * k / (1.0 - law.b2_m * k)
    return resistance + piece.tunnel
