"""Tables for other programs: what is read back is what the run has."""

import csv
import errno
import math
import os
import sys
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from openpyxl import load_workbook

from tractionpower.errors import OutputError, UsageError
from tractionpower.results.export import export_tables
from tractionpower.results.results import Results
from tractionpower.results.tables import schema_of

TABLES = ["events", "loads", "substations"]
LAST = {"csv": "substations.csv", "xlsx": "tables.xlsx", "netcdf": "substations.nc"}


def same(read, stored):
    """Return whether a value that was read back is the stored one; nothing and NaN are both no value."""
    if stored is None or (isinstance(stored, float) and math.isnan(stored)):
        return read in ("", None) or (isinstance(read, float) and math.isnan(read))
    if isinstance(stored, bool | str):
        return read == stored
    if isinstance(stored, float) and not isinstance(stored, np.float32):
        return math.isclose(float(read), stored, rel_tol=1e-15)  # Excel's files hold 16 digits
    return type(stored)(read) == stored


def stored_rows(results, table):
    """Yield the rows of a table as the run has them: numbers of 32 bits are such."""
    columns = []
    for name, values in results.table(table).items():
        kind = schema_of(table).field(name).type
        plain = [None if pd.isna(value) else value for value in values]
        columns.append([np.float32(v) if str(kind) == "float" and v is not None else v for v in plain])
    return list(zip(*columns, strict=True))


def agree(results, table, header, rows):
    assert list(header) == list(results.table(table).columns)
    stored = stored_rows(results, table)
    assert len(rows) == len(stored)
    for read, kept in zip(rows, stored, strict=True):
        wrong = [(r, k) for r, k in zip(read, kept, strict=True) if not same(r, k)]
        assert wrong == []


def test_csv_comes_back_as_it_was(results, tmp_path):
    paths = export_tables(results, tmp_path / "out", ["csv"])
    assert [path.name for path in paths] == ["events.csv", "loads.csv", "substations.csv"]
    words = {"true": True, "false": False}
    for path in paths:
        with path.open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        agree(results, path.stem, header, [[words.get(cell, cell) for cell in row] for row in rows])


def test_csv_numbers_have_the_digits_that_they_are_worth(results, tmp_path):
    export_tables(results, tmp_path, ["csv"], ["substations"])
    header, first, *_ = (tmp_path / "substations.csv").read_text(encoding="utf-8").splitlines()
    assert header.startswith("time_s,substation,voltage_v,current_a")
    assert first.startswith('0,"A",3600.1,0,')


def test_a_table_on_disk_is_exported_in_groups(folder, write_run, rows, tmp_path, monkeypatch):
    monkeypatch.setattr("tractionpower.results.parts.GROUP_ROWS", 7)
    write_run(cuts=(0, 4, 10))
    export_tables(Results.open(folder), tmp_path / "out", ["csv"])
    read = pd.read_csv(tmp_path / "out" / "loads.csv", dtype={"voltage_v": np.float32})
    assert read["voltage_v"].tolist() == rows(0, 10).to_pandas()["voltage_v"].tolist()
    assert read["load"].tolist() == ["x", "y"] * 10


def test_excel_comes_back_as_it_was_and_nothing_is_a_formula(results, tmp_path):
    assert export_tables(results, tmp_path, ["xlsx"]) == [tmp_path / "tables.xlsx"]
    book = load_workbook(tmp_path / "tables.xlsx")
    assert book.sheetnames == TABLES
    for table in TABLES:
        sheet = book[table]
        header, *rows = sheet.iter_rows(values_only=True)
        agree(results, table, header, rows)
        assert sheet.freeze_panes == "A2"
        assert all(cell.font.bold for cell in sheet[1])
        assert {cell.data_type for row in sheet for cell in row} <= {"s", "inlineStr", "n", "b"}
    kinds = {row[1].value: row[1].quotePrefix for row in book["events"].iter_rows(min_row=2)}
    assert {text for text, quoted in kinds.items() if quoted} == {text for text in kinds if text[0] in "=+-@#"}


def test_what_xml_or_excel_cannot_hold(make_events, tmp_path):
    texts, values = ["\x00a\x1b\ufffe", "x" * 40_000, ""], np.array([math.inf, -math.inf, 1.5])
    export_tables(Results({}, [], {"events": make_events(texts, values)}), tmp_path, ["xlsx"])
    _, *rows = load_workbook(tmp_path / "tables.xlsx")["events"].iter_rows(values_only=True)
    assert [row[1] for row in rows] == ["\ufffda\ufffd\ufffd", "x" * 32_767, None]
    assert [row[5] for row in rows] == [None, None, 1.5]


def test_netcdf_comes_back_as_it_was(results, tmp_path):
    io = pytest.importorskip("scipy.io")
    paths = export_tables(results, tmp_path, ["netcdf"])
    assert [path.name for path in paths] == ["events.nc", "loads.nc", "substations.nc"]
    for path in paths:
        with io.netcdf_file(path, "r", mmap=False) as file:
            assert file.input_hash == b"c0ffee"
            assert file.title.decode() == f"Łódź, table {path.stem}"
            columns = {name: variable[:] for name, variable in file.variables.items()}
            units = {name: getattr(variable, "units", b"").decode() for name, variable in file.variables.items()}
        if path.stem == "loads":
            assert columns == {}
            continue
        kinds = schema_of(path.stem)
        read = []
        for name in kinds.names:  # the classic format has an order of its own
            values = columns[name]
            plain = values.tolist()
            if values.ndim == 2:
                plain = [row.tobytes().rstrip(b"\0").decode() for row in values]
            read.append([bool(value) for value in plain] if str(kinds.field(name).type) == "bool" else plain)
            assert units[name] == kinds.field(name).metadata[b"unit"].decode()
        assert set(columns) == set(kinds.names)
        agree(results, path.stem, kinds.names, list(zip(*read, strict=True)))


def test_netcdf_without_scipy_says_what_to_install(results, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy.io", None)
    with pytest.raises(UsageError, match=r"pip install tractionpower\[netcdf\]"):
        export_tables(results, tmp_path / "out", ["csv", "netcdf"])
    assert not (tmp_path / "out").exists()


def test_a_table_that_is_longer_than_a_sheet_is_refused_before_anything_is_written(results, tmp_path, monkeypatch):
    monkeypatch.setattr("tractionpower.results.export.MOST_ROWS", 12)
    with pytest.raises(
        UsageError, match="table events has 12 rows, a sheet of Excel holds 11; export it with --to csv, or leave"
    ):
        export_tables(results, tmp_path / "out", ["csv", "xlsx"])
    with pytest.raises(UsageError, match="--tables loads,substations"):
        export_tables(results, tmp_path / "out", ["csv", "xlsx"])
    assert not (tmp_path / "out").exists()
    assert len(export_tables(results, tmp_path / "out", ["xlsx"], ["loads", "substations"])) == 1


@pytest.mark.parametrize(
    ("formats", "tables", "words"),
    [
        (["cvs"], None, "no format 'cvs'; there are csv, xlsx, netcdf"),
        ([], None, "no format is named"),
        (["csv"], ["trains"], "no table 'trains'; there are events, loads, substations"),
        (["csv"], [], "no table is named"),
    ],
)
def test_unknown_formats_and_tables(results, tmp_path, formats, tables, words):
    with pytest.raises(UsageError, match=words):
        export_tables(results, tmp_path / "out", formats, tables)
    assert not (tmp_path / "out").exists()


def test_names_that_come_twice_are_written_once(results, tmp_path):
    assert len(export_tables(results, tmp_path, ["csv", "csv"], ["loads", "loads"])) == 1


@pytest.mark.parametrize("form", LAST)
def test_a_full_disk_leaves_what_was_there(results, tmp_path, monkeypatch, form):
    if form == "netcdf":
        pytest.importorskip("scipy")
    export_tables(results, tmp_path, [form])
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    replace = Path.replace

    def fill_up(self, target):
        if Path(target).name == LAST[form]:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", fill_up)
    with pytest.raises(OutputError, match=r"tables cannot be written into .*the disk is full"):
        export_tables(results, tmp_path, [form])
    assert {path.name for path in tmp_path.iterdir()} == set(before)
    assert (tmp_path / LAST[form]).read_bytes() == before[LAST[form]]


def test_a_file_that_is_held_open_gets_its_successor_beside(results, tmp_path, hold_open):
    (tmp_path / "tables.xlsx").write_bytes(b"open in Excel")
    hold_open(tmp_path / "tables.xlsx")
    assert export_tables(results, tmp_path, ["xlsx"]) == [tmp_path / "tables.new.xlsx"]
    assert (tmp_path / "tables.xlsx").read_bytes() == b"open in Excel"
    assert zipfile.is_zipfile(tmp_path / "tables.new.xlsx")
