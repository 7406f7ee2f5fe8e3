"""``tractionpower validate``: computed against expected."""

import json
import shutil

import pytest

from tractionpower.cli import main
from tractionpower.io.finder import data_folder


@pytest.fixture
def cases(tmp_path):
    """Return a folder with a copy of one shipped case and a function that edits its ``case.yaml``."""
    shutil.copytree(data_folder("validation") / "seed-one-train", tmp_path / "cases" / "one-train")
    file = tmp_path / "cases" / "one-train" / "case.yaml"

    def edit(old, new):
        text = file.read_text(encoding="utf-8")
        assert old in text
        file.write_text(text.replace(old, new), encoding="utf-8")

    return tmp_path / "cases", edit


def test_all_shipped_cases_are_met(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["validate"]) == 0
    told = capsys.readouterr().out
    assert "MISSED" not in told
    assert ", 0 missed" in told
    for word in ("expected", "computed", "tolerance", "Krzysztozek 2019"):
        assert word in told
    for folder in data_folder("validation").iterdir():
        assert not folder.is_dir() or f"{folder.name}: " in told
    assert list(tmp_path.iterdir()) == []


def test_json_lists_every_finding(cases, capsys):
    folder, _ = cases
    assert main(["validate", str(folder), "--json"]) == 0
    findings = json.loads(capsys.readouterr().out)
    assert len(findings) > 8
    assert all(finding["met"] is True for finding in findings)
    assert set(findings[0]) == {"case", "check", "figure", "expected", "computed", "tolerance", "source", "form", "met"}


def test_a_wrong_expectation_is_missed_and_3(cases, capsys):
    folder, edit = cases
    edit("3247.5", "3247.6")
    assert main(["validate", str(folder)]) == 3
    told = capsys.readouterr().out
    assert told.count("MISSED") == 1
    assert ", 1 missed" in told
    assert "3247.6" in told
    assert "3247.5" in told
    assert main(["validate", str(folder), "--json"]) == 3
    missed = [finding for finding in json.loads(capsys.readouterr().out) if not finding["met"]]
    assert [(finding["figure"], finding["expected"]) for finding in missed] == [("loads.train.voltage_v", 3247.6)]


def test_a_run_that_cannot_be_served_is_missed_too(cases, capsys):
    folder, edit = cases
    limits = '"supply.loads[train].limits=none", "supply.loads[train].power_kw=90000", "supply.loads[train].current_a=null"'
    edit('set: ["supply.section_cabins[C].state=bypassed"]', f"set: [{limits}]")
    assert main(["validate", str(folder)]) == 3
    assert "flagged" in capsys.readouterr().out


def test_a_figure_that_does_not_come_out_is_an_error_of_the_case(cases, capsys):
    folder, edit = cases
    edit("loads.train.voltage_v: 3247.5", "loads.tram.voltage_v: 3247.5")
    assert main(["validate", str(folder)]) == 1
    assert "loads.tram.voltage_v" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("format: 1", "format: 2", "format"),
        ("title: One", "titel: One", "titel"),
        ("tolerance: 1.0e-3", "tolerance: -1.0", "tolerance"),
        ("cabins[C].state=bypassed", "cabins[X].state=bypassed", "cabins"),
    ],
)
def test_a_case_with_errors_is_1(cases, capsys, old, new, words):
    folder, edit = cases
    edit(old, new)
    assert main(["validate", str(folder)]) == 1
    assert words in capsys.readouterr().err


def test_a_folder_without_cases_is_wrong_usage(tmp_path, capsys):
    for folder in (tmp_path, tmp_path / "nowhere"):
        assert main(["validate", str(folder)]) == 2
        assert "case.yaml" in capsys.readouterr().err
