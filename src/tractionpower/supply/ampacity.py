"""What a contact line can carry: the heat balance of its wires.

A wire of resistance R(T), diameter d and current I in steady state has (structure of IEC TR 61597 and IEEE 738)

    I² R(T) + a S d = h(T) + e σ π d (T⁴ - Ta⁴),   R(T) = R20 (1 + alpha (T - 20))                            (1)

with the sun S, absorptivity a, emissivity e and what the wind v takes away (IEC TR 61597 as recalled, T in kelvin there)

    h(T) = π λ Nu (T - Ta),   Nu = 0.65 Re^0.2 + 0.23 Re^0.61,   Re = 1.644e9 v d ((T + Ta)/2)^-1.78          (2)

The wires of a contact line have one fall of voltage per metre, E. Each has its own temperature by (1) with I = E/R(T). The
contact line carries what it carries when the first of its wires reaches its highest permanent temperature. What lies on a
worn wire is taken as a round one of the cross-section that is left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from tractionpower.model.conductors import Conductor
from tractionpower.model.limits import Limit, common_limits
from tractionpower.model.supply import ContactLine
from tractionpower.supply.conductors import REFERENCE_C, look_up, worn_wires

_ZERO_C = 273.15
_STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m² K⁴)
_AIR_CONDUCTIVITY = 0.02585  # W/(m K), IEC TR 61597 as recalled
WEATHER = ("wire_ambient_c", "wire_wind_mps", "wire_sun_wpm2", "wire_emissivity", "wire_absorptivity")
"""Limits that describe the weather and the surface of wires."""


@dataclass(frozen=True, slots=True)
class Weather:
    """Design weather and surface: air [°C], wind across the wire [m/s], sun [W/m²], emissivity, absorptivity."""

    ambient_c: float
    wind_mps: float
    sun_wpm2: float
    emissivity: float
    absorptivity: float


@dataclass(frozen=True, slots=True)
class HeatedWire:
    """Equal wires: number, resistance of one at 20 °C [ohm/m], its coefficient [1/K], diameter [m], temperature [°C]."""

    conductor: str
    count: int
    ohm_per_m: float
    per_kelvin: float
    diameter_m: float
    highest_c: float

    def resistance(self, temperature_c: float) -> float:
        """Return the resistance of one wire at a temperature [ohm/m]."""
        return self.ohm_per_m * (1.0 + self.per_kelvin * (temperature_c - REFERENCE_C))

    def cooling(self, temperature_c: float, weather: Weather) -> float:
        """Return what one wire gives off at a temperature, less what the sun adds [W/m]."""
        wire_k, air_k = temperature_c + _ZERO_C, weather.ambient_c + _ZERO_C
        d = self.diameter_m
        reynolds = 1.644e9 * weather.wind_mps * d / math.pow(0.5 * (wire_k + air_k), 1.78)
        nusselt = 0.65 * math.pow(reynolds, 0.2) + 0.23 * math.pow(reynolds, 0.61)
        convection = math.pi * _AIR_CONDUCTIVITY * nusselt * (wire_k - air_k)
        radiation = weather.emissivity * _STEFAN_BOLTZMANN * math.pi * d * (wire_k**4 - air_k**4)
        return convection + radiation - weather.absorptivity * weather.sun_wpm2 * d

    def steepest(self, weather: Weather) -> float:
        """Return the fall of voltage that keeps the wire at its highest temperature [V/m]; 0 where none does."""
        return math.sqrt(max(0.0, self.cooling(self.highest_c, weather)) * self.resistance(self.highest_c))

    def temperature(self, volt_per_m: float, weather: Weather) -> float:
        """Return the temperature at a fall of voltage that is at most `steepest` [°C].

        Heating falls and cooling rises with the temperature, so halving finds the one place where they meet.
        """
        low, high = weather.ambient_c, self.highest_c
        while high - low > 1e-9:
            middle = 0.5 * (low + high)
            if volt_per_m**2 / self.resistance(middle) > self.cooling(middle, weather):  # it still warms
                low = middle
            else:
                high = middle
        return high


@dataclass(frozen=True, slots=True)
class Ampacity:
    """What a contact line carries [A], which of its wires rules, and the temperature of each kind of wire then [°C]."""

    current_a: float
    ruling: str
    temperatures_c: tuple[float, ...]


def weather_of(limits: Sequence[Limit], system: str) -> Weather | None:
    """Return the design weather by the limits table; None where a row of it is missing."""
    found = common_limits(limits, system, "wire_")
    if any(name not in found for name in WEATHER):
        return None
    return Weather(*(found[name].value for name in WEATHER))


def heated_wires(row: ContactLine, table: Sequence[Conductor]) -> list[HeatedWire] | str:
    """Return the wires of a contact line as their heat balance needs them, or in words what is not known of them."""
    worn = worn_wires(row, table)
    if not worn:
        return "its wires are not known"
    found = []
    for wire in worn:
        kind, left = look_up("wire", wire.conductor, table), 1.0 - wire.wear_percent / 100.0
        if kind.resistance_ohm_per_km is None or kind.diameter_mm is None or kind.highest_c is None:
            return f"diameter_mm or highest_c of wire {wire.conductor} is not known"
        ohm, diameter = kind.resistance_ohm_per_km / 1000.0 / left, kind.diameter_mm / 1000.0 * math.sqrt(left)
        found.append(HeatedWire(wire.conductor, wire.count, ohm, kind.per_kelvin, diameter, kind.highest_c))
    return found


def ampacity(wires: Sequence[HeatedWire], weather: Weather) -> Ampacity:
    """Return the permanent current of wires in parallel, (1) and (2)."""
    ruling = min(wires, key=lambda wire: wire.steepest(weather))
    fall = ruling.steepest(weather)
    if fall <= 0.0:
        return Ampacity(0.0, ruling.conductor, tuple(wire.highest_c for wire in wires))
    warm = tuple(wire.temperature(fall, weather) for wire in wires)
    current = sum(wire.count * fall / wire.resistance(t) for wire, t in zip(wires, warm, strict=True))
    return Ampacity(current, ruling.conductor, warm)
