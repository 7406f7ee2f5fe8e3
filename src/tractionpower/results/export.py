"""Tables of a run for other programs: CSV, Excel, NetCDF.

CSV: one file for each table, UTF-8, comma, point; a missing value is an empty cell, texts are quoted and stand there as
they are, also one that begins with ``=`` (which Excel takes for a formula when it opens a CSV file).
Excel: one workbook ``tables.xlsx`` with a sheet for each table; all texts are texts. A table that is longer than a sheet
is refused. NetCDF: one file for each table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import pyarrow as pa
from pyarrow import csv

from tractionpower.errors import UsageError
from tractionpower.results.disk import failures_told, write_or_beside
from tractionpower.results.netcdf import check_netcdf, write_netcdf
from tractionpower.results.results import Results

BOOK = "tables.xlsx"
"""File of the workbook."""

MOST_ROWS = 1_048_576
"""Rows of a sheet, the heading included; a limit of Excel."""


def export_tables(results: Results, folder: Path, formats: Sequence[str], tables: Sequence[str] | None = None) -> list[Path]:
    """Write tables of a run in other formats; every file is whole or not there.

    Parameters
    ----------
    results
        The run.
    folder
        Where the files go; made when it does not exist.
    formats
        Names out of `FORMATS`.
    tables
        Names of the tables; left out: all.

    Returns
    -------
    list of Path
        The files; one that another program holds open keeps its content, and the new one stands beside it.

    Raises
    ------
    UsageError
        If a format or table is unknown, a table is too long for a sheet, or SciPy is missing for NetCDF.
    OutputError
        If a file cannot be written.
    """
    wanted = _known("table", results.tables if tables is None else tables, results.tables)
    writers = [FORMATS[name] for name in _known("format", formats, list(FORMATS))]
    if "xlsx" in formats:
        _check_lengths(results, wanted)
    if "netcdf" in formats:
        check_netcdf()
    with failures_told(folder, "Complete files there stay", "tables"):
        folder.mkdir(parents=True, exist_ok=True)
        return [path for write in writers for path in write(results, folder, wanted)]


def _known(kind: str, names: Sequence[str], known: Sequence[str]) -> list[str]:
    if not names:
        raise UsageError(f"no {kind} is named; there are {', '.join(known) or 'none'}")
    for name in names:
        if name not in known:
            raise UsageError(f"no {kind} {name!r}; there are {', '.join(known) or 'none'}")
    return list(dict.fromkeys(names))


def _check_lengths(results: Results, tables: Sequence[str]) -> None:
    short = [name for name in tables if results.row_count(name) < MOST_ROWS]
    for name in tables:
        if name not in short:
            rest = f", or leave it out with --tables {','.join(short)}" if short else ""
            raise UsageError(
                f"table {name} has {results.row_count(name)} rows, a sheet of Excel holds {MOST_ROWS - 1};"
                f" export it with --to csv{rest}"
            )


def _write_csv(results: Results, folder: Path, tables: Sequence[str]) -> Iterator[Path]:
    for name in tables:
        yield write_or_beside(folder / f"{name}.csv", partial(_fill_csv, results, name))


def _fill_csv(results: Results, table: str, path: Path) -> None:
    with path.open("wb") as file:
        file.write((",".join(results.schema(table).names) + "\n").encode())
        for batch in results.batches(table):
            csv.write_csv(_plain(batch), file, csv.WriteOptions(include_header=False))


def _plain(batch: pa.Table) -> pa.Table:
    # The writer of CSV knows no coded texts.
    fields = [field.with_type(pa.string()) if pa.types.is_dictionary(field.type) else field for field in batch.schema]
    return batch.cast(pa.schema(fields))


def _write_book(results: Results, folder: Path, tables: Sequence[str]) -> Iterator[Path]:
    from tractionpower.results.sheets import Sheet, write_sheets  # noqa: PLC0415 - openpyxl is needed for Excel only

    sheets = [Sheet(name, results.schema(name).names, results.batches(name)) for name in tables]
    yield write_or_beside(folder / BOOK, lambda path: write_sheets(path, sheets))


def _write_netcdf(results: Results, folder: Path, tables: Sequence[str]) -> Iterator[Path]:
    for name in tables:
        yield write_or_beside(folder / f"{name}.nc", partial(_fill_netcdf, results, name))


def _fill_netcdf(results: Results, table: str, path: Path) -> None:
    batches = [results.schema(table).empty_table(), *results.batches(table)]
    about = {"title": f"{results.run.get('study', '')}, table {table}", "input_hash": results.run.get("input_hash", "")}
    write_netcdf(path, pa.concat_tables(batches).unify_dictionaries(), about)


FORMATS: dict[str, Callable[[Results, Path, Sequence[str]], Iterator[Path]]] = {
    "csv": _write_csv,
    "xlsx": _write_book,
    "netcdf": _write_netcdf,
}
"""What tables can be exported to, and how."""
