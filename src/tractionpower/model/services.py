"""The runs of a day: trains as declared, and those that services stand for."""

from __future__ import annotations

from functools import lru_cache

from tractionpower.model.timetable import Day, Timetable, TrainRun


@lru_cache(maxsize=8)
def unfold(timetable: Timetable, day: Day | None) -> tuple[TrainRun, ...]:
    """Return the runs of a timetable on a day: its trains, and the runs of its services.

    Parameters
    ----------
    timetable
        The timetable as declared.
    day
        The day; None: everything runs that is not bound to days.
    """
    return tuple(run for run in timetable.trains if run.days is None or day in run.days)
