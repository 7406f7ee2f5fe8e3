"""All reports of a run together: one that fails does not hinder the others."""

import errno
import os

import pytest
from small_studies import load, make_scenario

from tractionpower.errors import OutputError
from tractionpower.model.report import Report, ReportFigures
from tractionpower.reporting.reports import write_reports
from tractionpower.results.results import Results

SCENARIO = make_scenario(load("x"))


def fail_with(number):
    def fail(results, scenario, path, report=None):
        raise OSError(number, os.strerror(number))

    return fail


def write_file(results, scenario, path, report=None):
    path.write_bytes(b"report")
    return path


def write_folder(results, scenario, path):
    path.mkdir(exist_ok=True)
    return [write_file(results, scenario, path / "figure.png")]


@pytest.fixture
def writers(monkeypatch):
    """Return a function that puts other writers of figures and workbook into their places."""

    def put(figures=write_folder, workbook=write_file):
        monkeypatch.setattr("tractionpower.reporting.figures.of_run.write_figures", figures)
        monkeypatch.setattr("tractionpower.reporting.workbook.write_workbook", workbook)

    return put


def test_figures_and_workbook_are_written(tmp_path, writers):
    writers()
    folder = tmp_path / "new" / "folder"
    paths = write_reports(Results({}, [], {}), SCENARIO, folder)
    assert paths == [folder / "figures" / "figure.png", folder / "report.xlsx"]
    assert all(path.is_file() for path in paths)


@pytest.mark.parametrize(
    ("failing", "words", "left"),
    [
        ({"figures": fail_with(errno.ENOSPC)}, ["figures cannot be written", "the disk is full"], {"report.xlsx"}),
        ({"workbook": fail_with(errno.EACCES)}, ["report.xlsx cannot be written", "no permission"], {"figures"}),
        (
            {"figures": fail_with(errno.ENOSPC), "workbook": fail_with(errno.EIO)},
            ["figures cannot be written", "report.xlsx cannot be written", "the tables are complete"],
            set(),
        ),
    ],
)
def test_one_that_fails_does_not_hinder_the_others(tmp_path, writers, failing, words, left):
    writers(**failing)
    with pytest.raises(OutputError) as told:
        write_reports(Results({}, [], {}), SCENARIO, tmp_path)
    assert all(word in str(told.value) for word in words)
    assert {path.name for path in tmp_path.iterdir()} == left


def test_a_folder_that_cannot_be_made(tmp_path, writers):
    writers()
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(OutputError, match="cannot be written"):
        write_reports(Results({}, [], {}), SCENARIO, tmp_path / "file")


def test_figures_that_another_command_left_go(tmp_path, writers):
    writers()
    figures = tmp_path / "figures"
    stale = ["envelope_voltage", "outages_by_km_2", "sweep_maps", "compare_voltage", "demand", "train_graph", "trains/R1"]
    (figures / "trains").mkdir(parents=True)
    for name in (*stale, "mine"):
        (figures / f"{name}.png").write_bytes(b"earlier")
    write_reports(Results({}, [], {}), SCENARIO, tmp_path)
    assert {path.name for path in figures.iterdir()} == {"figure.png", "mine.png"}


def test_one_part_alone_is_written(tmp_path, writers):
    writers()
    assert write_reports(Results({}, [], {}), SCENARIO, tmp_path, only=frozenset({"workbook"})) == [tmp_path / "report.xlsx"]
    assert write_reports(Results({}, [], {}), SCENARIO, tmp_path / "2", only=frozenset({"figures"})) == [
        tmp_path / "2" / "figures" / "figure.png"
    ]
    assert {path.name for path in (tmp_path / "2").iterdir()} == {"figures"}


def test_figures_that_there_are_none_of_are_told_and_the_others_written(tmp_path, writers):
    writers()
    report = Report(figures=ReportFigures(names=("demand", "demnad", "trains/9")))
    with pytest.raises(OutputError, match=r"none of: demnad, trains/9; figures.names takes .*demand, .*trains, trains/ID"):
        write_reports(Results({}, [], {}), SCENARIO, tmp_path, report)
    assert {path.name for path in tmp_path.iterdir()} == {"figures", "report.xlsx"}
