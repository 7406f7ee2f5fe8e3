"""Import of railtoolkit's files and TrainRuns' folders: every path becomes a track, every train runs on each of them.

Without a path the rolling stock alone is given. Formats: `files`; formulas of TrainRuns.jl: `stock`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from tractionpower.errors import InputError, Problem
from tractionpower.io.imports import foreign as f
from tractionpower.io.imports.imported import Imported, Notes
from tractionpower.io.imports.railtoolkit.files import PATHS, STOCK, PathFile, RunningPath, SettingsFile, StockFile
from tractionpower.io.imports.railtoolkit.stock import length_m, trains_of, vehicles_of
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
from tractionpower.io.text_files import Source
from tractionpower.io.wording import printable
from tractionpower.io.yaml_files import read_yaml
from tractionpower.model.base import format_time
from tractionpower.model.line import Line
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle

SHIPPED_TRAIN = "vectron-9-coaches"
SUFFIXES = (".yaml", ".yml", ".json")


@dataclass(slots=True)
class _Found:
    # What the files of a source hold.
    stock: list[tuple[str, StockFile]] = field(default_factory=list)
    paths: list[tuple[str, RunningPath]] = field(default_factory=list)
    is_point: bool = True


def read_railtoolkit(source: Path, *, repair: bool = False, train: Path | None = None) -> Imported:
    """Return the study that rolling stock and running paths make; of rolling stock alone its files.

    Parameters
    ----------
    source
        A file, or a folder whose files are all read.
    repair
        Whether sections that are out of order are put in order, which is told.
    train
        A file of rolling stock to read with it.
    """
    notes, found = Notes(), _Found()
    files = sorted(path for path in source.rglob("*") if path.suffix in SUFFIXES) if source.is_dir() else [source]
    if not files or not source.exists():
        what = "no file of YAML in the folder" if source.is_dir() else "no such file"
        notes.problems.append(Problem("no_file", "", what, "", "name a file or a folder", place=printable(str(source))))
        return Imported({}, notes)
    if train is not None and f.find_file(train, SUFFIXES, notes):
        _add(train, train.name, found, notes)
    for path in files:
        _add(path, path.relative_to(source).as_posix() if source.is_dir() else path.name, found, notes)
    if not (found.stock or found.paths or notes.problems):
        allowed = f"files with schema: {STOCK} or {PATHS}"
        notes.problems.append(Problem("unknown_kind", "", "no rolling stock, no running path", allowed, place=source.name))
    texts = _texts(found, source.name, notes, repair=repair)
    is_good = not any(problem.severity == "error" for problem in notes.problems)
    return Imported(texts if is_good else {}, notes)


def _add(path: Path, label: str, found: _Found, notes: Notes) -> None:
    try:
        data = read_yaml(Source(path, label, "")).data
    except InputError as error:
        notes.problems += error.problems
        return
    schema = data.get("schema")
    if schema == STOCK:
        stock = f.read_foreign(path, StockFile, notes)
        if stock is not None:
            found.stock.append((label, stock))
            _tell(stock, label, notes)
    elif schema == PATHS:
        paths = f.read_foreign(path, PathFile, notes)
        if paths is not None:
            _add_paths(paths, label, found, notes)
    elif "settings" in data:
        settings = f.read_foreign(path, SettingsFile, notes)
        if settings is not None:
            found.is_point = settings.settings.mass_model != "homogeneous_strip" and found.is_point
            _tell(settings, label, notes)
    else:
        notes.ignored.append(f"{label}: no file of railtoolkit (schema {schema or 'missing'})")


def _add_paths(file: PathFile, label: str, found: _Found, notes: Notes) -> None:
    known = {path.id: (where, path) for where, path in found.paths}
    for path in file.paths:
        where, same = known.get(path.id, ("", path))
        if same != path:
            notes.problems.append(_twice("paths", path.id, label))
        elif where:
            notes.ignored.append(f"{label}: path {path.id}, the same as in {where}")
        else:
            found.paths.append((label, path))
            known[path.id] = (label, path)
    _tell(file, label, notes)


def _tell(model: f.Foreign, label: str, notes: Notes) -> None:
    notes.ignored += [f"{label}: {key}" for key in f.unknown_keys(model)]


def _texts(found: _Found, name: str, notes: Notes, *, repair: bool) -> dict[str, str]:
    vehicles: dict[str, Vehicle] = {}
    trains: dict[str, tuple[Train, float]] = {}
    for label, stock in found.stock:
        for vehicle in vehicles_of(stock, notes, label):
            if vehicles.setdefault(vehicle.id, vehicle) != vehicle:
                notes.problems.append(_twice("vehicles", vehicle.id, label))
        lengths = {train.id: length_m(train, stock) for train in stock.trains}
        for train in trains_of(stock, found.is_point, notes, label):
            if train.id in trains:
                notes.problems.append(_twice("trains", train.id, label))
            trains[train.id] = (train, lengths[train.id])
    if found.stock:
        mass = "a point under its front" if found.is_point else "spread over its length"
        notes.read.append(f"trains fully loaded, their mass {mass}, as TrainRuns reckons; picture and UUID left out")
    texts = stock_texts(vehicles.values(), [train for train, _ in trains.values()])
    if not found.paths:
        return texts
    return {**_study(found.paths, trains, vehicles, name, notes, repair=repair), **texts}


def _twice(kind: str, name: str, place: str) -> Problem:
    return Problem("twice", f"{kind}[{name}]", f"another {name} than before", "each once", "rename one", place=place)


def _study(
    paths: list[tuple[str, RunningPath]],
    trains: dict[str, tuple[Train, float]],
    vehicles: dict[str, Vehicle],
    name: str,
    notes: Notes,
    *,
    repair: bool,
) -> dict[str, str]:
    lengths = {key: length for key, (_, length) in trains.items()}
    if not trains:
        notes.assumed.append(f"the train {SHIPPED_TRAIN}, which ships: the source has none")
        lengths = {SHIPPED_TRAIN: 0.0}
    data: dict[str, list[Any]] = {key: [] for key in ("tracks", "stations", "gradients", "speed_limits")}
    runs = []
    for label, path in paths:
        many = len(paths) > 1
        rows = _sections(path, notes, repair=repair, place=label)
        if len(rows) > 1:
            _add_track(path.id, rows, data)
            runs += _runs(path, rows, lengths, data["stations"], f"{path.id} " if many else "", notes)
    if not data["tracks"]:
        return {}
    line = f.built(Line, {"name": name, "source": "railtoolkit running paths: see README.md", **data}, notes, name)
    timetable = f.built(Timetable, {"trains": runs}, notes, name)
    if line is None or timetable is None or too_long(line, notes, name):
        return {}
    fastest = min((vehicle.max_speed_kmh for vehicle in vehicles.values()), default=160.0)
    limits = [row.model_dump() for row in line.speed_limits]
    end_s = START_S + max(longest_s([row for row in limits if row["tracks"] == (track.id,)], fastest, 2) for track in line.tracks)
    texts = {"line.yaml": text_of(line), "supply.yaml": supply_text(line, notes), "timetable.yaml": text_of(timetable)}
    texts["study.yaml"] = study_text(name, end_s, notes)
    return {"README.md": readme_text(name, name, notes), **texts}


def _sections(path: RunningPath, notes: Notes, *, repair: bool, place: str) -> list[tuple[float, float, float]]:
    """Return km, speed limit [km/h] and resistance [permille] of every section; what is left out holds on from before."""
    where = f"paths[{path.id}].characteristic_sections"
    rows = [(row.position, row) for row in path.characteristic_sections]
    told, speed, resistance, kept = [], None, 0.0, 0
    for position, row in f.rising(rows, where, notes, repair=repair, place=place):
        kept += row.speed is None or row.resistance is None
        speed = row.speed if row.speed is not None else speed
        resistance = row.resistance if row.resistance is not None else resistance
        if speed is None:
            remedy = "give the first section a speed"
            notes.problems.append(Problem("missing_key", f"{where}[0].speed", "no speed", "", remedy, place=place))
            return []
        told.append((f.converted(position, "m", "km"), speed, resistance))
    if kept:
        notes.assumed.append(
            f"{path.id}: {kept} sections without speed or resistance keep that of the section before, level at first"
        )
    notes.read.append(f"path {path.id}: {len(told) - 1} sections, {len(path.points_of_interest)} points of interest")
    return told


def _add_track(name: str, rows: list[tuple[float, float, float]], data: dict[str, list[Any]]) -> None:
    data["tracks"].append({"id": name, "from_km": rows[0][0], "to_km": rows[-1][0]})
    for (low, speed, resistance), (high, _, _) in pairwise(rows):
        piece = {"from_km": low, "to_km": high, "tracks": [name]}
        data["speed_limits"].append({**piece, "kmh": speed})
        data["gradients"].append({**piece, "permille": resistance})


def _runs(
    path: RunningPath,
    rows: list[tuple[float, float, float]],
    lengths: dict[str, float],
    stations: list[Any],
    prefix: str,
    notes: Notes,
) -> list[dict[str, Any]]:
    start, end = rows[0][0], rows[-1][0]
    last = f"{prefix}end"
    stations.append({"id": last, "km": end, "tracks": [path.id]})
    known, runs = {last: end}, list[dict[str, Any]]()
    for train, length in lengths.items():
        passed = []
        for point in path.points_of_interest:
            # A rear or a middle passes a place when the front is as far behind it.
            shift = {"front": 0.0, "middle": length / 2.0, "rear": length}[point.measure]
            label = prefix + point.label.replace("[", "(").replace("]", ")")
            name = label if point.measure == "front" else f"{label} {point.measure} of {train}"
            km = f.tidy((point.position + shift) / 1000.0)
            if not start < km < end:
                notes.ignored.append(f"{path.id}: point {point.label}, where {train} would be outside of the path")
                continue
            name = name if known.get(name, km) == km else f"{name} at km {km:.10g}"  # a label may stand twice
            if name not in known:
                stations.append({"id": name, "km": km, "tracks": [path.id]})
                known[name] = km
            passed.append((km, {"station": name, "stops": False}))
        calls = [call for _, call in sorted(passed, key=lambda item: item[0])]
        route = [{"track": path.id, "from_km": start, "to_km": end}]
        run: dict[str, Any] = {
            "id": f"{train} {path.id}",
            "train": train,
            "route": route,
            "start": {"time": format_time(START_S)},
        }
        runs.append({**run, "calls": [*calls, {"station": last}]})
    notes.assumed.append(f"path {path.id}: every train starts from rest at {format_time(START_S)} and stops at the end")
    return runs
