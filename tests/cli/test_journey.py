"""``tractionpower journey``: what it writes, says and returns."""

import json
import re
from pathlib import Path

import pytest
from fake_journeys import make_journey, make_line
from train_study import FILES, write_train_study

from tractionpower.cli import journey as command
from tractionpower.cli import main
from tractionpower.cosimulation.calls import call_rows
from tractionpower.results.results import Results
from tractionpower.studies import journeys as studies


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    """Return the small study, in the working folder."""
    monkeypatch.chdir(tmp_path)
    return write_train_study(tmp_path / "six")


FILES_WRITTEN = {"trains.parquet", "calls.parquet", "run.json", "key_figures.json", "scenario.json", "figures"}
STEEP = ["--set", "line.gradients[1].permille=90", "--set", "vehicles[railcar].drive.starting_effort_kn=80"]


def results_of(folder="reports/six/journey"):
    return Results.open(folder)


def test_tables_figures_and_words(capsys):
    assert main(["journey", "six"]) == 0
    told = capsys.readouterr()
    folder = Path("reports/six/journey")
    assert {path.name for path in folder.iterdir()} == FILES_WRITTEN
    assert {path.name for path in (folder / "figures").iterdir()} == {"train_graph.png", "train-11.png", "train-EC 2%2F1.png"}
    assert all(path.stat().st_size > 5000 for path in (folder / "figures").iterdir())
    assert "theoretical journeys at 3000 V" in told.out
    results = results_of()
    run = round(results.key_figure("running_time_s", "train 11"))
    taken = results.key_figure("energy_taken_kwh", "train 11")
    row = next(line for line in told.out.splitlines() if "Alfa – Charlie" in line)
    assert f"00:{run // 60:02d}:{run % 60:02d}" in row
    assert f"{taken:.1f}" in row
    call = results.table("calls").query("station == 'B' and kind == 'arrival'").iloc[0]
    row = next(line for line in told.out.splitlines() if "Łódź Bravo" in line)
    assert re.search(rf"arrival +06:03:00 +06:\d\d:\d\d +{call['late_s']:+.0f}\b", row)
    assert f"results: {folder}" in told.err
    assert main(["journey", "six", "--no-reports"]) == 0  # the same study replaces its own results


def test_options(tmp_path):
    options = ["--train", "11", "--voltage", "2500", "--step", "0.5", "--form", "speed"]
    options += ["--set", "trains[local].max_speed_kmh=60"]
    assert main(["journey", "six/study.yaml", *options, "--out", "here", "--no-reports"]) == 0
    results = results_of("here")
    assert [results.run[name] for name in ("voltage_v", "step_s", "form")] == [2500.0, 0.5, "speed"]
    assert [note["train"] for note in results.run["journeys"]] == ["11"]
    assert results.key_figure("highest_speed_kmh") == pytest.approx(60.0, abs=0.01)
    assert not (tmp_path / "reports").exists()
    assert not (tmp_path / "here" / "figures").exists()


def test_a_run_and_journeys_of_a_study_do_not_mix(tmp_path, capsys):
    assert main(["journey", "six", "--no-reports"]) == 0
    (tmp_path / "six" / "study.yaml").write_text(FILES["study.yaml"].replace("timetable: timetable.yaml\n", ""), encoding="utf-8")
    assert main(["run", "six", "--no-reports"]) == 0  # reports/six holds nothing but the journeys
    assert results_of().run["study"] != results_of("reports/six").run["study"] == "six"
    write_train_study(tmp_path / "six")
    capsys.readouterr()
    assert main(["journey", "six", "--out", "reports/six"]) == 2
    assert "another study" in capsys.readouterr().err
    assert main(["journey", "six", "--out", "reports/six", "--force", "--no-reports"]) == 0


def test_a_folder_with_other_files_is_refused_unless_forced(tmp_path, capsys):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine", encoding="utf-8")
    assert main(["journey", "six", "--out", "mine"]) == 2
    assert "no results of a run" in capsys.readouterr().err
    assert main(["journey", "six", "--out", "mine", "--force", "--no-reports"]) == 0
    assert (tmp_path / "mine" / "notes.txt").is_file()


def test_problems_of_inputs_and_timetable_are_told_with_file_and_line(tmp_path, study, capsys):
    supply = FILES["supply.yaml"].replace("id: S, km: 0.0", "id: S, km: 99.0")
    line = FILES["line.yaml"].replace("from_km: 0.0, to_km: 6.5, kmh", "from_km: 0.0, to_km: 5.0, kmh")
    write_train_study(study, supply=supply, line=line)
    assert main(["journey", "six"]) == 1
    told = capsys.readouterr().err
    assert re.search(r"supply\.yaml:\d+: supply\.substations\[S\]\.km", told)
    assert not (tmp_path / "reports").exists()


def test_a_broken_file_is_told(study, capsys):
    (study / "timetable.yaml").write_text("format: 1\ntrains: 5\n", encoding="utf-8")
    assert main(["journey", "six"]) == 1
    assert "timetable.yaml:2: timetable.trains" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--train", "EC 2"], "no train 'EC 2', did you mean EC 2/1?"),
        (["--voltage", "0"], "--voltage 0: allowed are 1 to 100000 V"),
        (["--voltage", "nan"], "--voltage nan"),
        (["--step", "9"], "--step 9: allowed are 0.02 to 5 s"),
        (["--form", "place"], "--form"),
    ],
)
def test_wrong_usage(tmp_path, options, words, capsys):
    assert main(["journey", "six", *options]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


def test_a_study_without_trains(study, capsys):
    write_train_study(study, timetable="format: 1\ntrains: []\n")
    assert main(["journey", "six"]) == 2
    assert "the study has no trains" in capsys.readouterr().err


def test_a_stuck_train_is_kept_told_and_3(capsys):
    assert main(["journey", "six", *STEEP, "--train", "11"]) == 3
    told = capsys.readouterr()
    assert "train 11 is stuck on track 1 at km " in told.err
    assert re.search(r"^11 .*stuck", told.out, re.MULTILINE)
    results = results_of()
    assert results.run["status"] == "flagged"
    assert len(results.table("trains")) > 60
    assert Path("reports/six/journey/figures/train-11.png").is_file()


def test_of_many_trains_the_first_twelve_or_those_named_get_figures(monkeypatch, capsys):
    line = make_line()
    scenario = type("Study", (), {"line": line, "name": "many"})
    names = [f"T{k:02d}" for k in range(14)]
    made = tuple(make_journey(line, name, start_s=21600.0 + 60.0 * k) for k, name in enumerate(names))
    said = {"status": "complete", "ledgers": {}}
    calls = {each.run.id: call_rows(each.run.id, each.calls, studies.route_end(each)) for each in made}
    outcome = studies.JourneyOutcome(made, 3000.0, calls, run=said)
    drawn = []

    def compute(*arguments, **options):
        figures = [f.as_dict() for each in made for f in studies._figures(each)]
        return type("Outcome", (), {**vars_of(outcome), "key_figures": figures, "complete": True}), type("W", (), {"beside": []})

    monkeypatch.setattr(command, "_compute", compute)
    monkeypatch.setattr(command, "_write_figures", lambda outcome, scenario, folder, shown: drawn.append(list(shown)))
    monkeypatch.setattr(studies, "choose_runs", lambda scenario, named: names)
    assert main(["journey", "six"]) == 0
    told = capsys.readouterr()
    assert drawn == [names[:12]]
    assert "first 12 of 14 trains" in told.err
    assert told.out.count("Alfa – ") == 14
    assert told.out.count("Bravo") == 12
    assert main(["journey", "six", *(word for name in names for word in ("--train", name))]) == 0
    assert drawn[-1] == names
    assert scenario.name == "many"


def vars_of(outcome):
    return {name: getattr(outcome, name) for name in ("journeys", "voltage_v", "calls", "run", "warnings")}


def test_figures_that_cannot_be_written(tmp_path, capsys):
    assert main(["journey", "six", "--no-reports"]) == 0
    (tmp_path / "reports" / "six" / "journey" / "figures").write_text("in the way", encoding="utf-8")
    assert main(["journey", "six", "--train", "11"]) == 3
    told = capsys.readouterr()
    assert "the tables are complete" in told.err
    assert "theoretical journeys at 3000 V" in told.out


def test_ctrl_c_leaves_no_trace(tmp_path, monkeypatch, capsys):
    def interrupt(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(studies, "theoretical_journeys", interrupt)
    assert main(["journey", "six"]) == 3
    assert "interrupted" in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


def test_run_json_says_what_the_journeys_were():
    assert main(["journey", "six", "--no-reports"]) == 0
    run = json.loads(Path("reports/six/journey/run.json").read_text(encoding="utf-8"))
    assert {"format", "status", "study", "input_hash", "seed", "versions", "wall_seconds", "steps", "files"} <= set(run)
    assert run["verdicts"] == []
    assert run["compile_seconds"] > 0.0
    assert [note["status"] for note in run["journeys"]] == ["complete", "complete"]
