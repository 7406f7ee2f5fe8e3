"""How a train is driven: the plan that its driver follows while it is on time. A late train is driven flat out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Identifier, Real, TimeOfDay
from tractionpower.model.quantity import field


class FlatOut(Declaration):
    """Greatest effort, the highest speed allowed, the latest braking: the shortest running time."""

    kind: Literal["flat_out"] = Field(description="Kind of plan.")


class CoastingMark(Declaration):
    """A place from which the driver coasts."""

    km: Real = field("km", "Where coasting begins.")
    to_km: Real | None = field("to_km", "Where it ends; left out: at the next stop, or at the next mark.", default=None)
    track: Identifier | None = Field(default=None, description="The track; left out: whichever the route is on at this km.")


class _OnTime(Declaration):
    late_after_s: Real = field(
        "late_after_s", "Lateness from which on a train is driven flat out until it is on time.", at_least=0, default=1.0
    )
    voltage_v: Real | None = field(
        "voltage_v",
        "Voltage at the pantograph for which the plan is made, by which it is on time; left out: the nominal one.",
        above=0,
        default=None,
    )


class Rules(_OnTime):
    """Rules that hold together: a reduced cruising speed, coasting from marks, a capped effort."""

    kind: Literal["rules"] = Field(description="Kind of plan.")
    speed_percent: Real | None = field(
        "speed_percent", "Cruising speed as a share of the speed limit.", above=0, at_most=100, default=None
    )
    speed_kmh: Real | None = field("speed_kmh", "Greatest cruising speed.", above=0, default=None)
    coast_from: tuple[CoastingMark, ...] = Field(default=(), description="Coasting marks, in the order of the route.")
    coast_before_stops_km: Real | None = field(
        "coast_before_stops_km", "Length of the coasting before each stop.", above=0, default=None
    )
    coast_down_to_kmh: Real = field(
        "coast_down_to_kmh", "Speed below which the driver takes power again while coasting.", at_least=0, default=0.0
    )
    effort_percent: Real | None = field(
        "effort_percent", "Tractive effort as a share of the greatest at each speed.", above=0, at_most=100, default=None
    )

    @model_validator(mode="after")
    def _has_a_rule(self) -> Rules:
        rules = (self.speed_percent, self.speed_kmh, self.coast_before_stops_km, self.effort_percent)
        if not self.coast_from and all(rule is None for rule in rules):
            text = "rules need one of speed_percent, speed_kmh, coast_from, coast_before_stops_km, effort_percent"
            raise PydanticCustomError("driving", text)
        return self


class _Saving(_OnTime):
    method: Literal["optimal", "cruise"] = Field(
        default="optimal",
        description="How spare time is used. optimal: greatest effort, cruising, coasting and braking with the least energy;"
        " cruise: the same reduced share of the speed limit everywhere.",
    )
    returned_percent: Real = field(
        "returned_percent",
        "Share of the energy fed back that counts as saved: what other trains or substations take.",
        at_least=0,
        at_most=100,
        default=100.0,
    )
    slowest_kmh: Real = field(
        "slowest_kmh", "No slower cruising than this, only coasting to a stop; time left is waited there.", above=0, default=20.0
    )


class ToTime(_Saving):
    """Arrive on time with the least energy: the running time between timed calls is that of the timetable."""

    kind: Literal["to_time"] = Field(description="Kind of plan.")


class Reserve(_Saving):
    """A reserve on the shortest running time, spread over the run in proportion to it."""

    kind: Literal["reserve"] = Field(description="Kind of plan.")
    percent: Real | None = field("percent", "Reserve as a share of the shortest running time.", at_least=0, default=None)
    seconds: Real | None = field("seconds", "Reserve of the whole run.", at_least=0, default=None)

    @model_validator(mode="after")
    def _has_one_measure(self) -> Reserve:
        if (self.percent is None) == (self.seconds is None):
            raise PydanticCustomError("driving", "a reserve has either percent or seconds")
        return self


class Eco(_Saving):
    """The least energy for a given running time of the whole run, stops left out; calls are not met on time."""

    kind: Literal["eco"] = Field(description="Kind of plan.")
    running_time: TimeOfDay = Field(description="Running time of the run without its dwells, as HH:MM[:SS].")


Driving = Annotated[FlatOut | Rules | ToTime | Reserve | Eco, Field(discriminator="kind")]

FLAT_OUT = FlatOut(kind="flat_out")
