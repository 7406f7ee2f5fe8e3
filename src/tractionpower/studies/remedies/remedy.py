"""What a search for remedies has found, and how it is written down."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tractionpower.model.remedies import RemedyCosts


@dataclass(frozen=True, slots=True)
class Remedy:
    """A change of the timetable, and what it does.

    Attributes
    ----------
    kind
        Kind of change; two joined by a plus sign where one alone does not suffice.
    subject
        Train, class or service that is changed.
    size, unit
        Size of the change.
    words
        The change in a sentence.
    changes
        The change by paths, as for ``--set``.
    feasible
        Whether no train is late with it.
    verified
        Whether a run of the whole study with the network has shown that none is.
    lateness_after_s
        Greatest lateness of a train with it [s].
    lost_before_s, lost_after_s
        Seconds that all trains lose to low voltage without it and with it [s]; NaN where not computed.
    cost
        Cost in points of `tractionpower.model.remedies.RemedyCosts`.
    """

    kind: str
    subject: str
    size: float
    unit: str
    words: str
    changes: tuple[str, ...]
    feasible: bool
    verified: bool
    lateness_after_s: float
    lost_before_s: float
    lost_after_s: float
    cost: float


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """How the seconds that all trains lose to low voltage change with a small change of a device or a class.

    Attributes
    ----------
    kind
        What is changed, for example ``no_load_voltage``.
    subject
        Substation, section cabin or class of trains.
    per
        By how much, for example ``+1 %``.
    lost_s_change
        Change of the lost seconds of all trains [s]; negative: less is lost.
    change
        The change by paths, as for ``--set``.
    """

    kind: str
    subject: str
    per: str
    lost_s_change: float
    change: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Remedies:
    """What a search has found.

    Attributes
    ----------
    found
        The cheapest change of every kind and subject that saves the timetable, in the order of their costs; then those
        that do not suffice, the nearest first.
    tried
        Number of runs with the network.
    sensitivities
        Sensitivities of the lost seconds, the greatest first.
    notes
        What a reader should know: why only reserve was searched, what was left untried, what "smallest" means.
    interrupted
        Whether the search was broken off, by Ctrl-C or its wall time.
    stopped
        Whether that was Ctrl-C.
    reused
        Number of the runs that an earlier search had made.
    """

    found: tuple[Remedy, ...]
    tried: int
    sensitivities: tuple[Sensitivity, ...] = ()
    notes: tuple[str, ...] = ()
    interrupted: bool = False
    stopped: bool = False
    reused: int = field(default=0, compare=False)

    @property
    def best(self) -> Remedy | None:
        """The cheapest verified change that makes the timetable feasible; None if none was found."""
        return next((remedy for remedy in self.found if remedy.feasible and remedy.verified), None)


def as_notes(items: Remedies | Sequence[Remedy] | Sequence[Sensitivity]) -> list[dict[str, Any]]:
    """Return remedies or sensitivities as they stand in ``run.json``; of `Remedies` those found."""
    rows = items.found if isinstance(items, Remedies) else items
    return [{key: _plain(value) for key, value in dataclasses.asdict(row).items()} for row in rows]


def costs_in_words(costs: RemedyCosts) -> str:
    """Return how the size of changes is measured."""
    return (
        "Smallest means cheapest. Points by the study's bounds of the search:"
        f" {costs.departure_shift:g} for each second and train of a departure shift, {costs.reserve:g} for each second and train"
        f" of later planned times, {costs.current_cap:g} for each percent and train of a cap on current and {costs.power_cap:g}"
        f" on power, {costs.headway:g} for each second and run of a larger headway, {costs.driving:g} for each percent and train"
        " of a driving plan with reserve."
    )


def _plain(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None  # JSON knows neither NaN nor infinity
    return list(value) if isinstance(value, tuple) else value
