"""A small study of trains with planned times, what a search knows of it, and judgements made by hand."""

from types import SimpleNamespace
from typing import Any

from coupled import couple, run

from tractionpower.model.scenario import Scenario
from tractionpower.studies.feasibility import CallDelay, Judgement, LostTime, TrainVerdict
from tractionpower.studies.remedies.case import Case, Peak

NIGHT = 36_000.0
"""Clock of the study: the trains run in the first hour of ten [s]."""


def planned(name: str, at: float, *, track: str = "1", arrival: float = 900.0, **more: Any) -> dict[str, Any]:
    """Return a run from A to B that departs `at` and is planned `arrival` later at B, passing P on its way."""
    calls = [
        {"station": "A", "departure": at},
        {"station": "P", "arrival": at + arrival / 3.0, "stops": False},
        {"station": "B", "arrival": at + arrival},
    ]
    return run(name, track=track, calls=calls, **more) | {"start": None}


def small_study(*runs: dict[str, Any], end_s: float = 1800.0, **more: Any) -> Scenario:
    """Return a study of two trains, X and Y, or of those given; `remedies` are bounds of the search, `timetable` more of it."""
    remedies, timetable = more.pop("remedies", {}), more.pop("timetable", {})
    plain = couple(*(runs or (planned("X", 300.0), planned("Y", 420.0, track="2"))), end_s=end_s, **more)
    data = plain.model_dump(by_alias=True) | {"remedies": remedies}
    data["timetable"] |= timetable
    return Scenario.model_validate(data)


def case_of(scenario: Scenario, late: dict[str, float] | None = None, **more: Any) -> Case:
    """Return what a search knows when X is 20 s late at B, 5 s of it since P, and both trains draw 1000 A and 2500 kW."""
    late = {"X": 20.0} if late is None else late
    delays = {("X", "A", "departure"): (0.0,), ("X", "P", "pass"): (5.0,), ("X", "B", "arrival"): (20.0,)}
    names = [each.id for each in scenario.runs]
    known = {"delays": delays, "culprits": tuple(names), "peaks": {name: Peak(1000.0, 2500.0) for name in names}}
    return Case(scenario, 1.0, late, **(known | more))


def judged(late: dict[str, float], *, lost_s: float = 0.0, alone: float = 0.0, overlaps: int = 0) -> Judgement:
    """Return a judgement by how late trains are at B, of which `alone` [s] is the timetable's."""
    trains = tuple(
        TrainVerdict(name, "infeasible" if seconds > 1.0 else "feasible", late_s=seconds) for name, seconds in late.items()
    )
    delays = tuple(
        CallDelay(
            name, "B", "arrival", 0.0, seconds, max(seconds, 0.0),
            origin_timetable_s=min(alone, seconds), origin_voltage_s=max(seconds - alone, 0.0),
        )
        for name, seconds in late.items()
    )  # fmt: skip
    lost = tuple(LostTime(name, "1", 1.5, "B", lost_s / len(late)) for name in late)
    holds = all(train.verdict == "feasible" for train in trains)
    outcome: Any = SimpleNamespace(run={"overlaps": {"count": overlaps}})
    return Judgement(outcome, trains, delays, (), lost, "feasible" if holds else "infeasible", 0.0, 1.0)
