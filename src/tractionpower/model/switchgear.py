"""What switches the contact line: feeders with their breakers, isolators, cross ties, by-passes, and when they move."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Count, Declaration, Identifier, Real, Text, TimeOfDay
from tractionpower.model.quantity import field

Side = Literal["low_km", "high_km"]
Position = Literal["closed", "open"]

_SIDE = "Side of the place, where the contact line is cut there."


class Protection(Declaration):
    """Overcurrent trip of a feeder's breaker, and its automatic reclosure; left out: it does not trip."""

    trip_current_a: Real | None = field(
        "trip_current_a", "Current in either direction above which the breaker trips.", above=0, default=None
    )
    trip_delay_s: Real = field("trip_delay_s", "Time that the current must last above it.", at_least=0, default=0.0)
    reclose_after_s: Real | None = field(
        "reclose_after_s", "Dead time until the breaker closes again by itself; left out: it stays open.", above=0, default=None
    )
    reclosures: Count = Field(default=1, ge=1, description="How often it closes again by itself before it stays open.")
    reclaim_s: Real = field("reclaim_s", "Time in service after which its reclosures are counted anew.", above=0, default=180.0)


class Cable(Declaration):
    """A connection given by its resistance or by its cable."""

    resistance_ohm: Real | None = field("resistance_ohm", "Resistance; left out: that of the cable.", at_least=0, default=None)
    cable: Identifier | None = Field(default=None, description="Type of the cable, by the conductors table.")
    cables: Count = Field(default=1, ge=1, description="Number of cables in parallel.")
    length_m: Real | None = field("length_m", "Length of the cable.", above=0, default=None)
    rated_current_a: Real | None = field(
        "rated_current_a", "Continuous current of all cables together; left out: that of the cable's type.", above=0, default=None
    )

    @model_validator(mode="after")
    def _resistance_or_cable(self) -> Cable:
        if self.resistance_ohm is not None and self.cable is not None:
            raise PydanticCustomError("resistance_or_cable", "give either resistance_ohm or cable with length_m")
        if (self.cable is None) != (self.length_m is None):
            raise PydanticCustomError("cable", "cable and length_m go together")
        return self


class Feeder(Protection, Cable):
    """One feeder of a substation or section cabin, where it differs from the others there, or leads to another line.

    Its identifier is ``AT TRACK SIDE``, for example ``A 1 low_km``. Without a row a substation or cabin has a feeder to
    both sides of each of its tracks.
    """

    at: Identifier = Field(description="Substation or section cabin that it belongs to.")
    track: Identifier = Field(description="Track that it feeds.")
    side: Literal["low_km", "high_km", "return"] = Field(
        description="Side of the contact line that it feeds; return: return feeder from the rails of this track."
    )
    km: Real | None = field("km", "Place on the track; left out: that of the substation or cabin.", default=None)
    state: Position = Field(default="closed", description="Normal state of its breaker.")

    @property
    def id(self) -> str:
        """Identifier by which events and tables name it."""
        return feeder_id(self.at, self.track, self.side)


def feeder_id(at: str, track: str, side: str) -> str:
    """Return the identifier of a feeder."""
    return f"{at} {track} {side}"


class SwitchEnd(Declaration):
    """What one side of a switch is connected to: a contact line, or the busbar of a substation or section cabin."""

    track: Identifier | None = Field(default=None, description="Track whose contact line is meant.")
    km: Real | None = field("km", "Place on the track.", default=None)
    side: Side | None = Field(default=None, description=_SIDE)
    busbar: Identifier | None = Field(default=None, description="Substation or section cabin whose positive busbar is meant.")

    @model_validator(mode="after")
    def _line_or_busbar(self) -> SwitchEnd:
        if (self.busbar is None) == (self.track is None) or (self.track is None) != (self.km is None):
            raise PydanticCustomError("switch_end", "an end of a switch is track and km, or busbar")
        if self.side is not None and self.track is None:
            raise PydanticCustomError("switch_end", "side goes with track and km")
        return self


class Switch(Declaration):
    """A switch between two places of the contact lines: isolator, cross tie, by-pass, paralleling anywhere."""

    id: Identifier = Field(description="Identifier of the switch.")
    from_: SwitchEnd = Field(alias="from", description="One side.")
    to: SwitchEnd = Field(description="The other side.")
    resistance_ohm: Real = field("resistance_ohm", "Resistance of the connection when closed.", at_least=0, default=0.0)
    state: Position = Field(default="closed", description="Normal state.")


class SwitchEvent(Declaration):
    """A device changes its state at a time of day."""

    time: TimeOfDay = Field(description="When.")
    device: Identifier = Field(
        description="Substation, section cabin, section point, switch, voltage-limiting device, or feeder ('A 1 low_km')."
    )
    state: Text | None = Field(default=None, description="State that it takes: one that the device may have.")
    units_in_service: Count | None = Field(
        default=None, ge=0, description="For a substation: how many rectifier units are in service from then on."
    )

    @model_validator(mode="after")
    def _one_change(self) -> SwitchEvent:
        if (self.state is None) == (self.units_in_service is None):
            raise PydanticCustomError("switch_event", "a switch event has either state or units_in_service")
        return self
