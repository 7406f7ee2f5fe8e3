"""The spans of a graph as tables of the solver."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tractionpower.kernels.spans import LONG_ANGLE, SHORT_ANGLE
from tractionpower.kernels.tables import CONDUCTOR, NO_SLOT, SPAN
from tractionpower.supply.ordering import Structure
from tractionpower.supply.topology import Conductor, Span


@dataclass(frozen=True, slots=True)
class SpanTables:
    """Spans, conductors, terminals and scatter, see `tractionpower.kernels.tables.Network`.

    `first_conductor` is the number of the first conductor of each span.
    """

    spans: NDArray[np.void]
    conductors: NDArray[np.void]
    terminals: NDArray[np.int64]
    scatter: NDArray[np.int64]
    first_conductor: tuple[int, ...]


def span_tables(spans: Sequence[Span], number: Callable[[int], int], structure: Structure) -> SpanTables:
    """Return the tables of spans, with the number that `number` gives to each node."""
    rows: list[tuple[float | int, ...]] = []
    conductors: list[tuple[float | int, ...]] = []
    terminals: list[int] = []
    scatter: list[int] = []
    first_conductor: list[int] = []
    ground, place = len(structure.order), structure.place
    for span in spans:
        ends = [(number(c.left), number(c.right)) for c in span.conductors]
        left = sorted({i for i, _ in ends} - {ground})
        right = sorted({j for _, j in ends} - {ground} - set(left))
        own = right + left
        slots = {node: k for k, node in enumerate(own)}
        first_conductor.append(len(conductors))
        front = len(own)  # fronts come behind the ends, ground behind the fronts
        ground_slot = front + sum(c.ohm_per_m > 0.0 for c in span.conductors)
        for wire, (i, j) in zip(span.conductors, ends, strict=True):
            has_front = wire.ohm_per_m > 0.0
            left_slot, right_slot = slots.get(i, ground_slot), slots.get(j, ground_slot)
            whole = _whole_element(wire, span.length_m)
            slots_of = (left_slot, front if has_front else NO_SLOT, right_slot)
            conductors.append((wire.ohm_per_m, wire.siemens_per_m, *whole, i, j, place(i, j), *slots_of))
            front += has_front
        sizes = (len(span.conductors), front - len(own), len(terminals), len(right), len(left), len(scatter))
        rows.append((span.length_m, first_conductor[-1], *sizes))
        terminals += own
        scatter += [place(own[i], own[j]) for i in range(len(own)) for j in range(i + 1)]
    return SpanTables(
        np.array(rows, SPAN), np.array(conductors, CONDUCTOR), np.array(terminals, np.int64),
        np.array(scatter, np.int64), tuple(first_conductor),
    )  # fmt: skip


def _whole_element(wire: Conductor, length_m: float) -> tuple[float, float]:
    """Return conductance and shunt at either end [S] of a whole conductor; without resistance its ends are one node."""
    r, g = wire.ohm_per_m, wire.siemens_per_m
    if r == 0.0:
        return 0.0, 0.5 * g * length_m
    angle = math.sqrt(r * g) * length_m
    if angle < SHORT_ANGLE:
        return 1.0 / (r * length_m), 0.5 * g * length_m
    z = math.sqrt(r / g)
    return 1.0 / (z * math.sinh(min(angle, LONG_ANGLE))), math.tanh(0.5 * angle) / z
