"""``tractionpower report``: reports of an earlier run, also of one that broke off."""

import json
import os
from pathlib import Path

import pytest
from openpyxl import load_workbook
from small_files import write_small_study
from train_study import write_train_study

from tractionpower.cli import main
from tractionpower.io.scenario_files import load
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def folder():
    """Return the folder of a run without reports."""
    write_small_study(Path("small"))
    assert main(["run", "small", "--no-reports"]) == 0
    return Path("reports") / "small"


def tables_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in {".parquet", ".json"}}


def break_off(folder):
    """Leave a run as a crash does: parts, and nobody who says that it is over."""
    results = Results.open(folder)
    scenario = load("small")
    writer = RunWriter(folder, "small", scenario.input_hash, scenario=scenario)
    for table in ("substations", "feeders", "loads"):  # profile and events are written at the end of a run
        for rows in results.batches(table):
            writer.append(table, rows.slice(0, rows.num_rows // 2))
    return writer


def test_reports_are_written_again_from_the_tables_alone(folder, capsys, monkeypatch):
    monkeypatch.setattr("tractionpower.cosimulation.run.Run.execute", lambda *_: pytest.fail("no simulation"))
    before = tables_of(folder)
    Path("small").rename("elsewhere")  # the files of the study are not needed any more
    assert main(["report", str(folder)]) == 0
    assert {path.name for path in folder.iterdir()} == set(before) | {"figures", "report.xlsx"}
    assert tables_of(folder) == before
    told = capsys.readouterr().err
    assert f"report: {folder / 'report.xlsx'}" in told
    assert f"in {folder / 'figures'}" in told


def test_reports_made_later_follow_the_template_of_the_run(folder):
    Path("office.yaml").write_text("company: Office\nsheets: [Trains, Cover]\nfigures: {formats: [svg]}\n", encoding="utf-8")
    assert main(["run", "small", "--template", "office.yaml"]) == 0
    Path("office.yaml").unlink()
    for command in (None, ["report", str(folder)]):
        assert command is None or main(command) == 0
        book = load_workbook(folder / "report.xlsx")
        assert book.sheetnames == ["Cover"], "a run without trains has no such sheet"
        assert "Office" in [cell.value for row in book["Cover"].iter_rows() for cell in row]
        assert {path.suffix for path in (folder / "figures").rglob("*.*")} == {".svg"}
    kept = folder / "report.yaml"
    kept.write_text(kept.read_text(encoding="utf-8").replace("Office", "Office of today"), encoding="utf-8")
    assert main(["report", str(folder)]) == 0
    assert load_workbook(folder / "report.xlsx").properties.creator == "Office of today"


def test_a_wrong_template_stops_a_run_before_it_begins(folder, capsys, monkeypatch):
    monkeypatch.setattr("tractionpower.cosimulation.run.Run.execute", lambda *_: pytest.fail("no simulation"))
    Path("office.yaml").write_text("companie: Office\n", encoding="utf-8")
    assert main(["run", "small", "--template", "office.yaml"]) == 1
    assert "did you mean company?" in capsys.readouterr().err


def test_reports_of_a_run_are_the_same_when_they_are_written_again(folder):
    assert main(["run", "small"]) == 0
    before = {path.name: path.read_bytes() for path in (folder / "figures").iterdir()}
    assert before
    assert main(["report", str(folder)]) == 0
    assert {path.name: path.read_bytes() for path in (folder / "figures").iterdir()} == before


def test_a_run_that_broke_off_is_reported_apart(folder, capsys):
    before = tables_of(folder)
    break_off(folder)
    assert main(["report", str(folder), "--partial"]) == 0
    assert (folder / "partial" / "report.xlsx").is_file()
    assert any((folder / "partial" / "figures").iterdir())
    assert tables_of(folder) == before
    assert not (folder / "report.xlsx").exists()
    assert "the run is interrupted" in capsys.readouterr().err


def test_after_a_crash_of_the_first_run_the_remedy_is_told(folder, capsys):
    break_off(folder)
    for path in folder.glob("*.json"):
        path.unlink()
    assert main(["report", str(folder)]) == 2
    assert "--partial" in capsys.readouterr().err
    assert main(["report", str(folder), "--partial"]) == 0


def test_before_the_first_part_there_is_nothing_to_report(folder, capsys):
    scenario = load("small")
    RunWriter(folder, "small", scenario.input_hash, scenario=scenario)
    assert main(["report", str(folder), "--partial"]) == 2
    assert "no table is there" in capsys.readouterr().err


def test_results_of_a_version_that_kept_no_scenario(folder, capsys):
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    del run["files"]["scenario.json"]
    (folder / "run.json").write_text(json.dumps(run), encoding="utf-8")
    assert main(["report", str(folder)]) == 2
    told = capsys.readouterr().err
    assert "scenario.json" in told
    assert "run the study again" in told


def test_theoretical_journeys_are_told_apart(tmp_path, capsys):
    write_train_study(tmp_path / "trains")
    assert main(["journey", "trains", "--no-reports"]) == 0
    assert main(["report", str(Path("reports") / "trains" / "journey")]) == 2
    assert "theoretical journeys" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["nowhere"], ["small"], ["nowhere", "--partial"]])
def test_folders_without_results_are_wrong_usage(folder, capsys, arguments):
    assert main(["report", *arguments]) == 2
    told = capsys.readouterr().err
    assert arguments[0] in told
    assert "Traceback" not in told


def test_a_damaged_table_is_told(folder, capsys):
    (folder / "loads.parquet").write_bytes(b"damaged")
    assert main(["report", str(folder)]) == 2
    assert "loads.parquet: not the file that the run wrote" in capsys.readouterr().err


def test_reports_that_cannot_be_written_are_3_and_harm_no_table(folder, capsys):
    before = tables_of(folder)
    (folder / "figures").write_text("in the way", encoding="utf-8")
    assert main(["report", str(folder)]) == 3
    assert "figures cannot be written" in capsys.readouterr().err
    assert tables_of(folder) == before
    assert (folder / "report.xlsx").is_file()  # the other report


def test_a_workbook_that_is_open_elsewhere(folder, capsys, monkeypatch):
    replace = os.replace

    def refuse(source, target):
        if Path(target).name == "report.xlsx":
            raise PermissionError(13, "held open by another program")
        return replace(source, target)

    (folder / "report.xlsx").write_bytes(b"open in Excel")
    monkeypatch.setattr(os, "replace", refuse)
    assert main(["report", str(folder)]) == 0
    told = capsys.readouterr().err
    assert "report.new.xlsx was written beside a file that another program holds open" in told
    assert (folder / "report.xlsx").read_bytes() == b"open in Excel"
    assert (folder / "report.new.xlsx").stat().st_size > 1000
    assert not list(folder.rglob("*.tmp"))


def test_a_part_of_a_run_gets_reports_of_its_own(capsys):
    write_train_study(Path("trains"))
    assert main(["run", "trains"]) == 0
    folder = Path("reports") / "trains"
    before = tables_of(folder) | {"report.xlsx": (folder / "report.xlsx").read_bytes()}
    train = Results.open(folder).run["trains"][0]["train"]
    assert main(["report", str(folder), "--train", train, "--from-km", "1", "--to", "06:20"]) == 0
    part = folder / "selected" / f"train {train} to 06.20.00 from 1 km"
    assert (part / "report.xlsx").exists()
    assert (part / "figures" / "train_graph.png").exists()
    assert {name: (folder / name).read_bytes() for name in before} == before
    capsys.readouterr()
    assert main(["report", str(folder), "--train", "none", "--track", "none"]) == 1
    told = capsys.readouterr().err
    assert "--train" in told
    assert "--track" in told
    assert main(["report", str(folder), "--from", "noon"]) == 2
    assert "a time is HH:MM" in capsys.readouterr().err


def test_only_what_is_asked_for_is_written(folder, capsys):
    assert main(["report", str(folder), "--only", "voltage_along_line", "--format", "svg", "--format", "pdf"]) == 0
    assert {path.name for path in (folder / "figures").iterdir()} == {"voltage_along_line.svg", "voltage_along_line.pdf"}
    assert not (folder / "report.xlsx").exists()
    assert main(["report", str(folder), "--only", "workbook"]) == 0
    assert (folder / "report.xlsx").exists()
    assert len(list((folder / "figures").iterdir())) == 2
    capsys.readouterr()
    assert main(["report", str(folder), "--format", "gif"]) == 2
    assert "png, svg, pdf" in capsys.readouterr().err
    assert main(["report", str(folder), "--only", "voltages"]) == 2
    assert "voltage_along_line" in capsys.readouterr().err
