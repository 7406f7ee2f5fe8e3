"""What has come of the cases: rows in hand, tables from the store, and both written as results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.errors import InputError
from tractionpower.model.change import split_change
from tractionpower.results.columns import TABLES
from tractionpower.results.outcome import Writer
from tractionpower.results.tables import make_table, schema_of
from tractionpower.studies.runner.case import CASE_TABLES, FAILED, Case
from tractionpower.studies.runner.packed import table_of
from tractionpower.studies.runner.store import CaseStore

PIECE_ROWS = 100_000
"""Rows of the tables of cases that are in memory, and written, at a time."""

Completed = Callable[[pa.Table, Mapping[str, Any]], pa.Table]
"""From the rows of a table of a case, and the case's own row, the rows with what only the whole study knows."""


@dataclass(frozen=True)
class CasesRun:
    """Cases that were run, or had been.

    Attributes
    ----------
    cases
        All cases, in their order.
    rows
        A row of table ``cases`` of each that has ended, in the same order; what has no value is None.
    keys
        Under which key the store keeps the outcome of a case; those that failed or could not be made have none.
    store
        What keeps the outcomes.
    reused, run
        Cases whose outcome an earlier call had kept, and cases that were run now.
    interrupted
        Whether Ctrl-C came before all had ended.
    wall_seconds
        What it took [s].
    workers
        Cases that were run at a time.
    """

    cases: tuple[Case, ...]
    rows: tuple[dict[str, Any], ...]
    keys: Mapping[str, str]
    store: CaseStore
    reused: int
    run: int
    interrupted: bool
    wall_seconds: float
    workers: int

    @property
    def failed(self) -> int:
        """Cases that failed; they are run again by the next call."""
        return self.count(FAILED)

    def count(self, status: str) -> int:
        """Return how many cases have a status."""
        return sum(row["status"] == status for row in self.rows)

    def counts(self) -> dict[str, int]:
        """Return the numbers of cases for ``run.json``: all, and those of each status; how many were not run now."""
        told = {status: self.count(status) for status in ("complete", "flagged", "refused", FAILED)}
        return {"all": len(self.cases), **told, "reused": self.reused}

    def case_tables(self, name: str) -> Iterator[tuple[dict[str, Any], pa.Table]]:
        """Yield the row of each case with its rows of a table, where it has some; they are read as they are asked for."""
        schema = schema_of(name)
        for row in self.rows:
            rows = table_of(self.store.get(self.keys[row["case"]]), name) if row["case"] in self.keys else None
            if rows is not None:
                column = pa.DictionaryArray.from_arrays(np.zeros(rows.num_rows, np.int32), pa.array([row["case"]], pa.string()))
                at = schema.get_field_index("case")
                yield row, rows.add_column(at, schema.field(at), column).cast(schema)

    def tables(self, name: str) -> Iterator[pa.Table]:
        """Yield the rows of a table case by case; they are read as they are asked for."""
        return (rows for _, rows in self.case_tables(name))


def write_cases(run: CasesRun, writer: Writer, completed: Mapping[str, Completed] | None = None) -> None:
    """Write tables ``cases``, ``case_changes`` and those of `CASE_TABLES` that a case has rows in.

    Parameters
    ----------
    run
        The cases.
    writer
        Takes the rows.
    completed
        By table: what makes the rows of a case complete, where only the whole study can.
    """
    writer.append("cases", rows_table("cases", run.rows))
    ended = {row["case"] for row in run.rows}
    writer.append("case_changes", rows_table("case_changes", list(_changes(case for case in run.cases if case.id in ended))))
    for name in CASE_TABLES:
        complete = (completed or {}).get(name)
        pieces = (rows if complete is None else complete(rows, row) for row, rows in run.case_tables(name))
        for piece in _joined(pieces):
            writer.append(name, piece)


def rows_table(table: str, rows: Sequence[Mapping[str, Any]]) -> pa.Table:
    """Return rows as a table with the declared columns; what a row does not have, or has as None, has no value."""
    columns: dict[str, Any] = {}
    for column in TABLES[table]:
        values = [row.get(column.name) for row in rows]
        if column.kind == "text":
            words = ["" if value is None else str(value) for value in values]
            known = sorted({*words})
            codes = {word: code for code, word in enumerate(known)}
            columns[column.name] = [codes[word] for word in words], known
        elif column.kind.startswith("f"):
            columns[column.name] = [np.nan if value is None else value for value in values]
        else:
            columns[column.name] = values
    return make_table(table, columns)


def _changes(cases: Iterable[Case]) -> Iterator[dict[str, str]]:
    for case in cases:
        for change in case.changes:
            try:
                path, value = split_change(change)
            except InputError:  # told as the reason of the case
                path, value = change, ""
            yield {"case": case.id, "path": path, "value": value}


def _joined(tables: Iterable[pa.Table]) -> Iterator[pa.Table]:
    """Yield tables joined to pieces of some `PIECE_ROWS`."""
    waiting: list[pa.Table] = []
    for rows in tables:
        waiting.append(rows)
        if sum(each.num_rows for each in waiting) >= PIECE_ROWS:
            yield pa.concat_tables(waiting).unify_dictionaries().combine_chunks()
            waiting = []
    if waiting:
        yield pa.concat_tables(waiting).unify_dictionaries().combine_chunks()
