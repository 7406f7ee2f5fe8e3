"""Drives: what turns the voltage at the pantograph into tractive effort F_p(v, u) and current."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Real
from tractionpower.model.quantity import field

_Percent = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=100)]
_Ohm = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]

_MAX_CURRENT = (
    "Largest current from the line, that of coaches it feeds included. Left out: with a knee what full power takes at the knee,"
    " without one there is no limit."
)
_EFFICIENCY = "Power at the wheel over power from the line, without auxiliaries."
_KNEE = "Share of the nominal voltage below which the current is reduced, to nothing but auxiliaries at U_min2."


class PowerOverVoltage(Declaration):
    """A point of the power that the drive gives over the voltage."""

    voltage_v: Real = field("voltage_v", "Voltage at the pantograph.", at_least=0)
    power_kw: Real = field("power_kw", "Power at the wheel.", at_least=0)


class EfficiencyPoint(Declaration):
    """A point of an efficiency map."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0)
    load_percent: Real = field("load_percent", "Effort as a share of the greatest at this speed.", at_least=0, at_most=100)
    efficiency: Real = field("efficiency", _EFFICIENCY, above=0, at_most=1)


def _check_order(name: str, values: Sequence[float], unit: str, *, falls: bool = False) -> None:
    """Raise at the first value that does not rise, or fall, behind the one before; `name` has a place for its index."""
    for k, (before, after) in enumerate(pairwise(values), start=1):
        if not (after < before if falls else before < after):
            told = {"at": name.format(k), "after": f"{after:.10g} {unit}", "before": f"{before:.10g} {unit}"}
            if falls:
                raise PydanticCustomError("not_falling", "{at} does not fall from step to step: {after} behind {before}", told)
            raise PydanticCustomError("not_rising", "{at} does not rise from point to point: {after} behind {before}", told)


class InverterDrive(Declaration):
    """Induction or synchronous motors behind inverters (physics of the model: docs/model.md)."""

    kind: Literal["inverter"] = Field(description="Kind of drive.")
    starting_effort_kn: Real = field("starting_effort_kn", "Greatest tractive effort at the wheel.", above=0)
    power_kw: Real = field("power_kw", "Greatest power at the wheel in traction.", above=0)
    pull_out_kmh: Real | None = field(
        "pull_out_kmh", "Speed above which the effort falls with 1/v², by the motors' pull-out torque.", above=0, default=None
    )
    efficiency: Real | None = field("efficiency", _EFFICIENCY, above=0, at_most=1, default=None)
    efficiency_map: tuple[EfficiencyPoint, ...] = Field(
        default=(), description="Efficiency over speed and load in place of the constant one: every load at every speed."
    )
    max_current_a: Real | None = field("max_current_a", _MAX_CURRENT, above=0, default=None)
    knee_factor: Real | None = field("knee_factor", _KNEE, above=0, at_most=1, default=None)
    power_over_voltage: tuple[PowerOverVoltage, ...] = Field(
        default=(), description="Power at the wheel over the voltage, rising; left out: power_kw at any voltage."
    )
    fold_back_from_v: Real | None = field(
        "fold_back_from_v", "Voltage above which less is fed back.", above=0, default=None, source="U_max1 of the system"
    )
    fold_back_to_v: Real | None = field(
        "fold_back_to_v", "Voltage at which nothing is fed back.", above=0, default=None, source="U_max2 of the system"
    )

    @model_validator(mode="after")
    def _has_one_efficiency(self) -> InverterDrive:
        if (self.efficiency is None) == (not self.efficiency_map):
            raise PydanticCustomError("efficiency", "an inverter drive has either efficiency or efficiency_map")
        return self

    @model_validator(mode="after")
    def _has_power_by_rising_voltage(self) -> InverterDrive:
        _check_order("voltage_v of power_over_voltage[{}]", [point.voltage_v for point in self.power_over_voltage], "V")
        return self


class Grouping(Declaration):
    """A way of connecting the traction motors."""

    series: Count = Field(ge=1, description="Motors in series in each branch.")
    parallel: Count = Field(ge=1, description="Branches in parallel.")
    starting_current_a: Real | None = field(
        "starting_current_a", "Motor current held in this grouping; left out: that of the drive.", above=0, default=None
    )


class MagnetisationPoint(Declaration):
    """A point of the magnetisation curve of one motor."""

    current_a: Real = field("current_a", "Current through the field winding.", above=0)
    emf_vs_per_rev: Real = field("emf_vs_per_rev", "Voltage induced per speed, c phi.", above=0)


class StartingResistors(Declaration):
    """Resistance of one branch by notch, from the first to none; only those of groupings that exist are given."""

    series: tuple[_Ohm, ...] = Field(default=(), description="Notches of the grouping with one branch [ohm].")
    series_parallel: tuple[_Ohm, ...] = Field(default=(), description="Notches of the grouping between, if there is one [ohm].")
    parallel: tuple[_Ohm, ...] = Field(default=(), description="Notches of the last grouping [ohm].")


class Relay(Declaration):
    """Undervoltage relay: takes the motors off the line, and lets them start again."""

    off_v: Real = field("off_v", "Voltage below which it opens.", at_least=0)
    on_v: Real = field("on_v", "Voltage above which it closes again.", above=0)
    delay_s: Real = field("delay_s", "Time for which the voltage must stay below or above.", at_least=0, default=0.0)

    @model_validator(mode="after")
    def _closes_above(self) -> Relay:
        if not self.off_v < self.on_v:
            volts = {"off": f"{self.off_v:.10g}", "on": f"{self.on_v:.10g}"}
            raise PydanticCustomError("relay", "off_v is not below on_v: {off} V and {on} V", volts)
        return self


class SeriesMotorDrive(Declaration):
    """DC series motors with starting resistors."""

    kind: Literal["series_motors"] = Field(description="Kind of drive.")
    motors: Count = Field(ge=1, description="Traction motors of the vehicle.")
    groupings: tuple[Grouping, ...] = Field(min_length=1, description="Groupings, the one with most motors in series first.")
    starting_current_a: Real = field("starting_current_a", "Motor current that the starting resistors hold.", above=0)
    motor_resistance_ohm: Real = field("motor_resistance_ohm", "Resistance of the windings of one motor.", at_least=0)
    magnetisation: tuple[MagnetisationPoint, ...] = Field(
        min_length=2,
        description="Magnetisation curve at full field, by rising current; from zero to the first point it is straight.",
    )
    field_steps_percent: tuple[_Percent, ...] = Field(
        default=(100.0,),
        min_length=1,
        description="Share of the motor current that flows through the field, full field first [%].",
    )
    gear_ratio: Real = field("gear_ratio", "Revolutions of the motor per revolution of the wheel.", above=0)
    wheel_diameter_m: Real = field("wheel_diameter_m", "Diameter of the wheels.", above=0)
    gear_efficiency: Real = field("gear_efficiency", "Power at the wheel over power of the induced voltage.", above=0, at_most=1)
    starting_resistors_ohm: StartingResistors | None = Field(
        default=None,
        description="Resistance of one branch by notch; with it the notches are drawn and the first current checked.",
    )
    relay: Relay | None = Field(default=None, description="Undervoltage relay; left out: there is none.")
    notch_time_s: Real = field("notch_time_s", "Least time on a grouping or field step.", at_least=0, default=1.0)
    max_current_a: Real | None = field("max_current_a", _MAX_CURRENT, above=0, default=None)
    knee_factor: Real | None = field("knee_factor", f"{_KNEE} Left out: no reduction.", above=0, at_most=1, default=None)

    @model_validator(mode="after")
    def _is_in_order(self) -> SeriesMotorDrive:
        _check_order("current_a of magnetisation[{}]", [point.current_a for point in self.magnetisation], "A")
        _check_order("field_steps_percent[{}]", self.field_steps_percent, "%", falls=True)
        return self


_OTHER = "Not read here: so that one file may hold both curves."


class EffortPoint(Declaration):
    """A point of an effort table."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0)
    voltage_v: Real | None = field("voltage_v", "Voltage at the pantograph; left out: at any voltage.", above=0, default=None)
    effort_kn: Real = field("effort_kn", "Greatest tractive effort at the wheel.", at_least=0)
    current_a: Real | None = field("current_a", _OTHER, at_least=0, default=None)


class CurrentPoint(Declaration):
    """A point of a current table."""

    speed_kmh: Real = field("speed_kmh", "Speed.", at_least=0)
    voltage_v: Real | None = field("voltage_v", "Voltage at the pantograph; left out: at any voltage.", above=0, default=None)
    current_a: Real = field("current_a", "Current from the line at the greatest effort, without auxiliaries.", at_least=0)
    effort_kn: Real | None = field("effort_kn", _OTHER, at_least=0, default=None)


class TableDrive(Declaration):
    """Effort and current by points over speed and voltage; at part effort the current falls with the power."""

    kind: Literal["table"] = Field(description="Kind of drive.")
    effort: tuple[EffortPoint, ...] = Field(min_length=2, description="Greatest effort, by points.")
    current: tuple[CurrentPoint, ...] = Field(min_length=2, description="Current at the greatest effort, by points.")
    max_current_a: Real | None = field("max_current_a", _MAX_CURRENT, above=0, default=None)
    knee_factor: Real | None = field("knee_factor", f"{_KNEE} Left out: no reduction.", above=0, at_most=1, default=None)
    fold_back_from_v: Real | None = field(
        "fold_back_from_v", "Voltage above which less is fed back.", above=0, default=None, source="U_max1 of the system"
    )
    fold_back_to_v: Real | None = field(
        "fold_back_to_v", "Voltage at which nothing is fed back.", above=0, default=None, source="U_max2 of the system"
    )


Drive = Annotated[InverterDrive | SeriesMotorDrive | TableDrive, Field(discriminator="kind")]
