"""Checks of identifiers and places: every device stands on tracks, contact lines or rails that exist."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TypeAlias

from tractionpower.alignment.axis import tracks_at
from tractionpower.alignment.checks import check_ids, check_place, check_rows, check_tracks
from tractionpower.alignment.intervals import name_km, name_tracks
from tractionpower.errors import Problem, Severity
from tractionpower.io.wording import did_you_mean
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.earthing import Earthing, VoltageLimitingDevice
from tractionpower.model.loads import Load
from tractionpower.model.supply import SectionCabin, SectionPoint, Substation, Supply
from tractionpower.supply.site import Place, Site

Device: TypeAlias = Substation | SectionCabin | SectionPoint | Load

_KINDS = {
    "substations": "substation",
    "section_cabins": "section cabin",
    "section_points": "section point",
    "loads": "load",
}
_WITH_IDS = (*_KINDS, "switches", "earthing", "voltage_limiting_devices")


def check_identifiers(supply: Supply) -> list[Problem]:
    """Return identifiers that are given twice within a list, or in two lists that share a table of results."""
    problems = []
    for name in _WITH_IDS:
        problems += check_ids(f"supply.{name}", [device.id for device in getattr(supply, name)])
    pairs = ("substations", "section_cabins", "section cabin"), ("earthing", "voltage_limiting_devices", "device")
    for one, other, kind in pairs:
        taken = {device.id for device in getattr(supply, one)}
        for name in sorted({device.id for device in getattr(supply, other)} & taken):
            found = f"{name!r} is {_a(one)} and {_a(other)} at once"
            problems.append(Problem("duplicate_id", f"supply.{other}[{name}]", found, remedy=f"give the {kind} its own id"))
    return problems


def _a(name: str) -> str:
    words = {"earthing": "an earthing", "voltage_limiting_devices": "a voltage-limiting device"}
    return words.get(name) or f"a {_KINDS[name]}"


def check_places(site: Site) -> list[Problem]:
    """Return devices and bonds on tracks or at kilometres that do not exist."""
    problems = []
    for path, tracks, km, field in _standing(site.supply):
        problems += check_tracks(f"{path}.{field}", tracks, site.axes)
        problems += check_place(f"{path}.km", km, tracks, site.axes)
    return problems + check_rows("supply.bonds", site.supply.bonds, site.axes)


def _standing(supply: Supply) -> Iterator[tuple[str, tuple[str, ...] | None, float, str]]:
    """Yield path, tracks, kilometre and the field of the tracks of all that stands at a place."""
    for name in _KINDS:
        for device in getattr(supply, name):
            yield f"supply.{name}[{device.id}]", _tracks(device), device.km, "track" if hasattr(device, "track") else "tracks"
    for switch in supply.switches:
        for field, end in (("from", switch.from_), ("to", switch.to)):
            if end.track is not None and end.km is not None:
                yield f"supply.switches[{switch.id}].{field}", (end.track,), end.km, "track"
    for index, row in enumerate(supply.feeders):
        if row.km is not None:
            yield f"supply.feeders[{index}]", (row.track,), row.km, "track"
    for name in ("earthing", "voltage_limiting_devices"):
        for item in getattr(supply, name):
            if item.track is not None and item.km is not None:
                yield f"supply.{name}[{item.id}]", (item.track,), item.km, "track"


def _tracks(device: Device) -> tuple[str, ...] | None:
    return (device.track,) if isinstance(device, SectionPoint | Load) else device.tracks


def check_connected(site: Site) -> list[Problem]:
    """Return devices where no contact line is: an error for a load, which would have no supply."""
    problems = []
    for name, kind in _KINDS.items():
        for device in getattr(site.supply, name):
            places = _places(site, device)
            if isinstance(device, Substation | SectionCabin):
                places = [*site.fed[device.id].values()]
            if not places or any(site.has_contact_line(place) for place in places):
                continue  # off the tracks altogether is told elsewhere
            tracks = tuple(track for track, _ in places)
            found = f"{kind} {device.id} reaches no contact line on {name_tracks(tracks)} at km {name_km(device.km)}"
            remedy = "correct the km or the tracks, or add a row to contact_lines"
            severity: Severity = "error" if isinstance(device, Load) else "warning"
            problems.append(Problem("no_contact_line", f"supply.{name}[{device.id}].km", found, "", remedy, severity))
    return problems


def _places(site: Site, device: Device) -> list[Place]:
    return [(track, site.axes[track].metre(device.km)) for track in tracks_at(site.axes, device.km, _tracks(device))]


def check_neighbours(site: Site) -> list[Problem]:
    """Return devices of one kind that stand so close that they share a node; loads may, it changes nothing for them."""
    problems = []
    for name in ("substations", "section_cabins", "section_points"):
        standing: dict[str, list[tuple[float, str]]] = {}
        for device in getattr(site.supply, name):
            for track, metre in _places(site, device):
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


def check_rails_there(site: Site) -> list[Problem]:
    """Return earthings and voltage-limiting devices that stand where no rails are, or at a substation that is unknown."""
    problems = []
    items: Sequence[Earthing | VoltageLimitingDevice] = (*site.supply.earthing, *site.supply.voltage_limiting_devices)
    for item in items:
        path = f"supply.{'earthing' if isinstance(item, Earthing) else 'voltage_limiting_devices'}[{item.id}]"
        place = site.place(item.track, item.km)
        if place is not None and not site.rail_rows(place):
            found = f"{item.id} stands on track {place[0]} at km {name_km(item.km or 0.0)}, where no return circuit is"
            remedy = "correct the km or the track, or add a row to return_circuit"
            problems.append(Problem("no_return_circuit", f"{path}.km", found, "", remedy))
        if isinstance(item, Earthing) and item.substation is not None:
            problems += unknown_station(f"{path}.substation", item.substation, [one.id for one in site.supply.substations])
    return problems


def unknown_station(path: str, name: str, known: Sequence[str], kinds: str = "substation") -> list[Problem]:
    """Return a problem if no station of the kinds told has this name."""
    if name in known:
        return []
    shown = ", ".join(sorted(known)[:12]) + (f", ... ({len(known)} in all)" if len(known) > 12 else "")
    remedy = did_you_mean(name, known) or "correct the name, or describe the station"
    return [Problem("unknown_station", path, f"there is no {kinds} {name!r}", shown or f"there is no {kinds} at all", remedy)]
