"""``tractionpower feasibility``: what it says first, writes and returns."""

import types
from pathlib import Path

import pytest
from fake_feasibility import REMEDIES, judged
from fake_results import make_case
from train_study import FILES, write_train_study

from tractionpower.cli import main
from tractionpower.cli.feasibility_summary import headline, show
from tractionpower.results.results import Results
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

    def found(scenario, judgement, progress=None):
        calls.append(judgement.verdict)
        progress(1, 2)
        words = REMEDIES["search"]
        return types.SimpleNamespace(
            sensitivities="sensitivities", tried=words["tried"], interrupted=words["interrupted"], notes=tuple(words["notes"])
        )

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


def test_results_are_kept_when_the_search_breaks_off(study, search, monkeypatch):
    def broken(*arguments):
        raise KeyboardInterrupt

    write_train_study(study, timetable=TIGHT)
    monkeypatch.setattr(searching, "search", broken)
    assert main(["feasibility", "six", "--no-reports"]) == 3
    assert Results.open("reports/six-feasibility").run["feasibility"]["verdict"] == "infeasible"


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


@pytest.mark.parametrize(
    ("reserve", "words"),
    [
        (None, "no train is late; none has a call"),
        (12.4, "with 12 s of reserve left"),
        (-0.7, "only within the tolerance: 0.7 s"),
    ],
)
def test_headlines(reserve, words):
    told = {"verdict": "feasible", "reserve_left_s": reserve, "tolerance_s": 1.0, "trains": [{}] * 3, "late_trains": 0}
    assert headline(told).startswith("FEASIBLE")
    assert words in headline(told)
