"""``tractionpower import``: what it says, writes and returns."""

import sys
import types
from pathlib import Path

import pytest
from train_study import write_train_study

from tractionpower.cli import main
from tractionpower.io.imports.imported import Imported, Notes

PLAN = "train,station,arrival,departure\n11,A,,06:00\n11,B,06:03,06:03\n11,C,06:07,\n"


@pytest.fixture(autouse=True)
def plan(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_train_study(tmp_path / "six")
    file = tmp_path / "plan.csv"
    file.write_text(PLAN, encoding="utf-8")
    return file


def test_a_timetable_into_a_new_study(tmp_path, capsys):
    assert main(["import", "timetable", "plan.csv", "new", "--line", "six", "--train", "local"]) == 0
    told = capsys.readouterr().out
    for word in ("read:", "assumed:", "1 stop with equal arrival and departure", "next: tractionpower check new"):
        assert word in told
    assert {path.name for path in (tmp_path / "new").iterdir()} == {
        "study.yaml",
        "line.yaml",
        "supply.yaml",
        "timetable.yaml",
        "rollingstock",
    }
    assert main(["check", "new"]) == 0


def test_a_timetable_beside_its_line_replaces_one_only_when_forced(tmp_path, capsys):
    old = (tmp_path / "six" / "timetable.yaml").read_text(encoding="utf-8")
    assert main(["import", "timetable", "plan.csv", "six", "--train", "local"]) == 2
    assert "timetable.yaml already; --force" in capsys.readouterr().err
    assert (tmp_path / "six" / "timetable.yaml").read_text(encoding="utf-8") == old
    assert main(["import", "timetable", "plan.csv", "six", "--train", "local", "--force"]) == 0
    assert 'id: "11"' in (tmp_path / "six" / "timetable.yaml").read_text(encoding="utf-8")
    assert main(["check", "six"]) == 0


def test_problems_are_1_and_nothing_is_written(tmp_path, plan, capsys):
    plan.write_text(PLAN.replace("06:07", "05:07"), encoding="utf-8")
    assert main(["import", "timetable", "plan.csv", "new", "--line", "six", "--train", "locl"]) == 1
    told = capsys.readouterr().err
    assert "plan.csv:4: cell B4: found train '11': arrival 05:07:00 at C is before 06:03:00" in told
    assert "did you mean local?" in told
    assert "2 errors; nothing was written" in told
    assert not (tmp_path / "new").exists()


def test_options_reach_the_importer_by_its_own_names(monkeypatch):
    seen = {}

    def read(source, **options):
        seen.update(options)
        return Imported({"line.yaml": "format: 1\n"}, Notes(repaired=["a time"]))

    monkeypatch.setitem(sys.modules, "tractionpower.io.imports.gtfs.reading", types.SimpleNamespace(read_gtfs=read))
    given = ["--repair", "--routes", "1, 2", "--dwell", "25", "--stops", "places.csv", "--stop-tolerance", "80"]
    assert main(["import", "gtfs", "plan.csv", "feed", *given]) == 0
    assert seen == {
        "repair": True,
        "routes": ("1", "2"),
        "min_dwell_s": 25.0,
        "stops": Path("places.csv"),
        "stop_tolerance_m": 80.0,
        "folder": Path("feed"),
    }
    assert Path("feed/line.yaml").is_file()


def test_rolling_stock_alone_is_no_study_to_check(capsys):
    source = Path(__file__).parents[2] / "validation" / "trainruns" / "source" / "trains" / "local.yaml"
    assert main(["import", "railtoolkit", str(source), "stock"]) == 0
    (told,) = [line for line in capsys.readouterr().out.splitlines() if line.startswith("next: ")]
    assert "tractionpower check" not in told
    command, file = told.removeprefix("next: tractionpower ").partition(";")[0].split(" ", 1)
    assert main([command, file, "--out", "curves"]) == 0  # what it says can be done


def test_a_day_that_is_none_is_wrong_usage(capsys):
    source = Path(__file__).parents[2] / "lines" / "wkd" / "source"
    assert main(["import", "gtfs", str(source), "new", "--date", "2023-06-31"]) == 2
    assert "--date 2023-06-31: there is no such day" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["timetabel", "plan.csv", "new"], "did you mean timetable?"),
        (["timetable", "none.csv", "new"], "there is no file or folder none.csv"),
        (["timetable", "plan.csv", "new"], "--line STUDY"),
        (["timetable", "plan.csv", "plan.csv", "--line", "six"], "plan.csv is a file"),
        (["timetable", "plan.csv", "new", "--line", "nowhere"], "there is no study 'nowhere'"),
        (["timetable", "plan.csv", "new", "--line", "six", "--date", "2026-01-01"], "--date is no option of kind timetable"),
        (["timetable", "plan.csv", "new", "--line", "six", "--tracks", "9"], "--tracks 9"),
        (["gtfs", "plan.csv", "six"], "is not empty"),
    ],
)
def test_wrong_usage(tmp_path, arguments, words, capsys):
    assert main(["import", *arguments]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "new").exists()
