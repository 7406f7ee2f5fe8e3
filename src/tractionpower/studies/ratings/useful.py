"""The lowest mean useful voltages of a run: of zones and trains, by both definitions, in the run and in its worst parts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from tractionpower.cosimulation.useful_voltage_recorder import UsefulVoltageRecorder
from tractionpower.model.base import format_time
from tractionpower.model.limits import Limit
from tractionpower.results.key_figures import KeyFigure

DEFINITIONS = {"current_weighted_v": "current-weighted", "time_mean_v": "time mean"}
"""The two definitions, by column, in words."""


class LowestUseful(NamedTuple):
    """The lowest mean useful voltage of a kind, by one definition, of all windows of one kind.

    Attributes
    ----------
    kind, subject
        zone or train, and which.
    definition
        Column of table ``useful_voltage``.
    window, from_s, to_s
        run, hour or given, and which [s].
    value_v
        The voltage [V].
    """

    kind: str
    definition: str
    window: str
    from_s: float
    to_s: float
    value_v: float
    subject: str

    @property
    def when(self) -> str:
        """When its window begins; empty for the whole run."""
        return "" if self.window == "run" else format_time(self.from_s)


def lowest_useful(voltages: UsefulVoltageRecorder) -> tuple[LowestUseful, ...]:
    """Return the lowest mean useful voltages that there are; of equal ones that of the first window."""
    means, found = voltages.means(), dict[tuple[str, str, str], LowestUseful]()
    for kind in ("zone", "train"):
        for definition in DEFINITIONS:
            for each in means:
                window, (value_v, subject) = each.window, voltages.lowest(kind, definition, each)
                lowest = LowestUseful(kind, definition, window.kind, window.from_s, window.to_s, value_v, subject)
                known = found.get(lowest[:3])
                if math.isfinite(value_v) and (known is None or round(value_v, 6) < round(known.value_v, 6)):
                    found[lowest[:3]] = lowest
    return tuple(found.values())


def useful_figures(found: tuple[LowestUseful, ...], limit: Limit | None) -> Iterator[KeyFigure]:
    """Yield the lowest mean useful voltages as key figures."""
    words = {"run": "of the run", "hour": "of an hour by the clock", "given": "of a given part of the day"}
    for each in found:
        name = f"lowest_useful_voltage_{each.kind}_{each.definition.removesuffix('_v')}_{each.window}_v"
        told = f"lowest mean useful voltage of a {each.kind}, {DEFINITIONS[each.definition]}, {words[each.window]}"
        yield KeyFigure(name, each.value_v, f"{each.kind} {each.subject}", each.when, told, "" if limit is None else limit.status)
