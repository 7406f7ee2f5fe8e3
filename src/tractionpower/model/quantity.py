"""The one form in which a physical or counted quantity is declared.

A `Quantity` is declared once and feeds the validation of input fields, the JSON schema, the commented template
files, the reference page and the headings of result columns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pydantic import Field

REQUIRED: Any = ...

# The unit is the end of the name; the longest suffix wins. Times of day carry no suffix, their type says how they are written.
UNITS: dict[str, str] = {
    "ohm_per_km": "Ω/km",
    "kn_per_mm": "kN/mm",
    "kns_per_m": "kN s/m",
    "n_m_per_kn": "N m/kN",
    "n_per_kn_per_kmh2": "N/kN/(km/h)²",
    "n_per_kn_per_kmh": "N/kN/(km/h)",
    "n_per_kn": "N/kN",
    "n_per_kmh2": "N/(km/h)²",
    "n_per_kmh": "N/(km/h)",
    "vs_per_rev": "V s/rev",
    "s_per_km": "S/km",
    "a_per_km": "A/km",
    "per_km": "1/km",
    "percent": "%",
    "permille": "‰",
    "kmh": "km/h",
    "mps2": "m/s²",
    "mps": "m/s",
    "bar": "bar",
    "deg": "°",
    "cm2": "cm²",
    "kj": "kJ",
    "kwh": "kWh",
    "ah": "Ah",
    "kn": "kN",
    "ohm": "Ω",
    "vs": "V s",
    "km": "km",
    "kw": "kW",
    "pu": "p.u.",
    "per_kelvin": "1/K",
    "mva": "MVA",
    "mm2": "mm²",
    "mm": "mm",
    "ma_per_m": "mA/m",
    "s": "s",
    "m": "m",
    "v": "V",
    "a": "A",
    "t": "t",
    "n": "N",
    "c": "°C",
}


def unit_of(name: str) -> str:
    """Return the unit that the suffix of `name` stands for, or an empty string.

    A single letter is the symbol of a number in a formula, no unit.

    >>> unit_of("resistance_ohm_per_km"), unit_of("km"), unit_of("c")
    ('Ω/km', 'km', '')
    """
    for suffix in sorted(UNITS, key=len, reverse=True):
        if (name == suffix and len(name) > 1) or name.endswith("_" + suffix):
            return UNITS[suffix]
    return ""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A named quantity: unit, meaning, bounds, default and source.

    Attributes
    ----------
    name
        Name with the unit as suffix; the same in files, models, tables and headings.
    meaning
        One sentence for a person.
    above, at_least, at_most
        Bounds in the unit of the name; ``above`` is exclusive.
    default
        Value when the input leaves it out; `REQUIRED` when it must not.
    source
        Where the default or the definition comes from.
    example
        Value that template files show.
    """

    name: str
    meaning: str
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    default: Any = REQUIRED
    source: str = ""
    example: Any = None

    @property
    def unit(self) -> str:
        """Unit by the suffix of the name."""
        return unit_of(self.name)

    @property
    def words(self) -> str:
        """The name for people, without its unit."""
        for suffix in sorted(UNITS, key=len, reverse=True):
            if self.name.endswith("_" + suffix):
                return self.name[: -len(suffix) - 1].replace("_", " ")
        return self.name.replace("_", " ")

    @property
    def heading(self) -> str:
        """Heading of a column for people, for example ``voltage [V]``."""
        return f"{self.words} [{self.unit}]" if self.unit else self.words

    def field(self) -> Any:
        """Return this quantity as the default value of a pydantic field."""
        extra: dict[str, Any] = {key: value for key, value in (("unit", self.unit), ("source", self.source)) if value}
        return Field(
            default=self.default,
            description=self.meaning,
            gt=self.above,
            ge=self.at_least,
            le=self.at_most,
            json_schema_extra=extra or None,
        )


def field(name: str, meaning: str, **details: Any) -> Any:
    """Declare a quantity as a model field; see `Quantity` for `details`."""
    return Quantity(name, meaning, **details).field()
