"""A study's files to a scenario and back; all problems of all files are told at once."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from tractionpower.errors import InputError, Problem
from tractionpower.io.csv_files import read_csv
from tractionpower.io.finder import STUDY_FILE, Study, find_study
from tractionpower.io.limits_files import limits_text, read_limits, shipped_limits
from tractionpower.io.problems import Input, format_problem, in_file_order, problems_of
from tractionpower.io.provenance import Loc, Mark, Provenance, path_of
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.text_files import Source, relative_label, write_files
from tractionpower.io.wording import shown
from tractionpower.io.yaml_files import read_yaml
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT
from tractionpower.model.limits import Limit, overlay
from tractionpower.model.line import Line
from tractionpower.model.scenario import Scenario, StudyFile, Timetable
from tractionpower.model.supply import Supply

Model = TypeVar("Model", bound=BaseModel)

_OF_THE_STUDY = ("name", "clock", "coupling", "coupling_voltage_v", "seed", "output")


@dataclass(frozen=True, slots=True)
class LoadedScenario:
    """A scenario with the memory of where it came from.

    Attributes
    ----------
    scenario
        All parts of the study, resolved and frozen.
    provenance
        File and line of every model path.
    folder
        The study's folder.
    problems
        Warnings of the reading.
    origin
        Where the study was found, in words.
    """

    scenario: Scenario
    provenance: Provenance
    folder: Path
    problems: tuple[Problem, ...] = ()
    origin: str = ""


def load_scenario(study: str | Path) -> LoadedScenario:
    """Read the study at a path, or the shipped line of that name.

    Raises
    ------
    InputError
        With all problems of all files of the study.
    UsageError
        If there is no such study.
    """
    loaded, problems = read_scenario(study)
    if loaded is None:
        raise InputError(problems)
    return loaded


def load(study: str | Path) -> Scenario:
    """Return the scenario of the study at a path, or of the shipped line of that name; see `load_scenario`."""
    return load_scenario(study).scenario


def read_scenario(study: str | Path) -> tuple[LoadedScenario | None, list[Problem]]:
    """Read a study and return it with all problems found; None instead of a scenario if there are errors.

    Raises
    ------
    UsageError
        If there is no such study.
    """
    found = find_study(study)
    reader = _Reader(found)
    scenario = reader.scenario()
    problems = in_file_order(reader.problems)
    if scenario is None:
        return None, problems
    return LoadedScenario(scenario, Provenance(reader.root), found.folder, tuple(problems), found.origin), problems


def save_scenario(scenario: Scenario, folder: str | Path) -> None:
    """Write a scenario as a study; loading it gives an equal scenario with the same `input_hash`.

    Keys that have their default are left out; of the limits only rows that differ from the shipped ones are written.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    texts = {"line.yaml": document(_dump(scenario.line)), "supply.yaml": document(_dump(scenario.supply))}
    study: dict[str, Any] = {"format": FORMAT, "line": "line.yaml", "supply": "supply.yaml"}
    if scenario.timetable.trains:
        study["timetable"] = "timetable.yaml"
        texts["timetable.yaml"] = document(_dump(scenario.timetable))
    limits = limits_text(scenario.limits)
    if limits:
        study["limits"] = "limits.csv"
        texts["limits.csv"] = limits
    own = scenario.model_dump(mode="json", by_alias=True, include=set(_OF_THE_STUDY), exclude_defaults=True)
    # The study file comes last: a folder is a study once everything that it names is there.
    texts[STUDY_FILE] = document({**study, **own})
    write_files(Path(folder), texts)


def _dump(model: BaseModel) -> dict[str, Any]:
    return {"format": FORMAT, **model.model_dump(mode="json", by_alias=True, exclude_defaults=True)}


@dataclass(slots=True)
class _Reader:
    # Reads the files of one study and collects problems until all are read.
    found: Study
    problems: list[Problem] = field(default_factory=list)
    root: Mark = field(init=False)

    def __post_init__(self) -> None:
        self.root = Mark(self.found.file.name)

    def scenario(self) -> Scenario | None:
        """Return the scenario, or None if a file has an error."""
        file, folder = self.found.file, self.found.folder
        names, study = self._study(Source(file, relative_label(file, folder), ""))
        line = self._part("line", names, Line)
        supply = self._part("supply", names, Supply)
        timetable = self._part("timetable", names, Timetable) if names.get("timetable") is not None else Timetable()
        limits = self._limits(names)
        if study is None or line is None or supply is None or timetable is None or limits is None:
            return None
        if any(problem.severity == "error" for problem in self.problems):
            return None
        own = {name: getattr(study, name) for name in _OF_THE_STUDY}
        return Scenario(line=line, supply=supply, timetable=timetable, limits=limits, **own)

    def _study(self, source: Source) -> tuple[dict[str, Any], StudyFile | None]:
        # Also of a broken study file the parts are read, so that their problems are told in the same breath.
        content = self._read(source, StudyFile)
        if content is None:
            parts = {key: StudyFile.model_fields[key].default for key in ("line", "supply")}
            return {key: name for key, name in parts.items() if (self.found.folder / name).is_file()}, None
        self.root = content.mark
        study = self._validated(StudyFile, content)
        defaults = {key: info.default for key, info in StudyFile.model_fields.items()}
        return {key: content.data.get(key, default) for key, default in defaults.items()}, study

    def _part(self, key: str, names: dict[str, Any], model: type[Model]) -> Model | None:
        source = self._source(key, names)
        content = self._read(source, model) if source is not None else None
        if content is None:
            return None
        self.root.children[key] = content.mark
        if model is Timetable:
            self._refuse_trains(content)
        return self._validated(model, content)

    def _limits(self, names: dict[str, Any]) -> tuple[Limit, ...] | None:
        if names.get("limits") is None:
            return shipped_limits()
        source = self._source("limits", names)
        if source is None:
            return None
        try:
            rows, self.root.children["limits"] = read_limits(source)
        except InputError as error:
            self.problems += error.problems
            return None
        return overlay(shipped_limits(), rows)

    def _source(self, key: str, names: dict[str, Any]) -> Source | None:
        name = names.get(key)
        if not isinstance(name, str):  # told by the check of the study file
            return None
        return self._named(name, self.found.file, key, self.root.find((key,)).place)

    def _named(self, name: str, namer: Path, root: str, named_at: str) -> Source:
        file = namer.parent / name
        return Source(file, relative_label(file, self.found.folder) if "\0" not in name else shown(name), root, named_at)

    def _read(self, source: Source, model: type[BaseModel]) -> Input | None:
        try:
            read = read_yaml(source)
        except InputError as error:
            self.problems += error.problems
            return None
        self.problems += read.problems
        content = Input(source.root, read.data, read.mark, shape_of(model), source.file)
        newer = format_problem(content)
        if newer is not None:
            self.problems.append(newer)
            return None
        return content

    def _validated(self, model: type[Model], content: Input) -> Model | None:
        silent = self._expand(content.data, content.shape, content.mark, (), content)
        try:
            return model.model_validate(content.data)
        except ValidationError as error:
            self.problems += problems_of(error, content, silent)
            return None

    def _refuse_trains(self, content: Input) -> None:
        trains = content.data.pop("trains", None)
        if not trains:
            return
        place = content.mark.find(("trains",)).place
        remedy = "this version computes networks only: leave the timetable out or its list of trains empty"
        self.problems.append(Problem("no_trains_yet", "timetable.trains", shown(trains), "[]", remedy, place=place))

    def _expand(self, data: Any, shape: Shape, mark: Mark, loc: Loc, content: Input) -> set[Loc]:
        # Puts the rows of CSV files in the place of their names; returns the places that failed.
        silent: set[Loc] = set()
        items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
        for key, value in list(items):
            child = shape.child(key)
            if child is None:
                continue
            if child.kind == "rows" and isinstance(value, str):
                silent |= self._table(data, key, child, mark, (*loc, key), content)
            elif child.kind == "time" and isinstance(value, float):
                data[key] = str(value)  # 7.30 is no time; as a number it would pass for seconds
            else:
                silent |= self._expand(value, child, mark.find((key,)), (*loc, key), content)
        return silent

    def _table(self, data: Any, key: Any, shape: Shape, mark: Mark, loc: Loc, content: Input) -> set[Loc]:
        name, data[key] = data[key], []
        path = path_of(content.root, loc, content.data)
        place = mark.find((key,)).place
        row = shape.child(0)
        if row is None or not name.lower().endswith(".csv"):
            self.problems.append(
                Problem("wrong_type", path, shown(name), shape.allowed(), "a CSV file ends in .csv", place=place)
            )
            return {loc}
        try:
            table = read_csv(self._named(name, content.file, path, place), row)
        except InputError as error:
            self.problems += error.problems
            return {loc}
        self.problems += table.problems
        data[key], mark.children[key] = table.rows, table.mark
        return {loc} if table.problems else set()
