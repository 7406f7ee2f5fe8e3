"""A train as a point mass: masses, tractive characteristic, resistance, braking (Diviš and Kavička, TrainDyn)."""

from __future__ import annotations

from itertools import pairwise
from typing import Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Real
from tractionpower.model.quantity import field


class TractivePoint(Declaration):
    """A point of a tractive characteristic."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0, at_most=600)
    effort_kn: Real = field("effort_kn", "Greatest tractive effort at the wheel.", at_least=0)


class SpecificResistance(Declaration):
    """Running resistance over weight, a + b V + c V² with V in km/h (TrainDyn, eq. 10)."""

    a_n_per_kn: Real = field("a_n_per_kn", "Constant part.", at_least=0)
    b_n_per_kn_per_kmh: Real = field("b_n_per_kn_per_kmh", "Part that grows with the speed.", at_least=0, default=0.0)
    c_n_per_kn_per_kmh2: Real = field(
        "c_n_per_kn_per_kmh2", "Part that grows with the square of the speed.", at_least=0, default=0.0
    )


class RotatingPart(Declaration):
    """Equal rotating parts of a train (TrainDyn, eq. 3, 4 and 6)."""

    mass_t: Real = field("mass_t", "Mass of one.", above=0)
    radius_of_gyration_m: Real = field("radius_of_gyration_m", "Radius of gyration about its axis.", above=0)
    ratio: Real = field("ratio", "Its revolutions over those of the wheel.", above=0, default=1.0)
    wheel_radius_m: Real = field("wheel_radius_m", "Radius of the wheel.", above=0)
    count: Count = Field(default=1, ge=1, le=10_000, description="How many.")


class TrainCharacteristics(Declaration):
    """What a train is as a point mass: all that its motion needs but the track (TrainDyn, 3.1).

    The tractive characteristic is either `effort`, points joined by straight lines and level beyond the last one, or
    `starting_effort_kn` and `power_kw`: the smaller of the starting effort and of the power over the speed.
    """

    locomotive_mass_t: Real = field("locomotive_mass_t", "Mass of the locomotives.", above=0)
    hauled_mass_t: Real = field("hauled_mass_t", "Mass of what they haul.", at_least=0, default=0.0)
    braking_mps2: Real = field("braking_mps2", "Deceleration of the train that braking causes.", above=0, at_most=5)
    max_speed_kmh: Real = field("max_speed_kmh", "Greatest speed.", above=0, at_most=600)
    effort: tuple[TractivePoint, ...] = Field(default=(), description="Tractive characteristic by points, by rising speed.")
    starting_effort_kn: Real | None = field(
        "starting_effort_kn", "Greatest effort; with power_kw, instead of effort.", above=0, default=None
    )
    power_kw: Real | None = field("power_kw", "Greatest power at the wheel.", above=0, default=None)
    resistance: SpecificResistance = Field(description="Running resistance of the locomotives; of the train if hauled has none.")
    hauled_resistance: SpecificResistance | None = Field(
        default=None, description="Running resistance of what they haul; left out: the same by weight."
    )
    rotating_mass_factor: Real | None = field(
        "rotating_mass_factor", "Inertia over mass; left out: by rotating_parts, 1 without any.", at_least=1, at_most=2,
        default=None,
    )  # fmt: skip
    rotating_parts: tuple[RotatingPart, ...] = Field(
        default=(), description="Rotating parts of the train, instead of the factor."
    )

    @model_validator(mode="after")
    def _has_one_characteristic(self) -> Self:
        by_power = self.starting_effort_kn is not None and self.power_kw is not None
        half = (self.starting_effort_kn is None) != (self.power_kw is None)
        if half or by_power == bool(self.effort):
            raise PydanticCustomError(
                "tractive_characteristic", "a tractive characteristic is either effort, or starting_effort_kn and power_kw"
            )
        if any(after.speed_kmh <= before.speed_kmh for before, after in pairwise(self.effort)):
            raise PydanticCustomError("unsorted", "the points of effort are not sorted by rising speed_kmh")
        if self.rotating_mass_factor is not None and self.rotating_parts:
            raise PydanticCustomError("rotating_masses", "rotating masses are either rotating_mass_factor or rotating_parts")
        return self

    @property
    def mass_t(self) -> float:
        """Mass of the train."""
        return self.locomotive_mass_t + self.hauled_mass_t

    @property
    def inertia_factor(self) -> float:
        """Coefficient of rotating parts, 1 + sum of m i² u² / (m R²) (TrainDyn, eq. 6)."""
        if self.rotating_mass_factor is not None:
            return self.rotating_mass_factor
        parts = self.rotating_parts
        turning = sum(p.count * p.mass_t * (p.radius_of_gyration_m * p.ratio / p.wheel_radius_m) ** 2 for p in parts)
        return 1.0 + turning / self.mass_t
