"""Results in hand: tables as DataFrames, key figures, what the run says of itself."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from tractionpower.errors import UsageError
from tractionpower.results.store import KEY_FIGURES_FILE, read_run, table_names, written_as


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
    _source: dict[str, pa.Table] | Path

    def __repr__(self) -> str:
        rows = ", ".join(f"{name} ({self._row_count(name)} rows)" for name in self.tables)
        return f"<Results of study {self.run.get('study', '')!r}, {self.run.get('status', 'unknown')}; tables: {rows or 'none'}>"

    @classmethod
    def open(cls, folder: str | Path) -> Results:
        """Open a folder that a run has written.

        Raises
        ------
        UsageError
            If no valid results are there.
        """
        path = Path(folder)
        run = read_run(path)
        figures = json.loads((path / written_as(run, KEY_FIGURES_FILE)).read_text(encoding="utf-8"))
        return cls(run, figures, path)

    @property
    def tables(self) -> list[str]:
        """Names of the tables."""
        if isinstance(self._source, Path):
            return table_names(self.run)
        return sorted(self._source)

    def table(self, name: str) -> pd.DataFrame:
        """Return a table; its columns carry their units in their names.

        Raises
        ------
        UsageError
            If the run has no such table.
        """
        if name not in self.tables:
            raise UsageError(f"no table {name!r}; this run has {', '.join(self.tables)}")
        source = self._source
        table = source[name] if isinstance(source, dict) else pq.read_table(source / written_as(self.run, f"{name}.parquet"))
        frame: pd.DataFrame = table.to_pandas()
        return frame

    def _row_count(self, name: str) -> int | str:
        if isinstance(self._source, dict):
            return int(self._source[name].num_rows)
        try:
            return int(pq.read_metadata(self._source / written_as(self.run, f"{name}.parquet")).num_rows)
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
