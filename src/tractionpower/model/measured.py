"""What the columns of a measured file are: the map by which a measurement is held against a run."""

from __future__ import annotations

from datetime import date
from typing import Annotated, Literal

from pydantic import Field, StringConstraints, field_validator, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Identifier, Real, Text, TimeOfDay
from tractionpower.model.quantity import field, unit_of

SUBJECTS = {"train": "trains", "substation": "substations", "load": "loads", "feeder": "feeders", "cabin_feeder": "cabins"}
"""What can be measured, and the table of a run that holds the same."""

FACTORS: dict[str, dict[str, float]] = {
    "V": {"V": 1.0, "kV": 1000.0, "mV": 0.001},
    "A": {"A": 1.0, "kA": 1000.0, "mA": 0.001},
    "kW": {"kW": 1.0, "MW": 1000.0, "W": 0.001},
    "km/h": {"km/h": 1.0, "m/s": 3.6, "mph": 1.609344},
    "km": {"km": 1.0, "m": 0.001},
    "m": {"m": 1.0, "km": 1000.0},
    "kN": {"kN": 1.0, "N": 0.001},
    "m/s²": {"m/s2": 1.0, "m/s²": 1.0},
}
"""Units that a measurement may have, by the unit of the run, each as a multiple of that."""

ColumnName = Annotated[str, StringConstraints(strict=True, min_length=1, max_length=300)]


class MeasuredTime(Declaration):
    """The column of times and how they are written."""

    column: ColumnName = Field(description="Heading of the column of times.")
    format: Text | None = Field(
        default=None,
        description="seconds, unix (seconds since 1970), clock (HH:MM:SS), iso (date and time), excel (days as spreadsheets count"
        " them), or a pattern of strptime such as %d.%m.%Y %H:%M:%S; left out: found by the first rows.",
    )
    start: TimeOfDay = Field(default=0.0, description="Time of day of second 0, for a column of seconds.")
    date: Text | None = Field(
        default=None, description="Day of the study, YYYY-MM-DD, for times with a date; left out: the day of the first row."
    )
    utc_offset_h: Real | None = Field(
        default=None, ge=-14, le=14,
        description="Local time of the study less UTC [h]; times that do not say their own offset are UTC then."
        " Left out: the times of the file are local times.",
    )  # fmt: skip

    @field_validator("format")
    @classmethod
    def _is_known(cls, value: str | None) -> str | None:
        if value is None or value in ("seconds", "unix", "clock", "iso", "excel") or "%" in value:
            return value
        allowed = "a format is seconds, unix, clock, iso, excel, or a pattern with % such as %H:%M:%S"
        raise PydanticCustomError("time_format", allowed)

    @field_validator("date")
    @classmethod
    def _is_a_date(cls, value: str | None) -> str | None:
        if value is not None:
            try:
                date.fromisoformat(value)
            except ValueError:
                raise PydanticCustomError("date", "a date is YYYY-MM-DD") from None
        return value


class MeasuredSeries(Declaration):
    """One measured quantity: its column, what it belongs to, its unit."""

    column: ColumnName = Field(description="Heading of the column.")
    of: Text = Field(
        description="What was measured: train, substation, load, feeder or cabin_feeder, a blank, and its identifier;"
        " of a feeder that of its station, the track and the side: feeder A 1 low_km."
    )
    quantity: Identifier = Field(
        description="Quantity, as the column of the run's table is called: voltage_v, current_a, power_kw, speed_kmh."
    )
    unit: Text | None = Field(default=None, description="Unit of the file, such as kV or m/s; left out: that of the quantity.")
    sign: Literal[1, -1] = Field(default=1, description="-1 where the file counts the other direction as positive.")
    offset: Real = Field(default=0.0, description="Added to the values, in the unit of the quantity.")
    smoothing_s: Real = field(
        "smoothing_s", "Measured and computed values are averaged over a sliding window of this length; 0: they are not.",
        at_least=0, at_most=3600, default=0.0,
    )  # fmt: skip

    @model_validator(mode="after")
    def _is_of_something(self) -> MeasuredSeries:
        if self.kind not in SUBJECTS or not self.subject:
            known = ", ".join(SUBJECTS)
            raise PydanticCustomError("of", "of is one of {known}, a blank, and an identifier", {"known": known})
        known_units = FACTORS.get(unit_of(self.quantity))
        if known_units is None:
            raise PydanticCustomError("quantity", "a quantity that can be measured has V, A, kW, km/h, km, m, kN or m/s² as unit")
        if self.unit is not None and self.unit not in known_units:
            text = ", ".join(known_units)
            raise PydanticCustomError("unit", "the unit of {quantity} is {units}", {"quantity": self.quantity, "units": text})
        return self

    @property
    def kind(self) -> str:
        """What kind of thing was measured, ``train``."""
        return self.of.partition(" ")[0]

    @property
    def subject(self) -> str:
        """Identifier of what was measured."""
        return self.of.partition(" ")[2].strip()

    @property
    def table(self) -> str:
        """Table of a run that holds the same."""
        return SUBJECTS[self.kind]

    @property
    def factor(self) -> float:
        """What the values of the file are multiplied by."""
        return self.sign * (1.0 if self.unit is None else FACTORS[unit_of(self.quantity)][self.unit])

    @property
    def id(self) -> str:
        """Name of the series, ``train 2 voltage_v``."""
        return f"{self.kind} {self.subject} {self.quantity}"


class MeasuredMap(Declaration):
    """The map of a measured file: which column is what."""

    format: Format = 1
    name: Text = Field(default="", description="Name of the measurement.")
    source: Text = Field(default="", description="Where it comes from: who measured, with what, when.")
    time: MeasuredTime = Field(description="The column of times.")
    series: tuple[MeasuredSeries, ...] = Field(min_length=1, description="Columns that are held against the run.")
    delimiter: Literal["comma", "semicolon", "tab", "blank"] | None = Field(
        default=None, description="What stands between cells; left out: found."
    )
    decimal: Literal["point", "comma"] | None = Field(default=None, description="Decimal sign; left out: found.")
    encoding: Literal["utf-8", "utf-16", "cp1250", "cp1252"] = Field(default="utf-8", description="Encoding of the text.")
    samples: Literal["instant", "mean_after", "mean_before"] = Field(
        default="instant",
        description="What a row holds: the values at its time (straight lines lie between rows), or means of the time until the"
        " next row, or since the one before.",
    )
    gap_s: Real | None = field(
        "gap_s", "Rows that are further apart leave a gap, which is not filled; left out: five times the usual distance.",
        above=0, default=None,
    )  # fmt: skip
    shift_s: Real | Literal["find"] = Field(
        default="find", description="Added to the times of the file [s]; find: the one with the highest correlation."
    )
    shift_range_s: Real = field(
        "shift_range_s", "How far a shift is looked for, either way.", above=0, at_most=86_400, default=120.0
    )
    on: ColumnName | None = Field(default=None, description="Column by which the shift is found; left out: by all together.")
    align: Literal["time", "distance"] = Field(
        default="time",
        description="time: values of the same time are compared; distance: values of trains at the same place, which needs a"
        " series of position_km or distance_m of each train.",
    )
    every_m: Real = field(
        "every_m", "Length of the pieces of the way whose means are compared with align: distance.",
        above=0, at_most=10_000, default=100.0,
    )  # fmt: skip

    @model_validator(mode="after")
    def _fits_together(self) -> MeasuredMap:
        ids = [each.id for each in self.series]
        twice = next((name for name in ids if ids.count(name) > 1), None)
        if twice is not None:
            raise PydanticCustomError("series", "two columns are {id}", {"id": twice})
        if self.on is not None and self.on not in [each.column for each in self.series]:
            raise PydanticCustomError("on", "on is none of the columns of the series")
        if self.align == "distance":
            placed = {each.subject for each in self.series if each.quantity in PLACES and each.kind == "train"}
            if any(each.kind != "train" or each.subject not in placed for each in self.series):
                raise PydanticCustomError("align", "align: distance is for trains, each with a series position_km or distance_m")
        return self


PLACES = ("position_km", "distance_m")
"""Quantities that tell where a train is."""
