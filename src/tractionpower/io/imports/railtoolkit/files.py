"""Files of railtoolkit's schema: rolling stock and running paths, versions 2022.05 (rows as lists) and 2024.07 (rows by key).

Source: github.com/railtoolkit/schema; settings are those of TrainRuns.jl, github.com/railtoolkit/TrainRuns.jl (both ISC).
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from tractionpower.io.imports import foreign as f
from tractionpower.io.wording import shown
from tractionpower.model.base import Identifier, Real, Text
from tractionpower.model.quantity import field

STOCK = "https://railtoolkit.org/schema/rolling-stock.json"
PATHS = "https://railtoolkit.org/schema/running-path.json"
Version = Literal["2022.05", "2024.07"]


class StockVehicle(f.Foreign):
    """A vehicle."""

    id: Identifier
    name: Text = ""
    vehicle_type: Literal["traction unit", "freight", "passenger", "multiple unit"]
    power_type: Literal["diesel", "electric", "steam"] | None = None
    length: Real = field("length_m", "Length.", above=0)
    mass: Real = field("mass_t", "Mass without load.", above=0)
    mass_traction: Real | None = field("mass_t", "Mass on driven axles.", above=0, default=None)
    load_limit: Real = field("load_t", "Greatest load.", at_least=0, default=0.0)
    speed_limit: Real | None = field("speed_kmh", "Greatest speed.", above=0, default=None)
    a_braking: Real | None = Field(default=None, lt=0, description="Acceleration of service braking [m/s²], negative.")
    rotation_mass: Real | None = Field(default=None, ge=1, description="Factor of rotating masses.")
    base_resistance: Real = Field(default=0.0, ge=0, description="Basic resistance [permille of the weight].")
    rolling_resistance: Real = Field(default=0.0, ge=0, description="Resistance to rolling [permille of the weight].")
    air_resistance: Real = Field(default=0.0, ge=0, description="Air resistance at 100 km/h [permille of the weight].")
    tractive_effort: tuple[Annotated[f.Pair, f.numbers("speed", "effort")], ...] = Field(
        default=(), description="Speed [km/h] and tractive effort [N]."
    )
    picture: Text = ""
    uuid: Text = Field(default="", alias="UUID")


class StockTrain(f.Foreign):
    """A train."""

    id: Identifier
    name: Text = ""
    formation: Annotated[tuple[Identifier, ...], Field(min_length=1)]
    uuid: Text = Field(default="", alias="UUID")


class StockFile(f.Foreign):
    """Rolling stock."""

    schema_: Literal["https://railtoolkit.org/schema/rolling-stock.json"] = Field(alias="schema")
    schema_version: Version
    trains: tuple[StockTrain, ...] = ()
    vehicles: Annotated[tuple[StockVehicle, ...], Field(min_length=1)]


def _row_by_key(*names: str) -> BeforeValidator:
    # The older version has rows as lists in this order.
    def named(value: Any) -> Any:
        if isinstance(value, list):
            if len(value) != len(names):
                text = "{found} is no row of {names}"
                raise PydanticCustomError("bad_row", text, {"found": shown(value), "names": ", ".join(names)})
            return dict(zip(names, value, strict=True))
        return value

    return BeforeValidator(named)


class Section(f.Foreign):
    """Speed and resistance from a position on."""

    position: Real
    speed: Real | None = field("speed_kmh", "Speed limit.", above=0, default=None)
    resistance: Real | None = Field(default=None, description="Resistance of the path, positive uphill [permille of the weight].")


class Point(f.Foreign):
    """A place at which a run is looked at."""

    position: Real
    label: Text
    measure: Literal["front", "middle", "rear"]


class RunningPath(f.Foreign):
    """A path of sections."""

    id: Identifier
    name: Text = ""
    description: Text = ""
    uuid: Text = Field(default="", alias="UUID")
    characteristic_sections: Annotated[
        tuple[Annotated[Section, _row_by_key("position", "speed", "resistance")], ...], Field(min_length=2)
    ]
    points_of_interest: tuple[Annotated[Point, _row_by_key("position", "label", "measure")], ...] = ()


class PathFile(f.Foreign):
    """Running paths."""

    schema_: Literal["https://railtoolkit.org/schema/running-path.json"] = Field(alias="schema")
    schema_version: Version
    paths: Annotated[tuple[RunningPath, ...], Field(min_length=1)]


class Settings(f.Foreign):
    """How TrainRuns computes."""

    mass_model: Literal["mass_point", "homogeneous_strip"] | None = Field(default=None, alias="massModel")


class SettingsFile(f.Foreign):
    """Settings of TrainRuns."""

    settings: Settings
