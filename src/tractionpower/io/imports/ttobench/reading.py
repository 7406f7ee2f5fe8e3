"""Import of TTOBench: a track, a train or a journey becomes a study, or the rolling stock of one.

Source of the format: D. Kouzoupis and others, TTOBench, github.com/nuorail/ttobench, version 1.5 (BSD 2-Clause).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from tractionpower.errors import InputError, Problem
from tractionpower.io.imports import foreign as f
from tractionpower.io.imports.imported import Imported, Notes
from tractionpower.io.imports.study_texts import (
    START_S,
    longest_s,
    readme_text,
    stock_texts,
    study_text,
    supply_text,
    text_of,
    too_long,
)
from tractionpower.io.imports.ttobench.files import JourneyFile, TrackFile, TrainFile
from tractionpower.io.imports.ttobench.tracks import TRACK, calls_at_stops, calls_of_journey, line_of
from tractionpower.io.imports.ttobench.trains import train_of, vehicle_of
from tractionpower.io.text_files import Source
from tractionpower.io.yaml_files import read_yaml
from tractionpower.model.line import Line
from tractionpower.model.timetable import Timetable

SHIPPED_TRAIN = "vectron-9-coaches"
_KINDS = {"timing points": "journey", "stops": "track", "mass": "train"}


def read_ttobench(source: Path, *, repair: bool = False, train: Path | None = None, track: Path | None = None) -> Imported:
    """Return the study that a file of TTOBench makes; of a train its rolling stock alone.

    Parameters
    ----------
    source
        A track, a train or a journey.
    repair
        Whether rows that are out of order or leave a gap at the start are mended, which is told.
    train
        File of the train; left out: the first of the folder ``trains`` beside that of the source, or one that ships.
    track
        File of a journey's track; left out: the one that it names, in the folder ``tracks`` beside its own.
    """
    notes = Notes()
    kind = _kind_of(source, notes)
    texts: dict[str, str] = {}
    if kind == "train":
        texts = _stock(source, notes)
    elif kind == "journey":
        journey = f.read_foreign(source, JourneyFile, notes)
        if journey is not None:
            found = track or _beside(source, "tracks", f"{journey.metadata.track}.json", notes)
            if found is not None:
                texts = _study(found, train, journey, source, notes, repair=repair)
    elif kind == "track":
        texts = _study(source, train, None, source, notes, repair=repair)
    is_good = not any(problem.severity == "error" for problem in notes.problems)
    return Imported(texts if is_good else {}, notes)


def _kind_of(source: Path, notes: Notes) -> str:
    if not f.find_file(source, (".json",), notes):
        return ""
    try:
        keys = read_yaml(Source(source, source.name, "")).data
    except InputError as error:
        notes.problems += error.problems
        return ""
    kind = next((kind for key, kind in _KINDS.items() if key in keys), "")
    if not kind:
        allowed = "; ".join(f"{kind}: {key}" for key, kind in _KINDS.items())
        remedy = "name a file of TTOBench"
        problem = Problem("unknown_kind", "", f"keys {', '.join(list(keys)[:8])}", allowed, remedy, place=source.name)
        notes.problems.append(problem)
    return kind


def _beside(source: Path, folder: str, name: str, notes: Notes) -> Path | None:
    path = source.parent.parent / folder / name
    if path.is_file():
        return path
    found = f"no file {folder}/{name} beside the folder of the journey"
    notes.problems.append(Problem("no_file", "metadata.associated track", found, "", "name the track's file", place=source.name))
    return None


def _train_file(source: Path, train: Path | None, notes: Notes) -> tuple[Path | None, TrainFile | None]:
    files = sorted((source.parent.parent / "trains").glob("*.json"))
    if train is None and not files:
        notes.assumed.append(f"the train {SHIPPED_TRAIN}, which ships: the source names none")
        return None, None
    path = train or files[0]
    if train is None:
        others = f" of {', '.join(file.stem for file in files)}" if len(files) > 1 else ""
        notes.assumed.append(f"the train {path.stem}, the first{others}: the source names none")
    return path, _read(path, TrainFile, notes) if f.find_file(path, (".json",), notes) else None


def _read(path: Path, model: type[f.Model], notes: Notes) -> f.Model | None:
    file = f.read_foreign(path, model, notes)
    if file is not None:
        ignored = [key for key in f.unknown_keys(file) if not key.startswith("metadata.")]
        notes.ignored += [f"{path.name}: {key}" for key in ignored]
    return file


def _stock(source: Path, notes: Notes) -> dict[str, str]:
    file = _read(source, TrainFile, notes)
    vehicle = vehicle_of(file, notes, source.name) if file is not None else None
    return stock_texts([vehicle], [train_of(file)]) if file is not None and vehicle is not None else {}


def _study(
    track: Path, train: Path | None, journey: JourneyFile | None, source: Path, notes: Notes, *, repair: bool
) -> dict[str, str]:
    path, stock = _train_file(source, train, notes)
    file = _read(track, TrackFile, notes) if f.find_file(track, (".json",), notes) else None
    data = line_of(file, stock, notes, repair=repair, place=track.name) if file is not None else None
    vehicle = vehicle_of(stock, notes, path.name) if stock is not None and path is not None else None
    if file is None or data is None or (path is not None and vehicle is None):
        return {}
    calls = calls_of_journey(journey, data, notes, source.name) if journey is not None else None
    line = f.built(Line, data, notes, track.name)
    if line is None or too_long(line, notes, track.name):
        return {}
    calls = calls or calls_at_stops(line, notes)
    name = stock.metadata.id if stock is not None else SHIPPED_TRAIN
    run = {"id": (journey.metadata.id if journey is not None else name), "train": name, "calls": calls, **_route(line, calls)}
    timetable = f.built(Timetable, {"trains": [run]}, notes, source.name)
    if timetable is None:
        return {}
    latest = max([START_S, *(call.arrival or call.departure or 0.0 for call in timetable.trains[0].calls)])
    speed = vehicle.max_speed_kmh if vehicle is not None else 160.0
    end_s = 600.0 * math.ceil((latest + longest_s([row.model_dump() for row in line.speed_limits], speed, len(calls))) / 600.0)
    texts = {"line.yaml": text_of(line), "supply.yaml": supply_text(line, notes), "timetable.yaml": text_of(timetable)}
    texts |= stock_texts([vehicle], [train_of(stock)]) if vehicle is not None and stock is not None else {}
    texts["study.yaml"] = study_text(line.name, end_s, notes)
    return {"README.md": readme_text(line.name, source.name, notes), **texts}


def _route(line: Line, calls: list[dict[str, Any]]) -> dict[str, Any]:
    places = {station.id: station.km for station in line.stations}
    ends = {"from_km": places[calls[0]["station"]], "to_km": places[calls[-1]["station"]]}
    return {"route": [{"track": TRACK, **ends}]}
