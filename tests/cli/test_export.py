"""``tractionpower export``: tables of a run for other programs."""

import errno
from pathlib import Path

import pandas as pd
import pytest
from small_files import write_small_study

from tractionpower.cli import main
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    """Return the folder of a run without reports; not to be written into."""
    folder = tmp_path_factory.mktemp("runs")
    study = write_small_study(folder / "small")
    assert main(["run", str(study), "--out", str(folder / "out"), "--no-reports"]) == 0
    return folder / "out"


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_all_tables_as_csv(run_folder, tmp_path, capsys):
    assert main(["export", str(run_folder), "--to", "csv", "--out", "csv"]) == 0
    results = Results.open(run_folder)
    assert {path.stem for path in Path("csv").iterdir()} == set(results.tables)
    read = pd.read_csv("csv/substations.csv")
    assert read["current_a"].astype("float32").tolist() == results.table("substations")["current_a"].tolist()
    assert set(read["substation"]) == {"A", "Łódź"}
    told = capsys.readouterr().err
    assert f"tables: {Path('csv') / 'loads.csv'}" in told


def test_several_formats_and_some_tables_into_the_folder_of_the_run(tmp_path, capsys):
    study = write_small_study(tmp_path / "small")
    assert main(["run", str(study), "--no-reports"]) == 0
    folder = Path("reports") / "small"
    assert main(["export", str(folder), "--to", "csv, xlsx", "--tables", "loads,feeders"]) == 0
    assert {path.name for path in (folder / "export").iterdir()} == {"loads.csv", "feeders.csv", "tables.xlsx"}
    assert Results.open(folder).run["status"] == "complete"  # what is exported is no part of the results, and no hindrance
    assert main(["run", str(study), "--no-reports"]) == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--to", "cvs"], "no format 'cvs'; there are csv, xlsx, netcdf"),
        (["--to", ","], "no format is named"),
        (["--to", "csv", "--tables", "loads,trians"], "no table 'trians'; there are events, feeders, loads"),
        ([], "--to"),
    ],
)
def test_wrong_usage_is_told_and_nothing_is_written(run_folder, tmp_path, capsys, arguments, words):
    assert main(["export", str(run_folder), *arguments, "--out", "out"]) == 2
    assert words in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_without_results(tmp_path, capsys):
    assert main(["export", str(tmp_path), "--to", "csv"]) == 2
    assert "no results of a run are there" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("number", "words"), [(errno.ENOSPC, "the disk is full"), (errno.EACCES, "no permission to write; choose another folder")]
)
def test_what_hinders_the_writing_is_one_message_and_3(run_folder, capsys, monkeypatch, number, words):
    def fail(*arguments, **options):
        raise OSError(number, "x")

    monkeypatch.setattr("tractionpower.results.export.csv.write_csv", fail)
    assert main(["export", str(run_folder), "--to", "csv", "--out", "out"]) == 3
    told = capsys.readouterr().err
    assert words in told
    assert told.count("cannot be written") == 1
    assert list(Path("out").iterdir()) == []
