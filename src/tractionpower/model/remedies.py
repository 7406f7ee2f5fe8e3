"""Bounds of the search for changes that save a timetable: which kinds, how far, in which steps, what each costs."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Real
from tractionpower.model.quantity import field

Kind = Literal["departure_shift", "current_cap", "power_cap", "headway", "reserve", "driving"]
KINDS: tuple[Kind, ...] = ("departure_shift", "current_cap", "power_cap", "headway", "reserve", "driving")


class RemedyCosts(Declaration):
    """What a change costs, in points: one point is a second by which the planned times of one train are moved."""

    departure_shift: Real = Field(default=1.0, ge=0, description="Points for each second of a shift and train.")
    current_cap: Real = Field(default=1.0, ge=0, description="Points for each percent below its greatest current and train.")
    power_cap: Real = Field(default=1.0, ge=0, description="Points for each percent below its greatest power and train.")
    headway: Real = Field(
        default=1.0, ge=0, description="Points for each second of headway and run of the service; runs that fall away cost as"
        " many points as a headway has seconds.",
    )  # fmt: skip
    reserve: Real = Field(default=10.0, ge=0, description="Points for each second of longer running time and train.")
    driving: Real = Field(default=1.0, ge=0, description="Points for each percent of reserve in a driving plan and train.")


class RemedySearch(Declaration):
    """Bounds of the search for the smallest change that makes a timetable feasible."""

    kinds: Annotated[tuple[Kind, ...], Field(min_length=1)] = Field(
        default=KINDS,
        description="Kinds of change that are allowed. departure_shift: all planned times of a train moved; current_cap,"
        " power_cap: of a train or a class; headway: of a service; reserve: later planned times of late trains;"
        " driving: a driving plan with reserve for the trains that draw the most.",
    )
    greatest_shift_s: Real = field("greatest_shift_s", "Greatest departure shift, earlier or later.", above=0, default=180.0)
    shift_step_s: Real = field("shift_step_s", "Step of departure shifts.", above=0, default=5.0)
    lowest_cap_percent: Real = field(
        "lowest_cap_percent",
        "Lowest cap, as a share of the greatest current or power that the train has in the run.",
        above=0,
        at_most=100,
        default=50.0,
    )
    cap_step_percent: Real = field("cap_step_percent", "Step of caps.", above=0, at_most=100, default=2.0)
    greatest_headway_factor: Real = Field(default=1.5, ge=1, description="Greatest headway, as a multiple of the planned one.")
    headway_step_s: Real = field("headway_step_s", "Step of headways.", above=0, default=15.0)
    greatest_reserve_s: Real = field(
        "greatest_reserve_s", "Greatest time by which a call is planned later.", above=0, default=300.0
    )
    reserve_step_s: Real = field("reserve_step_s", "Step of later planned times.", above=0, default=5.0)
    greatest_driving_percent: Real = field(
        "greatest_driving_percent", "Greatest reserve of a driving plan, of the shortest running time.", above=0, default=20.0
    )
    driving_step_percent: Real = field("driving_step_percent", "Step of the reserve of driving plans.", above=0, default=1.0)
    subjects: Count = Field(
        default=4, ge=1, description="Trains, classes and services tried of each kind: those that draw the most."
    )
    most_runs: Count = Field(
        default=250, ge=1, description="Most runs of the search; verifying runs and sensitivities not counted."
    )
    wall_time_s: Real = field(
        "wall_time_s",
        "Wall time of the search: after 60 % of it nothing new is tried, at its end nothing but the best proposal is verified.",
        above=0,
        default=240.0,
    )
    most_verified: Count = Field(
        default=6, ge=1, description="Proposals that are verified on the whole study, the cheapest first."
    )
    sensitivities: Count = Field(default=8, ge=0, description="Small changes for which the change of the lost seconds is told.")
    workers: Count = Field(default=2, ge=1, description="Runs at a time.")
    costs: RemedyCosts = Field(default=RemedyCosts(), description="What changes cost; the smallest change is the cheapest.")

    @model_validator(mode="after")
    def _steps_fit(self) -> RemedySearch:
        pairs = (
            ("shift_step_s", self.shift_step_s, "greatest_shift_s", self.greatest_shift_s),
            ("reserve_step_s", self.reserve_step_s, "greatest_reserve_s", self.greatest_reserve_s),
            ("driving_step_percent", self.driving_step_percent, "greatest_driving_percent", self.greatest_driving_percent),
        )
        for name, step, bound_name, bound in pairs:
            if step > bound:
                raise PydanticCustomError("step", "{name} is more than {bound}", {"name": name, "bound": bound_name})
        return self
