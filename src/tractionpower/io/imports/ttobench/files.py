"""Files of TTOBench (github.com/nuorail/ttobench, version 1.5): tracks, trains and journeys as JSON with units in the file."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from tractionpower.io.imports import foreign as f
from tractionpower.io.wording import shown
from tractionpower.model.base import Identifier, Real, Text


class Metadata(f.Foreign):
    """Who made the file, under which licence."""

    id: Identifier
    created_by: Text = Field(default="", alias="created by")
    version: Text = Field(default="", alias="library version")
    license: Text = ""


class _Quantity(f.Foreign):
    unit: str
    value: Real

    def to(self, unit: str) -> float:
        """Return the value in `unit`."""
        return f.converted(self.value, self.unit, unit)


class Distance(_Quantity):
    """A length."""

    unit: f.Length


class MassValue(_Quantity):
    """A mass."""

    unit: f.Mass


class ForceValue(_Quantity):
    """A force."""

    unit: f.Force


class PowerValue(_Quantity):
    """A power."""

    unit: f.Power


class SpeedValue(_Quantity):
    """A speed."""

    unit: f.Speed


class AccelerationValue(_Quantity):
    """An acceleration."""

    unit: f.Acceleration


class ShareValue(_Quantity):
    """A share."""

    unit: f.Share


class PerSpeed(_Quantity):
    """Resistance that grows with the speed."""

    unit: f.ForcePerSpeed


class PerSpeed2(_Quantity):
    """Resistance that grows with the square of the speed."""

    unit: f.ForcePerSpeed2


class Stops(f.Foreign):
    """Places of the stops."""

    unit: f.Length
    values: Annotated[tuple[Real, ...], Field(min_length=2)]


class _PositionAndSpeed(f.Foreign):
    position: f.Length
    velocity: f.Speed


class _PositionAndSlope(f.Foreign):
    position: f.Length
    slope: f.Slope


class _RadiusUnits(f.Foreign):
    position: f.Length
    at_start: f.Length = Field(alias="radius at start")
    at_end: f.Length = Field(alias="radius at end")


class _TunnelUnits(f.Foreign):
    position: f.Length
    length: f.Length
    cross_section: f.Area = Field(alias="cross section")


class SpeedLimits(f.Foreign):
    """Speed limits, each from its position on."""

    units: _PositionAndSpeed
    values: Annotated[tuple[Annotated[f.Pair, f.numbers("position", "velocity")], ...], Field(min_length=1)]


class Gradients(f.Foreign):
    """Slopes, each from its position on; positive rises."""

    units: _PositionAndSlope
    values: Annotated[tuple[Annotated[f.Pair, f.numbers("position", "slope")], ...], Field(min_length=1)]


def _radii(value: Any) -> Any:
    # "infinity" is the radius of straight track; as a curvature it is 0, and so it stays out of floating-point infinities.
    good = isinstance(value, list) and len(value) == 3
    words = [0.0 if item == "infinity" else item for item in value[1:]] if good else []
    numeric = all(isinstance(item, int | float) and not isinstance(item, bool) for item in [*(value[:1] if good else ()), *words])
    if not good or not numeric:
        text = '{found} is no row of position, radius at start, radius at end ("infinity" for straight track)'
        raise PydanticCustomError("bad_row", text, {"found": shown(value)})
    return (value[0], *words)


class Curvatures(f.Foreign):
    """Curves, each from its position on: radii at both ends with a sign for the side; 0 stands for straight track."""

    units: _RadiusUnits
    values: Annotated[tuple[Annotated[f.Triple, BeforeValidator(_radii)], ...], Field(min_length=1)]


class Tunnels(f.Foreign):
    """Tunnels."""

    units: _TunnelUnits
    values: tuple[Annotated[f.Triple, f.numbers("position", "length", "cross section")], ...]


class TrackFile(f.Foreign):
    """A track."""

    metadata: Metadata
    stops: Stops
    speed_limits: SpeedLimits = Field(alias="speed limits")
    gradients: Gradients | None = None
    curvatures: Curvatures | None = None
    tunnels: Tunnels | None = None


class _TunnelResistanceUnits(f.Foreign):
    cross_section: f.Area = Field(alias="cross section")
    coefficient: f.ForcePerSpeed2


class TunnelResistance(f.Foreign):
    """What a tunnel adds to the part of the resistance that grows with the square of the speed."""

    units: _TunnelResistanceUnits
    values: tuple[Annotated[f.Pair, f.numbers("cross section", "coefficient")], ...]


class TrainFile(f.Foreign):
    """A train."""

    metadata: Metadata
    length: Distance | None = None
    mass: MassValue
    rho: ShareValue | None = None
    power: PowerValue = Field(alias="max traction power")
    braking_power: PowerValue | None = Field(default=None, alias="max reg braking power")
    force: ForceValue = Field(alias="max traction force")
    braking_force: ForceValue | None = Field(default=None, alias="max reg braking force")
    friction_force: ForceValue | None = Field(default=None, alias="max pn braking force")
    acceleration: AccelerationValue | None = Field(default=None, alias="max acceleration")
    deceleration: AccelerationValue | None = Field(default=None, alias="max deceleration")
    speed: SpeedValue = Field(alias="max speed")
    r0: ForceValue = Field(alias="rolling resistance r0")
    r1: PerSpeed = Field(alias="rolling resistance r1")
    r2: PerSpeed2 = Field(alias="rolling resistance r2")
    efficiency: ShareValue | None = Field(default=None, alias="efficiency traction")
    braking_efficiency: ShareValue | None = Field(default=None, alias="efficiency reg brake")
    tunnel_resistance: TunnelResistance | None = Field(default=None, alias="tunnel resistance")


class _JourneyMetadata(Metadata):
    track: Identifier = Field(alias="associated track")


class _PointUnits(f.Foreign):
    position: f.Length
    earliest: f.Time = Field(alias="lower time constraint")
    latest: f.Time = Field(alias="upper time constraint")
    slowest: f.Speed = Field(alias="lower speed constraint")
    fastest: f.Speed = Field(alias="upper speed constraint")


def _point(value: Any) -> Any:
    good = isinstance(value, list) and len(value) == 5 and value[0] is not None
    if not good or any(isinstance(x, bool) or not isinstance(x, int | float | None) for x in value):
        text = "{found} is no row of position, lower and upper time, lower and upper speed (null where there is none)"
        raise PydanticCustomError("bad_row", text, {"found": shown(value)})
    return value


Point = tuple[Real, Real | None, Real | None, Real | None, Real | None]


class TimingPoints(f.Foreign):
    """Places with windows of time and speed; two rows at one place are arrival and departure."""

    units: _PointUnits
    values: Annotated[tuple[Annotated[Point, BeforeValidator(_point)], ...], Field(min_length=2)]


class JourneyFile(f.Foreign):
    """A journey on a track."""

    metadata: _JourneyMetadata
    points: TimingPoints = Field(alias="timing points")
