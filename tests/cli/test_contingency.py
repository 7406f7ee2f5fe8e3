"""``tractionpower contingency``: what it says, writes and returns."""

import json
from pathlib import Path

import pytest
from small_files import STUDY, write_small_study

from tractionpower.cli import main
from tractionpower.cli.contingency_summary import headline
from tractionpower.results.results import Results
from tractionpower.studies.runner import run as running

OPTIONS = ["--no-reports", "--workers", "1", "--out", "out"]
STRONG = STUDY["supply.yaml"].replace("0.12", "0.06")


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    """Return a small network study, in the working folder."""
    monkeypatch.chdir(tmp_path)
    return write_small_study(tmp_path / "small")


def test_outages_that_violate_a_limit(capsys):
    options = [*OPTIONS, "--only", "substation", "--grid", "normal,low", "--set", "supply.loads[train].power_kw=9000"]
    options += ["--set", "supply.loads[train].limits=range"]
    assert main(["contingency", "small", *options]) == 0
    told = capsys.readouterr()
    assert "2 outages in 4 cases, 2 base cases" in told.err
    assert "FAILS: 2 of 2 outages fail, none of them at something that holds" in told.out
    assert "A bypassed, grid low" in told.out
    results = Results.open("out")
    assert (results.run["study"], results.run["kind"]) == ("small", "contingency")
    assert len(results.table("cases")) == 6
    assert main(["contingency", "small", *options, "--strict"]) == 4
    assert Results.open("out").run["cases"]["reused"] == 0  # it was complete, so all is computed again


def test_whole_results_of_each_case_are_written_where_they_are_asked_for():
    options = ["--only", "substation", "--device", "A", "--grid", "normal", "--full-tables"]
    assert main(["contingency", "small", *OPTIONS, *options]) == 0
    folders = [Results.open(path.parent) for path in sorted(Path("out-cases").glob("*/run.json"))]
    lowest = sorted(float(each.table("profile")["lowest_voltage_v"].min()) for each in folders)
    assert lowest == pytest.approx(sorted(Results.open("out").table("cases")["lowest_voltage_v"]), abs=1e-3)


def test_cases_that_cannot_be_served_are_told(capsys):
    options = ["--only", "substation", "--grid", "normal", "--set", "supply.loads[train].power_kw=9000"]
    assert main(["contingency", "small", *OPTIONS, *options]) == 3
    assert "A bypassed (flagged)" in capsys.readouterr().out
    reasons = Results.open("out").table("cases").set_index("case")["reason"]
    assert reasons["A bypassed"] == "60 steps did not converge or could not be served"


def test_outages_that_hold(study, capsys):
    (study / "supply.yaml").write_text(STRONG.replace("power_kw: 3000", "power_kw: 300"), encoding="utf-8")
    assert main(["contingency", "small", *OPTIONS, "--only", "unit", "--grid", "normal", "--strict"]) == 0
    told = capsys.readouterr()
    assert "HOLDS: all 2 outages hold" in told.out
    assert "without a rating, so not judged: 2 rectifier units, 2 substations" in told.out


def test_what_is_chosen_is_kept_with_the_results():
    options = ["--only", "feeder", "--only", "unit", "--device", "A", "--grid", "normal", "--pairs"]
    assert main(["contingency", "small", *OPTIONS, *options]) == 0
    results = Results.open("out")
    assert sorted(results.table("cases")["case"]) == [
        "A 1 high_km open", "A unit rectifiers_out", "A unit rectifiers_out + A 1 high_km open", "base",
    ]  # fmt: skip
    wish = json.loads(Path("out/scenario.json").read_text(encoding="utf-8"))["contingency"]
    assert (wish["kinds"], wish["devices"], wish["grid_voltages"]) == (["feeder", "unit"], ["A"], ["normal"])


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--only", "substatoin"], 2, "did you mean substation?"),
        (["--grid", "normal,lwo"], 2, "allowed are normal, low, high"),
        (["--device", "Lodz"], 1, "--device"),
        (["--device", "A 1 highkm"], 1, "did you mean A 1 high_km?"),
        (["--device", "A", "--only", "section_cabin"], 1, "there is no outage of kind section_cabin at A"),
        (["--set", "supply.substations[A].km=99"], 1, "error"),
    ],
)
def test_wrong_options_are_told(options, code, words, capsys):
    assert main(["contingency", "small", *OPTIONS, *options]) == code
    assert words in capsys.readouterr().err


def test_ctrl_c_keeps_what_was_computed_and_the_same_command_goes_on(monkeypatch, capsys):
    whole = running.new_crew
    calls = []

    def broken(*arguments):
        crew = whole(*arguments)
        start = crew.start

        def stop(task):
            calls.append(task)
            if len(calls) == 3:
                raise KeyboardInterrupt
            start(task)

        crew.start = stop
        return crew

    monkeypatch.setattr(running, "new_crew", broken)
    options = [*OPTIONS, "--only", "substation", "--only", "unit", "--grid", "normal"]
    assert main(["contingency", "small", *options]) == 3
    assert "interrupted after 2 of 5 cases; the same command goes on from there" in capsys.readouterr().err
    assert main(["contingency", "small", *options]) == 0
    assert "2 cases of an earlier call were not run again" in capsys.readouterr().err
    assert Results.open("out").run["cases"]["reused"] == 2


def test_headlines_say_what_fails_already_without_an_outage():
    told = {
        "verdict": "fails", "outages": {"all": 5, "failing": 4, "beyond_base": 1},
        "not_computed": [{}], "base": [{"fails": ["overload"]}, {"fails": ["overload", "late trains"]}],
    }  # fmt: skip
    assert headline(told) == (
        "FAILS: 4 of 5 outages fail, 1 of them at something that holds with nothing out;"
        " with nothing out: overload, late trains; 1 case could not be computed"
    )
    assert headline(told | {"verdict": "not judged", "base": [], "failing": 0}).startswith("NOT JUDGED")
