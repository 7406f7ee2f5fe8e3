"""Tables of data that ship with the program as CSV files, and a user's rows over them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from tractionpower.errors import Problem, raise_errors
from tractionpower.io.csv_files import csv_text, read_csv
from tractionpower.io.problems import Input, problems_of
from tractionpower.io.provenance import Mark
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.text_files import Source
from tractionpower.model.base import Declaration

Row = TypeVar("Row", bound=Declaration)


class OverlaidTable(Generic[Row]):
    """A shipped table whose rows a user may replace, and to which a user may add.

    Parameters
    ----------
    model
        Declaration of a row.
    name
        Key of the study file and of the scenario; the shipped file is ``data/NAME.csv``.
    word
        What messages call a row.
    keys
        The fields that tell rows apart.
    overlay
        Lays rows over others and sorts them.
    whole
        The fields that tell apart what `overlay` replaces as a whole; left out: single rows.
    """

    def __init__(
        self,
        model: type[Row],
        name: str,
        word: str,
        keys: tuple[str, ...],
        overlay: Callable[[Sequence[Row], Sequence[Row]], tuple[Row, ...]],
        whole: tuple[str, ...] = (),
    ) -> None:
        self.model, self.name, self.word, self.keys, self._overlay = model, name, word, keys, overlay
        self._whole = whole or keys

    @cached_property
    def shipped(self) -> tuple[Row, ...]:
        """The rows that ship with the program, sorted."""
        file = Path(str(resources.files("tractionpower"))) / "data" / f"{self.name}.csv"
        rows, _ = self.read(Source(file, file.name, self.name))
        return self._overlay(rows, ())

    def over_shipped(self, rows: Sequence[Row]) -> tuple[Row, ...]:
        """Return the shipped rows with each one replaced or added by `rows`."""
        return self._overlay(self.shipped, rows)

    def read(self, source: Source) -> tuple[tuple[Row, ...], Mark]:
        """Return the rows of a file and where they stand.

        Raises
        ------
        InputError
            With all problems of the file.
        """
        table = read_csv(source, shape_of(self.model))
        problems = [*table.problems, *self._twice(source, table.rows, table.mark)]
        adapter: TypeAdapter[tuple[Row, ...]] = TypeAdapter(tuple[self.model, ...])  # type: ignore[name-defined]
        rows: tuple[Row, ...] = ()
        try:
            rows = adapter.validate_python(table.rows)
        except ValidationError as error:
            problems += self._problems(error, source, table.rows, table.mark)
        raise_errors(problems)
        return rows, table.mark

    def text(self, rows: Sequence[Row]) -> str:
        """Return as CSV those of `rows` that differ from the shipped ones, with all of their whole; empty when none does."""
        shipped, columns = self._wholes(self.shipped), list(self.model.model_fields)
        changed = [own for name, own in self._wholes(rows).items() if set(own) != set(shipped.get(name, ()))]
        kept = [[getattr(row, name) for name in columns] for own in changed for row in own]
        return csv_text(columns, kept) if kept else ""

    def _wholes(self, rows: Sequence[Row]) -> dict[tuple[object, ...], list[Row]]:
        found: dict[tuple[object, ...], list[Row]] = {}
        for row in rows:
            found.setdefault(tuple(getattr(row, name) for name in self._whole), []).append(row)
        return found

    def _problems(self, error: ValidationError, source: Source, rows: list[dict[str, object]], mark: Mark) -> list[Problem]:
        # The table is a list, so it is looked at as the one key of a mapping around it.
        row = shape_of(self.model)
        shape = Shape({"items": row.schema}, row.definitions)
        return problems_of(error, Input(source.root, rows, mark, shape, source.file))

    def _twice(self, source: Source, rows: list[dict[str, object]], mark: Mark) -> list[Problem]:
        counts = Counter(" ".join(str(row.get(key)) for key in self.keys) for row in rows)
        return [
            source.problem("duplicate_row", f"the {self.word} {name} {count} times", "once", line=mark.find([name]).line)
            for name, count in counts.items()
            if count > 1
        ]
