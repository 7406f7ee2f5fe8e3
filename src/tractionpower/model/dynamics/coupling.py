"""Couplings: what two neighbouring vehicles pull and push each other with, draft gears and buffers, slack."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tractionpower.model.base import Count, Declaration, Format, Identifier, Real, Text
from tractionpower.model.quantity import field


class GearPoint(Declaration):
    """A point of a force-deflection curve."""

    deflection_mm: Real = field("deflection_mm", "Deflection of the gear.", at_least=0)
    force_kn: Real = field("force_kn", "Its force there.", at_least=0)


class Wedge(Declaration):
    """Friction wedge of a draft gear (Arshad et al., eq. 1, 6 and 7)."""

    angle_deg: Real = field("angle_deg", "Angle of the wedge.", above=0, at_most=89)
    static_friction: Real = field("static_friction", "Coefficient of friction at standstill.", at_least=0, at_most=2)
    kinetic_friction: Real = field("kinetic_friction", "Coefficient of friction of a moving wedge.", at_least=0, at_most=2)
    blending_mps: Real = field(
        "blending_mps", "Speed from which on friction is kinetic; linear from standstill up to it.",
        above=0, at_most=10, default=0.1, source="assumed: the paper gives no number",
    )  # fmt: skip


class Gear(Declaration):
    """One side of a coupling: what resists being drawn out, or being pushed in."""

    stiffness_kn_per_mm: Real | None = field(
        "stiffness_kn_per_mm", "Stiffness of a linear spring; instead of points.", above=0, default=None
    )
    loading: tuple[GearPoint, ...] = Field(
        default=(),
        description="Force while it is loaded, rising; straight from 0 to the first point; the last slope goes on.",
    )
    unloading: tuple[GearPoint, ...] = Field(
        default=(), description="Force while it is unloaded, nowhere above loading; left out: by damping_percent."
    )
    damping_percent: Real = field(
        "damping_percent", "Part of the force that is missing on unloading, and of the work that is lost; less when locked.",
        at_least=0, at_most=100, default=0.0,
    )  # fmt: skip
    wedge: Wedge | None = Field(default=None, description="Friction wedge; loading is the curve of its spring then.")
    locked_stiffness_kn_per_mm: Real | None = field(
        "locked_stiffness_kn_per_mm",
        "Stiffness between unloading and loading, of the parts in series with the gear; left out: the force passes from one curve"
        " to the other with the speed.",
        above=0, default=None,
    )  # fmt: skip
    relaxing_stiffness_kn_per_mm: Real = field(
        "relaxing_stiffness_kn_per_mm", "Least stiffness on unloading: what brings the gear back.", at_least=0, default=0.0
    )
    blending_mps: Real = field(
        "blending_mps", "Without a locked stiffness: speed of unloading at which its curve is reached.",
        above=0, at_most=10, default=0.1, source="TrainDy, figure 6",
    )  # fmt: skip
    stroke_mm: Real | None = field("stroke_mm", "Deflection at which it is solid; left out: never.", above=0, default=None)
    solid_stiffness_kn_per_mm: Real | None = field(
        "solid_stiffness_kn_per_mm", "Stiffness beyond the stroke; left out: the locked one.", above=0, default=None
    )
    locked_damping_kns_per_m: Real = field(
        "locked_damping_kns_per_m", "Viscous damping of the parts in series with the gear, while it is deflected; never pulls it"
        " back.", at_least=0, default=0.0,
    )  # fmt: skip
    in_series: Count = Field(
        default=1, ge=1, le=4, description="Equal gears one behind the other: all figures are of one, deflections add up."
    )


class Coupling(Declaration):
    """The coupling between two vehicles, as one: draw gear and buffers of both."""

    format: Format = 1
    id: Identifier = Field(description="Identifier of the coupling; also the name of its file.")
    name: Text = Field(default="", description="Name for people.")
    source: Text = Field(default="", description="Where the figures come from, and which are assumed.")
    status: Literal["verified", "secondary", "recalled", "assumed"] = Field(
        default="assumed", description="How far the figures are proven."
    )
    slack_mm: Real = field(
        "slack_mm", "Free travel between pulling and pushing, half of it to either side; negative: preloaded against each other.",
        at_least=-500, at_most=2000, default=0.0,
    )  # fmt: skip
    draw: Gear = Field(description="What is loaded in tension (draft).")
    buff: Gear | None = Field(default=None, description="What is loaded in compression; left out: the same as draw.")
    damping_kns_per_m: Real = field(
        "damping_kns_per_m", "Viscous damper between the two vehicles, in tension, compression and slack alike.",
        at_least=0, default=0.0,
    )  # fmt: skip
    endurable_tension_kn: Real | None = field(
        "endurable_tension_kn", "Greatest tension that is endured; left out: not judged.", above=0, default=None
    )
    endurable_compression_kn: Real | None = field(
        "endurable_compression_kn", "Greatest compression that is endured; left out: not judged.", above=0, default=None
    )
