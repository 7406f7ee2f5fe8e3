"""Vehicles and trains (EPT): masses, running resistance, drive, brakes, auxiliaries, and how vehicles form a train."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Format, Identifier, Real, Text
from tractionpower.model.drive import Drive
from tractionpower.model.quantity import field


class Resistance(Declaration):
    """Running resistance A + B V + C V² of one vehicle; the absolute and the specific part add."""

    a_n: Real = field("a_n", "Constant part.", at_least=0, default=0.0)
    b_n_per_kmh: Real = field("b_n_per_kmh", "Part that grows with the speed.", at_least=0, default=0.0)
    c_n_per_kmh2: Real = field("c_n_per_kmh2", "Part that grows with the square of the speed.", at_least=0, default=0.0)
    specific_a_n_per_kn: Real = field("specific_a_n_per_kn", "Constant part by weight.", at_least=0, default=0.0)
    specific_b_n_per_kn_per_kmh: Real = field(
        "specific_b_n_per_kn_per_kmh", "Part that grows with the speed, by weight.", at_least=0, default=0.0
    )
    specific_c_n_per_kn_per_kmh2: Real = field(
        "specific_c_n_per_kn_per_kmh2", "Part that grows with the square of the speed, by weight.", at_least=0, default=0.0
    )
    tunnel_factor_single_track: Real | None = field(
        "tunnel_factor_single_track",
        "Factor on the part with V² in a tunnel of one track; left out: 2 N/kN are added instead.",
        at_least=1,
        default=None,
    )
    tunnel_factor_double_track: Real | None = field(
        "tunnel_factor_double_track",
        "Factor on the part with V² in a tunnel of two tracks; left out: 1 N/kN is added instead.",
        at_least=1,
        default=None,
    )


class Adhesion(Declaration):
    """Adhesion of driven wheels, mu = a / (V + b) + c (Curtius and Kniffler)."""

    a_kmh: Real = field("a_kmh", "Numerator.", at_least=0, default=7.5, source="Curtius and Kniffler, secondary")
    b_kmh: Real = field("b_kmh", "Shift of the speed.", above=0, default=44.0, source="Curtius and Kniffler, secondary")
    c: Real = field("c", "Constant part: 0.161 for dry rails, 0.13 for wet ones.", at_least=0, default=0.161)


class Brake(Declaration):
    """Brakes: the electric one is used up to its own curve, friction gives the rest."""

    electric_effort_kn: Real = field("electric_effort_kn", "Greatest effort of the electric brake.", at_least=0, default=0.0)
    electric_power_kw: Real = field(
        "electric_power_kw", "Greatest power of the electric brake at the wheel.", at_least=0, default=0.0
    )
    electric_above_kmh: Real = field(
        "electric_above_kmh", "Speed below which the electric brake gives nothing.", at_least=0, default=0.0
    )
    efficiency: Real | None = field(
        "efficiency",
        "Electric power over power at the wheel; left out: the efficiency of an inverter drive, 1 without one.",
        above=0,
        at_most=1,
        default=None,
    )
    regenerates: bool | None = Field(
        default=None,
        strict=True,
        description="Whether it feeds back; left out: inverter and table drives do, series motors do not.",
    )
    rheostat_kw: Real = field("rheostat_kw", "Power of the braking resistors.", at_least=0, default=0.0)
    service_rate_mps2: Real = field(
        "service_rate_mps2", "Deceleration in service on level straight track.", above=0, at_most=5, default=0.5
    )


class Auxiliaries(Declaration):
    """Auxiliaries: constant power, and heating or air conditioning."""

    power_kw: Real = field("power_kw", "Constant power.", at_least=0, default=0.0)
    heating_kw: Real = field("heating_kw", "Power of heating or air conditioning at nominal voltage.", at_least=0, default=0.0)
    heating: Literal["resistive", "constant_power"] = Field(
        default="resistive", description="resistive: grows with the square of the voltage; constant_power: does not."
    )


class Vehicle(Declaration):
    """One vehicle, given by what moves and feeds it."""

    format: Format = 1
    id: Identifier = Field(description="Identifier of the vehicle; also the name of its file.")
    name: Text = Field(default="", description="Name for people.")
    source: Text = Field(default="", description="Where the figures come from, and which are assumed.")
    kind: Literal["locomotive", "multiple_unit", "coach", "wagon"] = Field(description="Kind of vehicle.")
    mass_t: Real = field("mass_t", "Mass without load.", above=0)
    load_t: Real = field("load_t", "Mass of the full load.", at_least=0, default=0.0)
    adhesive_mass_t: Real | None = field(
        "adhesive_mass_t", "Mass on driven axles, without load; left out: no limit by adhesion.", above=0, default=None
    )
    length_m: Real = field("length_m", "Length over buffers.", above=0)
    max_speed_kmh: Real = field("max_speed_kmh", "Greatest speed.", above=0, at_most=600)
    axles: Count | None = Field(default=None, ge=1, description="Number of axles.")
    rotating_mass_factor: Real = field(
        "rotating_mass_factor", "Inertia of the empty vehicle with its rotating parts, over its mass.", at_least=1, at_most=2
    )
    resistance: Resistance = Field(description="Running resistance.")
    adhesion: Adhesion = Field(default=Adhesion(), description="Adhesion of the driven wheels.")
    drive: Drive | None = Field(default=None, description="Drive; left out: the vehicle has none.")
    brake: Brake = Field(default=Brake(), description="Brakes.")
    auxiliaries: Auxiliaries = Field(default=Auxiliaries(), description="Auxiliaries.")

    @model_validator(mode="after")
    def _adheres_with_its_own_mass(self) -> Vehicle:
        if self.adhesive_mass_t is not None and self.adhesive_mass_t > self.mass_t + 1e-9:
            told = {"adhesive": f"{self.adhesive_mass_t:.10g}", "mass": f"{self.mass_t:.10g}"}
            raise PydanticCustomError("adhesive_mass", "adhesive_mass_t is greater than mass_t: {adhesive} t and {mass} t", told)
        return self


class Part(Declaration):
    """Equal vehicles of a train."""

    id: Identifier = Field(description="The vehicle.")
    count: Count = Field(default=1, ge=1, le=500, description="How many.")
    load_percent: Real = field("load_percent", "Share of the full load.", at_least=0, at_most=200, default=0.0)
    powered: bool = Field(default=True, strict=True, description="Whether its drive works; false: it is hauled.")


Parts = Annotated[tuple[Part, ...], Field(min_length=1, description="Vehicles of the train, from the front.")]


class Train(Declaration):
    """A train: vehicles that run coupled."""

    format: Format = 1
    id: Identifier = Field(description="Identifier of the train; also the name of its file.")
    name: Text = Field(default="", description="Name for people.")
    source: Text = Field(default="", description="Where the figures come from, and which are assumed.")
    category: Text | None = Field(default=None, description="Category, by which speed limits may differ.")
    vehicles: Parts
    max_speed_kmh: Real | None = field(
        "max_speed_kmh", "Greatest speed of the train; left out: the lowest of its vehicles.", above=0, at_most=600, default=None
    )
    service_rate_mps2: Real | None = field(
        "service_rate_mps2",
        "Deceleration in service on level straight track; left out: the lowest of its vehicles.",
        above=0,
        at_most=5,
        default=None,
    )
    mass_distribution: Literal["uniform", "point"] = Field(
        default="uniform", description="uniform: gradients and curves act under the whole train; point: under its front."
    )
