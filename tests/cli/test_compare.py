"""``tractionpower compare``: what it says, writes and returns."""

from pathlib import Path

import pytest
from openpyxl import load_workbook
from read_workbook import read_table, texts
from small_files import write_small_study

from tractionpower.cli import main
from tractionpower.results.results import Results


@pytest.fixture(autouse=True, scope="module")
def runs(tmp_path_factory):
    """Write two runs that are compared by all tests."""
    place = tmp_path_factory.mktemp("runs")
    study = str(write_small_study(place / "small"))
    assert main(["run", study, "--out", str(place / "base"), "--no-reports"]) == 0
    change = ["--set", "supply.substations[A].internal_resistance_ohm=0.3"]
    assert main(["run", study, "--out", str(place / "weak"), "--no-reports", *change]) == 0
    return place


@pytest.fixture(autouse=True)
def _there(runs, monkeypatch):
    monkeypatch.chdir(runs)


def test_two_runs_side_by_side(capsys):
    assert main(["compare", "base", "weaker=weak"]) == 0
    told = capsys.readouterr()
    assert "supply.substations[A].internal_resistance_ohm: 0.12 -> 0.3" in told.out
    assert "lowest_voltage_v" in told.out
    folder = Path("reports/small-compare")
    for name in ("compare.xlsx", "compare.parquet", "figures/compare_voltage.png", "figures/compare_substations.png"):
        assert (folder / name).is_file(), name
    results = Results.open(folder)
    book = load_workbook(folder / "compare.xlsx", data_only=True)
    assert {"Cover", "Run", "Substations", "Inputs that differ", "Verdicts"} <= set(book.sheetnames)
    shown = {(row["figure"], row["place"]): row for row in read_table(book["Substations"])}
    rows = results.table("compare")
    own = rows[(rows["figure"] == "energy_kwh") & (rows["place"] == "substation A")].set_index("folder")
    assert shown["energy", "substation A"]["base"] == pytest.approx(own.loc["base", "value"])
    assert shown["energy", "substation A"]["weaker less base"] == pytest.approx(own.loc["weaker", "difference"])
    assert "substation A: internal resistance [Ω]: 0.12 → 0.3" in texts(book["Cover"])
    (folder / "compare.xlsx").unlink()
    assert main(["report", str(folder)]) == 0
    assert (folder / "compare.xlsx").is_file()


def test_folders_that_hold_no_results(capsys):
    assert main(["compare", "base", "nowhere", "small"]) == 2
    told = capsys.readouterr().err
    assert "nowhere: there is no such folder" in told
    assert "small: no results of a run are there" in told
    assert main(["compare", "base"]) == 2
    assert "at least two" in capsys.readouterr().err


def test_another_base(capsys):
    assert main(["compare", "base", "weak", "--base", "weak", "--no-reports", "--out", "other"]) == 0
    assert "0.3 -> 0.12" in capsys.readouterr().out
    assert Results.open("other").run["compare"]["base"] == "weak"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["base", "weak", "--measured", "m.csv", "--map", "map.yaml"], "2 folders"),
        (["base", "weak", "--json"], "--json prints"),
    ],
)
def test_options_that_do_not_go_together(options, words, capsys):
    assert main(["compare", *options]) == 2
    assert words in capsys.readouterr().err
