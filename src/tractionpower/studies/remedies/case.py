"""What a search knows before it begins: the study, who is late, who draws how much, whose demand causes the loss."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from tractionpower.model.remedies import RemedySearch
from tractionpower.model.scenario import Scenario
from tractionpower.studies.remedies.fleet import Declared, declared_of


@dataclass(frozen=True, slots=True)
class Peak:
    """The greatest current that a run takes [A] and its greatest power at the wheel in traction [kW]."""

    current_a: float = 0.0
    power_kw: float = 0.0


@dataclass(frozen=True, eq=False)
class Case:
    """A timetable that does not hold.

    Attributes
    ----------
    scenario
        The study.
    tolerance_s
        Lateness up to which a train is on time [s].
    late
        Greatest lateness of the runs that are late [s].
    delays
        Delay at calls with a planned time, by (run, station, kind) in the order of the route [s].
    culprits
        Runs by their share in the demand that causes the loss, the greatest first.
    peaks
        Greatest current and power of runs.
    """

    scenario: Scenario
    tolerance_s: float
    late: Mapping[str, float]
    delays: Mapping[tuple[str, str, str], tuple[float, ...]]
    culprits: tuple[str, ...]
    peaks: Mapping[str, Peak]

    @property
    def bounds(self) -> RemedySearch:
        """Bounds of the search."""
        return self.scenario.remedies

    @cached_property
    def known(self) -> dict[str, Declared]:
        """What the timetable declares, by the runs of the day."""
        return declared_of(self.scenario)

    @cached_property
    def foremost(self) -> tuple[Declared, ...]:
        """The train that is latest, those that draw the most, those that are late: as many as the bounds allow."""
        known = self.known
        worst = sorted(self.late, key=lambda run: (-self.late[run], run))
        names = [*worst[:1], *self.culprits, *worst[1:]]
        return tuple(dict.fromkeys(known[name] for name in names if name in known))[: self.bounds.subjects]
