"""``tractionpower sweep``: what it says, writes and returns."""

from pathlib import Path

import pytest
from small_files import write_small_study

from tractionpower.cli import main
from tractionpower.results.results import Results

R = "supply.substations[A].internal_resistance_ohm"


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return write_small_study(tmp_path / "small")


def test_a_grid_with_reports(capsys):
    assert main(["sweep", "small", "--vary", f"{R}=0.1,0.3", "--vary", "clock.end=00:00:05,nonsense", "--workers", "1"]) == 0
    told = capsys.readouterr()
    assert "4 variants and the base" in told.err
    lines = told.out.splitlines()
    assert any(line.startswith("base") for line in lines)
    assert any("REFUSED" in line for line in lines)
    assert any(line.startswith("case 02, the inputs have errors: clock.end") for line in lines)
    assert any(line.startswith("lowest voltage [V]: worst") for line in lines)
    folder = Path("reports/small-sweep")
    assert (folder / "report.xlsx").is_file()
    assert (folder / "figures" / "sweep_maps.png").is_file()
    (folder / "report.xlsx").unlink()
    assert main(["report", str(folder)]) == 0
    assert (folder / "report.xlsx").is_file()


def test_cases_from_a_file_a_sample_and_whole_tables(capsys):
    Path("cases.csv").write_text(f"case;{R}\nstrong;0,05\nweak;0,4\n", encoding="utf-8")
    assert main(["sweep", "small", "--cases", "cases.csv", "--full-tables", "--no-reports", "--workers", "1", "--out", "x"]) == 0
    assert list(Results.open("x").table("cases")["case"]) == ["base", "strong", "weak"]
    assert {path.name for path in Path("x-cases").iterdir()} == {"base", "strong", "weak"}
    assert main(["compare", "x-cases/base", "x-cases/strong", "--no-reports", "--out", "y"]) == 0
    assert f"{R}: 0.12 -> 0.05" in capsys.readouterr().out
    sample = ["--sample", "2", "--range", f"{R}=log:0.05..0.4", "--seed", "9"]
    assert main(["sweep", "small", *sample, "--no-reports", "--workers", "1", "--out", "s"]) == 0
    assert Results.open("s").run["sweep"]["sample"] == {"count": 2, "seed": 9}


def test_all_paths_that_do_not_exist_are_told_before_anything_runs(capsys):
    assert main(["sweep", "small", "--vary", "supply.substation[A].km=1,2", "--vary", "clock.ende=3"]) == 1
    told = capsys.readouterr().err
    assert "did you mean 'substations'" in told
    assert "did you mean 'end'" in told
    assert "2 errors" in told
    assert not Path("reports").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ([], 2, "nothing to vary"),
        (["--sample", "3"], 2, "needs both"),
        (["--vary", "clock.end"], 1, "names no values"),
        (["--vary", "clock.end=1,1", "--range", "x=3"], 1, "2 errors"),
        (["--cases", "nowhere.csv"], 1, "no file nowhere.csv"),
        (["--vary", f"{R}=-1,-2"], 1, "-2"),
    ],
)
def test_what_cannot_be_done_is_told(arguments, code, words, capsys):
    assert main(["sweep", "small", *arguments]) == code
    assert words in capsys.readouterr().err


def test_a_violated_limit_counts_with_strict_only(capsys):
    grid = ["--vary", "supply.substations[*].no_load_voltage_v=3600,4200", "--no-reports", "--workers", "1"]
    assert main(["sweep", "small", *grid]) == 0
    assert main(["sweep", "small", *grid, "--strict"]) == 4
    capsys.readouterr()
