"""``tractionpower dynamics run``: what it writes, says and returns; reports and tables of its folder."""

import json
import re
import sys
from pathlib import Path

import pytest
from fake_dynamics import fake_results

from tractionpower.cli import main
from tractionpower.dynamics.session import NotComputableError, Session
from tractionpower.results.results import Results

CASE = """
format: 1
name: A short start
vehicles:
  - {id: v43}
  - {id: wagon-zobory, count: 2, load_percent: 50}
coupling: zobory-linear
traction: {levels: 15, time_constant_s: 0.2}
brake: {brake_ratio: 0.5}
commands:
  - {time_s: 0, drive: 4}
  - {time_s: 3, drive: 0, brake: full_service}
run: {duration_s: 12, step_s: 0.005, record_every_s: 0.1}
"""

PAGE = Path(__file__).parents[2] / "docs" / "dynamics.md"

TABLES = {"vehicles", "couplings", "controls", "coupling_extremes", "distributions", "rainflow"}


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def case(tmp_path):
    """Return the name of a small case in the working folder."""
    (tmp_path / "short").mkdir()
    (tmp_path / "short" / "case.yaml").write_text(CASE, encoding="utf-8")
    return "short"


def run(*arguments):
    return main(["dynamics", "run", *arguments, "--no-reports"])


# --- 0: done


def test_a_case_is_written_where_its_name_says(case, tmp_path, capsys):
    assert run(case) == 0
    told = capsys.readouterr()
    folder = tmp_path / "reports" / "dynamics-short"
    results = Results.open(folder)
    assert set(results.tables) == TABLES
    assert (results.run["kind"], results.run["status"], results.run["study"]) == ("dynamics", "complete", "short")
    assert results.run["steps"] >= 2400
    assert results.run["ledgers"]["energy"]["closes"]
    assert results.scenario.name == "A short start"
    assert results.row_count("controls") == 121
    assert "greatest tension" in told.out and "stopping distance" in told.out and "energy ledger closes" in told.out
    assert "coupling 1-2" in told.out
    assert "results: " in told.err


def test_the_summary_says_what_the_results_hold(case, capsys):
    assert run(case) == 0
    told = capsys.readouterr().out
    results = Results.open("reports/dynamics-short")
    line = next(line for line in told.splitlines() if line.startswith("greatest tension"))
    assert f"{results.key_figure('greatest_tension_kn'):.1f}" in line.split()
    assert "0.0001 % is the limit for symplectic" in told
    line = next(line for line in told.splitlines() if line.startswith("stopping distance"))
    assert f"{results.key_figure('stopping_distance_m'):.2f}" in line.split()


def test_what_reading_has_found_is_kept_with_the_results(capsys):
    assert run("arshad", "--set", "case.run.duration_s=2") == 0
    told = " ".join(capsys.readouterr().err.split())
    kept = Results.open("reports/dynamics-arshad").run["warnings"]
    assert [warning for warning in kept if "state vector" in warning.lower()], kept
    assert told.lower().count("state vector size") == 1, "told once"


def test_method_and_step_come_from_the_options(case):
    assert run(case, "--method", "rk4", "--step-s", "0.01", "--out", "rk4") == 0
    results = Results.open("rk4")
    assert (results.run["method"], results.run["step_s"]) == ("rk4", 0.01)
    assert results.scenario.case.run.method == "rk4"
    assert run(case, "--set", "case.run.method=rk4", "--set", "case.run.step_s=0.01", "--out", "set") == 0
    assert Results.open("set").run["input_hash"] == results.run["input_hash"]


def test_couplings_are_changed_by_their_identifier(case):
    assert run(case) == 0
    assert run(case, "--set", "couplings[zobory-linear].draw.stiffness_kn_per_mm=2.5", "--out", "soft") == 0
    hard, soft = (Results.open(folder).table("couplings") for folder in ("reports/dynamics-short", "soft"))
    assert soft["deflection_mm"].max() > 1.7 * hard["deflection_mm"].max()


def test_tables_go_to_other_programs(case, tmp_path):
    assert run(case) == 0
    assert main(["export", "reports/dynamics-short", "--to", "csv,xlsx"]) == 0
    written = {path.name for path in (tmp_path / "reports" / "dynamics-short" / "export").iterdir()}
    assert written == {f"{name}.csv" for name in TABLES} | {"tables.xlsx"}


def test_a_second_run_replaces_the_first(case, tmp_path):
    assert run(case) == 0
    assert run(case, "--step-s", "0.0025") == 0
    assert Results.open("reports/dynamics-short").run["step_s"] == 0.0025


def test_one_vehicle_alone_has_no_couplings(tmp_path, capsys):
    (tmp_path / "one").mkdir()
    text = CASE.replace("  - {id: wagon-zobory, count: 2, load_percent: 50}\ncoupling: zobory-linear\n", "")
    (tmp_path / "one" / "case.yaml").write_text(text, encoding="utf-8")
    assert run("one") == 0
    results = Results.open("reports/dynamics-one")
    assert set(results.tables) == {"vehicles", "controls", "distributions"}
    assert set(results.table("distributions")["of"]) == {"drive_speed", "brake_speed", "acceleration"}
    assert "coupling" not in capsys.readouterr().out


# --- 1: errors in the inputs


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--step-s", "-1"], "case.run.step_s"),
        (["--method", "leapfrog"], "case.run.method"),
        (["--set", "case.run.stepp_s=1"], "did you mean 'step_s'"),
        (["--set", "case.coupling=nothing"], "nothing"),
        (["--set", "couplings[zobory].slack_mm=1"], "zobory-linear"),
        (["--step-s", "1", "--set", "case.run.record_every_s=1"], "step_s"),
    ],
)
def test_wrong_inputs_leave_no_trace(case, options, words, tmp_path, capsys):
    assert run(case, *options) == 1
    assert words in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


# --- 2: wrong usage


def test_a_case_that_is_not_there(capsys):
    assert run("arshda") == 2
    assert "arshad" in capsys.readouterr().err


def test_a_folder_of_another_case_stays(case, tmp_path, capsys):
    assert run(case) == 0
    before = (tmp_path / "reports" / "dynamics-short" / "run.json").read_bytes()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "case.yaml").write_text(CASE, encoding="utf-8")
    assert run("other", "--out", "reports/dynamics-short") == 2
    assert "another study ('short', not 'other')" in capsys.readouterr().err
    assert (tmp_path / "reports" / "dynamics-short" / "run.json").read_bytes() == before
    assert run("other", "--out", "reports/dynamics-short", "--force") == 0


def test_what_is_for_runs_of_a_supply_is_refused_in_words(case, capsys):
    assert run(case) == 0
    for arguments in (
        ["report", "reports/dynamics-short", "--train", "1"],
        ["report", "reports/dynamics-short", "--from", "00:01"],
    ):
        capsys.readouterr()
        assert main(arguments) == 2
        assert "reports cover the whole run" in capsys.readouterr().err
    assert run(case, "--out", "again") == 0
    capsys.readouterr()
    assert main(["compare", "reports/dynamics-short", "again"]) == 2
    assert capsys.readouterr().err.count("holds results of train dynamics") == 2


# --- 3: not completed


def test_what_is_interrupted_is_kept(case, tmp_path, monkeypatch, capsys):
    advance = Session.advance

    def interrupted(self, until_s):
        if self.time_s >= 4.0:
            raise KeyboardInterrupt
        return advance(self, min(until_s, self.time_s + 1.0))

    monkeypatch.setattr(Session, "advance", interrupted)
    assert run(case) == 3
    told = capsys.readouterr().err
    assert "what was computed is kept in" in told and "--partial" in told
    results = Results.open("reports/dynamics-short", partial=True)
    assert results.run["status"] == "interrupted"
    assert set(results.tables) == TABLES
    assert 4.0 <= results.run["end_s"] < 12.0
    assert results.table("controls")["time_s"].max() == pytest.approx(results.run["end_s"], abs=0.1)
    assert not (tmp_path / "reports" / "dynamics-short" / "run.json").exists()


def test_what_cannot_be_computed_on_is_flagged(case, monkeypatch, capsys):
    advance = Session.advance

    def stuck(self, until_s):
        if self.time_s >= 2.0:
            raise NotComputableError("at 2 s a speed is no number any more")
        return advance(self, min(until_s, self.time_s + 1.0))

    monkeypatch.setattr(Session, "advance", stuck)
    assert run(case) == 3
    assert "a speed is no number any more" in capsys.readouterr().out
    assert Results.open("reports/dynamics-short").run["status"] == "flagged"


def test_numbers_that_are_none_are_left_out_of_json(case, monkeypatch, tmp_path, capsys):
    advance = Session.advance

    def spoilt(self, until_s):
        if self.time_s >= 2.0:
            self.state.movers["v_mps"] = self.state.movers["s_m"] = float("nan")
            raise NotComputableError("at 2 s a speed is no number any more")
        return advance(self, min(until_s, self.time_s + 1.0))

    monkeypatch.setattr(Session, "advance", spoilt)
    assert run(case) == 3
    for name in ("run.json", "key_figures.json"):
        text = (tmp_path / "reports" / "dynamics-short" / name).read_text(encoding="utf-8")
        json.loads(text, parse_constant=pytest.fail)
    assert "DOES NOT CLOSE: no number" in capsys.readouterr().out


# --- 4: a limit is violated


def test_strict_counts_what_a_coupling_endures(case, capsys):
    weak = ["--set", "couplings[zobory-linear].endurable_tension_kn=1"]
    assert run(case, *weak) == 0
    assert "VIOLATED" in capsys.readouterr().out
    assert run(case, *weak, "--strict") == 4
    assert run(case, "--set", "couplings[zobory-linear].endurable_tension_kn=900", "--strict") == 0


def test_strict_says_when_nothing_could_be_judged(case, capsys):
    assert run(case, "--strict") == 0
    assert "nothing was judged" in capsys.readouterr().err
    assert run(case, "--strict", "--set", "couplings[zobory-linear].endurable_tension_kn=900") == 0
    assert "nothing was judged" not in capsys.readouterr().err


# --- what is said


def test_a_step_by_option_is_blamed_for_all_that_it_breaks(case, capsys):
    assert run(case, "--step-s", "0.5") == 1
    told = capsys.readouterr().err
    assert re.findall(r"^  error: (.*?): found (.*)$", told, re.MULTILINE) == 2 * [("--step-s: case.run.step_s", "0.5 s")]
    assert "distance of recorded rows" in told and "with method symplectic" in told
    assert "case.yaml" not in told


def test_the_greeting_says_where_the_case_is(case, capsys):
    assert run(case) == 0
    assert "A short start: short\n" in capsys.readouterr().err


def test_the_summary_is_in_the_units_of_the_case(case, capsys):
    limit = ["--set", "couplings[zobory-linear].endurable_tension_kn=444.82216152605"]
    assert run(case, *limit, "--set", "case.units=imperial") == 0
    told = capsys.readouterr().out
    results = Results.open("reports/dynamics-short")
    lines = {line.split("  ")[0]: line for line in told.splitlines()}
    for name, words, unit, per in (
        ("greatest_tension_kn", "greatest tension", "kip", 1.0 / 4.4482216152605),
        ("greatest_speed_kmh", "greatest speed", "mph", 1.0 / 1.609344),
        ("stopping_distance_m", "stopping distance", "ft", 1.0 / 0.3048),
    ):
        value, shown = lines[words].split()[len(words.split()) :][:2]
        assert shown == unit
        assert float(value) == pytest.approx(results.key_figure(name) * per, abs=0.06)
    assert "(endurable 100 kip" in told or "100 kip, source status" in told
    assert not re.search(r"\b(kN|km/h|m/s²)", told)


# --- reports, other kinds, missing packages


def test_reports_are_made_of_the_folder_alone(case, tmp_path, capsys):
    assert run(case) == 0
    (tmp_path / "short" / "case.yaml").unlink()
    assert main(["report", "reports/dynamics-short", "--only", "workbook", "--only", "coupling_extremes"]) == 0
    folder = tmp_path / "reports" / "dynamics-short"
    assert [path.name for path in (folder / "figures").iterdir()] == ["coupling_extremes.png"]
    assert (folder / "report.xlsx").stat().st_size > 5000


def test_without_rainflow_it_says_so(case, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    assert run(case) == 0
    assert "pip install tractionpower[dynamics]" in capsys.readouterr().out
    assert "rainflow" not in Results.open("reports/dynamics-short").tables


def test_a_case_of_stations_runs_by_the_same_command(tmp_path, capsys):
    pytest.importorskip("simpy")
    assert main(["dynamics", "run", "traindyn-three-stations"]) == 0
    told = capsys.readouterr()
    assert "writing figures and workbook\n" in told.err
    folder = tmp_path / "reports" / "dynamics-traindyn-three-stations"
    results = Results.open(folder)
    assert results.run["kind"] == "stations"
    assert set(results.tables) == {"point_masses", "station_events"}
    assert results.scenario.name == results.run["name"]
    assert {path.name for path in (folder / "figures").iterdir()} >= {"station_topology.png", "station_distance_time.png"}
    assert (folder / "report.xlsx").exists()
    assert "trains that have left" in told.out
    assert main(["report", str(folder), "--only", "figures"]) == 0


def test_without_simpy_stations_say_what_to_install(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "simpy", None)
    assert run("traindyn-three-stations") == 2
    assert "pip install tractionpower[simpy]" in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


# --- the page that tells of it


def test_the_case_of_the_page_runs(tmp_path, capsys):
    (block,) = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "my-case").mkdir()
    (tmp_path / "my-case" / "case.yaml").write_text(block, encoding="utf-8")
    assert run("my-case") == 0
    (stop,) = Results.open("reports/dynamics-my-case").run["stops"]
    assert stop["braked_at_s"] == 35.0
    for line in re.findall(r"^tractionpower dynamics run (.*--set.*)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE):
        assert run(*line.replace('"', "").split()) == 0
    assert len(Results.open("long").run["vehicles"]) == 41


def test_the_python_of_the_page_runs(tmp_path, capsys):
    (block,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    exec(compile(block, str(PAGE), "exec"), {})
    assert "coupling" in capsys.readouterr().out


def test_the_page_names_every_key_figure(tmp_path):
    figures = {figure["name"] for figure in fake_results(tmp_path / "fake").key_figures}
    told = set(re.findall(r"`([a-z]\w*)`", PAGE.read_text(encoding="utf-8").split("### Key figures")[1].split("###")[0]))
    assert figures <= told
