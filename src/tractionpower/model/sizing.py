"""What a study of ratings looks at, and the bounds of its search for equipment that meets the limits."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Identifier, Real, TimeOfDay, Tracks
from tractionpower.model.quantity import field


class Zone(Declaration):
    """A part of the line of which the mean useful voltage is told."""

    id: Identifier = Field(description="Identifier of the zone.")
    from_km: Real = field("from_km", "Where it begins.")
    to_km: Real = field("to_km", "Where it ends.")
    tracks: Tracks | None = Field(default=None, description="Tracks that belong to it; left out: all.")

    @model_validator(mode="after")
    def _has_a_length(self) -> Zone:
        if not self.from_km < self.to_km:
            raise PydanticCustomError("zone", "from_km is not below to_km")
        return self


class Window(Declaration):
    """A part of the day of which the mean useful voltage is told."""

    from_: TimeOfDay = Field(alias="from", description="When it begins.")
    to: TimeOfDay = Field(description="When it ends.")

    @model_validator(mode="after")
    def _has_a_length(self) -> Window:
        if not self.from_ < self.to:
            raise PydanticCustomError("window", "from is not before to")
        return self


class UsefulVoltageStudy(Declaration):
    """Where and when the mean useful voltage is told, and what it is held against."""

    zones: tuple[Zone, ...] = Field(default=(), description="Zones; none: between neighbouring substations, each of all tracks.")
    windows: tuple[Window, ...] = Field(default=(), description="Parts of the day, beside every whole hour and the whole run.")
    shortest_stay_s: Real = field(
        "shortest_stay_s", "A train that is in a zone for less time than this within a window does not count there.",
        at_least=0, default=60.0,
    )  # fmt: skip
    line_class: Literal["conventional", "high_speed"] = Field(
        default="conventional", description="Class of the line, by which the limits table gives the lowest mean useful voltage."
    )


class SizingSearch(Declaration):
    """Bounds of the search for the least equipment that meets the limits."""

    outages: bool = Field(default=True, description="Whether the limits must hold in every single outage, too.")
    most_units: Count = Field(default=4, ge=1, description="Most rectifier units of a substation.")
    fewest_units: Count = Field(default=1, ge=1, description="Fewest rectifier units of a substation.")
    most_cables: Count = Field(default=6, ge=1, description="Most cables in parallel of a feeder.")
    contact_lines: tuple[Identifier, ...] = Field(
        default=(), description="Types of contact line that may be built, in the order of their cost; none: as it is."
    )
    most_runs: Count = Field(
        default=120, ge=1, description="Most rounds of the search; a round runs all cases of a design, or some of them."
    )
    unit_points: Real = Field(default=10.0, ge=0, description="Cost of a rectifier unit, in points.")
    cable_points: Real = Field(default=0.5, ge=0, description="Cost of a cable of a feeder, in points.")
    contact_line_points: Real = Field(default=1.0, ge=0, description="Cost of each kilometre and step of contact line.")

    @model_validator(mode="after")
    def _bounds_fit(self) -> SizingSearch:
        if self.fewest_units > self.most_units:
            raise PydanticCustomError("bounds", "fewest_units is more than most_units")
        return self


class Sizing(Declaration):
    """What a study of ratings asks for."""

    utilisation_percent: Real = field(
        "utilisation_percent", "Highest utilisation of a device that passes, of what its rating permits.",
        above=0, at_most=200, default=100.0,
    )  # fmt: skip
    breaker_percent: Real = field(
        "breaker_percent", "Highest current of a feeder that passes, of the setting of its breaker.", above=0, at_most=100,
        default=100.0,
    )  # fmt: skip
    useful_voltage: UsefulVoltageStudy = Field(default=UsefulVoltageStudy(), description="The mean useful voltage.")
    search: SizingSearch = Field(default=SizingSearch(), description="Bounds of the search with --search.")
