"""The files of a study made from a feed: line, timetable, supply to be filled in, study, README."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tractionpower.io.imports.gtfs.network import Network
from tractionpower.io.imports.gtfs.options import GtfsOptions
from tractionpower.io.imports.gtfs.tracks import Tracks
from tractionpower.io.imports.imported import Notes
from tractionpower.io.yaml_text import document, entry
from tractionpower.model.base import format_time

# Assumed supply: units PD-16 behind 110 kV, as the line wkd has them.
_SUBSTATION = {
    "no_load_voltage_v": 3476.7, "unit": "PD-16", "units": 2, "unit_resistance_ohm": 0.08396, "grid_resistance_ohm": 0.01322,
    "feeder_resistance_ohm": 0.0105,
}  # fmt: skip
_SPACING_KM = 10.0
_SHORT_BRANCH_KM = 6.0
_CONTACT_LINE = "C95-2C"
_RAIL = "49E1"
_ROUND_S = 600.0


def study_text(name: str, first_s: float, last_s: float, tolerance_s: float = 0.0) -> str:
    """Return study.yaml; the clock runs from before the first to after the last train, `tolerance_s` is for its delays."""
    start = max(math.floor((first_s - _ROUND_S) / _ROUND_S) * _ROUND_S, 0.0)
    end = math.ceil((last_s + 3.0 * _ROUND_S) / _ROUND_S) * _ROUND_S
    data: dict[str, Any] = {
        "format": 1,
        "name": name,
        "line": "line.yaml",
        "supply": "supply.yaml",
        "timetable": "timetable.yaml",
    }
    clock = {"start": format_time(start), "end": format_time(end), "step_s": 1.0}
    judged = {"feasibility": {"tolerance_s": tolerance_s}} if tolerance_s else {}
    return "# Made from a GTFS feed: README.md says what was read and what is assumed.\n" + document(
        data | {"clock": clock} | judged
    )


def line_text(name: str, tracks: Tracks, names: dict[str, str], ids: dict[str, str], options: GtfsOptions) -> str:
    """Return line.yaml."""
    network = tracks.network
    several = len(network.axes) > 1 or bool(tracks.seconds)
    stations = []
    for station, place in sorted(network.stations.items(), key=lambda item: (item[1], item[0])):
        row: dict[str, Any] = {"id": ids[station], "name": names.get(station, ""), "km": place.km}
        stations.append(row | ({"tracks": tracks.at(place)} if several else {}))
    limits = [
        {"from_km": low, "to_km": high, "kmh": options.speed_kmh} | ({"tracks": on} if several else {})
        for k in range(len(network.axes))
        for low, high, on in tracks.stretches(k)
    ]
    data: dict[str, Any] = {"format": 1, "name": name, "source": "Made from a GTFS feed; see README.md.", "tracks": tracks.rows()}
    data |= {"stations": stations, "speed_limits": limits}
    if tracks.connections:
        data["connections"] = [
            {"from": {"track": a[0], "km": a[1]}, "to": {"track": b[0], "km": b[1]}} for a, b in sorted(tracks.connections)
        ]
    head = (
        "# Stations by their places on the shapes of the feed. Speed limits are assumed; no gradients and curves are known,\n"
        "# so it is level and straight.\n"
    )
    return head + document(data)


def supply_text(tracks: Tracks) -> str:
    """Return supply.yaml: an assumed supply, to be replaced."""
    substations: list[dict[str, Any]] = []
    contact: list[dict[str, Any]] = []
    returns: list[dict[str, Any]] = []
    for k in range(len(tracks.network.axes)):
        stretches = list(tracks.stretches(k))
        for km in _substations(tracks.network, k):
            on = next(names for low, high, names in stretches if low <= km <= high)
            substations.append({"id": f"S{len(substations) + 1}", "km": km, "tracks": on, **_SUBSTATION})
        for low, high, on in stretches:
            contact.append({"tracks": on, "from_km": low, "to_km": high, "type": _CONTACT_LINE})
            returns.append({"tracks": on, "from_km": low, "to_km": high, "rail": _RAIL})
    head = (
        "# ALL OF IT IS ASSUMED, the feed says nothing about the supply: substations at equal distances of at most\n"
        f"# {_SPACING_KM:g} km, two units each, contact line {_CONTACT_LINE}, rails {_RAIL}. Put in your own.\n"
    )
    data: dict[str, Any] = {"format": 1, "system": "dc3000"}
    return head + document(data | {"substations": substations, "contact_lines": contact, "return_circuit": returns})


def _substations(network: Network, k: int) -> list[float]:
    axis = network.axes[k]
    length = axis.to_km - axis.from_km
    if axis.tree != k and length < _SHORT_BRANCH_KM:
        return []  # fed through its junction
    count = max(math.ceil(length / _SPACING_KM), 1)
    return [round(axis.from_km + (j + 0.5) * length / count, 3) for j in range(count)]


def timetable_text(parts: dict[str, list[dict[str, Any]]]) -> str:
    """Return timetable.yaml from its lists of trains, services and rotations."""
    head = (
        "# The trips of the feed, by their trip_id. A call without arrival has one time in the feed, which is taken as its\n"
        "# departure.\n"
    )
    return head + "format: 1\n" + "".join(f"{entry(key, rows)}\n" for key, rows in parts.items() if rows)


def readme_text(name: str, notes: Notes) -> str:
    """Return README.md: what was read, assumed, repaired and left out."""
    blocks = [f"# {name}\n\nMade by the import of a GTFS feed. The licence of the feed holds for what was taken from it.\n"]
    warnings = [str(problem) for problem in notes.problems if problem.severity == "warning"]
    for title, rows in _chapters(notes, warnings):
        if rows:
            blocks.append(f"## {title}\n\n" + "".join(f"- {row}\n" for row in rows))
    return "\n".join(blocks)


def _chapters(notes: Notes, warnings: Sequence[str]) -> list[tuple[str, Sequence[str]]]:
    told = [("Read", notes.read), ("Assumed", notes.assumed), ("Repaired", notes.repaired), ("Left out", notes.ignored)]
    return [*told, ("Doubtful", warnings)]
