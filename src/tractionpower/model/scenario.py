"""A scenario: everything that one run needs, resolved and frozen; and the study file that names its parts."""

from __future__ import annotations

import hashlib
import json
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Format, Real, Text, TimeOfDay
from tractionpower.model.conductors import Conductor, used_conductors
from tractionpower.model.contingency import Contingency
from tractionpower.model.feasibility import Feasibility
from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.quantity import field
from tractionpower.model.ratings import DutyRow, RectifierUnit, used_duty, used_units
from tractionpower.model.remedies import RemedySearch
from tractionpower.model.services import unfold
from tractionpower.model.sizing import Sizing
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Day, Timetable, TrainRun
from tractionpower.model.vehicle import Train, Vehicle

ROUNDING_S = 5e-7
"""A step starts at a time of day when it starts this much before it: start + k step is rounded, times have microseconds [s]."""


class Clock(Declaration):
    """The simulated time."""

    start: TimeOfDay = Field(description="Start of the simulation.")
    end: TimeOfDay = Field(description="End of the simulation.")
    step_s: Real = field("step_s", "Length of a time step.", at_least=0.02, at_most=5.0, default=1.0)
    warm_up: TimeOfDay | None = Field(
        default=None, description="Length of the first part of the run, as HH:MM[:SS], that is left out of the key figures."
    )

    @model_validator(mode="after")
    def _runs_forward(self) -> Clock:
        if not self.start < self.end:
            raise PydanticCustomError("clock", "start is not before end")
        if self.warm_up is not None and self.warm_up >= self.end - self.start:
            raise PydanticCustomError("clock", "warm_up leaves nothing of the run")
        return self

    @property
    def counts_from_s(self) -> float:
        """From when on a run counts in key figures [s after midnight]: the end of the warm-up."""
        return self.start + (self.warm_up or 0.0)


class Output(Declaration):
    """What a run writes."""

    every_s: Real | None = field("every_s", "Interval of the rows; left out: every step.", above=0, default=None)
    tables: tuple[Text, ...] | None = Field(default=None, description="Tables to write; left out: all.")
    rails_every_s: Real = field(
        "rails_every_s",
        "Interval of the rows of table rails, whose places are many; to the nearest whole number of steps.",
        above=0,
        default=60.0,
    )


class StudyFile(Declaration):
    """The file ``study.yaml``: names the parts of a study and sets the clock."""

    format: Format = 1
    name: Text = Field(default="", description="Name for people.")
    line: Text = Field(default="line.yaml", description="File of the line.")
    supply: Text = Field(default="supply.yaml", description="File of the supply system.")
    timetable: Text | None = Field(default=None, description="File of the timetable; left out: a network calculation.")
    clock: Clock = Field(description="The simulated time.")
    day: Day | None = Field(default=None, description="Day of the week, where trains have days of operation.")
    coupling: Literal["full", "constant_voltage"] = Field(
        default="full", description="full: trains and network in one step; constant_voltage: currents at a fixed voltage."
    )
    coupling_voltage_v: Real | None = field(
        "coupling_voltage_v", "Voltage of the constant-voltage coupling.", above=0, default=None, source="U_n of the system"
    )
    seed: Count = Field(default=1, ge=0, description="Seed of everything that is drawn.")
    limits: Text | None = Field(default=None, description="CSV file that overlays the shipped limits row by row.")
    conductors: Text | None = Field(default=None, description="CSV file that overlays the shipped conductors row by row.")
    duty_classes: Text | None = Field(default=None, description="CSV file that overlays the shipped classes, each as a whole.")
    rectifier_units: Text | None = Field(default=None, description="CSV file that overlays the shipped units row by row.")
    coast_without_voltage_s: Real = field(
        "coast_without_voltage_s",
        "How long a train on a dead contact line coasts before it brakes to a stand.",
        at_least=0,
        default=120.0,
    )
    report: Text | None = Field(default=None, description="File of the template of reports; left out: English, all sheets.")
    output: Output = Field(default=Output(), description="What a run writes.")
    feasibility: Feasibility = Field(default=Feasibility(), description="How the timetable is judged.")
    remedies: RemedySearch = Field(
        default=RemedySearch(), description="Bounds of the search for changes that make the timetable feasible."
    )
    sizing: Sizing = Field(default=Sizing(), description="What the study of ratings asks for.")
    contingency: Contingency = Field(default=Contingency(), description="Which outages are looked at.")


class Scenario(Declaration):
    """One run, resolved: no file names, all parts in place.

    Equal scenarios have equal `input_hash`, whatever the files were called. Of conductors, duty classes and rectifier units
    it keeps the rows that its supply uses, so that a row that nobody uses changes no hash.
    """

    name: Text = ""
    line: Line
    supply: Supply
    timetable: Timetable = Timetable()
    trains: tuple[Train, ...] = ()
    vehicles: tuple[Vehicle, ...] = ()
    clock: Clock
    day: Day | None = None
    coupling: Literal["full", "constant_voltage"] = "full"
    coupling_voltage_v: Real | None = None
    seed: Count = 1
    limits: tuple[Limit, ...]
    conductors: tuple[Conductor, ...] = ()
    coast_without_voltage_s: Real = 120.0
    output: Output = Output()
    feasibility: Feasibility = Feasibility()
    remedies: RemedySearch = RemedySearch()
    duty_classes: tuple[DutyRow, ...] = ()
    rectifier_units: tuple[RectifierUnit, ...] = ()
    sizing: Sizing = Sizing()
    contingency: Contingency = Contingency()

    @model_validator(mode="after")
    def _keeps_what_it_uses(self) -> Scenario:
        self.__dict__["conductors"] = used_conductors(self.supply, self.conductors)
        self.__dict__["rectifier_units"] = used_units(self.supply, self.rectifier_units)
        self.__dict__["duty_classes"] = used_duty(self.supply, self.duty_classes, self.rectifier_units)
        return self

    @property
    def runs(self) -> tuple[TrainRun, ...]:
        """All trains of the day, those of services included."""
        return unfold(self.timetable, self.day)

    @property
    def input_hash(self) -> str:
        """SHA-256 of the canonical JSON of this scenario."""
        plain = self.model_dump(mode="json", by_alias=True)
        text = json.dumps(plain, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
        return hashlib.sha256(text.encode()).hexdigest()
