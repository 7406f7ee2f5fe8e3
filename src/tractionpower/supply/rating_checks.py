"""Checks of what devices can bear: units and duty classes that the tables have, values that belong together, limits in range."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from tractionpower.errors import Problem
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.io.wording import counted, did_you_mean, shown
from tractionpower.model.conductors import Conductor
from tractionpower.model.limits import common_limits, find_limit
from tractionpower.model.ratings import DutyRow, RectifierUnit, duty_of, find_unit
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import ContactLine, Substation, Supply
from tractionpower.results.device_loads import steps_of
from tractionpower.supply.ampacity import HeatedWire, ampacity, heated_wires, weather_of
from tractionpower.supply.ratings import NO_OVERLOAD

_RANGES = {
    "wire_ambient_c": (-60.0, 80.0),
    "wire_wind_mps": (0.0, 60.0),
    "wire_sun_wpm2": (0.0, 2000.0),
    "wire_emissivity": (0.0, 1.0),
    "wire_absorptivity": (0.0, 1.0),
    "grid_low": (0.5, 1.0),
    "grid_high": (1.0, 1.5),
}
"""Least and greatest value of limits that formulas use or that a model takes over."""

_WINDOWS = ("window_contact_line_s", "window_cable_s", "window_rails_s")


def check_ratings(scenario: Scenario) -> list[Problem]:
    """Return what is wrong or doubtful with the ratings of a scenario."""
    problems: list[Problem] = []
    for station in scenario.supply.substations:
        path = f"supply.substations[{station.id}]"
        problems += _check_unit(path, station, scenario)
        problems += _check_class(path, station, scenario)
        problems += _check_reserve(path, station)
    problems += _check_windows(scenario.duty_classes, scenario.clock.step_s)
    limits = list(_check_limits(scenario))
    problems += [*_check_contracts(scenario.supply), *limits, *_check_whole_steps(scenario)]
    return problems if any(problem.code == "bad_limit" for problem in limits) else [*problems, *_check_wires(scenario)]


def _check_unit(path: str, station: Substation, scenario: Scenario) -> Iterator[Problem]:
    """Yield a type of unit that the table lacks, or one of another system."""
    if station.unit is None:
        return
    unit = find_unit(scenario.rectifier_units, station.unit)
    if unit is None:
        shipped = [row.unit for row in RECTIFIER_UNITS.shipped]
        known = {*shipped, *(row.unit for row in scenario.rectifier_units)}
        yield _unknown("unknown_unit", f"{path}.unit", "rectifier unit", station.unit, known, RECTIFIER_UNITS.name)
        return
    yield from _check_voltage(f"{path}.unit", unit, scenario)


def _check_voltage(path: str, unit: RectifierUnit, scenario: Scenario) -> Iterator[Problem]:
    system = scenario.supply.system
    nominal, highest = (find_limit(scenario.limits, system, name) for name in ("u_n", "u_max2"))
    if nominal is None or highest is None or 0.8 * nominal.value <= unit.rated_voltage_v <= highest.value:
        return
    found = f"unit {unit.unit} is rated for {unit.rated_voltage_v:g} V, the system is {system}"
    yield Problem(
        "unit_voltage", path, found, f"{0.8 * nominal.value:g} to {highest.value:g} V", "choose another unit", "warning"
    )


def _check_class(path: str, station: Substation, scenario: Scenario) -> Iterator[Problem]:
    """Yield a duty class that the table lacks, and a rated current and a class of which one stands alone."""
    unit = find_unit(scenario.rectifier_units, station.unit) if station.unit is not None else None
    name = station.duty_class or (unit.duty_class if unit is not None else None)
    known = {row.duty_class for row in scenario.duty_classes}
    if name is not None and name not in known:
        known |= {row.duty_class for row in DUTY_CLASSES.shipped}
        where, owner = (f"{path}.duty_class", "") if station.duty_class else (f"{path}.unit", f" of unit {station.unit}")
        yield _unknown("unknown_duty_class", where, "duty class", name, known, DUTY_CLASSES.name, owner)
    elif name is None and station.rated_current_a is not None:
        found = "rated_current_a without duty_class: nothing says what a unit bears for how long"
        remedy = "give duty_class, or unit; without, a unit is taken to bear no overload"
        yield Problem("no_duty_class", f"{path}.duty_class", found, "", remedy, "warning")
    elif station.duty_class is not None and station.unit is None and station.rated_current_a is None:
        found, remedy = "duty_class without a rated current", "give rated_current_a, or unit"
        yield Problem("duty_class_without_current", f"{path}.duty_class", found, "", remedy, "warning")


def _check_reserve(path: str, station: Substation) -> Iterator[Problem]:
    """Yield settings of a reserve that there is not."""
    fields = Substation.model_fields
    given = [
        name
        for name in ("reserve_after_s", "reserve_overload_percent")
        if getattr(station, name) != fields[name].default and station.reserve_units == 0
    ]
    if given:
        found = f"{' and '.join(given)} without reserve_units: nothing comes in place of a unit that is out"
        yield Problem(
            "reserve_without_units", f"{path}.{given[0]}", found, "", "give reserve_units, or leave them out", "warning"
        )


def _check_windows(rows: Sequence[DutyRow], step_s: float) -> Iterator[Problem]:
    """Yield windows of duty classes that the step cannot resolve, and rows that a shorter window makes useless."""
    by_class: dict[str, list[DutyRow]] = {}
    for row in rows:
        by_class.setdefault(row.duty_class, []).append(row)
        if 0.0 < row.window_s < step_s:
            found = f"class {row.duty_class} has a window of {row.window_s:g} s, the step is {step_s:g} s"
            remedy = "shorten clock.step_s, or leave the row out of the class"
            yield Problem("window_below_step", "duty_classes", found, f"at least {step_s:g} s, or 0 for the whole run", remedy)
    for name, own in by_class.items():
        ordered = sorted(own, key=lambda row: row.window_s or float("inf"))
        for shorter, longer in pairwise(ordered):
            if shorter.multiple < longer.multiple:
                found = (
                    f"class {name} permits {shorter.multiple:g} over {shorter.window_s:g} s and {longer.multiple:g} for longer"
                )
                remedy = "what a longer window permits never rules; correct the multiples"
                yield Problem("duty_row_without_effect", "duty_classes", found, "less for longer windows", remedy, "warning")


def _check_whole_steps(scenario: Scenario) -> Iterator[Problem]:
    """Yield windows of ratings that are no whole number of steps: they are held a part of a step too short."""
    step_s = scenario.clock.step_s
    uneven: dict[float, list[str]] = {}
    for window_s, owner in _used_windows(scenario):
        steps = steps_of(window_s, step_s)
        if steps and window_s - steps * step_s > 1e-6 * step_s:
            uneven.setdefault(window_s, []).append(owner)
    for window_s, owners in sorted(uneven.items()):
        steps = steps_of(window_s, step_s)
        found = (
            f"a window of {window_s:g} s ({', '.join(dict.fromkeys(owners))}) is no whole number of steps of {step_s:g} s:"
            f" it counts as {steps * step_s:g} s"
        )
        remedy = "choose a clock.step_s of which the window is a whole number"
        yield Problem("window_not_whole", "clock.step_s", found, "", remedy, "warning")


def _used_windows(scenario: Scenario) -> Iterator[tuple[float, str]]:
    """Yield the windows that ratings of the supply can have [s], and in words whose they are."""
    supply = scenario.supply
    for station in supply.substations:
        unit = find_unit(scenario.rectifier_units, station.unit) if station.unit is not None else None
        name = station.duty_class or (unit.duty_class if unit is not None else "")
        if unit is not None or station.rated_current_a is not None:
            rows = duty_of(scenario.duty_classes, name)
            windows = [(row.window_s, f"class {name}") for row in rows] or [(w, "no duty class") for w, _ in NO_OVERLOAD]
            yield from ((window_s, owner) for window_s, owner in windows if window_s > 0.0)
    given = {
        "window_contact_line_s": any(row.rated_current_a is not None or row.type or row.wires for row in supply.contact_lines),
        "window_cable_s": bool(supply.feeders)
        or any(
            getattr(station, name, None) is not None
            for station in (*supply.substations, *supply.section_cabins)
            for name in ("feeder_rated_current_a", "return_rated_current_a")
        ),
        "window_rails_s": any(row.rated_current_a is not None or row.rail is not None for row in supply.return_circuit),
    }
    for name, limit in common_limits(scenario.limits, supply.system, "window_").items():
        if given.get(name):
            yield limit.value, name


def _check_wires(scenario: Scenario) -> Iterator[Problem]:
    """Yield contact lines whose wires, in the weather of the limits table, are at their highest temperature without current."""
    weather = weather_of(scenario.limits, scenario.supply.system)
    for index, row in enumerate(scenario.supply.contact_lines):
        wires = _heated(row, scenario.conductors) if row.rated_current_a is None else ()
        if weather is None or not wires or ampacity(wires, weather).current_a > 0.0:
            continue
        hottest = min(wires, key=lambda wire: wire.steepest(weather))
        found = (
            f"at {weather.ambient_c:g} °C and {weather.sun_wpm2:g} W/m² of sun wire {hottest.conductor} is beyond its"
            f" {hottest.highest_c:g} °C without any current: the contact line may carry nothing"
        )
        remedy = "correct wire_ambient_c, wire_sun_wpm2 or wire_wind_mps of the limits table, or give rated_current_a"
        yield Problem("no_ampacity", f"supply.contact_lines[{index}]", found, "", remedy, "warning")


def _heated(row: ContactLine, table: Sequence[Conductor]) -> Sequence[HeatedWire]:
    """Return the wires of a contact line; none where not all is known of them, of which the checks of conductors tell."""
    try:
        found = heated_wires(row, table)
    except (KeyError, ValueError):
        return ()
    return () if isinstance(found, str) else found


def _check_contracts(supply: Supply) -> Iterator[Problem]:
    """Yield a contract that two substations of one supply point tell differently."""
    told: dict[str, Substation] = {}
    for station in supply.substations:
        if station.contract_power_kw is None:
            continue
        first = told.setdefault(station.supply_point or station.id, station)
        if first.contract_power_kw != station.contract_power_kw:
            found = (
                f"{station.contract_power_kw:g} kW for supply point {station.supply_point}, for which {first.id}"
                f" has {first.contract_power_kw:g} kW"
            )
            path = f"supply.substations[{station.id}].contract_power_kw"
            yield Problem("contract_twice", path, found, "one value for each supply point", "leave it out at all but one of them")


def _check_limits(scenario: Scenario) -> Iterator[Problem]:
    """Yield windows and weather of the limits table that cannot be used, and windows that are missing though needed."""
    limits, system, step_s = scenario.limits, scenario.supply.system, scenario.clock.step_s
    windows = common_limits(limits, system, "window_")
    for name in _WINDOWS:
        if name in windows and windows[name].value < step_s:
            found = f"{name} is {windows[name].value:g} s, the step is {step_s:g} s"
            yield Problem("window_below_step", "limits", found, f"at least {step_s:g} s", "correct the row of the limits table")
    missing = [name for name in _WINDOWS if name not in windows]
    if missing and _rated(scenario.supply):
        found = f"the limits lack {', '.join(missing)}: {counted(len(missing), 'kind')} of conductors cannot be rated"
        yield Problem("missing_limit", "limits", found, ", ".join(_WINDOWS), "add the rows to the limits table", "warning")
    found_limits = common_limits(limits, system, "wire_") | common_limits(limits, system, "grid_")
    for name, (low, high) in _RANGES.items():
        if name in found_limits and not low <= found_limits[name].value <= high:
            found = f"{name} is {found_limits[name].value:g}"
            yield Problem("bad_limit", "limits", found, f"{low:g} to {high:g}", "correct the row of the limits table")


def _rated(supply: Supply) -> bool:
    """Tell whether a conductor has a rated current of its own."""
    rows: tuple[object, ...] = (*supply.feeders, *supply.contact_lines, *supply.return_circuit)
    stations: tuple[object, ...] = (*supply.substations, *supply.section_cabins)
    names = ("feeder_rated_current_a", "return_rated_current_a")
    return any(getattr(row, "rated_current_a", None) is not None for row in rows) or any(
        getattr(station, name, None) is not None for station in stations for name in names
    )


def _unknown(code: str, path: str, word: str, name: str, known: Iterable[str], table: str, owner: str = "") -> Problem:
    """Return the problem of a name that the table of a scenario lacks; `known` are all names that there are."""
    names = sorted(known)
    found = f"there is no {word} {shown(name)}{owner} in the table of {table.replace('_', ' ')}"
    if name in names:
        return Problem(code, path, found, "", f"it ships with the program: put its rows into Scenario.{table}")
    remedy = f"choose one of them, or add it to a CSV file that `{table}:` of the study names"
    hint = did_you_mean(name, names)
    return Problem(code, path, found, ", ".join(names), f"{hint} {remedy}" if hint else remedy)
