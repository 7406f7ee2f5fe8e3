"""The supply system (UZ): substations, section cabins, contact lines, return circuit, fixed loads."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Identifier, Real, TimeOfDay, Tracks
from tractionpower.model.line import Stretch
from tractionpower.model.quantity import field

_ALL_TRACKS = "Tracks it belongs to; left out: all tracks that exist there."


class Substation(Declaration):
    """A traction substation, given by its no-load voltage and internal resistance.

    With k equal units in service the no-load voltage stays; `internal_resistance_ohm` is that of the whole plant.
    """

    id: Identifier = Field(description="Identifier of the substation.")
    km: Real = field("km", "Place of the substation.")
    no_load_voltage_v: Real = field("no_load_voltage_v", "Voltage of the busbar without load.", above=0, at_most=10_000)
    internal_resistance_ohm: Real = field(
        "internal_resistance_ohm", "Slope of the external characteristic, (E - U)/I.", above=0, at_most=10
    )
    conducts: Literal["forward", "both"] = Field(
        default="forward", description="forward: diode rectifier; both: a two-way linear source."
    )
    state: Literal["in_service", "rectifiers_out", "bypassed", "open"] = Field(
        default="in_service",
        description="in_service; rectifiers_out: the busbar still ties the tracks; bypassed: each track runs through,"
        " nothing is tied; open: each track is cut here.",
    )
    feeder_resistance_ohm: Real = field(
        "feeder_resistance_ohm",
        "Resistance of each feeder from the positive busbar to the contact line, one per track and side.",
        at_least=0,
        default=0.0,
    )
    return_resistance_ohm: Real = field(
        "return_resistance_ohm", "Resistance of the return feeder from the rails to the negative busbar.", at_least=0, default=0.0
    )
    dissipative_resistance_ohm: Real | None = field(
        "dissipative_resistance_ohm",
        "Part of the slope that is heat in copper and diodes; the rest is commutation drop and no loss.",
        at_least=0,
        default=None,
    )
    grid_voltage_pu: Real = field(
        "grid_voltage_pu",
        "Voltage of the feeding grid, which scales the no-load voltage.",
        at_least=0.5,
        at_most=1.5,
        default=1.0,
    )
    tracks: Tracks | None = Field(default=None, description=_ALL_TRACKS)


class SectionCabin(Declaration):
    """A section cabin (paralleling post): joins contact lines of several tracks, never rails."""

    id: Identifier = Field(description="Identifier of the section cabin.")
    km: Real = field("km", "Place of the section cabin.")
    state: Literal["closed", "bypassed", "open"] = Field(
        default="closed", description="closed: all tracks tied; bypassed: each track through, no tie; open: each track cut here."
    )
    tracks: Tracks | None = Field(default=None, description=_ALL_TRACKS)


class SectionPoint(Declaration):
    """A section insulator or isolator in the contact line of one track."""

    id: Identifier = Field(description="Identifier of the section point.")
    track: Identifier = Field(description="The track.")
    km: Real = field("km", "Place of the section point.")
    state: Literal["open", "closed"] = Field(default="open", description="open: the contact line is cut here.")


class ContactLine(Stretch):
    """Contact line: the resistance of each listed track."""

    resistance_ohm_per_km: Real = field(
        "resistance_ohm_per_km", "Resistance of the contact line of one track.", above=0, at_most=10
    )
    tracks: Tracks | None = Field(default=None, description=_ALL_TRACKS)


class ReturnCircuit(Stretch):
    """Return rails: one conductor for all listed tracks together."""

    resistance_ohm_per_km: Real = field(
        "resistance_ohm_per_km",
        "Resistance of all rails of the listed tracks in parallel; zero is allowed.",
        at_least=0,
        at_most=10,
    )
    tracks: Tracks | None = Field(default=None, description="Tracks that share this one conductor; left out: all tracks.")


class Load(Declaration):
    """A fixed tap between contact line and rail: a depot, heating, a measured load."""

    id: Identifier = Field(description="Identifier of the load.")
    track: Identifier = Field(description="The track.")
    km: Real = field("km", "Place of the tap.")
    power_kw: Real | None = field("power_kw", "Power taken from the line; negative feeds back.", default=None)
    current_a: Real | None = field("current_a", "Current taken from the line; negative feeds back.", default=None)
    limits: Literal["range", "none"] = Field(
        default="range",
        description="range: as given between U_min2 and U_max2, below linear to zero, feeding back folds to zero at U_max2;"
        " none: as given at any voltage, there may be no solution.",
    )
    fold_back_from_v: Real | None = field(
        "fold_back_from_v",
        "Voltage from which feeding back is reduced; U_max2 makes a hard ceiling.",
        above=0,
        default=None,
        source="U_max1 of the system",
    )
    from_: TimeOfDay | None = Field(default=None, alias="from", description="Time of day from which the load is on.")
    to: TimeOfDay | None = Field(default=None, description="Time of day from which the load is off again.")

    @model_validator(mode="after")
    def _power_or_current(self) -> Load:
        if (self.power_kw is None) == (self.current_a is None):
            raise PydanticCustomError("power_or_current", "a load has either power_kw or current_a")
        if self.from_ is not None and self.to is not None and not self.from_ < self.to:
            raise PydanticCustomError("times", "from is not before to")
        return self


class Supply(Declaration):
    """The supply system along the line (block UZ of Krzysztozek 2019, figures 2 and 3)."""

    format: Format = 1
    system: Identifier = Field(default="dc3000", description="System whose voltage limits hold, by the limits table.")
    substations: tuple[Substation, ...] = Field(default=(), description="Traction substations.")
    section_cabins: tuple[SectionCabin, ...] = Field(default=(), description="Section cabins (paralleling posts).")
    section_points: tuple[SectionPoint, ...] = Field(default=(), description="Section insulators and isolators.")
    contact_lines: Annotated[tuple[ContactLine, ...], Field(min_length=1, description="Contact lines.")]
    return_circuit: Annotated[tuple[ReturnCircuit, ...], Field(min_length=1, description="Return conductors.")]
    loads: tuple[Load, ...] = Field(default=(), description="Fixed taps between contact line and rail.")
