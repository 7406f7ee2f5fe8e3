"""How a timetable is judged: what counts as late."""

from __future__ import annotations

from tractionpower.model.base import Declaration, Real
from tractionpower.model.quantity import field


class Feasibility(Declaration):
    """What the study of feasibility asks of a timetable."""

    tolerance_s: Real = field("tolerance_s", "A train is late at a call if it is later than this.", at_least=0, default=1.0)
