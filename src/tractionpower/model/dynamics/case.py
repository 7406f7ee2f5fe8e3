"""A case of train dynamics: the vehicles of a train, its track, what the driver does, how it is computed."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Format, Identifier, Real, Text
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.dynamics.gear import AirBrake, BrakeGear, ElectricBrake, Traction
from tractionpower.model.quantity import field
from tractionpower.model.vehicle import Part, Vehicle


class CasePart(Part):
    """Equal vehicles of the train of a case; what is left out is that of the case."""

    coupling: Identifier | None = Field(default=None, description="Coupling behind each of these vehicles.")
    traction: Traction | None = Field(default=None, description="Traction of these vehicles.")
    electric_brake: ElectricBrake | None = Field(default=None, description="Electric brake of these vehicles.")
    brake: BrakeGear | None = Field(default=None, description="Air brake of these vehicles.")


class CaseGradient(Declaration):
    """A gradient, along the way of the train."""

    from_m: Real = field("from_m", "From.")
    to_m: Real = field("to_m", "To.")
    permille: Real = field("permille", "Gradient; positive rises.", at_least=-200, at_most=200)


class CaseCurve(Declaration):
    """A curve, along the way of the train."""

    from_m: Real = field("from_m", "From, the middle of its transition.")
    to_m: Real = field("to_m", "To, the middle of its transition.")
    radius_m: Real = field("radius_m", "Radius.", above=0)
    turns: Literal["right", "left"] = Field(default="right", description="Direction.")


class CaseTunnel(Declaration):
    """A tunnel, along the way of the train."""

    from_m: Real = field("from_m", "From.")
    to_m: Real = field("to_m", "To.")
    kind: Literal["single_track", "double_track"] = Field(description="Kind: 2 N/kN or 1 N/kN (TrainDyn, 2.2.1).")


class TransitionLength(Declaration):
    """Half the length of the transition curve to a circle of some radius."""

    radius_m: Real = field("radius_m", "Radius of the circle.", above=0)
    half_length_m: Real = field("half_length_m", "Half the length of the transition.", at_least=0)


class CaseCurveResistance(Declaration):
    """Specific curve resistance a / (R - b) [N/kN] for all radii; two such laws are divided by a radius otherwise."""

    a_n_m_per_kn: Real = field("a_n_m_per_kn", "Numerator a.", at_least=0)
    b_m: Real = field("b_m", "Shift of the radius, b.", at_least=0, default=0.0)


class CaseTrack(Declaration):
    """The track of a case, by the distance from where the front of the train starts; level and straight where nothing is said."""

    gradients: tuple[CaseGradient, ...] = Field(default=(), description="Gradients; gaps are level.")
    curves: tuple[CaseCurve, ...] = Field(default=(), description="Curves.")
    tunnels: tuple[CaseTunnel, ...] = Field(default=(), description="Tunnels.")
    rounding_radius_m: Real = field(
        "rounding_radius_m", "Radius of the vertical rounding between gradients; 0: sharp breaks.", at_least=0, default=4000.0,
        source="Zobory and Bekefi, section 3",
    )  # fmt: skip
    transitions: tuple[TransitionLength, ...] = Field(
        default=(), description="Half-lengths of transition curves by radius, linear between; none: curves begin at once."
    )
    curve_resistance: CaseCurveResistance | None = Field(
        default=None, description="Left out: Roeckl, 650/(R - 55) N/kN from 300 m on, 500/(R - 30) below."
    )


MOST_LEVELS = 100
"""Levels that a control has at most."""

MOST_INDEPENDENT_BAR = 15.0
"""Pressure of the independent brake that can be asked for at most."""

BrakeWord = Literal["charge", "release", "full_service", "emergency", "unchanged"]

BRAKE_WORDS: tuple[str, ...] = get_args(BrakeWord)


def _brake_setting(value: Any) -> Any:
    # A cell of a CSV file is a text, also where it holds a level.
    if isinstance(value, str) and value.strip().isdecimal():
        value = int(value)
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST_LEVELS:
        return value
    if isinstance(value, str) and value in BRAKE_WORDS:
        return value
    told = f"a brake is a level from 0 to {MOST_LEVELS}, or one of {', '.join(BRAKE_WORDS)}; found {str(value)[:40]!r}"
    raise PydanticCustomError("brake_setting", "{told}", {"told": told})


BrakeSetting = Annotated[
    int | str,
    BeforeValidator(_brake_setting),
    WithJsonSchema({"anyOf": [{"type": "integer", "minimum": 0, "maximum": MOST_LEVELS}, {"enum": [*BRAKE_WORDS]}]}),
]
"""Level of the brake control, or a word."""


class Command(Declaration):
    """What the driver sets at a time, held until another row changes it; what is left out stays as it is."""

    time_s: Real = field("time_s", "Time from the start.", at_least=0)
    drive: Annotated[Count | None, Field(ge=0, le=100)] = Field(default=None, description="Level of the drive control.")
    brake: BrakeSetting | None = Field(
        default=None, description="Level of the brake control, or charge (release), full_service, emergency, unchanged."
    )
    reduction_bar: Real | None = field(
        "reduction_bar", "Reduction of the brake pipe below its charged pressure, instead of brake.", at_least=0, default=None
    )
    electric: Real | None = Field(default=None, ge=0, le=100, description="Level of the electric brake.")
    independent_bar: Real | None = field(
        "independent_bar",
        "Cylinder pressure of the independent brake of powered vehicles.",
        at_least=0,
        at_most=MOST_INDEPENDENT_BAR,
        default=None,
    )


class CaseStart(Declaration):
    """How the train stands or runs at the start."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0, at_most=600, default=0.0)
    couplings: Literal["centred", "stretched", "bunched"] = Field(
        default="centred", description="Where in their slack the couplings are: in its middle, or at either end."
    )
    brake: Literal["charge", "release", "full_service", "emergency"] = Field(
        default="charge", description="State of the air brake, settled."
    )


class CaseRun(Declaration):
    """How the case is computed."""

    duration_s: Real = field("duration_s", "Simulated time.", above=0, at_most=86_400)
    step_s: Real = field("step_s", "Step; with method variable the longest one.", above=0, at_most=10, default=0.005)
    method: Literal["symplectic", "rk4", "euler", "variable"] = Field(
        default="symplectic",
        description="symplectic: velocities first, one evaluation a step; rk4: classical Runge-Kutta; euler: explicit, for"
        " comparison; variable: Dormand-Prince with a step by tolerance.",
    )
    tolerance: Real = field("tolerance", "Relative tolerance of a variable step.", above=0, at_most=0.1, default=1e-6)
    record_every_s: Real = field("record_every_s", "Distance of recorded rows.", above=0, default=0.05)
    ends: Literal["duration", "standstill"] = Field(
        default="duration",
        description="duration: always runs to the end; standstill: ends when the whole train has come to a stand.",
    )
    distance_limit_m: Real | None = field(
        "distance_limit_m", "Ends when the front has run so far; left out: no limit.", above=0, default=None
    )
    rows_limit: Count | None = Field(
        default=None, ge=2, description="Most recorded rows (state vector size); more are refused, with the step that fits."
    )


class Case(Declaration):
    """A case of train dynamics, as its file says it."""

    format: Format = 1
    kind: Literal["vehicles"] = Field(default="vehicles", description="A train as many vehicles.")
    name: Text = Field(description="Name for people.")
    source: Text = Field(default="", description="Where the case comes from; what is given and what is filled in.")
    vehicles: Annotated[tuple[CasePart, ...], Field(min_length=1, description="Vehicles of the train, from the front.")]
    coupling: Identifier | None = Field(default=None, description="Coupling of all vehicles that name none.")
    traction: Traction | None = Field(
        default=None,
        description="Traction of all powered vehicles without one of their own: those with a drive, and locomotives.",
    )
    electric_brake: ElectricBrake | None = Field(
        default=None, description="Electric brake of all powered vehicles; left out: what their own files say of it."
    )
    brake: BrakeGear | None = Field(
        default=None, description="Air brake of all vehicles that have none of their own; left out: none."
    )
    air_brake: AirBrake = Field(default=AirBrake(), description="The brake pipe and the answer of the cylinders.")
    track: CaseTrack = Field(default=CaseTrack(), description="The track.")
    commands: tuple[Command, ...] = Field(default=(), description="What the driver does, by time.")
    start: CaseStart = Field(default=CaseStart(), description="How the train starts.")
    run: CaseRun = Field(description="How it is computed.")
    unified_resistance: Literal["paper", "brake_only"] = Field(
        default="brake_only",
        description="What adhesion caps: all resistance (Zobory and Bekefi, eq. 6, as printed), or the brake alone.",
    )
    grade: Literal["vehicle", "train"] = Field(
        default="vehicle", description="Gradient under each vehicle, or the mean one under the train (Arshad et al., eq. 11)."
    )
    standstill_mps: Real = field(
        "standstill_mps", "Speed below which resistance holds a vehicle (Zobory and Bekefi, eq. 1).",
        at_least=0, at_most=0.1, default=1e-4,
    )  # fmt: skip
    units: Literal["metric", "imperial"] = Field(default="metric", description="Units of the figures.")


class DynamicsScenario(Declaration):
    """A case with all that it names: what is computed.

    Attributes
    ----------
    case
        The case.
    vehicles, couplings
        What it names, each once, by identifier.
    """

    case: Case
    vehicles: tuple[Vehicle, ...] = Field(description="Vehicles of the case, each once.")
    couplings: tuple[Coupling, ...] = Field(description="Couplings of the case, each once.")

    @property
    def name(self) -> str:
        """Name for people."""
        return self.case.name

    def vehicle(self, identifier: str) -> Vehicle:
        """Return the vehicle of that identifier."""
        return next(vehicle for vehicle in self.vehicles if vehicle.id == identifier)

    def coupling(self, identifier: str) -> Coupling:
        """Return the coupling of that identifier."""
        return next(coupling for coupling in self.couplings if coupling.id == identifier)

    @property
    def parts(self) -> tuple[CasePart, ...]:
        """The vehicles one by one from the front: a part each, of count 1, with what the case says where it says nothing."""
        case = self.case
        common = {
            "coupling": case.coupling,
            "traction": case.traction,
            "electric_brake": case.electric_brake,
            "brake": case.brake,
        }
        return tuple(
            part.model_copy(update={"count": 1} | {key: value for key, value in common.items() if getattr(part, key) is None})
            for part in case.vehicles
            for _ in range(part.count)
        )
