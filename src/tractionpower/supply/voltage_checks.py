"""Checks of values: resistances, voltages against the limits of the system, settings of trips."""

from __future__ import annotations

from tractionpower.errors import Problem
from tractionpower.model.limits import VOLTAGE_NAMES, Limit, find_limit, known_systems
from tractionpower.model.supply import SectionCabin, Substation, Supply
from tractionpower.model.switchgear import Feeder, Protection
from tractionpower.supply.reach import station_path


def check_resistances(supply: Supply) -> list[Problem]:
    """Return substations with more heat than resistance."""
    problems = []
    for station in supply.substations:
        by_unit = station.unit_resistance_ohm is not None
        whole = station.unit_resistance_ohm if by_unit else station.internal_resistance_ohm
        heat, words = station.dissipative_resistance_ohm, "unit resistance" if by_unit else "internal resistance"
        if whole is not None and heat is not None and heat > whole:
            path = f"supply.substations[{station.id}].dissipative_resistance_ohm"
            found = f"{heat:g} ohm of heat in {whole:g} ohm {words}"
            remedy = "the part cannot be above the whole"
            problems.append(Problem("dissipative_above_internal", path, found, f"0 to {whole:g} ohm", remedy))
    return problems


def check_units(supply: Supply) -> list[Problem]:
    """Return a warning for each number of units that changes nothing.

    The resistance is that of the whole plant with all of them. Where that of the grid is given too, the units are part of a
    description that is complete, whether or not one of them is ever out; so they are where their rated current is.
    """
    switched = {event.device for event in supply.switch_events if event.units_in_service is not None}
    problems = []
    for station in supply.substations:
        is_rated = station.unit is not None or station.rated_current_a is not None
        is_described = station.unit_resistance_ohm is not None or station.grid_resistance_ohm > 0.0 or is_rated
        is_used = is_described or station.units_in_service is not None or station.id in switched
        if station.units > 1 and not is_used:
            found = f"{station.units} units change nothing: internal_resistance_ohm is that of all of them together"
            remedy = "another number of units needs another internal_resistance_ohm; units_in_service says how many of them feed"
            path = f"supply.substations[{station.id}].units"
            problems.append(Problem("units_without_effect", path, found, "", remedy, "warning"))
    return problems


def check_voltages(supply: Supply, limits: tuple[Limit, ...]) -> list[Problem]:
    """Return voltages that the limits of the system do not allow, and limits that are missing."""
    system = supply.system
    known = known_systems(limits)
    if system not in known:
        remedy = "choose one of them, or give the limits of the system in a file of your own"
        allowed = ", ".join(known) or "none, the limits table is empty"
        return [Problem("unknown_system", "supply.system", f"no limits are known for system {system!r}", allowed, remedy)]
    problems = []
    missing = [name for name in VOLTAGE_NAMES if find_limit(limits, system, name) is None]
    if missing:
        found = f"the limits of system {system} lack {', '.join(missing)}"
        problems.append(Problem("missing_limit", "limits", found, ", ".join(VOLTAGE_NAMES), "add the rows to the limits table"))
    highest = find_limit(limits, system, "u_max2")
    return problems + (_check_highest(supply, highest.value) if highest else [])


def _check_highest(supply: Supply, u_max2: float) -> list[Problem]:
    """Return voltages above U_max2 [V]; between U_max1 and U_max2 they are in order."""
    allowed = f"up to U_max2 = {u_max2:g} V of {supply.system}"
    problems = []
    for station in supply.substations:
        voltage = station.no_load_voltage_v * station.grid_voltage_pu
        if voltage > u_max2:
            path = f"supply.substations[{station.id}].no_load_voltage_v"
            grid = f" at a grid voltage of {station.grid_voltage_pu:g} p.u." if station.grid_voltage_pu != 1.0 else ""
            remedy = "the limit is broken without any load; correct the voltage or the system"
            problems.append(
                Problem("no_load_above_u_max2", path, f"{voltage:g} V without load{grid}", allowed, remedy, "warning")
            )
    for load in supply.loads:
        if load.fold_back_from_v is not None and load.fold_back_from_v > u_max2:
            path = f"supply.loads[{load.id}].fold_back_from_v"
            remedy = "feeding back ends at U_max2; U_max2 itself makes a hard ceiling"
            problems.append(
                Problem("fold_back_above_u_max2", path, f"fold-back begins at {load.fold_back_from_v:g} V", allowed, remedy)
            )
    return problems


def check_trips(supply: Supply) -> list[Problem]:
    """Return settings of trips and reclosures that have no effect; return feeders have no breaker and are told elsewhere."""
    stations: tuple[Substation | SectionCabin, ...] = (*supply.substations, *supply.section_cabins)
    problems = [problem for station in stations for problem in _check_trip(station_path(station), station)]
    for index, row in enumerate(supply.feeders):
        if row.side != "return":
            problems += _check_trip(f"supply.feeders[{index}]", row)
    return problems


def _check_trip(path: str, item: Protection) -> list[Problem]:
    given = [name for name in ("trip_delay_s", "reclose_after_s", "reclosures", "reclaim_s") if _is_set(item, name)]
    if item.trip_current_a is None and given:
        what = "those of its station hold" if isinstance(item, Feeder) else "the breaker never trips"
        found, remedy = f"{', '.join(given)} without trip_current_a: {what}", "give trip_current_a, or leave them out"
        return [Problem("trip_without_current", path, found, "", remedy, "warning")]
    given = [name for name in given if name.startswith("recl") and name != "reclose_after_s"]
    if item.trip_current_a is not None and item.reclose_after_s is None and given:
        found = f"{', '.join(given)} without reclose_after_s: the breaker stays open once it has tripped"
        remedy = "give reclose_after_s, or leave them out"
        return [Problem("reclosure_without_time", path, found, "", remedy, "warning")]
    return []


def _is_set(item: Protection, name: str) -> bool:
    return bool(getattr(item, name) != type(item).model_fields[name].default)
