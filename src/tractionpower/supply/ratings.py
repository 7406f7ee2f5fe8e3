"""What each device can bear: rated currents, over which windows, and settings of breakers.

Rectifier units have a rated current and a duty class, contact lines what the heat balance of their wires gives, cables and
rails what their tables give; an own value of the inputs always wins. What conductors carry is averaged over the windows of
the limits table (`window_contact_line_s`, `window_cable_s`, `window_rails_s`), since they are slow to warm.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from tractionpower.model.conductors import find_conductor
from tractionpower.model.limits import Limit, common_limits
from tractionpower.model.ratings import duty_of, find_unit
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import ContactLine, ReturnCircuit, Substation
from tractionpower.results.windows import window_label
from tractionpower.supply.ampacity import ampacity, heated_wires, weather_of
from tractionpower.supply.devices import Device
from tractionpower.supply.protection import breaker_of

NO_OVERLOAD = ((0.0, 1.0), (60.0, 1.0))
"""Windows of a unit that has no duty class: it is taken to bear no overload, not even for a minute."""

Row = TypeVar("Row", ContactLine, ReturnCircuit)

_SURE = ("verified", "user", "secondary", "derived", "recalled")  # from the surest on


@dataclass(frozen=True, slots=True)
class Rating:
    """What a device can bear.

    Attributes
    ----------
    device_id
        Its identifier.
    rated_a
        Rated current [A]; NaN without one.
    duty_class
        Duty class, or the window over which currents of a conductor are averaged.
    windows
        Window [s] (0: the whole run) and permitted root mean square in rated currents.
    setting_a
        Setting of its breaker [A]; NaN where none trips.
    status
        How the least sure value of it is known: verified, user, secondary, derived, recalled; empty without a rating.
    source
        Where it comes from, or why there is none.
    """

    device_id: str
    rated_a: float
    duty_class: str
    windows: tuple[tuple[float, float], ...]
    setting_a: float
    status: str
    source: str


def ratings_of(scenario: Scenario, devices: Iterable[Device]) -> tuple[Rating, ...]:
    """Return the ratings of devices of a checked scenario, in their order."""
    raters = _Raters(scenario)
    return tuple(raters.rate(device) for device in devices)


def no_rating(device_id: str, why: str = "no rating given") -> Rating:
    """Return the rating of a device that has none."""
    return Rating(device_id, math.nan, "", (), math.nan, "", why)


class _Raters:
    def __init__(self, scenario: Scenario) -> None:
        supply = scenario.supply
        self.scenario, self.supply = scenario, supply
        self.substations = {station.id: station for station in supply.substations}
        self.cabins = {cabin.id: cabin for cabin in supply.section_cabins}
        self.rows = {row.id: row for row in supply.feeders}
        self.windows = common_limits(scenario.limits, supply.system, "window_")
        self.weather = weather_of(scenario.limits, supply.system)
        self.of_lines: dict[ContactLine, Rating] = {}
        self.by_kind: dict[str, Callable[[Device], Rating]] = {
            "unit": lambda device: self._unit(device, 1),
            "substation": self._substation,
            "feeder": self._feeder,
            "cabin_feeder": self._feeder,
            "return_feeder": self._feeder,
            "contact_line": self._contact_line,
            "rails": self._rails,
        }

    def rate(self, device: Device) -> Rating:
        rate = self.by_kind.get(device.kind)
        return no_rating(device.id) if rate is None else replace(rate(device), device_id=device.id)

    def _substation(self, device: Device) -> Rating:
        """Return what the units that are in service from the start bear together."""
        station = self.substations[device.station]
        units = station.units if station.units_in_service is None else station.units_in_service
        return self._unit(device, units) if units else no_rating(device.id, "no unit is in service")

    def _unit(self, device: Device, units: int) -> Rating:
        station = self.substations[device.station]
        kind = find_unit(self.scenario.rectifier_units, station.unit) if station.unit is not None else None
        rated, told, known = station.rated_current_a, f"rated_current_a of substation {station.id}", "user"
        if rated is None and kind is not None:
            rated, told, known = kind.rated_current_a, f"unit {kind.unit}: {kind.source}", kind.status
        if rated is None:
            return no_rating(device.id, "no rating given: neither rated_current_a nor unit")
        name, windows, more, status = self._duty(station)
        source = (
            f"{units} x {rated:g} A, {units} of {station.units} units in service; {told}" if device.kind == "substation" else told
        )
        return Rating(device.id, units * rated, name, windows, math.nan, _least_sure(known, status), f"{source}; {more}")

    def _duty(self, station: Substation) -> tuple[str, tuple[tuple[float, float], ...], str, str]:
        """Return the duty class of the units of a substation, its windows, their source and status."""
        kind = find_unit(self.scenario.rectifier_units, station.unit) if station.unit is not None else None
        name = station.duty_class or (kind.duty_class if kind is not None else "")
        rows = duty_of(self.scenario.duty_classes, name)
        if not rows:
            return name, NO_OVERLOAD, "no duty class: taken to bear no overload", "derived"
        sources = "; ".join(dict.fromkeys(row.source for row in rows))
        windows = tuple((row.window_s, row.multiple) for row in rows)
        return name, windows, f"class {name}: {sources}", _least_sure(*(row.status for row in rows))

    def _feeder(self, device: Device) -> Rating:
        station = self.substations.get(device.station) or self.cabins[device.station]
        row, returns = self.rows.get(device.id), device.kind == "return_feeder"
        breaker = None if returns else breaker_of(row, station)
        setting = math.nan if breaker is None or breaker.trip_current_a is None else breaker.trip_current_a
        name = "return_rated_current_a" if returns else "feeder_rated_current_a"
        of_station: float | None = getattr(station, name, None)
        cable = find_conductor(self.scenario.conductors, "cable", row.cable) if row is not None and row.cable else None
        if row is not None and row.rated_current_a is not None:
            found = self._conductor("window_cable_s", row.rated_current_a, "user", f"rated_current_a of feeder {row.id}")
        elif row is not None and cable is not None and cable.rated_current_a is not None:
            told = f"{row.cables} x {cable.rated_current_a:g} A, cable {cable.name}: {cable.source}"
            found = self._conductor("window_cable_s", row.cables * cable.rated_current_a, cable.status, told)
        elif of_station is not None:
            found = self._conductor("window_cable_s", of_station, "user", f"{name} of {station.id}")
        else:
            why = f"no rating given; the conductors table has none for cable {cable.name}" if cable is not None else ""
            found = no_rating(device.id, *([why] if why else []))
        return replace(found, setting_a=setting)

    def _contact_line(self, device: Device) -> Rating:
        row = _row_of(device, self.supply.contact_lines)
        if row is None:
            return no_rating(device.id)
        if row not in self.of_lines:
            self.of_lines[row] = self._line(row)
        return self.of_lines[row]

    def _line(self, row: ContactLine) -> Rating:
        window = "window_contact_line_s"
        if row.rated_current_a is not None:
            return self._conductor(window, row.rated_current_a, "user", "rated_current_a of the contact line")
        wires = heated_wires(row, self.scenario.conductors)
        if isinstance(wires, str):
            return no_rating("", f"no rating given; {wires}")
        if self.weather is None:
            return no_rating("", "no rating given; the limits table lacks the weather of wires")
        found, weather = ampacity(wires, self.weather), self.weather
        told = (
            f"heat balance of its wires, {found.ruling} at its highest temperature; air {weather.ambient_c:g} °C,"
            f" wind {weather.wind_mps:g} m/s, sun {weather.sun_wpm2:g} W/m²"
        )
        if found.current_a == 0.0:
            told += ": it may carry nothing"
        return self._conductor(window, found.current_a, "derived", told)

    def _rails(self, device: Device) -> Rating:
        row = _row_of(device, self.supply.return_circuit)
        if row is None:
            return no_rating(device.id)
        if row.rated_current_a is not None:
            return self._conductor("window_rails_s", row.rated_current_a, "user", "rated_current_a of the return circuit")
        rail = find_conductor(self.scenario.conductors, "rail", row.rail) if row.rail is not None else None
        if rail is None or rail.rated_current_a is None:
            return no_rating(device.id)
        tracks = len(device.track.split())
        told = f"{tracks} x {rail.rated_current_a:g} A, rail {rail.name}: {rail.source}"
        return self._conductor("window_rails_s", tracks * rail.rated_current_a, rail.status, told)

    def _conductor(self, window: str, rated_a: float, status: str, source: str) -> Rating:
        """Return the rating of a conductor, averaged over the window of that name in the limits table."""
        limit: Limit | None = self.windows.get(window)
        if limit is None:
            return no_rating("", f"no rating: the limits table lacks {window}")
        label = window_label(limit.value).replace("_", " ")
        return Rating("", rated_a, label, ((limit.value, 1.0),), math.nan, status, source)


def _row_of(device: Device, rows: Sequence[Row]) -> Row | None:
    """Return the row of which a section is: that which shares most of its length, as sections end where rows do."""
    tracks = set(device.track.split())
    own = [row for row in rows if row.tracks is None or tracks.intersection(row.tracks)]
    shared = [min(row.to_km, device.to_km) - max(row.from_km, device.from_km) for row in own]
    return own[shared.index(max(shared))] if own else None


def _least_sure(*statuses: str) -> str:
    return max(statuses, key=_SURE.index)
