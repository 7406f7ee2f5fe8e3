"""``tractionpower size``: what it says, writes and returns, and the search for equipment behind it."""

import json
from pathlib import Path

import pytest
from train_study import FILES, write_train_study

from tractionpower.cli import main
from tractionpower.cli.size_summary import headline, search_headline
from tractionpower.results.results import Results
from tractionpower.studies.ratings.words import KINDS, counted
from tractionpower.studies.sizing_search import search as searching

PLAIN = "no_load_voltage_v: 3300, internal_resistance_ohm: 0.1}"
RATED = (
    "no_load_voltage_v: 3300, unit: PD-12, units: 2, unit_resistance_ohm: 0.16, grid_resistance_ohm: 0.01, trip_current_a: 1500}"
)
SHORT = "--set=clock.end=06:15:00"
RATED_LOW = "--set=supply.substations[S].rated_current_a=20"


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    """Return the small study with rated units, in the working folder."""
    monkeypatch.chdir(tmp_path)
    folder = write_train_study(tmp_path / "six")
    (folder / "supply.yaml").write_text(FILES["supply.yaml"].replace(PLAIN, RATED))
    return folder


def test_a_supply_that_holds(capsys):
    assert main(["size", "six", "--no-reports", "--strict", SHORT]) == 0
    told = capsys.readouterr()
    assert told.out.strip().startswith("PASS: all 2 rated devices within 100 % (most S")
    assert "rectifier units" in told.out
    assert "peak of feeders, of the setting of the breaker" in told.out
    assert "without a rating, not judged: 2 feeders" in told.out
    assert "results: reports/six-size" in told.err
    results = Results.open("reports/six-size")
    assert results.run["kind"] == "size"
    assert {"ratings", "peaks", "breakers", "demand", "useful_voltage", "trains"} <= set(results.tables)


def test_one_that_does_not_hold_and_its_reports(capsys):
    assert main(["size", "six", SHORT, RATED_LOW, "--strict", "--no-reports"]) == 4
    told = capsys.readouterr().out.strip()
    assert told.startswith("FAIL: 2 of 2 rated devices beyond 100 %")
    assert "beyond their ratings, the worst first: S" in told
    assert "FAILS" in told
    folder = Path("reports/six-size")
    assert main(["report", str(folder)]) == 0  # from the tables alone
    assert (folder / "report.xlsx").is_file()
    assert main(["size", "six", SHORT, RATED_LOW, "--no-reports"]) == 0
    assert "is of an earlier run" in capsys.readouterr().err


def test_the_verdict_as_json(capsys):
    assert main(["size", "six", SHORT, "--no-reports", "--json"]) == 0
    said = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert (said.pop("format"), said.pop("study"), said["folder"]) == (1, "six", "reports/six-size")
    assert said == Results.open(said.pop("folder")).run["size"]


def test_a_search_finds_what_is_enough_and_goes_on_after_ctrl_c(capsys, monkeypatch):
    command = ["size", "six", SHORT, "--no-reports", "--search", "--workers", "1", "--set=sizing.search.outages=false"]
    whole, runs = searching.Trials.evaluate, []

    def broken(self, design, only=None):
        if runs:
            self.interrupted = True
            return {}
        runs.append(1)
        return whole(self, design, only)

    monkeypatch.setattr(searching.Trials, "evaluate", broken)
    assert main(command) == 3
    told = capsys.readouterr()
    assert "SEARCH BROKEN OFF" in told.out
    assert "the same command goes on from its runs" in told.err
    folder = Path("reports/six-size")
    assert list((folder / ".running" / "continued").rglob("*"))
    assert Results.open(folder).run["size"]["search"]["interrupted"]

    monkeypatch.setattr(searching.Trials, "evaluate", whole)
    assert main(command) == 0
    out = capsys.readouterr().out
    assert "FOUND: meets all limits in " in out
    assert "try it: --set 'supply.substations[S].units=1'" in out
    found = Results.open(folder).run["size"]["search"]
    assert (found["holds"], found["verified"], found["interrupted"]) == (True, True, False)
    assert not (folder / ".running").exists()


@pytest.mark.parametrize("option", [["--workers", "2"], ["--scheduler", "tcp://127.0.0.1:8786"]])
def test_options_of_the_search_are_refused_without_it(option, capsys):
    assert main(["size", "six", SHORT, *option]) == 2
    assert f"{option[0]}: only with --search" in capsys.readouterr().err


def test_a_search_with_nothing_to_vary_is_refused_before_the_run(capsys):
    keep = ["--set=sizing.search.most_units=2", "--set=sizing.search.fewest_units=2"]
    assert main(["size", "six", "--search", *keep]) == 2
    assert "nothing to vary" in capsys.readouterr().err
    assert not Path("reports/six-size").exists()


def test_ctrl_c_while_the_timetable_runs(monkeypatch, capsys):
    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("tractionpower.studies.ratings.study.lowest_useful", interrupt)
    assert main(["size", "six", SHORT, "--no-reports"]) == 3
    told = capsys.readouterr().err
    assert "interrupted after 900 of 900 steps; what was computed is kept in " in told
    assert Results.open("reports/six-size", partial=True).run["status"] == "interrupted"


def test_inputs_with_errors_are_told_by_file(study, capsys):
    (study / "supply.yaml").write_text(FILES["supply.yaml"].replace("km: 0.0", "km: -7.0", 1))
    assert main(["size", "six"]) == 1
    assert "supply.yaml" in capsys.readouterr().err
    assert not Path("reports").exists()


def test_verdicts_in_words():
    told = {"verdict": "fail", "permitted_percent": 90.0, "rated": 12, "devices": 20}
    told |= {"failing": ["a"], "failing_breakers": ["b", "c"], "failing_contracts": []}
    assert headline(told) == (
        "FAIL: 1 of 12 rated devices beyond 90 %, 2 feeders beyond what breakers are set to;"
        " 8 more have no rating and are not judged"
    )
    assert headline(told | {"verdict": "not rated"}).startswith("NOT RATED: none of 20 devices")
    found = {
        "holds": False,
        "interrupted": False,
        "runs": 9,
        "rounds": 3,
        "cases": 5,
        "design": [],
        "cost_found": 4,
        "cost_declared": 5,
    }
    assert search_headline(found).startswith("NO DESIGN within the bounds meets all limits (9 runs, 3 designs)")
    assert search_headline(found | {"holds": True}).startswith("NO LESS: what is declared meets all limits in 5 cases")
    assert {counted(1, kind) for kind in KINDS}.isdisjoint({f"1 {words}" for words in KINDS.values()})
