"""The railway line (LK): tracks, stations, vertical and horizontal profile, speed limits."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Identifier, Real, Text, Tracks
from tractionpower.model.quantity import field

Direction = Literal["increasing", "decreasing"]

_FROM_KM = "Start of the stretch, kilometre of the line."
_TO_KM = "End of the stretch, kilometre of the line."
_TRACKS = "Tracks it holds for; left out: all tracks that exist there."


class Stretch(Declaration):
    """A piece of line from one kilometre to a higher one."""

    from_km: Real = field("from_km", _FROM_KM)
    to_km: Real = field("to_km", _TO_KM)

    @model_validator(mode="after")
    def _runs_upwards(self) -> Stretch:
        if not self.from_km < self.to_km:
            raise PydanticCustomError("stretch", "from_km {a} is not below to_km {b}", {"a": self.from_km, "b": self.to_km})
        return self


class Track(Stretch):
    """A track of the line, with its own end points."""

    id: Identifier = Field(description="Identifier of the track.")


class Station(Declaration):
    """A station, stop or other named place."""

    id: Identifier = Field(description="Identifier of the station.")
    name: Text = Field(default="", description="Name for people.")
    km: Real = field("km", "Place of the station.")
    tracks: Tracks | None = Field(default=None, description=_TRACKS)
    stop_km: dict[str, Real] | None = Field(
        default=None, description="Where the front of a train stops, by track or by track and direction ('1 increasing')."
    )


class Gradient(Stretch):
    """Constant slope; positive rises with increasing kilometre."""

    permille: Real = field("permille", "Slope, positive when the line rises with increasing km.", at_least=-100, at_most=100)
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class Curve(Stretch):
    """Horizontal curve of constant radius."""

    radius_m: Real = field("radius_m", "Radius of the curve.", above=55)
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class CurveResistance(Declaration):
    """Resistance in curves, a/(R - b) in N/kN; left out: 650/(R - 55), and 500/(R - 30) below 300 m (Roeckl)."""

    a: Real = Field(ge=0, description="Numerator [N/kN m].")
    b_m: Real = field("b_m", "What is taken from the radius.", at_least=0, default=0.0)


class Tunnel(Stretch):
    """Tunnel, by its number of tracks."""

    kind: Literal["single_track", "double_track"] = Field(description="Number of tracks in the tunnel.")
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class SpeedLimit(Stretch):
    """Speed limit of the line, by track, direction and train category."""

    kmh: Real = field("kmh", "Permitted speed.", above=0, at_most=600)
    tracks: Tracks | None = Field(default=None, description=_TRACKS)
    direction: Direction | None = Field(default=None, description="Direction it holds for; left out: both.")
    category: Text | None = Field(default=None, description="Train category that this row is for; it replaces the others.")


class TrainCurrentLimit(Stretch):
    """Largest current that one train may take from the line."""

    max_current_a: Real = field("max_current_a", "Largest train current in motion.", above=0)
    standstill_current_a: Real | None = field(
        "standstill_current_a", "Largest current at standstill; left out: max_current_a.", above=0, default=None
    )
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class PowerOff(Stretch):
    """Stretch without traction current: neutral section, coasting board, lowered pantograph."""

    kind: Literal["neutral", "coast", "lower_pantograph"] = Field(description="What trains do there.")
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class TrackPoint(Declaration):
    """A place on a track."""

    track: Identifier = Field(description="The track.")
    km: Real = field("km", "Place on the track.")


class Connection(Declaration):
    """A connection between two places of the tracks, for trains and for currents alike."""

    from_: TrackPoint = Field(alias="from", description="One end.")
    to: TrackPoint = Field(description="The other end.")


class ChainageBreak(Declaration):
    """A jump of the kilometrage: the kilometre `at_km` is followed by `continues_as_km`."""

    at_km: Real = field("at_km", "Last kilometre before the jump.")
    continues_as_km: Real = field("continues_as_km", "First kilometre after the jump.")
    tracks: Tracks | None = Field(default=None, description=_TRACKS)


class Line(Declaration):
    """The railway line: what a train and the supply stand along (block LK of Krzysztozek 2019, figure 2)."""

    format: Format = 1
    name: Text = Field(default="", description="Name for people.")
    source: Text = Field(default="", description="Where the data come from.")
    tracks: Annotated[tuple[Track, ...], Field(min_length=1, description="The tracks.")]
    stations: tuple[Station, ...] = Field(default=(), description="Stations, stops and other named places.")
    gradients: tuple[Gradient, ...] = Field(
        default=(), description="Slopes; left out: level. Given: every named track is covered end to end."
    )
    curves: tuple[Curve, ...] = Field(default=(), description="Horizontal curves; only what exists.")
    curve_resistance: CurveResistance | None = Field(
        default=None, description="Resistance in curves; left out: Roeckl's formula."
    )
    tunnels: tuple[Tunnel, ...] = Field(default=(), description="Tunnels; only what exists.")
    speed_limits: tuple[SpeedLimit, ...] = Field(
        default=(), description="Speed limits; must cover the tracks that trains run on."
    )
    train_current_limits: tuple[TrainCurrentLimit, ...] = Field(default=(), description="Largest train currents.")
    power_off: tuple[PowerOff, ...] = Field(default=(), description="Stretches without traction current.")
    connections: tuple[Connection, ...] = Field(default=(), description="Connections between places of the tracks.")
    chainage_breaks: tuple[ChainageBreak, ...] = Field(default=(), description="Jumps of the kilometrage.")
