"""The study that an imported timetable becomes part of: an existing one beside it, or a copy of another without its timetable."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tractionpower.errors import UsageError
from tractionpower.io.documents import read_document
from tractionpower.io.finder import STUDY_FILE, find_study
from tractionpower.io.imports.imported import Notes
from tractionpower.io.stock_finder import FOLDER
from tractionpower.io.wording import printable
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT, format_time
from tractionpower.model.line import Line
from tractionpower.model.scenario import StudyFile

TIMETABLE = "timetable.yaml"
HOUR_S = 3600.0
MARGIN_S = 600.0
"""The clock begins by so much before the first train and ends by so much after the last [s], at full hours."""


@dataclass(frozen=True, slots=True)
class Frame:
    """The line of a timetable, and the files of its study.

    Attributes
    ----------
    line
        The line.
    folder
        Folder in which the rolling stock of the study is looked for first.
    study
        The study file, if there is one.
    texts
        Files to be written beside the timetable.
    is_new
        Whether a study file is to be written.
    """

    line: Line
    folder: Path
    study: StudyFile | None = None
    texts: dict[str, str] = field(default_factory=dict)
    is_new: bool = True

    def study_text(self, begin_s: float, end_s: float, name: str) -> str:
        """Return a study file whose clock takes in all trains, which run from `begin_s` to `end_s` [s]."""
        first = max(0.0, (begin_s - MARGIN_S) // HOUR_S * HOUR_S)
        last = -(-(end_s + MARGIN_S) // HOUR_S) * HOUR_S
        data: dict[str, Any] = {"format": FORMAT, "name": name}
        if self.study is not None:
            kept = {"limits", "conductors", "coupling", "coupling_voltage_v", "seed", "coast_without_voltage_s", "output"}
            data |= self.study.model_dump(mode="json", by_alias=True, exclude_defaults=True, include=kept)
        data |= {"line": "line.yaml", "supply": "supply.yaml", "timetable": TIMETABLE}
        data["clock"] = {"start": format_time(first), "end": format_time(last), "step_s": 1.0}
        return document(data)


def find_frame(folder: Path, line: str | None, notes: Notes) -> Frame:
    """Return the line for a timetable that goes into `folder`: that of a study that is named, or the one that lies there.

    Raises
    ------
    UsageError
        If there is none.
    InputError
        If its files have errors.
    """
    if line is not None:
        return _copied(line, notes)
    file = folder / STUDY_FILE
    study = read_document(file, StudyFile) if file.is_file() else None
    named = folder / (study.line if study is not None else "line.yaml")
    if not named.is_file():
        where = printable(str(folder))
        raise UsageError(f"{where} has no {printable(named.name)}: name the line by --line STUDY, or give a folder that holds it")
    found = read_document(named, Line)
    notes.read.append(f"line {found.name or named.name}: {len(found.stations)} stations, {len(found.tracks)} tracks")
    return Frame(found, folder, study, is_new=study is None)


def _copied(name: str, notes: Notes) -> Frame:
    """Return the files of a study without its timetable, as they stand there."""
    found = find_study(name)
    study = read_document(found.file, StudyFile)
    line = read_document(found.folder / study.line, Line)
    texts = {"line.yaml": _line_text(line), "supply.yaml": _supply_text(found.folder / study.supply)}
    for own in (study.limits, study.conductors):
        if own is not None:
            texts[own] = (found.folder / own).read_text(encoding="utf-8")
    for file in sorted((found.folder / FOLDER).rglob("*")):
        if file.is_file() and file.suffix in (".yaml", ".csv"):
            texts[file.relative_to(found.folder).as_posix()] = file.read_text(encoding="utf-8")
    notes.read.append(
        f"line, supply and rolling stock of {printable(name)}: {len(line.stations)} stations, {len(line.tracks)} tracks"
    )
    return Frame(line, found.folder, study, texts)


def _line_text(line: Line) -> str:
    return document({"format": FORMAT, **line.model_dump(mode="json", by_alias=True, exclude_defaults=True)})


def _supply_text(file: Path) -> str:
    from tractionpower.model.supply import Supply  # noqa: PLC0415 - only where a study is copied

    supply = read_document(file, Supply)
    return document({"format": FORMAT, **supply.model_dump(mode="json", by_alias=True, exclude_defaults=True)})
