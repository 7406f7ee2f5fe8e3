"""Fixed taps between contact line and rail: depots, heating, measured loads."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Identifier, Real, TimeOfDay, format_time
from tractionpower.model.quantity import field


class LoadPoint(Declaration):
    """A value of a load's profile, which holds until the next one."""

    time: TimeOfDay = Field(description="From when.")
    power_kw: Real | None = field("power_kw", "Power taken from the line from then on.", default=None)
    current_a: Real | None = field("current_a", "Current taken from the line from then on.", default=None)

    @model_validator(mode="after")
    def _power_or_current(self) -> LoadPoint:
        if (self.power_kw is None) == (self.current_a is None):
            raise PydanticCustomError("power_or_current", "a row of a load's profile has either power_kw or current_a")
        return self

    @property
    def value(self) -> float:
        """Power [kW] or current [A], whichever is given."""
        return self.power_kw if self.power_kw is not None else self.current_a or 0.0


class Load(Declaration):
    """A fixed tap between contact line and rail: a depot, heating, a measured load."""

    id: Identifier = Field(description="Identifier of the load.")
    track: Identifier = Field(description="The track.")
    km: Real = field("km", "Place of the tap.")
    power_kw: Real | None = field("power_kw", "Power taken from the line; negative feeds back.", default=None)
    current_a: Real | None = field("current_a", "Current taken from the line; negative feeds back.", default=None)
    profile: tuple[LoadPoint, ...] | None = Field(
        default=None,
        min_length=1,
        description="Power or current over the time of day, instead of one value; zero before the first.",
    )
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
        if sum(value is not None for value in (self.power_kw, self.current_a, self.profile)) != 1:
            raise PydanticCustomError("power_or_current", "a load has one of power_kw, current_a, profile")
        if self.from_ is not None and self.to is not None and not self.from_ < self.to:
            raise PydanticCustomError("times", "from is not before to")
        return self

    @model_validator(mode="after")
    def _one_characteristic(self) -> Load:
        rows = self.profile or ()
        for before, row in pairwise(rows):
            if not before.time < row.time:
                times = {"a": format_time(row.time), "b": format_time(before.time)}
                raise PydanticCustomError("profile_times", "the times of a profile rise: {a} stands behind {b}", times)
        if len({row.power_kw is None for row in rows}) > 1:
            raise PydanticCustomError("profile_kinds", "a profile has either power_kw or current_a in all of its rows")
        if any(row.value > 0.0 for row in rows) and any(row.value < 0.0 for row in rows):
            # Feeding back has another characteristic: it is limited from above, taking from below.
            text = "a profile does not change its sign: describe what takes and what feeds back as two loads"
            raise PydanticCustomError("profile_signs", text)
        return self
