"""``tractionpower feasibility``: what it says first, writes and returns."""

import json
import os
import signal
import subprocess
import sys
import time
import types
from functools import partial
from pathlib import Path

import pytest
from fake_feasibility import REMEDIES, judged
from fake_results import make_case
from train_study import FILES, write_train_study

from tractionpower.cli import main
from tractionpower.cli.feasibility_summary import headline, show
from tractionpower.reporting.workbook.feasibility.feasibility import verdict_in_words
from tractionpower.results.results import Results
from tractionpower.studies import feasibility
from tractionpower.studies.feasibility import study as whole
from tractionpower.studies.remedies import remedy
from tractionpower.studies.remedies import search as searching

TIGHT = FILES["timetable.yaml"].replace('arrival: "06:06:00"}', 'arrival: "06:05:10"}')
LOOSE = FILES["timetable.yaml"].replace('"06:03:00", departure: "06:03:20"', '"06:04:00", departure: "06:04:20"')
LOOSE = LOOSE.replace('"06:05:00"', '"06:06:00"').replace('arrival: "06:06:00"}\n  - id: EC', 'arrival: "06:10:00"}\n  - id: EC')


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    """Return the small study, in the working folder."""
    monkeypatch.chdir(tmp_path)
    return write_train_study(tmp_path / "six", timetable=LOOSE)


@pytest.fixture
def search(monkeypatch):
    """Stand in for the search; return the calls that it gets."""
    calls = []

    def found(scenario, judgement, progress=None, *, folder=None):
        calls.append(judgement.verdict)
        progress(1, 2)
        assert Results.open(folder.parent.parent).run["feasibility"]["verdict"] == judgement.verdict  # written before it begins
        words = REMEDIES["search"]
        return types.SimpleNamespace(
            sensitivities="sensitivities", tried=words["tried"], interrupted=words["interrupted"], notes=tuple(words["notes"]),
            stopped=False, reused=0,
        )  # fmt: skip

    monkeypatch.setattr(searching, "search", found)
    monkeypatch.setattr(remedy, "as_notes", lambda items: REMEDIES["sensitivities" if items == "sensitivities" else "remedies"])
    return calls


def test_a_timetable_that_holds(search, capsys):
    assert main(["feasibility", "six", "--no-reports", "--strict"]) == 0
    told = capsys.readouterr()
    assert told.out.strip().startswith("FEASIBLE, with ")
    assert "least reserve, trains on time" in told.out
    assert "results: reports/six-feasibility" in told.err
    assert search == []
    results = Results.open("reports/six-feasibility")
    assert results.run["feasibility"]["verdict"] == "feasible"
    assert {"delays", "sections", "trains"} <= set(results.tables)


def test_one_that_does_not_hold_is_searched_and_reported(study, search, capsys):
    write_train_study(study, timetable=TIGHT)
    assert main(["feasibility", "six", "--strict"]) == 4
    told = capsys.readouterr()
    lines = told.out.strip().splitlines()
    assert lines[0].startswith("INFEASIBLE: 1 of 2 trains late or not there (tolerance 1 s)")
    assert lines[1].startswith("worst: train 11: late ")
    assert "timetable too tight" in told.out
    assert "departure shift, 1001" in told.out
    assert "try it: --set 'timetable.trains[1001].calls[0].departure=06:06:00'" in told.out
    assert search == ["infeasible"]
    folder = Path("reports/six-feasibility")
    assert Results.open(folder).run["feasibility"]["search"]["tried"] == 73
    assert {"delay_graph.png", "delays_by_cause.png"} <= {path.name for path in (folder / "figures").iterdir()}
    (folder / "report.xlsx").unlink()
    (folder / "figures" / "delay_graph.png").unlink()
    assert main(["report", str(folder)]) == 0  # from the tables alone
    assert (folder / "report.xlsx").is_file()
    assert (folder / "figures" / "delay_graph.png").is_file()


def test_without_search_and_with_another_tolerance(study, search, capsys):
    write_train_study(study, timetable=TIGHT)
    assert main(["feasibility", "six", "--no-reports", "--no-search"]) == 0
    assert search == []
    assert main(["feasibility", "six", "--no-reports", "--strict", "--tolerance", "600", "--out", "here"]) == 0
    assert "FEASIBLE" in capsys.readouterr().out
    assert Results.open("here").run["feasibility"]["tolerance_s"] == 600.0


BOUNDS = {"kinds": ["reserve", "departure_shift"], "subjects": 1, "sensitivities": 0, "workers": 1}
SEARCHED = "--set=remedies=" + json.dumps(BOUNDS)


def test_a_search_that_is_broken_off_goes_on_when_the_study_is_judged_again(study, monkeypatch, capsys):
    write_train_study(study, timetable=TIGHT)
    lateness, runs = feasibility.lateness, []

    def counted(scenario):
        if len(runs) == 4:
            raise KeyboardInterrupt
        runs.append(1)
        return lateness(scenario)

    command = ["feasibility", "six", "--no-reports", SEARCHED]
    monkeypatch.setattr(feasibility, "lateness", counted)
    assert main(command) == 3
    told = capsys.readouterr()
    assert told.out.strip().startswith("INFEASIBLE")
    assert "goes on from its trial runs" in told.err
    assert "Traceback" not in told.err
    folder = Path("reports/six-feasibility")
    found = Results.open(folder).run["feasibility"]
    assert (found["verdict"], found["search"]["interrupted"]) == ("infeasible", True)
    assert 0 < found["search"]["tried"] <= 4
    assert (folder / ".running" / "continued" / "remedies.json").is_file()
    before = {path.name for path in folder.iterdir()} - {".running"}

    monkeypatch.setattr(feasibility, "lateness", lateness)
    assert main(command) == 0
    told = capsys.readouterr()
    assert f"{found['search']['tried']} trial runs of before are reused" in told.err
    resumed = Results.open(folder).run["feasibility"]
    assert not resumed["search"]["interrupted"]
    assert {path.name for path in folder.iterdir()} == before  # what it went on from is gone
    assert main([*command, "--out", "fresh"]) == 0
    assert resumed == Results.open("fresh").run["feasibility"]
    assert any(remedy["verified"] and remedy["feasible"] for remedy in resumed["remedies"])


def test_ctrl_c_while_the_timetable_runs(study, monkeypatch, capsys):
    assert main(["feasibility", "six", "--no-reports"]) == 0
    before = Path("reports/six-feasibility/run.json").read_bytes()

    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(whole, "judge_outcome", interrupt)
    capsys.readouterr()
    assert main(["feasibility", "six", "--no-reports"]) == 3
    told = capsys.readouterr().err
    assert "interrupted after 3600 of 3600 steps; what was computed is kept in " in told
    assert "`tractionpower report reports/six-feasibility --partial` makes reports of it" in told
    folder = Path("reports/six-feasibility")
    partial = Results.open(folder, partial=True)
    assert partial.run["status"] == "interrupted"
    assert "feasibility" not in partial.run
    assert len(partial.table("trains")) > 0
    assert (folder / "run.json").read_bytes() == before
    assert main(["report", str(folder), "--partial"]) == 0
    assert (folder / "partial" / "report.xlsx").is_file()


@pytest.mark.skipif(os.name != "posix", reason="sends a signal as a terminal does")
def test_a_real_ctrl_c_in_the_middle(study):
    ready = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
    command = [sys.executable, "-m", "tractionpower", "feasibility", "six", "--set", "clock.end=900:00:00"]
    command += ["--set", "clock.step_s=0.02"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=ready) as ran:  # noqa: PLW1509
        waited = time.monotonic() + 120
        while len(list(Path().glob("reports/*/.running/*/substations-*.parquet"))) < 2 and time.monotonic() < waited:
            assert ran.poll() is None, ran.communicate()
            time.sleep(0.05)
        ran.send_signal(signal.SIGINT)
        out, err = ran.communicate(timeout=60)
    assert ran.returncode == 3, err
    assert "Traceback" not in err
    assert out == ""
    assert Results.open("reports/six-feasibility", partial=True).run["status"] == "interrupted"


def test_ctrl_c_before_the_first_step_leaves_nothing(tmp_path, monkeypatch):
    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("tractionpower.cosimulation.run.compile_scenario", interrupt)
    assert main(["feasibility", "six"]) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["six"]


def test_the_verdict_as_json(study, search, capsys):
    write_train_study(study, timetable=TIGHT)
    assert main(["feasibility", "six", "--no-reports", "--json", "--strict"]) == 4
    said = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert (said.pop("format"), said.pop("study"), said["folder"]) == (1, "six", "reports/six-feasibility")
    assert said == Results.open(said.pop("folder")).run["feasibility"]
    assert said["verdict"] == "infeasible"
    assert said["search"]["tried"] == 73


def test_another_study_file_has_results_of_its_own(study):
    (study / "other.yaml").write_text((study / "study.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    assert main(["feasibility", "six/other.yaml", "--no-reports"]) == 0
    assert Path("reports/six-other-feasibility/run.json").is_file()


def test_bad_input_and_wrong_usage(study, capsys):
    assert main(["feasibility", "six", "--tolerance", "-1"]) == 2
    write_train_study(study, timetable="format: 1\ntrains: []\n")
    assert main(["feasibility", "six"]) == 2
    assert "no trains" in capsys.readouterr().err
    write_train_study(study, timetable=TIGHT.replace("station: P", "station: Q"))
    assert main(["feasibility", "six"]) == 1
    assert "timetable.yaml:" in capsys.readouterr().err
    assert not Path("reports").exists()


def summary_of(capsys, run):
    show(run)
    return capsys.readouterr().out


def test_the_summary_shows_the_latest_first_and_says_what_is_left_out(capsys):
    results, scenario = make_case(trains=20)
    late = {f"{1000 + k}": {"voltage": 10.0 + k, "dwell": 1.0} for k in range(15)}
    told = summary_of(capsys, judged(results, scenario, late).run)
    rows = [line.split()[0] for line in told.splitlines() if line.startswith("10")]
    assert rows[:12] == [f"{1014 - k}" for k in range(12)]
    assert "... and 3 more late trains" in told
    assert "INFEASIBLE: 15 of 20 trains" in told
    assert told.count("late 25 s at") == 1  # the worst one in words; the table has columns for it


def test_the_summary_of_a_search_that_found_nothing(capsys):
    results, scenario = make_case()
    late = {"1001": {"voltage": 10.0}}
    near = [REMEDIES["remedies"][1]]
    told = summary_of(capsys, judged(results, scenario, late, **(REMEDIES | {"remedies": near})).run)
    assert "nothing within the bounds saves it (73 runs); nearest: Train =cmd(): power capped." in told
    assert "Smallest means cheapest." in told
    told = summary_of(capsys, judged(results, scenario, late, **(REMEDIES | {"remedies": []})).run)
    assert "nothing within the bounds saves it (73 runs)" in told


def test_what_was_not_judged_is_not_told_as_feasible():
    told = {"verdict": "not judged", "reserve_left_s": None, "tolerance_s": 1.0, "trains": [{}], "late_trains": 0}
    assert headline(told).startswith("NOT JUDGED: no train comes to a call with a planned time")
    assert "give calls an arrival or a departure (1 train)" in headline(told)
    assert verdict_in_words(told) == (
        "Not judged: none of 1 trains comes to a call with a planned time within the time that counts",
        "doubt",
    )


@pytest.mark.parametrize(
    ("reserve", "words"),
    [
        (None, "no train is late (3 trains"),
        (12.4, "with 12 s of reserve left"),
        (-0.7, "only within the tolerance: 0.7 s"),
    ],
)
def test_headlines(reserve, words):
    told = {"verdict": "feasible", "reserve_left_s": reserve, "tolerance_s": 1.0, "trains": [{}] * 3, "late_trains": 0}
    assert headline(told).startswith("FEASIBLE")
    assert words in headline(told)
