"""The scheduled timetable (RJ): which train runs when and where, and where it stops."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Identifier, Real, Text, TimeOfDay
from tractionpower.model.driving import Driving
from tractionpower.model.quantity import field
from tractionpower.model.vehicle import Part

Day = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]


def _days(value: Any) -> Any:
    return value.split() if isinstance(value, str) else value  # in a CSV cell days are separated by blanks


Days = Annotated[tuple[Day, ...], BeforeValidator(_days)]


class Leg(Declaration):
    """A part of a route on one track; with falling kilometres the train runs in that direction."""

    track: Identifier = Field(description="The track.")
    from_km: Real = field("from_km", "Where the front of the train comes onto it.")
    to_km: Real = field("to_km", "Where the front of the train leaves it.")

    @model_validator(mode="after")
    def _has_a_length(self) -> Leg:
        if self.from_km == self.to_km:
            raise PydanticCustomError("leg", "from_km and to_km are the same place: km {km}", {"km": f"{self.from_km:.10g}"})
        return self


class Start(Declaration):
    """When and how a train begins its run, at the start of its route."""

    time: TimeOfDay = Field(description="Time at which it enters.")
    speed_kmh: Real = field("speed_kmh", "Speed at which it enters.", at_least=0, default=0.0)


class Call(Declaration):
    """A station of a train's run: a stop, or with `stops: false` a place that it passes."""

    station: Identifier = Field(description="The station.")
    arrival: TimeOfDay | None = Field(default=None, description="Planned arrival, or the time of passing.")
    departure: TimeOfDay | None = Field(default=None, description="Planned departure; no train leaves before it.")
    min_dwell_s: Real = field("min_dwell_s", "Shortest time at the station.", at_least=0, default=0.0)
    stops: bool = Field(default=True, strict=True, description="Whether the train stops there.")


class _Trip(Declaration):
    # What runs and services share.
    train: Identifier | None = Field(default=None, description="The train, by the name of its file.")
    vehicles: tuple[Part, ...] = Field(default=(), description="Vehicles in place of a train, from the front.")
    category: Text | None = Field(default=None, description="Category in place of that of the train.")
    route: Annotated[tuple[Leg, ...], Field(min_length=1, description="Legs of the route, in order.")]
    end: Literal["leave", "stop", "stay"] | None = Field(
        default=None,
        description="leave: at its speed at the end of the route; stop: at the last call, or the end of the route, leaving after"
        " its dwell; stay: there with its auxiliaries. Left out: stop if the last call is a stop, else leave.",
    )
    driving: Driving | None = Field(default=None, description="How it is driven while it is on time; left out: as all trains.")
    max_current_a: Real | None = field(
        "max_current_a",
        "Largest current that the train takes while it moves, whatever line and vehicle allow.",
        above=0,
        default=None,
    )
    max_power_kw: Real | None = field(
        "max_power_kw", "Greatest power at the wheel in traction, whatever the vehicle can.", above=0, default=None
    )
    days: Days | None = Field(default=None, description="Days of operation; left out: every day.")

    @model_validator(mode="after")
    def _has_one_train(self) -> Self:
        if (self.train is None) == (not self.vehicles):
            found = "both" if self.vehicles else "neither"
            raise PydanticCustomError("train_run", "a run has either train or vehicles, found {found}", {"found": found})
        return self


class TrainRun(_Trip):
    """One train of the timetable."""

    id: Identifier = Field(description="Identifier of the run.")
    start: Start | None = Field(default=None, description="Start of the run; left out: at rest, by the first call's departure.")
    calls: tuple[Call, ...] = Field(default=(), description="Stations in the order of the run.")

    @model_validator(mode="after")
    def _starts(self) -> TrainRun:
        if self.start is None and not (self.calls and self.calls[0].departure is not None):
            raise PydanticCustomError("train_run", "a run has a start, or a first call with a departure")
        return self


class Service(_Trip):
    """A periodic service: equal runs at equal intervals, named by the service and the time at which they start."""

    id: Identifier = Field(description="Identifier of the service; its run at 05:10 is called `ID 05:10`.")
    first: TimeOfDay = Field(description="Start of the first run.")
    last: TimeOfDay = Field(description="No run starts after this time.")
    headway_s: Real = field("headway_s", "Time from one run to the next.", at_least=1)
    start_speed_kmh: Real = field("start_speed_kmh", "Speed at which the runs enter.", at_least=0, default=0.0)
    calls: tuple[Call, ...] = Field(default=(), description="Stations in the order of the run; times are counted from its start.")

    @model_validator(mode="after")
    def _runs(self) -> Service:
        if self.last < self.first:
            raise PydanticCustomError("service", "last is before first; past midnight hours go on beyond 24")
        return self


class Rotation(Declaration):
    """What becomes of trains at the end of their runs: each turns into the next one of a list."""

    id: Identifier | None = Field(default=None, description="Identifier of the rotation.")
    runs: Annotated[tuple[Identifier, ...], Field(min_length=2, description="Runs of one train set, in order.")]
    turn_round_s: Real = field(
        "turn_round_s", "Shortest time from the end of a run to the start of the next.", at_least=0, default=0.0
    )


class Join(Declaration):
    """Portions that become one train: it starts when the last of them has come."""

    portions: Annotated[tuple[Identifier, ...], Field(min_length=2, description="Runs that end as portions.")]
    into: Identifier = Field(description="Run that they become.")
    coupling_s: Real = field("coupling_s", "Shortest time from the last arrival to the start.", at_least=0, default=0.0)


class Split(Declaration):
    """A train that is split: its portions start when it has come."""

    run: Identifier = Field(description="Run that ends.")
    portions: Annotated[tuple[Identifier, ...], Field(min_length=2, description="Runs that its portions become.")]
    uncoupling_s: Real = field("uncoupling_s", "Shortest time from its arrival to the first start.", at_least=0, default=0.0)


class Timetable(Declaration):
    """The trains that run."""

    format: Format = 1
    driving: Driving | None = Field(default=None, description="How trains are driven that do not say it; left out: flat out.")
    trains: tuple[TrainRun, ...] = Field(default=(), description="The trains; left out: a network calculation.")
    services: tuple[Service, ...] = Field(default=(), description="Periodic services.")
    rotations: tuple[Rotation, ...] = Field(default=(), description="Trains that turn into others.")
    joins: tuple[Join, ...] = Field(default=(), description="Portions that are joined.")
    splits: tuple[Split, ...] = Field(default=(), description="Trains that are split.")
    carry_over: bool = Field(
        default=False,
        strict=True,
        description="Whether trains of the day before that are under way past 24:00 run at the start of this one as well.",
    )
