"""Running sums as unevaluated sums of two floats, some 32 digits (Dekker 1971, Knuth's two-sum): they do not drift."""

from __future__ import annotations

from tractionpower.kernels.jit import inlined


@inlined
def plus(high, low, x):
    """Return the double-double (high, low) + x."""
    total = high + x
    part = total - high
    rest = (high - (total - part)) + (x - part) + low
    high = total + rest
    return high, rest - (high - total)


@inlined
def minus(high, low, other_high, other_low):
    """Return the difference of two double-doubles, rounded to one float."""
    total = high - other_high
    part = total - high
    rest = (high - (total - part)) - (other_high + part)
    return total + (rest + (low - other_low))
