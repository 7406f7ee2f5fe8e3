"""Is the timetable feasible on this supply? Trains alone and with the network, delays split by cause, verdicts."""

from tractionpower.studies.feasibility.judgement import CallDelay, Judgement, LostTime, SectionVerdict, TrainVerdict
from tractionpower.studies.feasibility.study import feasibility, judge, lateness

__all__ = ["CallDelay", "Judgement", "LostTime", "SectionVerdict", "TrainVerdict", "feasibility", "judge", "lateness"]
