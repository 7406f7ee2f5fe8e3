"""Files of a study made by an importer: their texts, and what no source says, its supply and its clock."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from tractionpower.errors import Problem
from tractionpower.io.file_names import file_names
from tractionpower.io.imports.imported import Notes
from tractionpower.io.stock_finder import FOLDER
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT, format_time
from tractionpower.model.line import Line
from tractionpower.model.vehicle import Train, Vehicle

NO_LOAD_V = 3600.0
SOURCE_OHM = 0.12
CONTACT_OHM_PER_KM = 0.05
RETURN_OHM_PER_KM = 0.02
LARGEST_GAP_KM = 15.0
START_S = 8 * 3600.0
LONGEST_KM = 5000.0
"""A longer track is a slip of units."""


def text_of(model: BaseModel) -> str:
    """Return a declaration as a file; keys that have their default are left out."""
    return document({"format": FORMAT, **model.model_dump(mode="json", by_alias=True, exclude_defaults=True)})


def readme_text(name: str, source: str, notes: Notes) -> str:
    """Return a README that says what was read, assumed, repaired and ignored."""
    parts = {"Read": notes.read, "Assumed": notes.assumed, "Repaired": notes.repaired, "Ignored": notes.ignored}
    told = (f"## {title}\n\n" + "".join(f"- {note}\n" for note in told) for title, told in parts.items() if told)
    return "\n".join([f"# {name}\n\nImported from `{source}`.\n", *told])


def stock_texts(vehicles: Iterable[Vehicle], trains: Iterable[Train]) -> dict[str, str]:
    """Return the files of rolling stock by name."""
    texts: dict[str, str] = {}
    for kind, items in (("vehicles", list(vehicles)), ("trains", list(trains))):
        names = file_names(item.id for item in items)
        texts |= {f"{FOLDER}/{kind}/{names[item.id]}": text_of(item) for item in items}
    return texts


def study_text(name: str, end_s: float, notes: Notes) -> str:
    """Return ``study.yaml`` of a study whose trains start at 08:00 and are done by `end_s` [s after midnight]."""
    clock = {"start": format_time(START_S), "end": format_time(end_s), "step_s": 1.0}
    notes.assumed.append(f"the clock runs from {format_time(START_S)} to {format_time(end_s)} in steps of 1 s")
    parts = {part: f"{part}.yaml" for part in ("line", "supply", "timetable")}
    return document({"format": FORMAT, "name": name, **parts, "clock": clock})


def supply_text(line: Line, notes: Notes) -> str:
    """Return an assumed supply: substations at both ends of every track and no more than 15 km apart.

    Tracks with the same ends share their substations; rails of each track are a conductor of their own. No and internal
    resistance of the source and contact line are those of Krzysztozek 2019, figure 3, with 0.02 ohm/km for one track's rails.
    """
    groups: dict[tuple[float, float], list[str]] = {}
    for track in line.tracks:
        groups.setdefault((track.from_km, track.to_km), []).append(track.id)
    substations: list[dict[str, Any]] = []
    contact, rails = [], []
    for (low, high), tracks in groups.items():
        parts = max(1, math.ceil((high - low) / LARGEST_GAP_KM))
        for k in range(parts + 1):
            km = round(low + (high - low) * k / parts, 6)
            row = {"id": f"Substation {len(substations) + 1}", "km": km, "no_load_voltage_v": NO_LOAD_V}
            row["internal_resistance_ohm"] = SOURCE_OHM
            substations.append(row if len(groups) == 1 else {**row, "tracks": tracks})
        contact.append(_conductor(tracks, low, high, CONTACT_OHM_PER_KM))
        rails += [_conductor([track], low, high, RETURN_OHM_PER_KM) for track in tracks]
    notes.assumed += [
        f"supply of 3 kV DC: {len(substations)} substations of {NO_LOAD_V:g} V and {SOURCE_OHM:g} ohm,"
        f" no more than {LARGEST_GAP_KM:g} km apart, at both ends of the line as well",
        f"contact line {CONTACT_OHM_PER_KM:g} ohm/km for each track, rails {RETURN_OHM_PER_KM:g} ohm/km for each track",
    ]
    data: dict[str, Any] = {"format": FORMAT, "system": "dc3000", "substations": substations}
    return "# Assumed as a whole: the source has no supply.\n" + document(
        {**data, "contact_lines": contact, "return_circuit": rails}
    )


def _conductor(tracks: Sequence[str], low: float, high: float, ohm_per_km: float) -> dict[str, Any]:
    return {"tracks": list(tracks), "from_km": low, "to_km": high, "resistance_ohm_per_km": ohm_per_km}


def too_long(line: Line, notes: Notes, place: str) -> bool:
    """Return whether a track is absurdly long, and tell it."""
    tracks = [track for track in line.tracks if track.to_km - track.from_km > LONGEST_KM]
    for track in tracks:
        found, allowed = f"{track.to_km - track.from_km:.6g} km", f"at most {LONGEST_KM:g} km"
        problem = Problem("absurd_length", f"track {track.id}", found, allowed, "check positions and their unit", place=place)
        notes.problems.append(problem)
    return bool(tracks)


def longest_s(limits: Iterable[Mapping[str, float]], speed_kmh: float, stops: int) -> float:
    """Return a time that a run needs at most [s]: half as long again as at the speed limits, 90 s per stop, to 10 min."""
    pieces = ((row["to_km"] - row["from_km"]) / min(row["kmh"], speed_kmh) for row in limits)
    return 600.0 * math.ceil((1.5 * 3600.0 * sum(pieces) + 90.0 * stops + 600.0) / 600.0)
