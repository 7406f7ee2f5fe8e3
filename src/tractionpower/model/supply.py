"""The supply system (UZ): substations, section cabins, contact lines, return circuit, fixed loads."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Format, Identifier, Real, Tracks
from tractionpower.model.earthing import Bonds, Earthing, VoltageLimitingDevice
from tractionpower.model.line import Stretch
from tractionpower.model.loads import Load
from tractionpower.model.quantity import field
from tractionpower.model.switchgear import Feeder, Protection, Switch, SwitchEvent

_ALL_TRACKS = "Tracks it belongs to; left out: all tracks that exist there."


class Substation(Protection):
    """A traction substation, given by its no-load voltage and internal resistance.

    With k of its n equal rectifier units in service the no-load voltage stays and the resistance is R_unit/k + R_grid:
    `internal_resistance_ohm` is that of the whole plant with all units, ``R_unit/n + R_grid``; or `unit_resistance_ohm`
    gives R_unit, so that another number of units is another plant; `dissipative_resistance_ohm` is a part of whichever of
    the two is given. The overcurrent trip is that of each of its feeders.
    """

    id: Identifier = Field(description="Identifier of the substation.")
    km: Real = field("km", "Place of the substation.")
    no_load_voltage_v: Real = field("no_load_voltage_v", "Voltage of the busbar without load.", above=0, at_most=10_000)
    internal_resistance_ohm: Real | None = field(
        "internal_resistance_ohm",
        "Slope of the external characteristic, (E - U)/I, with all units; left out: by unit_resistance_ohm.",
        above=0,
        at_most=10,
        default=None,
    )
    unit_resistance_ohm: Real | None = field(
        "unit_resistance_ohm", "That of one rectifier unit alone, without the grid.", above=0, at_most=10, default=None
    )
    unit: Identifier | None = Field(default=None, description="Type of its rectifier units, by the table of rectifier units.")
    rated_current_a: Real | None = field(
        "rated_current_a", "Rated current of one rectifier unit; left out: that of its type.", above=0, default=None
    )
    duty_class: Identifier | None = Field(
        default=None, description="Duty class of the units, by the table of duty classes; left out: that of their type."
    )
    units: Count = Field(default=1, ge=1, description="Number of equal rectifier units.")
    units_in_service: Count | None = Field(default=None, ge=0, description="How many of them feed; left out: all.")
    reserve_units: Count = Field(
        default=0, ge=0, description="Further units that stand by and replace units that are out, reserve_after_s later."
    )
    reserve_after_s: Real = field(
        "reserve_after_s", "Time from the outage of a unit until a reserve unit feeds.", at_least=0, default=600.0
    )
    reserve_overload_percent: Real = field(
        "reserve_overload_percent",
        "Overload permitted to the other units until then: their currents count by so much less.",
        at_least=0,
        at_most=200,
        default=0.0,
    )
    supply_point: Identifier | None = Field(
        default=None, description="Point of the feeding grid that it shares with substations of the same name; left out: its own."
    )
    contract_power_kw: Real | None = field(
        "contract_power_kw",
        "Greatest mean power over a quarter of an hour by the clock at its supply point; one substation of each says it.",
        above=0,
        default=None,
    )
    feeder_rated_current_a: Real | None = field(
        "feeder_rated_current_a", "Continuous current of each of its feeders, where they have no own.", above=0, default=None
    )
    return_rated_current_a: Real | None = field(
        "return_rated_current_a", "Continuous current of its return feeder, where it has no own.", above=0, default=None
    )
    grid_resistance_ohm: Real = field(
        "grid_resistance_ohm",
        "Part of the internal resistance that the feeding grid causes and that no unit shares.",
        at_least=0,
        default=0.0,
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
        "Part of the resistance given, of internal_resistance_ohm or else of unit_resistance_ohm, that is heat in copper and"
        " diodes; the rest is commutation drop and no loss.",
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

    @model_validator(mode="after")
    def _units(self) -> Substation:
        if self.units_in_service is not None and self.units_in_service > self.units:
            raise PydanticCustomError("units", "units_in_service is more than units")
        if (self.internal_resistance_ohm is None) == (self.unit_resistance_ohm is None):
            raise PydanticCustomError("resistance", "a substation has either internal_resistance_ohm or unit_resistance_ohm")
        if self.internal_resistance_ohm is not None and self.grid_resistance_ohm >= self.internal_resistance_ohm:
            raise PydanticCustomError("grid_resistance", "grid_resistance_ohm is not below internal_resistance_ohm")
        return self

    @property
    def plant_resistance_ohm(self) -> float:
        """Internal resistance with all units, R_unit/n + R_grid [ohm]."""
        if self.unit_resistance_ohm is not None:
            return self.unit_resistance_ohm / self.units + self.grid_resistance_ohm
        assert self.internal_resistance_ohm is not None
        return self.internal_resistance_ohm

    @property
    def plant_dissipative_ohm(self) -> float | None:
        """Part of `plant_resistance_ohm` that is heat [ohm]; None where it is not given."""
        given = self.dissipative_resistance_ohm
        return given / self.units if given is not None and self.unit_resistance_ohm is not None else given

    @property
    def feeds(self) -> bool:
        """Whether a rectifier unit is in service."""
        return self.state == "in_service" and self.units_in_service != 0


class SectionCabin(Protection):
    """A section cabin (paralleling post): joins contact lines of several tracks, never rails.

    The overcurrent trip is that of the breaker of each of its feeders.
    """

    id: Identifier = Field(description="Identifier of the section cabin.")
    km: Real = field("km", "Place of the section cabin.")
    state: Literal["closed", "bypassed", "open"] = Field(
        default="closed", description="closed: all tracks tied; bypassed: each track through, no tie; open: each track cut here."
    )
    feeder_resistance_ohm: Real = field(
        "feeder_resistance_ohm",
        "Resistance of each feeder from the busbar to the contact line, one per track and side.",
        at_least=0,
        default=0.0,
    )
    feeder_rated_current_a: Real | None = field(
        "feeder_rated_current_a", "Continuous current of each of its feeders, where they have no own.", above=0, default=None
    )
    tracks: Tracks | None = Field(default=None, description=_ALL_TRACKS)


class SectionPoint(Declaration):
    """A section insulator or isolator in the contact line of one track."""

    id: Identifier = Field(description="Identifier of the section point.")
    track: Identifier = Field(description="The track.")
    km: Real = field("km", "Place of the section point.")
    state: Literal["open", "closed"] = Field(default="open", description="open: the contact line is cut here.")


class Wire(Declaration):
    """Equal wires of a contact line, in parallel with the others."""

    conductor: Identifier = Field(description="Type of the wire, by the conductors table.")
    count: Count = Field(default=1, ge=1, description="Number of such wires.")
    use: Literal["contact", "messenger", "feeder"] = Field(description="Contact wire, messenger wire or reinforcing feeder.")
    wear_percent: Real | None = field(
        "wear_percent",
        "Lost part of the cross-section; left out: that of the contact line for contact wires, else none.",
        at_least=0,
        at_most=60,
        default=None,
    )


class ContactLine(Stretch):
    """Contact line of each listed track: by its resistance, by a type of the conductors table, or by its wires."""

    resistance_ohm_per_km: Real | None = field(
        "resistance_ohm_per_km", "Resistance of the contact line of one track.", above=0, at_most=10, default=None
    )
    type: Identifier | None = Field(default=None, description="Type of contact line, by the conductors table.")
    wires: tuple[Wire, ...] | None = Field(default=None, min_length=1, description="Wires in parallel.")
    wear_percent: Real | None = field(
        "wear_percent", "Lost part of the cross-section of the contact wires.", at_least=0, at_most=60, default=None
    )
    temperature_c: Real | None = field(
        "temperature_c", "Temperature of the wires; left out: 20 °C.", at_least=-50, at_most=200, default=None
    )
    rated_current_a: Real | None = field(
        "rated_current_a",
        "Continuous current of the contact line of one track; left out: reckoned from its wires, where they are known.",
        above=0,
        default=None,
    )
    tracks: Tracks | None = Field(default=None, description=_ALL_TRACKS)

    @model_validator(mode="after")
    def _one_way(self) -> ContactLine:
        given = [self.resistance_ohm_per_km is not None, self.type is not None, self.wires is not None]
        if sum(given) != 1:
            raise PydanticCustomError("contact_line", "a contact line has one of resistance_ohm_per_km, type, wires")
        return self


class ReturnCircuit(Stretch):
    """Return rails: one conductor for all listed tracks together, by its resistance or by the type of rail."""

    resistance_ohm_per_km: Real | None = field(
        "resistance_ohm_per_km",
        "Resistance of all rails of the listed tracks in parallel; zero is allowed.",
        at_least=0,
        at_most=10,
        default=None,
    )
    rail: Identifier | None = Field(
        default=None, description="Type of rail, by the conductors table; two rails for each listed track."
    )
    wear_percent: Real = field(
        "wear_percent", "Lost part of the cross-section of the rails.", at_least=0, at_most=60, default=0.0
    )
    temperature_c: Real | None = field(
        "temperature_c", "Temperature of the rails; left out: 20 °C.", at_least=-50, at_most=100, default=None
    )
    leakage_s_per_km: Real = field(
        "leakage_s_per_km",
        "Conductance to remote earth of all rails of the listed tracks together.",
        at_least=0,
        at_most=1000,
        default=0.0,
    )
    rated_current_a: Real | None = field(
        "rated_current_a", "Continuous current of all rails of the listed tracks together.", above=0, default=None
    )
    tracks: Tracks | None = Field(default=None, description="Tracks that share this one conductor; left out: all tracks.")

    @model_validator(mode="after")
    def _one_way(self) -> ReturnCircuit:
        if (self.resistance_ohm_per_km is None) == (self.rail is None):
            raise PydanticCustomError("return_circuit", "a return circuit has either resistance_ohm_per_km or rail")
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
    feeders: tuple[Feeder, ...] = Field(default=(), description="Feeders that differ from the others of their station.")
    switches: tuple[Switch, ...] = Field(default=(), description="Isolators, cross ties, by-passes.")
    switch_events: tuple[SwitchEvent, ...] = Field(default=(), description="What changes its state, and when.")
    bonds: tuple[Bonds, ...] = Field(default=(), description="Cross bonds between the rails of tracks.")
    earthing: tuple[Earthing, ...] = Field(default=(), description="Connections of the rails with remote earth.")
    voltage_limiting_devices: tuple[VoltageLimitingDevice, ...] = Field(
        default=(), description="Devices that join the rails with earth when their potential is too high."
    )
    loads: tuple[Load, ...] = Field(default=(), description="Fixed taps between contact line and rail.")
