"""``tractionpower run``: what it writes, says and returns."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from small_files import STUDY, write_small_study

from tractionpower.cli import main
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter

TABLES = {f"{name}.parquet" for name in ("substations", "feeders", "loads", "profile", "events")}
WRITTEN = TABLES | {"run.json", "key_figures.json", "scenario.json"}


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def small(tmp_path):
    """Return the name of a small study in the working folder."""
    write_small_study(tmp_path / "small")
    return "small"


def run(*arguments):
    return main(["run", *arguments, "--no-reports"])


def process(*arguments, **more):
    """Return a process of the command line in which Ctrl-C works, also when the tests run in the background."""
    ready = partial(signal.signal, signal.SIGINT, signal.default_int_handler) if os.name == "posix" else None
    command = [sys.executable, "-m", "tractionpower", "run", *arguments, "--no-reports"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=ready, **more)  # noqa: PLW1509


# --- 0: done


def test_a_shipped_line_in_an_empty_folder(tmp_path, capsys):
    assert main(["run", "two-substations"]) == 0
    told = capsys.readouterr()
    folder = tmp_path / "reports" / "two-substations"
    assert [path.name for path in tmp_path.iterdir()] == ["reports"]
    written = WRITTEN - {"loads.parquet"} | {"trains.parquet", "cabins.parquet", "figures", "report.xlsx"}
    assert {path.name for path in folder.iterdir()} == written
    assert Results.open(folder).run["status"] == "complete"
    assert all(path.stat().st_size > 1000 for path in (folder / "figures").iterdir())
    for word in ("highest", "energy", "lowest voltage", "met", "trains: 4 left the line", "electric ledger closes"):
        assert word in told.out
    assert f"results: {Path('reports') / 'two-substations'}" in told.err
    assert f"report: {Path('reports') / 'two-substations' / 'report.xlsx'}" in told.err


def test_no_reports_means_tables_only(tmp_path, small):
    assert run(small) == 0
    assert {path.name for path in (tmp_path / "reports" / "small").iterdir()} == WRITTEN


def test_an_earlier_workbook_that_is_not_written_again_is_told(small, capsys):
    assert main(["run", small]) == 0
    capsys.readouterr()
    assert run(small) == 0
    assert re.search(r"report\.xlsx is of an earlier run; `tractionpower report \S+` writes it again", capsys.readouterr().err)


def test_tables_are_left_out_without_harm(tmp_path, small):
    file = Path(small) / "study.yaml"
    file.write_text(file.read_text(encoding="utf-8") + "output: {tables: [loads]}\n", encoding="utf-8")
    assert main(["run", small]) == 0
    assert Results.open(tmp_path / "reports" / "small").tables == ["loads"]


def test_out_names_the_folder_and_set_changes_an_input(tmp_path, small):
    assert run(small, "--out", "here/there") == 0
    assert run(small, "--out", "other", "--set", "supply.substations[A].state=bypassed", "--set", "supply.loads[train].km=5") == 0
    base, changed = Results.open(tmp_path / "here" / "there"), Results.open(tmp_path / "other")
    assert changed.key_figure("lowest_voltage_v") < base.key_figure("lowest_voltage_v")
    assert changed.key_figure("energy_kwh", "substation A") == 0.0
    assert base.run["input_hash"] != changed.run["input_hash"]
    assert base.run["study"] == changed.run["study"] == "small"
    assert not (tmp_path / "reports").exists()


def test_a_second_run_replaces_the_first_and_gives_the_same_tables(tmp_path, small):
    files = []
    for _ in range(2):
        assert run(small) == 0
        files.append(Results.open(tmp_path / "reports" / "small").run["files"])
    assert files[0] == files[1]


def test_the_study_file_itself_may_be_named(tmp_path, small):
    assert run(str(Path(small) / "study.yaml")) == 0
    assert (tmp_path / "reports" / "small" / "run.json").is_file()


def test_a_warning_does_not_stop_the_run(small, capsys):
    file = Path(small) / "line.yaml"
    text = "gradients:\n  - {from_km: 0.0, to_km: 5.0, permille: 1.0}\n  - {from_km: 6.0, to_km: 20.0, permille: 1.0}\n"
    file.write_text(file.read_text(encoding="utf-8") + text, encoding="utf-8")
    assert run(small) == 0
    assert re.search(r"line\.yaml:\d+: line\.gradients", capsys.readouterr().err)


@pytest.mark.parametrize("encoding", ["ascii", "cp1250", "utf-8"])
def test_names_with_letters_that_the_terminal_lacks(small, encoding):
    with process(small, env={**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}, encoding=encoding) as ran:
        out, err = ran.communicate(timeout=120)
    assert "Traceback" not in err
    assert ran.returncode == 0
    assert "lowest voltage" in out


# --- 1: the inputs have errors


def test_all_problems_are_told_with_file_and_line_and_nothing_is_written(tmp_path, small, capsys):
    file = Path(small) / "supply.yaml"
    text = file.read_text(encoding="utf-8").replace("km: 10.0, power_kw", "km: 99.0, power_kw")
    file.write_text(text + '  - {id: second, track: "7", km: 1.0, power_kw: 5}\n', encoding="utf-8")
    assert run(small) == 1
    told = capsys.readouterr()
    assert "supply.yaml:10: supply.loads[train].km" in told.err
    assert "supply.yaml:11: supply.loads[second].track" in told.err
    assert "2 errors" in told.err
    assert [path.name for path in tmp_path.iterdir()] == ["small"]


def test_problems_of_several_files_come_together(tmp_path, small, capsys):
    (tmp_path / "small" / "line.yaml").write_text("format: 1\ntracks: 5\n", encoding="utf-8")
    (tmp_path / "small" / "study.yaml").write_text('format: 1\nclock: {start: "1", end: "00:01:00"}\n', encoding="utf-8")
    assert run(small) == 1
    told = capsys.readouterr().err
    assert "line.yaml:2: line.tracks" in told
    assert "study.yaml:2: clock.start" in told
    assert [path.name for path in tmp_path.iterdir()] == ["small"]


def test_errors_leave_earlier_results_alone(tmp_path, small):
    assert run(small) == 0
    before = (tmp_path / "reports" / "small" / "run.json").read_bytes()
    assert run(small, "--set", "supply.loads[train].km=99") == 1
    assert (tmp_path / "reports" / "small" / "run.json").read_bytes() == before
    assert not (tmp_path / "reports" / "small" / ".running").exists()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("supply.substation[A].km=1", "substations"),
        ("supply.substations[X].km=1", "A"),
        ("supply.substations[A].stat=bypassed", "state"),
        ("supply.substations[A].state=bypased", "bypassed"),
        ("clock.step_s=100", "5"),
        ("nonsense", "nonsense"),
    ],
)
def test_a_wrong_change_is_told_with_what_may_be_meant(tmp_path, small, capsys, change, words):
    assert run(small, "--set", change) == 1
    told = capsys.readouterr().err
    assert words in told
    assert "1 error" in told
    assert [path.name for path in tmp_path.iterdir()] == ["small"]


# --- 2: wrong usage


@pytest.mark.parametrize("arguments", [[], ["no-such-line"], ["two-substations", "--frob"], ["two-substations", "more"]])
def test_wrong_usage(tmp_path, capsys, arguments):
    assert run(*arguments) == 2
    assert capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_misspelt_line_is_told_with_the_one_that_ships(capsys):
    assert run("two-substation") == 2
    assert "two-substations" in capsys.readouterr().err


def test_a_folder_of_another_study_is_refused_unless_forced(small, capsys):
    assert run(small, "--out", "x") == 0
    assert run("two-substations", "--out", "x") == 2
    assert "another study" in capsys.readouterr().err
    assert Results.open("x").run["study"] == "small"
    assert run("two-substations", "--out", "x", "--force") == 0
    assert Results.open("x").run["study"] == "two-substations"


def test_a_folder_with_other_files_is_refused_unless_forced(tmp_path, small, capsys):
    assert run(small, "--out", small) == 2  # the study's own folder, of all places
    assert "no results of a run" in capsys.readouterr().err
    assert {path.name for path in (tmp_path / small).iterdir()} == set(STUDY)
    assert run(small, "--out", str(Path(small) / "line.yaml")) == 2
    assert "is a file" in capsys.readouterr().err


# --- 3: not completed, or flagged


def test_a_demand_that_cannot_be_served(tmp_path, small, capsys):
    change = "supply.loads[train].power_kw=20000"
    assert run(small, "--set", change) == 3
    told = capsys.readouterr()
    assert re.search(
        r"00:00:00 to 00:01:00: the demand cannot be served, first at train \(track 1, km 10\); \d\d\.\d+ %", told.out
    )
    assert "60 steps are flagged" in told.out
    results = Results.open(tmp_path / "reports" / "small")
    assert results.run["status"] == "flagged"
    assert results.table("events")["kind"].tolist() == ["limit_violated", "not_servable"]


@pytest.mark.skipif(sys.platform != "linux", reason="/proc is read-only on Linux")
def test_a_folder_that_cannot_be_written(small, capsys):
    assert run(small, "--out", "/proc/x") == 3
    assert "cannot be written into /proc/x" in capsys.readouterr().err


def test_a_full_disk(tmp_path, small, capsys, monkeypatch):
    assert run(small) == 0

    def fill_up(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pq, "write_table", fill_up)
    assert run(small) == 3
    assert "the disk is full" in capsys.readouterr().err
    Results.open(tmp_path / "reports" / "small")


def test_figures_that_cannot_be_written(tmp_path, small, capsys):
    assert run(small) == 0
    (tmp_path / "reports" / "small" / "figures").write_text("in the way", encoding="utf-8")
    assert main(["run", small]) == 3
    assert "figures" in capsys.readouterr().err
    Results.open(tmp_path / "reports" / "small")


@pytest.mark.skipif(sys.platform == "win32", reason="limits the size of files as POSIX does")
def test_a_disk_that_takes_no_more(tmp_path, small):
    assert run(small) == 0
    code = (
        "import resource, signal, sys\n"
        "from tractionpower.cli import main\n"
        "import pyarrow.parquet\n"
        "from tractionpower.kernels import block\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "sys.exit(main(['run', 'small', '--no-reports']))\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=120)
    assert ran.returncode == 3, ran.stderr
    assert "results cannot be written" in ran.stderr
    assert "Traceback" not in ran.stderr
    Results.open(tmp_path / "reports" / "small")
    assert not list(tmp_path.rglob("*.tmp"))


LONG = ["--set", "clock.end=900:00:00", "--set", "clock.step_s=0.02"]


@pytest.mark.skipif(os.name != "posix", reason="sends a signal as a terminal does")
def test_ctrl_c_in_the_middle(tmp_path, small):
    assert run(small) == 0
    folder = tmp_path / "reports" / "small"
    before = (folder / "run.json").read_bytes()
    with process(small, *LONG) as ran:
        waited = time.monotonic() + 120
        while len(list(folder.glob(".running/*/loads-*.parquet"))) < 3 and time.monotonic() < waited:
            assert ran.poll() is None, ran.communicate()
            time.sleep(0.05)
        pressed = time.monotonic()
        ran.send_signal(signal.SIGINT)
        _, err = ran.communicate(timeout=60)
    assert ran.returncode == 3, err
    assert time.monotonic() - pressed < 10.0
    assert "Traceback" not in err
    told = re.search(r"interrupted after (\d+) of 162000000 steps; what was computed is kept in (\S+)", err)
    assert told, err
    kept = tmp_path / told[2]
    assert not list(folder.rglob("*.tmp"))
    unfinished = json.loads((kept / "run.json").read_text(encoding="utf-8"))
    assert (unfinished["status"], unfinished["steps"]) == ("interrupted", int(told[1]))
    parts = sorted(kept.glob("loads-*.parquet"))
    assert sum(pq.read_table(part).num_rows for part in parts) >= int(told[1]) > 0
    partial = Results.open(folder, partial=True)
    assert partial.row_count("loads") == sum(pq.read_table(part).num_rows for part in parts)
    assert partial.key_figure("energy_kwh", "substation A") > 0.0
    assert partial.scenario.name == "Small"
    assert f"tractionpower report {Path('reports') / 'small'} --partial" in err

    assert (folder / "run.json").read_bytes() == before  # and the earlier results still hold
    assert len(Results.open(folder).table("loads")) == 60
    assert run(small) == 0
    assert not (folder / ".running").exists()


def test_ctrl_c_before_the_first_step_leaves_nothing(tmp_path, small, capsys, monkeypatch):
    def interrupt(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("tractionpower.cosimulation.run.compile_scenario", interrupt)
    assert run(small) == 3
    assert "interrupted" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["small"]


def test_ctrl_c_while_the_results_are_joined(tmp_path, small, capsys, monkeypatch):
    assert run(small) == 0

    def interrupt(self, table):
        raise KeyboardInterrupt

    monkeypatch.setattr(RunWriter, "_join", interrupt)
    assert run(small) == 3
    assert "interrupted after 60 of 60 steps" in capsys.readouterr().err
    Results.open(tmp_path / "reports" / "small")


# --- 4: a limit is violated, with --strict


def test_a_violated_limit_is_4_only_with_strict(small, capsys):
    changes = ["--set", "supply.loads[train].power_kw=null", "--set", "supply.loads[train].current_a=9000"]
    assert run(small, *changes) == 0
    assert "VIOLATED" in capsys.readouterr().out
    assert run(small, *changes, "--strict") == 4
    assert run(small, "--strict") == 0


def test_flagged_steps_come_before_violated_limits(small):
    assert run(small, "--set", "supply.loads[train].power_kw=20000", "--strict") == 3
