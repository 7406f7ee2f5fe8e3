"""A line with stations on which trains run as point masses in a discrete-event simulation (TrainDyn, 3.4)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tractionpower.model.base import Count, Declaration, Format, Identifier, Real, Text, Tracks
from tractionpower.model.dynamics.case import CaseCurve, CaseCurveResistance, CaseGradient, CaseTunnel
from tractionpower.model.dynamics.point_mass import TrainCharacteristics
from tractionpower.model.quantity import field


class TrainKind(Declaration):
    """A kind of trains of the traffic."""

    id: Identifier = Field(description="Identifier of the kind.")
    share: Real = field("share", "How often it comes, against the shares of the other kinds.", above=0, default=1.0)
    length_m: Real = field(
        "length_m", "Length behind which a track is free again; forces act on the point at its front.", above=0
    )
    characteristics: TrainCharacteristics = Field(description="What such a train is.")


class CaseStation(Declaration):
    """A station: parallel tracks between two places, each for one train at a time."""

    id: Identifier = Field(description="Identifier of the station.")
    name: Text = Field(default="", description="Name for people.")
    from_m: Real = field("from_m", "Where its tracks part; trains wait before it until one is free.", at_least=0)
    to_m: Real = field("to_m", "Where its tracks join again; trains wait before it until the line ahead is free.", above=0)
    tracks: Annotated[Tracks, Field(min_length=1, description="Tracks; the first one goes straight through.")]
    choice: Literal["random", "first_free"] = Field(
        default="first_free", description="Track that a train gets of those that are free: any, or the first one listed."
    )
    stops: bool = Field(default=False, strict=True, description="Whether all trains stop there.")
    dwell_s: Real = field("dwell_s", "Time of a stop.", at_least=0, default=0.0)
    speed_kmh: Real | None = field(
        "speed_kmh", "Speed on all tracks but the first; left out: that of the line.", above=0, at_most=600, default=None
    )
    track_distance_m: Real = field("track_distance_m", "Distance between tracks in the drawing.", above=0, default=60.0)


class Traffic(Declaration):
    """Trains that come: in one direction, one behind the other."""

    trains: Count = Field(ge=1, le=10_000, description="How many.")
    headway_s: Real = field("headway_s", "Mean time from one train to the next.", above=0)
    distribution: Literal["exponential", "constant"] = Field(
        default="exponential", description="exponential: random times above the least one; constant: always the mean one."
    )
    least_headway_s: Real = field("least_headway_s", "Least time from one train to the next.", at_least=0, default=0.0)
    speed_kmh: Real = field("speed_kmh", "Speed with which trains come, at most that of the line.", at_least=0, default=0.0)


class StationsRun(Declaration):
    """How it is computed."""

    duration_s: Real = field("duration_s", "Simulated time; it ends before when all trains have left.", above=0, at_most=864_000)
    period_s: Real = field(
        "period_s", "Sampling period of the dynamics.", above=0, at_most=60, default=1.0, source="TrainDyn, 3.3: starting value"
    )
    method: Literal["euler", "held_speed", "fine"] = Field(
        default="euler",
        description="euler: forces at the beginning of the period (TrainDyn, eq. 21 and 22); fine: substeps of 0.1 s by the"
        " midpoint rule; held_speed: places by the speed of the sample before, as AnyLogic moves them, for comparison.",
    )
    record_every_s: Real = field("record_every_s", "Distance of recorded rows; not below the period.", above=0, default=1.0)


class StationsCase(Declaration):
    """A case of trains as point masses on a line with stations, as its file says it. Places are metres from where trains come."""

    format: Format = 1
    kind: Literal["stations"] = Field(description="Trains as point masses on a line with stations.")
    name: Text = Field(description="Name for people.")
    source: Text = Field(default="", description="Where the case comes from; what is given and what is filled in.")
    seed: Count = Field(default=1, ge=0, description="Seed of all that is random: the same seed gives the same traffic.")
    trains: Annotated[tuple[TrainKind, ...], Field(min_length=1, description="Kinds of trains.")]
    traffic: Traffic = Field(description="Trains that come.")
    length_m: Real = field("length_m", "Length of the line: there trains leave.", above=0)
    speed_kmh: Real = field("speed_kmh", "Permitted speed of the line.", above=0, at_most=600)
    stations: Annotated[tuple[CaseStation, ...], Field(min_length=1, description="Stations, in the order of the line.")]
    gradients: tuple[CaseGradient, ...] = Field(default=(), description="Gradients, on all tracks; gaps are level.")
    curves: tuple[CaseCurve, ...] = Field(default=(), description="Curves, on all tracks; elsewhere the line is straight.")
    tunnels: tuple[CaseTunnel, ...] = Field(default=(), description="Tunnels.")
    curve_resistance: CaseCurveResistance | None = Field(
        default=None, description="Left out: Roeckl, 650/(R - 55) N/kN from 300 m on, 500/(R - 30) below."
    )
    run: StationsRun = Field(description="How it is computed.")
    shown_at_s: tuple[Real, ...] = Field(
        default=(), description="Times of which the topology with its trains is drawn; none: one."
    )
