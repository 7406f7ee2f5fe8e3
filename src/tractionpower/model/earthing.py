"""What joins the rails with each other and with earth: cross bonds, earthed places, voltage-limiting devices."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Identifier, Real, Tracks
from tractionpower.model.line import Stretch
from tractionpower.model.quantity import field


class Bonds(Stretch):
    """Cross bonds between the rails of tracks, at equal distances from `from_km` on."""

    every_km: Real = field("every_km", "Distance between them.", above=0)
    resistance_ohm: Real = field(
        "resistance_ohm", "Resistance of one bond between two neighbouring tracks.", at_least=0, default=0.0
    )
    tracks: Tracks | None = Field(default=None, description="Tracks that they join; left out: all tracks that exist there.")


class Earthing(Declaration):
    """A connection of the rails, or of a substation's negative busbar, with remote earth: a depot, an earth electrode."""

    id: Identifier = Field(description="Identifier of the earthing.")
    track: Identifier | None = Field(default=None, description="Track whose rails are earthed.")
    km: Real | None = field("km", "Place on the track.", default=None)
    substation: Identifier | None = Field(default=None, description="Substation whose negative busbar is earthed.")
    resistance_ohm: Real = field("resistance_ohm", "Resistance to remote earth.", above=0, at_most=1e6)

    @model_validator(mode="after")
    def _rails_or_busbar(self) -> Earthing:
        if (self.substation is None) == (self.track is None) or (self.track is None) != (self.km is None):
            raise PydanticCustomError("earthing", "an earthing has track and km, or substation")
        return self


class VoltageTime(Declaration):
    """A point of the closing characteristic of a voltage-limiting device."""

    above_v: Real = field("above_v", "Rail potential, of either sign, above which it closes.", above=0)
    after_s: Real = field("after_s", "Time that the potential must last above it; 0: at once.", at_least=0, default=0.0)


class VoltageLimitingDevice(Declaration):
    """A device that joins the rails with earth when their potential is too high for too long, and latches."""

    id: Identifier = Field(description="Identifier of the device.")
    track: Identifier = Field(description="Track whose rails it is connected to.")
    km: Real = field("km", "Place on the track.")
    closes: tuple[VoltageTime, ...] = Field(min_length=1, description="Closing characteristic: any of its points closes it.")
    closed_resistance_ohm: Real = field(
        "closed_resistance_ohm", "Resistance to remote earth when closed, with that of the earth electrode.", above=0, default=0.1
    )
    opens_after_s: Real | None = field(
        "opens_after_s", "Time after closing at which it opens again; left out: it stays closed.", above=0, default=None
    )
    state: Literal["open", "closed"] = Field(default="open", description="Normal state.")
