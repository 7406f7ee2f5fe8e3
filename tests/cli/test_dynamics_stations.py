"""``tractionpower dynamics run`` of a case of trains on a line with stations."""

import json

import pytest

import tractionpower as tp
from tractionpower.cli import main


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments):
    return main(["dynamics", "run", "traindyn-three-stations", *arguments])


def test_the_shipped_case_runs_reports_and_exports(working_folder, capsys):
    assert run("--set", "case.traffic.trains=3", "--set", "case.run.period_s=0.5") == 0
    out = capsys.readouterr().out
    assert "trains that have left" in out
    assert "period 0.5 s" in out
    (folder,) = (working_folder / "reports").iterdir()
    assert {path.stem for path in (folder / "figures").iterdir()} == {
        "station_topology", "station_distance_time", "station_speed_distance",
    }  # fmt: skip
    note = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    assert (note["kind"], note["status"], note["trains"], note["seed"]) == ("stations", "complete", 3, 3)
    results = tp.Results.open(folder)
    assert set(results.tables) == {"point_masses", "station_events"}
    assert results.scenario.run.period_s == 0.5
    assert main(["report", str(folder)]) == 0
    assert main(["export", str(folder), "--to", "csv"]) == 0
    assert len(list(folder.rglob("*.csv"))) == 2


def test_errors_are_told_with_their_place_and_nothing_is_written(working_folder, capsys):
    assert run("--set", "case.length_m=10000", "--set", "case.run.record_every_s=0.1") == 1
    told = capsys.readouterr()
    for words in ("case.length_m", "case.gradients[2].to_m", "case.run.record_every_s", "case.yaml:", "--set"):
        assert words in told.out + told.err
    assert list(working_folder.iterdir()) == []
