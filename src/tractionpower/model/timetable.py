"""The scheduled timetable (RJ): which train runs when and where, and where it stops."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Identifier, Real, Text, TimeOfDay
from tractionpower.model.quantity import field
from tractionpower.model.vehicle import Part


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


class TrainRun(Declaration):
    """One train of the timetable."""

    id: Identifier = Field(description="Identifier of the run.")
    train: Identifier | None = Field(default=None, description="The train, by the name of its file.")
    vehicles: tuple[Part, ...] = Field(default=(), description="Vehicles in place of a train, from the front.")
    category: Text | None = Field(default=None, description="Category in place of that of the train.")
    route: Annotated[tuple[Leg, ...], Field(min_length=1, description="Legs of the route, in order.")]
    start: Start | None = Field(default=None, description="Start of the run; left out: at rest, by the first call's departure.")
    end: Literal["leave", "stop", "stay"] | None = Field(
        default=None,
        description="leave: at its speed at the end of the route; stop: at the last call, or the end of the route, leaving after"
        " its dwell; stay: there with its auxiliaries. Left out: stop if the last call is a stop, else leave.",
    )
    calls: tuple[Call, ...] = Field(default=(), description="Stations in the order of the run.")

    @model_validator(mode="after")
    def _is_complete(self) -> TrainRun:
        if (self.train is None) == (not self.vehicles):
            found = "both" if self.vehicles else "neither"
            raise PydanticCustomError("train_run", "a run has either train or vehicles, found {found}", {"found": found})
        if self.start is None and not (self.calls and self.calls[0].departure is not None):
            raise PydanticCustomError("train_run", "a run has a start, or a first call with a departure")
        return self


class Timetable(Declaration):
    """The trains that run."""

    format: Format = 1
    trains: tuple[TrainRun, ...] = Field(default=(), description="The trains; left out: a network calculation.")
