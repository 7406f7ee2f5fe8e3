"""What the driver has in hand: traction by levels, brake pipe and cylinders, friction of blocks, electric brake."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tractionpower.model.base import Count, Declaration, Real
from tractionpower.model.quantity import field


class EffortPoint(Declaration):
    """A point of the steady tractive effort of one level."""

    level: Count = Field(ge=1, le=100, description="Level of the drive control.")
    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0, at_most=600)
    effort_kn: Real = field("effort_kn", "Steady tractive effort at the wheel.", at_least=0)


class Traction(Declaration):
    """Tractive effort by levels of a control: F = min(share of the starting effort, share of the power / v), or points.

    Zobory and Bekefi, figure 8 and eq. 2; Arshad et al., section 2.10.
    """

    levels: Count = Field(default=15, ge=1, le=100, description="Highest level of the drive control; 0 gives nothing.")
    starting_effort_kn: Real | None = field(
        "starting_effort_kn",
        "Greatest effort in the highest level; left out: that of the vehicle's drive.",
        above=0,
        default=None,
    )
    power_kw: Real | None = field(
        "power_kw", "Power at the wheel in the highest level; left out: that of the vehicle's drive.", above=0, default=None
    )
    law: Literal["linear", "quadratic_power"] = Field(
        default="linear",
        description="Effort grows with the level; power with the level, or with its square (diesel-electric notches).",
    )
    effort: tuple[EffortPoint, ...] = Field(
        default=(), description="Points of the steady effort over speed for each level, instead of effort and power."
    )
    time_constant_s: Real = field(
        "time_constant_s", "Time constant of the effort after a change of level.", at_least=0, at_most=60, default=0.01,
        source="Zobory and Bekefi, section 4: order of magnitude",
    )  # fmt: skip
    adhesion: bool = Field(default=False, strict=True, description="Whether adhesion of the driven wheels caps the effort.")


class ElectricBrake(Declaration):
    """Electric (dynamic) brake of a powered vehicle, by a share of the greatest."""

    levels: Count = Field(default=8, ge=1, le=100, description="Highest level of its control.")
    effort_kn: Real = field("effort_kn", "Greatest effort.", above=0)
    power_kw: Real = field("power_kw", "Greatest power at the wheel.", above=0)
    fades_below_kmh: Real = field(
        "fades_below_kmh", "Speed below which it fades, linearly to nothing at standstill.", at_least=0, default=15.0,
        source="assumed",
    )  # fmt: skip
    time_constant_s: Real = field("time_constant_s", "Time constant of its effort.", at_least=0, at_most=60, default=1.0)


class FrictionPoint(Declaration):
    """A point of a table of block friction."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0, at_most=600)
    block_force_kn: Real = field("block_force_kn", "Force of one block.", at_least=0)
    friction: Real = field("friction", "Coefficient of friction.", at_least=0, at_most=1)


class BlockFriction(Declaration):
    """Coefficient of friction between block and tread over block force and speed (Zobory and Bekefi, eq. 5)."""

    law: Literal["karwatzki", "constant", "table"] = Field(
        default="karwatzki",
        description="karwatzki: 0.6 (16 F + 100)/(80 F + 100) (V + 100)/(5 V + 100), F [t] a block, V [km/h] (recalled).",
    )
    friction: Real = field("friction", "Coefficient of friction of the law constant.", at_least=0, at_most=1, default=0.3)
    points: tuple[FrictionPoint, ...] = Field(default=(), description="Full grid of speeds and block forces of the law table.")


class BrakeGear(Declaration):
    """Air brake of one vehicle: cylinder, rigging, blocks (Zobory and Bekefi, eq. 4 and 5).

    The force of all blocks follows from cylinder, rigging and efficiency, or from `brake_ratio`, which has the efficiency in it.
    """

    cylinder_area_cm2: Real | None = field(
        "cylinder_area_cm2", "Area of all its brake pistons; with rigging_ratio, instead of brake_ratio.", above=0, default=None
    )
    rigging_ratio: Real | None = field(
        "rigging_ratio", "Force of all blocks over force of the pistons, without losses.", above=0, default=None
    )
    brake_ratio: Real | None = field(
        "brake_ratio", "Force of all blocks at the greatest cylinder pressure over the weight of the vehicle as loaded"
        " (net braking ratio, after the losses of the rigging).", above=0, at_most=5, default=None,
    )  # fmt: skip
    rigging_efficiency: Real = field(
        "rigging_efficiency", "Efficiency of the rigging.", above=0, at_most=1, default=0.83, source="secondary"
    )
    blocks: Count = Field(default=8, ge=1, le=64, description="Blocks of the vehicle.")
    friction: BlockFriction = Field(default=BlockFriction(), description="Friction of the blocks.")
    in_use: bool = Field(default=True, strict=True, description="Whether it brakes; false: isolated, the pipe passes through.")


class AirBrake(Declaration):
    """The brake pipe and the answer of the cylinders (Zobory and Bekefi, eq. 3), and what each level commands.

    The pressure of the pipe falls by a reduction that tends exponentially to the one commanded; it reaches a vehicle after
    its distance over `propagation_mps`; the cylinder gets `gain` times the reduction there, up to its greatest pressure.
    Its lag behind that, in filling and in emptying, is ours; with 0 the cylinder is the paper's. In emergency the pipe is
    emptied fast, and the cylinder's own lag keeps its filling in the time of full service.
    """

    pipe_pressure_bar: Real = field("pipe_pressure_bar", "Pressure of the charged pipe, gauge.", above=0, at_most=15, default=5.0)
    levels: Count = Field(default=15, ge=1, le=100, description="Highest level of the brake control.")
    full_service_reduction_bar: Real = field(
        "full_service_reduction_bar", "Reduction of the pipe in full service, at the highest level.", above=0, default=1.5
    )
    first_reduction_bar: Real | None = field(
        "first_reduction_bar", "Reduction at the first level, then linear; left out: all linear from 0.", above=0, default=None
    )
    reductions_bar: tuple[Real, ...] | None = Field(
        default=None, description="Reduction at each level from 1 on, instead of the linear ones."
    )
    emergency_time_constant_s: Real = field(
        "emergency_time_constant_s", "Time constant of the pipe in emergency, when it is emptied.", at_least=0, default=0.5,
        source="assumed",
    )  # fmt: skip
    application_time_constant_s: Real = field(
        "application_time_constant_s", "Time constant of the reduction on application.", at_least=0, default=4.0 / 3.0,
        source="95 % after 4 s, P: t95 / 3",
    )  # fmt: skip
    release_time_constant_s: Real = field(
        "release_time_constant_s", "Time constant of the reduction on release.", at_least=0, default=17.5 / 3.0,
        source="95 % after 17.5 s, P: t95 / 3",
    )  # fmt: skip
    propagation_mps: Real = field(
        "propagation_mps",
        "Speed at which a change of pressure travels along the pipe.",
        above=0,
        default=250.0,
        source="secondary",
    )
    gain: Real = field("gain", "Cylinder pressure over reduction of the pipe.", above=0, default=3.8 / 1.5)
    cylinder_pressure_bar: Real = field("cylinder_pressure_bar", "Greatest cylinder pressure, gauge.", above=0, default=3.8)
    cylinder_emergency_bar: Real | None = field(
        "cylinder_emergency_bar", "Greatest cylinder pressure in emergency; left out: the same.", above=0, default=None
    )
    cylinder_fill_s: Real = field(
        "cylinder_fill_s", "Time constant of a filling cylinder behind its valve.", at_least=0, default=0.0
    )
    cylinder_emergency_fill_s: Real | None = field(
        "cylinder_emergency_fill_s",
        "Time constant of a filling cylinder in emergency; left out: the greater of cylinder_fill_s and"
        " application_time_constant_s, as no cylinder fills faster than in full service because the pipe empties faster.",
        at_least=0, default=None,
    )  # fmt: skip
    cylinder_release_s: Real = field("cylinder_release_s", "Time constant of an emptying cylinder.", at_least=0, default=0.0)
    independent_time_constant_s: Real = field(
        "independent_time_constant_s", "Time constant of the independent brake of powered vehicles.", at_least=0, default=1.0
    )
