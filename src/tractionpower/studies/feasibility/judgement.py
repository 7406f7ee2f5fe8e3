"""What the study of feasibility finds: delays by cause, sections, seconds lost by place, verdicts. Times in s."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from tractionpower.errors import Problem
from tractionpower.results.outcome import Outcome

NAN = float("nan")

Verdict = Literal["feasible", "infeasible", "not finished", "not judged"]

FEASIBLE: Final = "feasible"
INFEASIBLE: Final = "infeasible"
NOT_FINISHED: Final = "not finished"
NOT_JUDGED: Final = "not judged"
"""Verdicts on trains; not judged: it has no planned time, or nothing of its run lies within the time that counts."""


@dataclass(frozen=True, slots=True)
class CallDelay:
    """The delay of a train at a timed arrival, departure or passing, and its parts [s]; a row of table ``delays``.

    Where the train did not get there, times and parts are NaN. Those without `origin` add up to the delay, and so do those
    with it, in which knock-on is followed back to where it first arose.
    """

    train: str
    station: str
    kind: str
    planned_s: float
    actual_s: float = NAN
    delay_s: float = NAN
    knock_on_s: float = NAN
    timetable_s: float = NAN
    current_limit_s: float = NAN
    voltage_s: float = NAN
    dwell_s: float = NAN
    driving_s: float = NAN
    cause: str = ""
    origin_timetable_s: float = NAN
    origin_current_limit_s: float = NAN
    origin_voltage_s: float = NAN
    origin_dwell_s: float = NAN
    origin_driving_s: float = NAN

    @property
    def late_s(self) -> float:
        """Computed less planned time [s]; negative is early."""
        return self.actual_s - self.planned_s


@dataclass(frozen=True, slots=True)
class SectionVerdict:
    """Running times of a train from one timed call to the next [s]; a row of table ``sections``.

    `from_station` is empty where the section begins at the start of the run.
    """

    train: str
    from_station: str
    to_station: str
    from_km: float
    to_km: float
    planned_s: float
    shortest_s: float
    limited_s: float
    recorded_s: float
    actual_s: float
    worst_track: str = ""
    worst_km: float = NAN
    area: str = ""
    lowest_voltage_v: float = NAN

    @property
    def reserve_s(self) -> float:
        """What the timetable gives beyond the shortest running time [s]."""
        return self.planned_s - self.shortest_s

    @property
    def reserve_left_s(self) -> float:
        """What current limits and voltage leave of the reserve [s]."""
        return self.planned_s - self.recorded_s

    @property
    def lost_voltage_s(self) -> float:
        """Seconds lost to low voltage; negative are gained."""
        return self.recorded_s - self.limited_s

    @property
    def lost_current_s(self) -> float:
        """Seconds lost to train current limits."""
        return self.limited_s - self.shortest_s


@dataclass(frozen=True, slots=True)
class LostTime:
    """Seconds that a train loses to low voltage within a kilometre of a track; a row of table ``lost_time``."""

    train: str
    track: str
    km: float
    area: str
    lost_s: float


@dataclass(frozen=True, slots=True)
class TrainVerdict:
    """The verdict on one train.

    Attributes
    ----------
    train, verdict
        Identifier of the run, and one of feasible, infeasible, not finished, not judged.
    reserve_left_s, reserve_left_at
        Least time by which it could come before a planned arrival or passing, driven flat out on the recorded voltages
        and leaving no stop before its time [s]; and the section that ends there. NaN without a timed call.
    worst_station, late_s, cause
        Where it is latest, how late [s], and the largest part of that by where it first arose.
    why
        The verdict in a sentence.
    shortest_s, running_time_ratio
        Running time alone at nominal voltage [s], stops left out; that on the recorded voltages divided by that at nominal
        voltage, both with current limits (quality index of the supply).
    mean_useful_voltage_current_weighted_v, mean_useful_voltage_time_mean_v
        Mean useful voltage by both definitions [V].
    lost_voltage_s, lost_area
        Seconds lost to low voltage over the run, and the area in which most of them are lost.
    """

    train: str
    verdict: Verdict
    reserve_left_s: float = NAN
    reserve_left_at: str = ""
    worst_station: str = ""
    late_s: float = NAN
    cause: str = ""
    why: str = ""
    shortest_s: float = NAN
    running_time_ratio: float = NAN
    mean_useful_voltage_current_weighted_v: float = NAN
    mean_useful_voltage_time_mean_v: float = NAN
    lost_voltage_s: float = NAN
    lost_area: str = ""

    @property
    def holds(self) -> bool:
        """Whether the timetable holds for this train."""
        return self.verdict in (FEASIBLE, NOT_JUDGED)


@dataclass(frozen=True)
class Judgement:
    """The timetable judged.

    Attributes
    ----------
    outcome
        How the run with the network ended; its `run` has the key ``feasibility``.
    trains, delays, sections, lost
        By train, in the order of their identifiers, and then in the order of the run.
    verdict, reserve_left_s
        Of the timetable: feasible if it is for every train, not judged if no train came to a call with a planned time within
        the time that counts; the least reserve that a train has left [s], NaN without one.
    tolerance_s
        A train is late if it is later than this [s].
    warnings
        Warnings of the checks, and of the study.
    """

    outcome: Outcome
    trains: tuple[TrainVerdict, ...]
    delays: tuple[CallDelay, ...]
    sections: tuple[SectionVerdict, ...]
    lost: tuple[LostTime, ...]
    verdict: Literal["feasible", "infeasible", "not judged"]
    reserve_left_s: float
    tolerance_s: float
    warnings: tuple[Problem, ...] = ()
