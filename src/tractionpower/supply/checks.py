"""Checks of the supply system against the line and the limits of its system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from tractionpower.alignment.axis import TrackAxis, compile_axes, tracks_at
from tractionpower.alignment.checks import check_ids, check_overlaps, check_place, check_rows, check_tracks
from tractionpower.alignment.intervals import (
    TOLERANCE_M,
    Coverage,
    find_gaps,
    group,
    name_km,
    name_tracks,
    patch,
    place_rows,
    subtract,
)
from tractionpower.errors import Problem, Severity
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.limits import VOLTAGE_NAMES, Limit, find_limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Load, SectionCabin, SectionPoint, Substation, Supply
from tractionpower.supply.reach import find_stretches, places

Device: TypeAlias = Substation | SectionCabin | SectionPoint | Load

_KINDS = {
    "substations": "substation",
    "section_cabins": "section cabin",
    "section_points": "section point",
    "loads": "load",
}


@dataclass(frozen=True, slots=True)
class _Site:
    """A supply and where it lies: what the checks share."""

    supply: Supply
    axes: Mapping[str, TrackAxis]
    contact: Coverage
    returns: Coverage

    def has_contact_line(self, track: str, km: float) -> bool:
        metre = self.axes[track].metre(km)
        return any(part.start_m - TOLERANCE_M <= metre <= part.end_m + TOLERANCE_M for part in self.contact[track])


def check_supply(supply: Supply, line: Line, limits: tuple[Limit, ...]) -> list[Problem]:
    """Return everything that is wrong or doubtful with a supply system.

    Parameters
    ----------
    supply
        The supply system.
    line
        The line along which it stands; its own faults are told by `alignment.checks.check_line`.
    limits
        The limits table, with the voltages of `supply.system`.
    """
    axes = compile_axes(line)
    contact = place_rows(enumerate(supply.contact_lines), axes)
    returns = place_rows(enumerate(supply.return_circuit), axes)
    site = _Site(supply, axes, contact, returns)
    problems = _check_ids(supply) + _check_places(site)
    for name in ("contact_lines", "return_circuit"):
        rows = getattr(supply, name)
        problems += check_rows(f"supply.{name}", rows, axes) + check_overlaps(f"supply.{name}", rows, axes)
    for check in (_check_gaps, _check_returns, _check_connected, _check_neighbours, _check_reach):
        problems += check(site)
    return problems + _check_resistances(supply) + _check_voltages(supply, limits)


# --- identifiers and places --------------------------------------------------------------------------------------


def _check_ids(supply: Supply) -> list[Problem]:
    problems = []
    for name in _KINDS:
        problems += check_ids(f"supply.{name}", [device.id for device in getattr(supply, name)])
    stations = {station.id for station in supply.substations}
    for cabin in sorted({cabin.id for cabin in supply.section_cabins} & stations):
        found = f"{cabin!r} is a substation and a section cabin at once"
        problems.append(Problem("duplicate_id", f"supply.section_cabins[{cabin}]", found, remedy="give each its own id"))
    return problems


def _check_places(site: _Site) -> list[Problem]:
    problems = []
    for name in _KINDS:
        for device in getattr(site.supply, name):
            path = f"supply.{name}[{device.id}]"
            tracks = _tracks(device)
            field = "track" if hasattr(device, "track") else "tracks"
            problems += check_tracks(f"{path}.{field}", tracks, site.axes)
            problems += check_place(f"{path}.km", device.km, tracks, site.axes)
    return problems


def _tracks(device: Device) -> tuple[str, ...] | None:
    return (device.track,) if isinstance(device, SectionPoint | Load) else device.tracks


# --- contact lines and return circuit ----------------------------------------------------------------------------


def _check_gaps(site: _Site) -> list[Problem]:
    """Return a warning for each gap on a track that has a contact line elsewhere; a track may have none at all."""
    wired = {track: parts for track, parts in site.contact.items() if parts}
    remedy = "a train or load there has no supply; add a row if the line is wired there"
    return [
        Problem("gap", "supply.contact_lines", f"no contact line on {gap}", remedy=remedy, severity="warning")
        for gap in find_gaps(wired, site.axes)
    ]


def _check_returns(site: _Site) -> list[Problem]:
    bare = []
    for track, parts in site.contact.items():
        rails = [(part.start_m, part.end_m) for part in site.returns[track]]
        for part in parts:
            bare += [patch(site.axes[track], gap, (part.row,)) for gap in subtract([(part.start_m, part.end_m)], rails)]
    remedy = "add a row to return_circuit; zero resistance is allowed"
    return [
        Problem(
            "no_return_circuit",
            f"supply.contact_lines[{item.rows[0]}]",
            f"the contact line has no return circuit on {item}",
            remedy=remedy,
        )
        for item in group(bare)
    ]


def _check_connected(site: _Site) -> list[Problem]:
    """Return devices that stand where no contact line is: an error for a load, which would have no supply."""
    problems = []
    for name, kind in _KINDS.items():
        for device in getattr(site.supply, name):
            tracks = tracks_at(site.axes, device.km, _tracks(device))
            if not tracks or any(site.has_contact_line(track, device.km) for track in tracks):
                continue  # off the tracks altogether is told elsewhere
            found = f"{kind} {device.id} reaches no contact line on {name_tracks(tracks)} at km {name_km(device.km)}"
            remedy = "correct the km or the tracks, or add a row to contact_lines"
            severity: Severity = "error" if isinstance(device, Load) else "warning"
            problems.append(Problem("no_contact_line", f"supply.{name}[{device.id}].km", found, "", remedy, severity))
    return problems


# --- devices among each other ------------------------------------------------------------------------------------


def _check_neighbours(site: _Site) -> list[Problem]:
    """Return devices of one kind that stand so close that they share a node; loads may, it changes nothing for them."""
    problems = []
    for name in ("substations", "section_cabins", "section_points"):
        standing: dict[str, list[tuple[float, str]]] = {}
        for device in getattr(site.supply, name):
            for track, metre in places(device, site.axes):
                standing.setdefault(track, []).append((metre, device.id))
        close: dict[tuple[str, str], list[str]] = {}
        for track, devices in sorted(standing.items()):
            for (metre, device), (next_metre, neighbour) in pairwise(sorted(devices)):
                if next_metre - metre < SHARED_NODE_M and device != neighbour:
                    close.setdefault((device, neighbour), []).append(track)
        for (device, neighbour), tracks in close.items():
            found = f"{_KINDS[name]}s {device} and {neighbour} stand less than {SHARED_NODE_M:g} m apart on {name_tracks(tracks)}"
            remedy = "they share a node; set them apart if they are two, or describe them as one"
            problems.append(Problem("shared_node", f"supply.{name}[{neighbour}].km", found, "", remedy, "warning"))
    return problems


def _check_reach(site: _Site) -> list[Problem]:
    """Return what no substation in service can feed: the whole supply, or stretches of it and the loads there."""
    supply = site.supply
    if not any(station.state == "in_service" for station in supply.substations):
        if not supply.substations and not supply.loads:
            return []
        remedy = "put a substation into service; without one nothing is fed"
        return [Problem("no_source", "supply.substations", "no substation is in service", "", remedy, "warning")]
    stretches = find_stretches(supply, site.axes, site.contact)
    remedy = "close a section cabin or section point, or put a substation into service"
    dead = [
        patch(site.axes[item.track], (item.start_m, item.end_m), (_row_at(site, item.track, item.start_m),))
        for item in stretches
        if not item.live
    ]
    problems = [
        Problem(
            "dead_stretch",
            f"supply.contact_lines[{item.rows[0]}]",
            f"no substation in service reaches {item}",
            remedy=remedy,
            severity="warning",
        )
        for item in group(dead)
    ]
    for load in supply.loads:
        place = [(track, site.axes[track].metre(load.km)) for track in tracks_at(site.axes, load.km, (load.track,))]
        around = [item for item in stretches for at in place if item.touches(at)]
        if around and not any(item.live for item in around):
            found = f"load {load.id} on track {load.track}, km {name_km(load.km)}, is reached by no substation in service"
            problems.append(Problem("dead_load", f"supply.loads[{load.id}].km", found, "", remedy, "warning"))
    return problems


def _row_at(site: _Site, track: str, metre: float) -> int:
    """Return the row of the contact line that begins at or covers a place where there is one."""
    return next(part.row for part in site.contact[track] if part.end_m > metre + TOLERANCE_M)


# --- values ------------------------------------------------------------------------------------------------------


def _check_resistances(supply: Supply) -> list[Problem]:
    return [
        Problem(
            "dissipative_above_internal",
            f"supply.substations[{station.id}].dissipative_resistance_ohm",
            f"{station.dissipative_resistance_ohm:g} ohm of heat in {station.internal_resistance_ohm:g} ohm internal resistance",
            f"0 to {station.internal_resistance_ohm:g} ohm",
            "the part cannot be above the whole",
        )
        for station in supply.substations
        if (station.dissipative_resistance_ohm or 0.0) > station.internal_resistance_ohm
    ]


def _check_voltages(supply: Supply, limits: tuple[Limit, ...]) -> list[Problem]:
    system = supply.system
    known = sorted({limit.system for limit in limits})
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
