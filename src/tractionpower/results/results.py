"""Results in hand: tables as DataFrames, key figures, what the run says of itself."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from tractionpower.errors import UsageError
from tractionpower.model.base import Declaration
from tractionpower.results.disk import read_json
from tractionpower.results.kept import SCENARIO_FILE, read_scenario_file
from tractionpower.results.parts import count_rows, read_groups, read_joined
from tractionpower.results.store import (
    KEY_FIGURES_FILE,
    RUN_FILE,
    find_unfinished,
    parts_of,
    read_run,
    table_names,
    written_as,
)


@dataclass(frozen=True)
class Results:
    """Results of a run.

    Attributes
    ----------
    run
        What ``run.json`` says: status, residuals, ledgers, verdicts.
    key_figures
        The figures that sum the run up, each with name, value, unit, place, time, definition.
    """

    run: dict[str, Any]
    key_figures: list[dict[str, Any]]
    _source: Mapping[str, pa.Table | Sequence[Path]]
    _scenario: Declaration | Path | None = None

    def __repr__(self) -> str:
        rows = ", ".join(f"{name} ({self._row_count(name)} rows)" for name in self.tables)
        return f"<Results of study {self.run.get('study', '')!r}, {self.run.get('status', 'unknown')}; tables: {rows or 'none'}>"

    @classmethod
    def open(cls, folder: str | Path, *, partial: bool = False) -> Results:
        """Open a folder that a run has written.

        Parameters
        ----------
        folder
            The folder.
        partial
            Read what a run that was interrupted has left there, instead of complete results.

        Raises
        ------
        UsageError
            If no valid results are there.
        """
        return _open_unfinished(Path(folder)) if partial else _open_complete(Path(folder))

    @cached_property
    def scenario(self) -> Any:
        """What was computed: a `Scenario`, of kind dynamics a `DynamicsScenario`; None if it was not kept with the results.

        Raises
        ------
        UsageError
            If it was kept, but this version does not understand it.
        """
        kind = str(self.run.get("kind") or "")
        return read_scenario_file(self._scenario, kind) if isinstance(self._scenario, Path) else self._scenario

    @property
    def tables(self) -> list[str]:
        """Names of the tables."""
        return sorted(self._source)

    def table(self, name: str, columns: Sequence[str] | None = None) -> pd.DataFrame:
        """Return a table; its columns carry their units in their names.

        Parameters
        ----------
        name
            Name of the table.
        columns
            Those to read, in their order; None: all. A few columns of a day of trains take a small part of its memory.

        Raises
        ------
        UsageError
            If the run has no such table.
        """
        source = self._source_of(name)
        if isinstance(source, pa.Table):
            rows = source if columns is None else source.select(list(columns))
        else:
            rows = read_joined(source, columns)
        frame: pd.DataFrame = rows.to_pandas()
        return frame

    def batches(self, name: str) -> Iterator[pa.Table]:
        """Yield the rows of a table as Arrow tables, as many at a time as are well in memory.

        Raises
        ------
        UsageError
            If the run has no such table.
        """
        source = self._source_of(name)
        if isinstance(source, pa.Table):
            yield source.unify_dictionaries()
        else:
            yield from read_groups(source)

    def schema(self, name: str) -> pa.Schema:
        """Return the Arrow schema of a table, with unit and meaning of each column.

        Raises
        ------
        UsageError
            If the run has no such table.
        """
        source = self._source_of(name)
        return source.schema if isinstance(source, pa.Table) else pq.read_schema(source[0])

    def row_count(self, name: str) -> int:
        """Return the number of rows of a table.

        Raises
        ------
        UsageError
            If the run has no such table.
        """
        source = self._source_of(name)
        return int(source.num_rows) if isinstance(source, pa.Table) else count_rows(source)

    def _source_of(self, name: str) -> pa.Table | Sequence[Path]:
        if name not in self._source:
            raise UsageError(f"no table {name!r}; this run has {', '.join(self.tables)}")
        return self._source[name]

    def _row_count(self, name: str) -> int | str:
        try:
            return self.row_count(name)
        except (OSError, pa.ArrowInvalid):  # gone since it was opened
            return "?"

    def key_figure(self, name: str, place: str = "") -> float:
        """Return the value of a key figure, by name and, where there are several, by place.

        Raises
        ------
        UsageError
            If there is none, or more than one.
        """
        found = [f for f in self.key_figures if f["name"] == name and place in ("", f["place"])]
        if len(found) != 1:
            known = ", ".join(sorted({f["name"] for f in self.key_figures}))
            raise UsageError(f"{len(found)} key figures {name!r} {place!r}; this run has {known}")
        return float(found[0]["value"])


def _open_complete(folder: Path) -> Results:
    run = read_run(folder)
    tables = {name: [folder / written_as(run, f"{name}.parquet")] for name in table_names(run)}
    scenario = folder / written_as(run, SCENARIO_FILE)
    return Results(
        run,
        json.loads((folder / written_as(run, KEY_FIGURES_FILE)).read_text(encoding="utf-8")),
        tables,
        scenario if scenario.name in run["files"] else None,
    )


def _open_unfinished(folder: Path) -> Results:
    running = find_unfinished(folder)
    figures, scenario = running / KEY_FIGURES_FILE, running / SCENARIO_FILE
    return Results(
        read_json(running / RUN_FILE) or {},
        json.loads(figures.read_text(encoding="utf-8")) if figures.is_file() else [],
        parts_of(running),
        scenario if scenario.is_file() else None,
    )
