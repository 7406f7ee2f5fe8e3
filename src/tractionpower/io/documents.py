"""Reading of YAML files into declarations: lists may stand in CSV files, and all problems of all files are collected."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from tractionpower.errors import InputError, Problem
from tractionpower.io.csv_files import read_csv
from tractionpower.io.problems import Input, format_problem, problems_of
from tractionpower.io.provenance import Loc, Mark, path_of, told_once
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.text_files import Source, relative_label
from tractionpower.io.wording import shown
from tractionpower.io.yaml_files import read_yaml

Model = TypeVar("Model", bound=BaseModel)

_PLAIN = ("number", "integer", "boolean", "time", "choice", "identifier", "text")
"""Kinds of cells that hold one value."""


def read_document(path: Path, model: type[Model]) -> Model:
    """Read one file that stands for itself as a model.

    Raises
    ------
    InputError
        With all problems of the file.
    """
    reader = Reader(path.parent)
    content = reader.read(Source(path, path.name, ""), model)
    read = reader.validated(model, content) if content is not None else None
    if read is None or reader.has_errors:
        raise InputError(reader.problems)
    return read


@dataclass(slots=True)
class Reader:
    """Reads files and collects their problems until all are read.

    Attributes
    ----------
    folder
        Messages call files relative to it.
    problems
        What was wrong up to now.
    """

    folder: Path
    problems: list[Problem] = field(default_factory=list)

    @property
    def has_errors(self) -> bool:
        """Whether something is wrong enough to stop a run."""
        return any(problem.severity == "error" for problem in self.problems)

    def named(self, name: str, namer: Path, root: str, named_at: str) -> Source:
        """Return the file that the file `namer` names at the place `named_at`; `root` is the model path of its content."""
        file = namer.parent / name
        return Source(file, relative_label(file, self.folder) if "\0" not in name else shown(name), root, named_at)

    def read(self, source: Source, model: type[BaseModel]) -> Input | None:
        """Return the content of a file, with the rows of CSV files in the place of their names; None if it cannot be read."""
        try:
            read = read_yaml(source)
        except InputError as error:
            self._tell(error.problems)
            return None
        self.problems += read.problems
        content = Input(source.root, read.data, read.mark, shape_of(model), source.file)
        newer = format_problem(content)
        if newer is not None:
            self.problems.append(newer)
            return None
        content.silent.update(self._expand(content.data, content.shape, content.mark, (), content))
        return content

    def validated(self, model: type[Model], content: Input) -> Model | None:
        """Return `content` as a model, or None if the model refuses it."""
        try:
            return model.model_validate(content.data)
        except ValidationError as error:
            self._tell(problems_of(error, content))
            return None

    def _tell(self, problems: Iterable[Problem]) -> None:
        # In place: others may hold the list.
        self.problems[:] = told_once([*self.problems, *problems])

    def _expand(self, data: Any, shape: Shape, mark: Mark, loc: Loc, content: Input) -> set[Loc]:
        # Puts the rows of CSV files in the place of their names; returns the places that failed.
        silent: set[Loc] = set()
        shape = shape.branch(data)
        items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
        for key, value in list(items):
            child = shape.child(key)
            if child is None:
                continue
            if child.kind == "rows" and isinstance(value, str):
                silent |= self._table(data, key, child, mark, (*loc, key), content)
            elif child.kind == "time" and isinstance(value, float):
                data[key] = str(value)  # 7.30 is no time; as a number it would pass for seconds
            elif child.kind == "identifier" and isinstance(value, float) and "e" in mark.find((key,)).written.lower():
                data[key] = mark.find((key,)).written  # the rail 60E1 is no number
            else:
                silent |= self._expand(value, child, mark.find((key,)), (*loc, key), content)
        return silent

    def _table(self, data: Any, key: Any, shape: Shape, mark: Mark, loc: Loc, content: Input) -> set[Loc]:
        name, data[key] = data[key], []
        path = path_of(content.root, loc, content.data)
        named_in = mark.find((key,))
        row = shape.child(0)
        if row is None or not name.lower().endswith(".csv"):
            self.problems.append(
                Problem("wrong_type", path, shown(name), shape.allowed(), "a CSV file ends in .csv", place=named_in.place)
            )
            return {loc}
        source = self.named(name, content.file, path, named_in.place)
        try:
            table = read_csv(source, row)
        except InputError as error:
            self._tell(error.problems)
            return {loc}
        self._tell(table.problems)
        data[key], mark.children[key] = table.rows, table.mark
        # The rows may name further files, relative to their own; most cannot, and some are many.
        nested = any((child := row.child(key)) is not None and child.kind not in _PLAIN for key in row.keys)
        deeper = self._expand(table.rows, shape, table.mark, loc, replace(content, file=source.file)) if nested else set()
        return {loc, *deeper} if table.problems else deeper
