"""Which outages a study of contingencies looks at."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Identifier, Real, TimeOfDay
from tractionpower.model.quantity import field

OutageKind = Literal["unit", "substation", "feeder", "section_cabin", "contact_line"]
OUTAGE_KINDS: tuple[OutageKind, ...] = ("unit", "substation", "feeder", "section_cabin", "contact_line")


class Contingency(Declaration):
    """Bounds of the study of outages: each device of these kinds is out, one by one."""

    kinds: Annotated[tuple[OutageKind, ...], Field(min_length=1)] = Field(
        default=OUTAGE_KINDS,
        description="Kinds of outages. unit: one rectifier unit of a substation; substation; feeder: of a substation;"
        " section_cabin; contact_line: that of one track between two places where it can be switched off.",
    )
    substation_modes: Annotated[tuple[Literal["rectifiers_out", "bypassed", "open"], ...], Field(min_length=1)] = Field(
        default=("bypassed",), description="States that a substation which is out takes, each a case of its own."
    )
    cabin_modes: Annotated[tuple[Literal["bypassed", "open"], ...], Field(min_length=1)] = Field(
        default=("bypassed",), description="States that a section cabin which is out takes, each a case of its own."
    )
    devices: tuple[Identifier, ...] | None = Field(
        default=None,
        description="Only these substations with their units and feeders, section cabins, feeders ('A 1 low_km') and contact"
        " lines ('track 1 km 0-10.8'); left out: all.",
    )
    low_grid_voltage_pu: Real | None = field(
        "low_grid_voltage_pu", "Low voltage of the feeding grid, at which each outage is looked at, too; left out: by the limits"
        " table (grid_low).", at_least=0.5, at_most=1.0, default=None,
    )  # fmt: skip
    high_grid_voltage_pu: Real | None = field(
        "high_grid_voltage_pu", "High voltage of the feeding grid, at which each outage is looked at, too; left out: by the"
        " limits table (grid_high).", at_least=1.0, at_most=1.5, default=None,
    )  # fmt: skip
    grid_voltages: Annotated[tuple[Literal["normal", "low", "high"], ...], Field(min_length=1)] = Field(
        default=("normal", "low", "high"), description="Grid voltages at which each outage is looked at."
    )
    begins: TimeOfDay | None = Field(
        default=None,
        description="Time of day at which outages begin; left out: with the clock, and those of units that a reserve replaces"
        " when the units carry most, with nothing out, over the time until the reserve feeds.",
    )

    @model_validator(mode="after")
    def _no_repetition(self) -> Contingency:
        for name in ("kinds", "substation_modes", "cabin_modes", "grid_voltages"):
            if len(set(getattr(self, name))) < len(getattr(self, name)):
                raise PydanticCustomError("repeated", "{name} names something twice", {"name": name})
        return self
