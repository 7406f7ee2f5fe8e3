"""A study's files to a scenario and back; all problems of all files are told at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel

from tractionpower.errors import InputError, Problem
from tractionpower.io.changes import changed, changes_of
from tractionpower.io.conductor_files import CONDUCTORS
from tractionpower.io.csv_files import csv_text
from tractionpower.io.documents import Reader
from tractionpower.io.file_names import file_names
from tractionpower.io.finder import STUDY_FILE, Study, find_study
from tractionpower.io.library import shipped_library
from tractionpower.io.limits_files import LIMITS
from tractionpower.io.overlaid_tables import OverlaidTable, Row
from tractionpower.io.problems import in_file_order
from tractionpower.io.provenance import Mark, Provenance
from tractionpower.io.rating_files import DUTY_CLASSES, RECTIFIER_UNITS
from tractionpower.io.report_files import add_report
from tractionpower.io.rolling_stock import RollingStock
from tractionpower.io.stock_finder import FOLDER
from tractionpower.io.text_files import Source, relative_label, write_files
from tractionpower.io.yaml_text import document
from tractionpower.model.base import FORMAT, format_time
from tractionpower.model.library import Library
from tractionpower.model.line import Line
from tractionpower.model.report import Report
from tractionpower.model.scenario import Scenario, StudyFile
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle

Model = TypeVar("Model", bound=BaseModel)

LONG_PROFILE = 50
"""Rows of a load's profile beyond which it is saved as a CSV file of its own."""

_OF_THE_STUDY = (
    "name", "clock", "day", "coupling", "coupling_voltage_v", "seed", "coast_without_voltage_s", "output",
    "feasibility", "remedies", "sizing", "contingency",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class LoadedScenario:
    """A scenario with the memory of where it came from.

    Attributes
    ----------
    scenario
        All parts of the study, resolved and frozen.
    provenance
        File and line of every model path.
    folder, file
        The study's folder, and the study file in it.
    problems
        Warnings of the reading.
    origin
        Where the study was found, in words.
    library
        The whole tables of equipment; the scenario holds the rows that it uses.
    report
        The template of reports that the study names. It changes nothing that is computed.
    """

    scenario: Scenario
    provenance: Provenance
    folder: Path
    problems: tuple[Problem, ...] = ()
    origin: str = ""
    library: Library = field(default_factory=shipped_library)
    file: Path = Path(STUDY_FILE)
    report: Report | None = None

    def changed(self, changes: Iterable[str], option: str = "--set") -> Scenario:
        """Return the scenario with changes by path applied; they may name any row of the library.

        Messages call what asks for them `option`.

        Raises
        ------
        InputError
            With all that is wrong with them.
        """
        return changed(self.scenario, changes_of(changes, option), self.library)


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
    files = _StudyReader(found)
    scenario = files.scenario()
    problems = in_file_order(files.reader.problems)
    if scenario is None:
        return None, problems
    told = tuple(problems)
    loaded = LoadedScenario(
        scenario, Provenance(files.root), found.folder, told, found.origin,
        library=files.library, file=found.file, report=files.report,
    )  # fmt: skip
    return loaded, problems


def save_scenario(scenario: Scenario, folder: str | Path) -> None:
    """Write a scenario as a study; loading it gives an equal scenario with the same `input_hash`.

    Keys that have their default are left out; of limits and conductors only rows that differ from the shipped ones are written.
    Trains and vehicles go into ``rollingstock`` beside the study, long profiles of loads into ``profiles``.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    profiles = _profile_texts(scenario.supply)
    supply = _dump(scenario.supply)
    for name, load in zip(profiles, supply.get("loads", ()), strict=False):
        if profiles[name]:
            load["profile"] = name
    texts = {"line.yaml": document(_dump(scenario.line)), "supply.yaml": document(supply)}
    texts |= {name: text for name, text in profiles.items() if text}
    study: dict[str, Any] = {"format": FORMAT, "line": "line.yaml", "supply": "supply.yaml"}
    if scenario.timetable != Timetable():
        study["timetable"] = "timetable.yaml"
        texts["timetable.yaml"] = document(_dump(scenario.timetable))
    texts |= _stock_texts("vehicles", scenario.vehicles) | _stock_texts("trains", scenario.trains)
    tables: tuple[tuple[OverlaidTable[Any], Any], ...] = (
        (LIMITS, scenario.limits), (CONDUCTORS, scenario.conductors),
        (DUTY_CLASSES, scenario.duty_classes), (RECTIFIER_UNITS, scenario.rectifier_units),
    )  # fmt: skip
    for table, rows in tables:
        text = table.text(rows)
        if text:
            study[table.name] = f"{table.name}.csv"
            texts[f"{table.name}.csv"] = text
    own = scenario.model_dump(mode="json", by_alias=True, include=set(_OF_THE_STUDY), exclude_defaults=True)
    # The study file comes last: a folder is a study once everything that it names is there.
    texts[STUDY_FILE] = document({**study, **own})
    write_files(Path(folder), texts)


def _dump(model: BaseModel) -> dict[str, Any]:
    return {"format": FORMAT, **model.model_dump(mode="json", by_alias=True, exclude_defaults=True)}


def _profile_texts(supply: Supply) -> dict[str, str]:
    """Return the CSV files of the profiles of all loads, in their order; empty texts for those that need none."""
    texts = {}
    for number, load in enumerate(supply.loads, 1):
        rows = load.profile or ()
        name = f"profiles/load-{number}.csv"  # by number: two loads of one id are told as an error only when it is read
        columns = [column for column in ("power_kw", "current_a") if rows and getattr(rows[0], column) is not None]
        cells = ([format_time(row.time), row.value] for row in rows)
        texts[name] = csv_text(["time", *columns], cells) if len(rows) > LONG_PROFILE else ""
    return texts


def _stock_texts(kind: str, items: tuple[Train, ...] | tuple[Vehicle, ...]) -> dict[str, str]:
    names = file_names(item.id for item in items)
    return {f"{FOLDER}/{kind}/{names[item.id]}": document(_dump(item)) for item in items}


@dataclass(slots=True)
class _StudyReader:
    # Reads the files of one study; problems are collected until all are read.
    found: Study
    reader: Reader = field(init=False)
    stock: RollingStock = field(init=False)
    root: Mark = field(init=False)
    library: Library = field(default_factory=Library)
    report: Report | None = None

    def __post_init__(self) -> None:
        self.reader = Reader(self.found.folder)
        self.stock = RollingStock(self.reader, self.found.folder)
        self.root = Mark(self.found.file.name)

    def scenario(self) -> Scenario | None:
        """Return the scenario, or None if a file has an error."""
        file, folder = self.found.file, self.found.folder
        names, study = self._study(Source(file, relative_label(file, folder), ""))
        line = self._part("line", names, Line)
        supply = self._part("supply", names, Supply)
        timetable = self._part("timetable", names, Timetable) if names.get("timetable") is not None else Timetable()
        self.root.children |= {"trains": self.stock.trains.mark(), "vehicles": self.stock.vehicles.mark()}
        limits = self._overlaid(LIMITS, names)
        of_library = (CONDUCTORS, DUTY_CLASSES, RECTIFIER_UNITS)
        self.library = Library(**{table.name: self._overlaid(table, names) for table in of_library})
        self._read_report(names)
        if study is None or line is None or supply is None or timetable is None or self.reader.has_errors:
            return None
        own = {name: getattr(study, name) for name in _OF_THE_STUDY}
        trains, vehicles = self.stock.trains.sorted(), self.stock.vehicles.sorted()
        tables = {"limits": limits, **{table.name: getattr(self.library, table.name) for table in of_library}}
        return Scenario(line=line, supply=supply, timetable=timetable, trains=trains, vehicles=vehicles, **tables, **own)

    def _study(self, source: Source) -> tuple[dict[str, Any], StudyFile | None]:
        # Also of a broken study file the parts are read, so that their problems are told in the same breath.
        content = self.reader.read(source, StudyFile)
        if content is None:
            parts = {key: StudyFile.model_fields[key].default for key in ("line", "supply")}
            return {key: name for key, name in parts.items() if (self.found.folder / name).is_file()}, None
        self.root = content.mark
        study = self.reader.validated(StudyFile, content)
        defaults = {key: info.default for key, info in StudyFile.model_fields.items()}
        return {key: content.data.get(key, default) for key, default in defaults.items()}, study

    def _part(self, key: str, names: dict[str, Any], model: type[Model]) -> Model | None:
        source = self._source(key, names)
        content = self.reader.read(source, model) if source is not None else None
        if content is None:
            return None
        self.root.children[key] = content.mark
        part = self.reader.validated(model, content)
        if model is Timetable:  # also of a broken one, so that problems of its trains are told in the same breath
            self.stock.add_timetable(content)
        return part

    def _read_report(self, names: dict[str, Any]) -> None:
        source = self._source("report", names) if names.get("report") is not None else None
        if source is not None:
            self.report, mark = add_report(self.reader, source)
            self.root.children |= {} if mark is None else {"report": mark}

    def _overlaid(self, table: OverlaidTable[Row], names: dict[str, Any]) -> tuple[Row, ...]:
        # Of a broken file no rows; its problems stop the reading later.
        source = self._source(table.name, names) if names.get(table.name) is not None else None
        if source is None:
            return table.shipped
        try:
            rows, self.root.children[table.name] = table.read(source)
        except InputError as error:
            self.reader.problems += error.problems
            return ()
        return table.over_shipped(rows)

    def _source(self, key: str, names: dict[str, Any]) -> Source | None:
        name = names.get(key)
        if not isinstance(name, str):  # told by the check of the study file
            return None
        return self.reader.named(name, self.found.file, key, self.root.find((key,)).place)
