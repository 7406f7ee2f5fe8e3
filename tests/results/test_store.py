"""Results on disk: valid or not there, whatever happens while they are written."""

import errno
import hashlib
import json
import os
import signal
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from small_studies import load, make_scenario

from tractionpower.errors import OutputError, UsageError
from tractionpower.results.results import Results
from tractionpower.results.store import RunWriter, read_run

HASH = "0123456789abcdef" * 4


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def fail_with(number):
    def fail(*args, **kwargs):
        raise OSError(number, os.strerror(number))

    return fail


# --- the way of the rows


def test_parts_are_readable_while_the_run_lasts(folder, rows):
    writer = RunWriter(folder, "study", HASH)
    for first in (0, 10):
        writer.append("loads", rows(first, first + 10))
        parts = sorted(writer.running.glob("loads-*.parquet"))
        assert [pq.read_table(part).num_rows for part in parts] == [20] * len(parts)
    assert [part.name for part in parts] == ["loads-000001.parquet", "loads-000002.parquet"]
    assert writer.running == folder / ".running" / HASH[:16]
    assert not list(folder.rglob("*.tmp"))
    assert not (folder / "run.json").exists()


def test_parts_are_joined_in_their_order(folder, write_run, rows):
    write_run(cuts=(0, 4, 5, 10))
    table = pq.read_table(folder / "loads.parquet")
    assert table.to_pylist() == rows(0, 10).to_pylist()
    assert sorted(path.name for path in folder.iterdir()) == ["key_figures.json", "loads.parquet", "run.json"]


def test_columns_on_disk_carry_unit_and_meaning(folder, write_run):
    write_run()
    field = pq.read_schema(folder / "loads.parquet").field("power_kw")
    assert field.metadata[b"unit"] == b"kW"
    assert b"negative feeds back" in field.metadata[b"meaning"]


def test_a_file_does_not_depend_on_how_many_rows_came_at_a_time(folder, write_run, monkeypatch):
    monkeypatch.setattr("tractionpower.results.parts.GROUP_ROWS", 7)
    digests = {write_run(cuts=cuts)["files"]["loads.parquet"]["sha256"] for cuts in [(0, 20), (0, 1, 2, 9, 20), (0, 13, 20)]}
    assert len(digests) == 1
    assert pq.ParquetFile(folder / "loads.parquet").num_row_groups == 6


def test_run_json_tells_size_and_hash_of_every_file(folder, write_run):
    run = write_run()
    assert json.loads((folder / "run.json").read_text(encoding="utf-8")) == run
    assert set(run["files"]) == {"loads.parquet", "key_figures.json"}
    for name, entry in run["files"].items():
        data = (folder / name).read_bytes()
        assert entry == {"size": len(data), "sha256": hashlib.sha256(data).hexdigest()}


def test_run_json_comes_last(folder, write_run, monkeypatch):
    moved = []
    replace = Path.replace

    def watch(self, target):
        if Path(target).parent == folder:
            moved.append(Path(target).name)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", watch)
    write_run()
    assert moved == ["loads.parquet", "key_figures.json", "run.json"]


def test_nothing_is_touched_before_the_new_results_are_complete(folder, write_run, rows):
    write_run()
    before = contents(folder)
    writer = RunWriter(folder, "study", HASH)
    for first in range(5):
        writer.append("loads", rows(first, first + 1, 2500.0))
        assert {name: data for name, data in contents(folder).items() if ".running" not in name} == before
    writer.finish({"study": "study", "status": "complete"}, [])
    assert Results.open(folder).table("loads")["voltage_v"].max() < 2600


def test_a_table_that_the_new_run_does_not_write_goes(folder, write_run):
    write_run()
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    RunWriter(folder, "study", HASH).finish({"study": "study", "status": "complete"}, [])
    assert sorted(path.name for path in folder.iterdir()) == ["key_figures.json", "notes.txt", "run.json"]
    assert Results.open(folder).tables == []


def test_parts_of_an_earlier_run_that_broke_off_do_not_mix_in(folder, rows):
    RunWriter(folder, "study", HASH).append("loads", rows(0, 50))
    writer = RunWriter(folder, "study", HASH)  # the folder of parts alone is no foreign matter
    writer.append("loads", rows(0, 2))
    writer.finish({"study": "study"}, [])
    assert pq.read_table(folder / "loads.parquet").num_rows == 4
    assert not (folder / ".running").exists()


def test_an_unfinished_run_keeps_its_parts_with_a_note(folder, write_run, rows):
    write_run()
    before = contents(folder)
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))
    kept = writer.keep_unfinished({"status": "interrupted", "study": "study", "steps": 3})
    assert json.loads((kept / "run.json").read_text(encoding="utf-8"))["status"] == "interrupted"
    assert pq.read_table(kept / "loads-000001.parquet").num_rows == 6
    assert before.items() <= contents(folder).items()
    read_run(folder)


def test_run_json_is_amended_and_the_tables_stay(folder, rows):
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))
    run = {"study": "study", "said": 1}
    writer.finish(run, [])
    before = contents(folder)
    writer.amend(run | {"said": 2})
    after = contents(folder)
    assert {name for name in after if after[name] != before.get(name)} == {"run.json"}
    assert after.keys() == before.keys()
    assert read_run(folder)["said"] == 2


def test_what_a_later_study_goes_on_from_stays_until_one_has_no_use_for_it(folder, rows):
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))
    writer.beside_parts.mkdir()
    (writer.beside_parts / "kept.json").write_text("{}", encoding="utf-8")
    kept = writer.beside_parts / "kept.json"
    writer.finish({"study": "study"}, [], is_continued=True)
    assert [path.name for path in (folder / ".running").iterdir()] == [kept.parent.name]
    read_run(folder)
    again = RunWriter(folder, "study", "f" * 64)
    again.append("loads", rows(0, 3))
    assert kept.exists()
    again.discard()
    assert kept.exists()
    again.amend({"study": "study"}, is_continued=True)
    assert kept.exists()
    again.amend({"study": "study"})
    assert not (folder / ".running").exists()


def test_an_amended_run_json_beside_one_that_is_held_open(folder, write_run, rows, hold, monkeypatch):
    write_run()
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))
    writer.finish({"study": "study", "said": 1}, [])
    hold("run.json")
    for said in (2, 3):
        writer.amend({"study": "study", "said": said})
        assert read_run(folder)["said"] == said
    assert [path.name for path in writer.beside] == ["run.new.json"]
    monkeypatch.undo()
    writer.amend({"study": "study", "said": 4})
    assert read_run(folder)["said"] == 4
    assert not (folder / "run.new.json").exists()


@pytest.mark.parametrize("ended", [True, False])
def test_a_folder_of_results_inside_is_no_foreign_matter(folder, rows, write_run, ended):
    inside = RunWriter(folder / "journey", "study, journey", HASH)
    inside.append("loads", rows(0, 3))
    if ended:
        inside.finish({"study": "study, journey"}, [])
    write_run()
    assert (folder / "journey" / "run.json").is_file() == ended
    (folder / "run.json").unlink()
    (folder / "other").mkdir()
    with pytest.raises(UsageError, match="no results of a run"):
        write_run()


def test_what_was_not_begun_leaves_no_trace(tmp_path):
    RunWriter(tmp_path / "a" / "b" / "c", "study", HASH).discard()
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "mine").mkdir()
    RunWriter(tmp_path / "mine" / "c", "study", HASH).discard()
    assert [path.name for path in tmp_path.rglob("*")] == ["mine"]


# --- folders that are refused


def test_a_folder_of_another_study_is_refused(folder, write_run):
    write_run()
    before = contents(folder)
    with pytest.raises(UsageError, match=r"another study \('study', not 'other'\).*--force"):
        RunWriter(folder, "other", HASH)
    assert contents(folder) == before
    write_run(study="other", force=True)
    assert read_run(folder)["study"] == "other"


@pytest.mark.parametrize(("there", "new"), [("", "size"), ("contingency", ""), ("contingency", "size")])
def test_a_folder_of_another_command_is_refused(tmp_path, there, new):
    kind = {"kind": there} if there else {}
    RunWriter(tmp_path / "a", "study", HASH, kind=there).finish({"study": "study", **kind}, [])
    RunWriter(tmp_path / "b", "study", HASH, kind=there).keep_unfinished({"study": "study"})
    for folder, held in (("a", "results"), ("b", "an interrupted run")):
        before = contents(tmp_path / folder)
        words = rf"holds {held} of another command \({there or 'run'}, not {new or 'run'}\).*--force"
        with pytest.raises(UsageError, match=words):
            RunWriter(tmp_path / folder, "study", HASH, kind=new)
        assert contents(tmp_path / folder) == before
        RunWriter(tmp_path / folder, "study", HASH, kind=there)
        RunWriter(tmp_path / folder, "study", HASH, kind=new, force=True)


@pytest.mark.parametrize("text", ["{", "[1]", "5", ""])
def test_a_folder_with_an_unreadable_run_is_refused(folder, text):
    folder.mkdir(parents=True)
    (folder / "run.json").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="an unreadable run"):
        RunWriter(folder, "study", HASH)
    RunWriter(folder, "study", HASH, force=True).finish({"study": "study"}, [])
    assert read_run(folder)["files"]


def test_a_folder_with_other_files_is_refused(folder):
    folder.mkdir(parents=True)
    (folder / "thesis.docx").write_bytes(b"years of work")
    with pytest.raises(UsageError, match=r"no results of a run.*--force"):
        RunWriter(folder, "study", HASH)
    assert [path.name for path in folder.iterdir()] == ["thesis.docx"]
    RunWriter(folder, "study", HASH, force=True).finish({"study": "study"}, [])
    assert (folder / "thesis.docx").read_bytes() == b"years of work"


@pytest.mark.parametrize("force", [False, True])
def test_a_folder_that_is_a_file_is_refused(tmp_path, force):
    (tmp_path / "file").write_text("x", encoding="utf-8")
    with pytest.raises(UsageError, match="is a file"):
        RunWriter(tmp_path / "file", "study", HASH, force=force)
    with pytest.raises(OutputError, match="cannot be written"):
        RunWriter(tmp_path / "file" / "deeper", "study", HASH, force=force)
    assert (tmp_path / "file").read_text(encoding="utf-8") == "x"


# --- what was computed is kept with the results


SCENARIO = make_scenario(load("żółw"), name="Small")


def test_the_scenario_is_kept_and_its_file_has_the_input_hash(folder, rows):
    writer = RunWriter(folder, "study", SCENARIO.input_hash, scenario=SCENARIO)
    writer.append("loads", rows(0, 3))
    run = writer.finish({"study": "study"}, [])
    assert run["files"]["scenario.json"]["sha256"] == SCENARIO.input_hash
    assert Results.open(folder).scenario == SCENARIO


def test_results_without_a_scenario(folder, write_run):
    write_run()
    assert Results.open(folder).scenario is None


def test_a_scenario_of_another_version_does_not_hinder_the_tables(folder, rows):
    text = '{"line": "of the future"}'
    folder.mkdir(parents=True)
    (folder / "scenario.json").write_text(text, encoding="utf-8")
    files = {"scenario.json": {"size": len(text), "sha256": hashlib.sha256(text.encode()).hexdigest()}}
    (folder / "key_figures.json").write_text("[]", encoding="utf-8")
    files["key_figures.json"] = {"size": 2, "sha256": hashlib.sha256(b"[]").hexdigest()}
    (folder / "run.json").write_text(json.dumps({"study": "study", "files": files}), encoding="utf-8")
    results = Results.open(folder)
    assert results.tables == []
    with pytest.raises(UsageError, match=r"scenario\.json: not a scenario of this version"):
        _ = results.scenario


# --- what a run that broke off has left


def broken_off(folder, rows, key=HASH, **more):
    writer = RunWriter(folder, "study", key, **more)
    for first in (0, 3):
        writer.append("loads", rows(first, first + 3))
    return writer


def test_parts_of_a_run_that_was_killed_are_read(folder, rows, write_run):
    write_run()
    broken_off(folder, rows, SCENARIO.input_hash, scenario=SCENARIO)
    results = Results.open(folder, partial=True)
    assert results.table("loads").equals(rows(0, 6).to_pandas())
    assert results.row_count("loads") == 12
    assert (results.run["status"], results.run["study"], results.run["name"]) == ("interrupted", "study", "Small")
    assert results.scenario == SCENARIO
    assert results.key_figures == []
    assert Results.open(folder).row_count("loads") == 20  # the complete results are the earlier ones


def test_what_an_interrupted_run_says_of_itself_is_read(folder, rows):
    figure = {"name": "lowest_voltage_v", "value": 1.0, "place": ""}
    broken_off(folder, rows).keep_unfinished({"status": "interrupted", "steps": 6}, [figure])
    results = Results.open(folder, partial=True)
    assert results.run == {"status": "interrupted", "steps": 6}
    assert results.key_figure("lowest_voltage_v") == 1.0
    assert results.scenario is None


def test_half_written_and_joined_files_are_no_parts(folder, rows, monkeypatch):
    writer = broken_off(folder, rows)
    (writer.running / "loads-000003.tmp").write_bytes(b"half")
    with monkeypatch.context() as patch:
        patch.setattr("tractionpower.results.store.sha256_of", fail_with(errno.EIO))
        with pytest.raises(OutputError):
            writer.finish({}, [])
    assert (writer.running / "loads.parquet").is_file()
    assert Results.open(folder, partial=True).row_count("loads") == 12


def test_parts_are_read_up_to_the_first_damaged_one(folder, rows):
    writer = broken_off(folder, rows)
    writer.append("loads", rows(6, 9))
    (writer.running / "loads-000002.parquet").write_bytes(b"")
    assert Results.open(folder, partial=True).table("loads").equals(rows(0, 3).to_pandas())


def test_the_last_of_several_unfinished_runs_is_read(folder, rows):
    for number, key in enumerate(("a" * 64, "c" * 64, "b" * 64)):
        running = broken_off(folder, rows, key).running
        os.utime(running, (1000.0 + number, 1000.0 + number))
    assert Results.open(folder, partial=True).run["input_hash"] == "b" * 64


def test_without_an_unfinished_run_there_is_nothing_partial(folder, write_run, rows):
    write_run()
    with pytest.raises(UsageError, match="no parts of an unfinished run are there"):
        Results.open(folder, partial=True)


def test_without_complete_results_the_partial_ones_are_named(folder, rows):
    broken_off(folder, rows)
    with pytest.raises(UsageError, match=r"no results of a run are there.*--partial"):
        Results.open(folder)


def test_reports_of_an_unfinished_run_are_no_foreign_matter(folder, rows, write_run):
    broken_off(folder, rows)
    (folder / "partial").mkdir()
    write_run()
    assert Results.open(folder).tables == ["loads"]


# --- disks that fail


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is read-only on Linux")
def test_a_place_that_cannot_be_written_on_linux():
    with pytest.raises(OutputError, match="cannot be written into /proc/tractionpower"):
        RunWriter(Path("/proc/tractionpower"), "study", HASH)


@pytest.mark.parametrize("number", [errno.EACCES, errno.EPERM, errno.EROFS])
def test_a_folder_without_permission(folder, monkeypatch, number):
    monkeypatch.setattr(Path, "mkdir", fail_with(number))
    with pytest.raises(OutputError, match="no permission to write; choose another folder with --out"):
        RunWriter(folder, "study", HASH)


def test_a_full_disk_while_the_run_lasts(folder, write_run, rows, monkeypatch):
    write_run()
    before = contents(folder)
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))

    def fill_up(table, where, **options):
        Path(where).write_bytes(b"half")
        fail_with(errno.ENOSPC)()

    monkeypatch.setattr(pq, "write_table", fill_up)
    with pytest.raises(OutputError, match=r"the disk is full; make room and run again. Earlier results there are unharmed"):
        writer.append("loads", rows(3, 6))
    assert before.items() <= contents(folder).items()
    assert not list(folder.rglob("*.tmp"))
    assert pq.read_table(writer.running / "loads-000001.parquet").num_rows == 6
    read_run(folder)


def test_a_full_disk_while_the_results_are_joined(folder, write_run, rows, monkeypatch):
    write_run()
    before = contents(folder)
    for broken in ("write_text", "ParquetWriter"):
        writer = RunWriter(folder, "study", HASH)
        writer.append("loads", rows(0, 3))
        with monkeypatch.context() as patch:
            patch.setattr(*((Path, "write_text") if broken == "write_text" else (pq, "ParquetWriter")), fail_with(errno.ENOSPC))
            with pytest.raises(OutputError, match=r"disk is full.*unharmed"):
                writer.finish({"study": "study"}, [])
        assert before.items() <= contents(folder).items()
        read_run(folder)


def test_a_failure_while_results_move_in_is_told_as_it_is(folder, write_run, rows, monkeypatch):
    write_run()
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))
    replace = Path.replace

    def fail_at_the_figures(self, target):
        if Path(target) == folder / "key_figures.json":
            raise OSError(errno.EIO, "input/output error")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", fail_at_the_figures)
    with pytest.raises(OutputError, match="some old; mend that and run again"):
        writer.finish({"study": "study"}, [])
    with pytest.raises(UsageError, match="not the file that the run wrote"):
        read_run(folder)


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_comes_too_late_when_the_results_move_in(folder, write_run, monkeypatch):
    replace = Path.replace

    def interrupt(self, target):
        if Path(target).parent == folder:
            signal.raise_signal(signal.SIGINT)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", interrupt)
    before = signal.getsignal(signal.SIGINT)
    write_run()
    assert signal.getsignal(signal.SIGINT) is before
    read_run(folder)


def test_ctrl_c_leaves_no_half_written_part(folder, rows, monkeypatch):
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3))

    def interrupt(table, where, **options):
        Path(where).write_bytes(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(pq, "write_table", interrupt)
    with pytest.raises(KeyboardInterrupt):
        writer.append("loads", rows(3, 6))
    assert sorted(path.name for path in writer.running.iterdir()) == ["loads-000001.parquet", "run.json"]


# --- files that another program holds open


@pytest.fixture
def hold(folder, monkeypatch):
    """Return a function after which files of these names cannot be replaced, as when Excel has them open on Windows."""
    replace, unlink = Path.replace, Path.unlink

    def hold_open(*names):
        def refuse(self, target):
            if Path(target).parent == folder and Path(target).name in names:
                raise PermissionError(errno.EACCES, "held open by another program")
            return replace(self, target)

        def keep(self, missing_ok=False):
            if self.parent == folder and self.name in names:
                raise PermissionError(errno.EACCES, "held open by another program")
            unlink(self, missing_ok=missing_ok)

        monkeypatch.setattr(Path, "replace", refuse)
        monkeypatch.setattr(Path, "unlink", keep)

    return hold_open


@pytest.mark.parametrize("held", ["loads.parquet", "key_figures.json"])
def test_a_file_that_is_held_open_gets_its_successor_beside(folder, write_run, rows, hold, monkeypatch, held):
    write_run()
    before = (folder / held).read_bytes()
    hold(held)
    writer = RunWriter(folder, "study", HASH)
    writer.append("loads", rows(0, 3, 2000.0))
    run = writer.finish({"study": "study"}, [{"name": "lowest_voltage_v", "value": 1.0, "place": ""}])
    stem, suffix = held.split(".")
    assert [path.name for path in writer.beside] == [f"{stem}.new.{suffix}"]
    assert f"{stem}.new.{suffix}" in run["files"]
    assert held not in run["files"]
    assert (folder / held).read_bytes() == before
    results = Results.open(folder)
    assert results.tables == ["loads"]
    assert results.table("loads")["voltage_v"].max() < 2100.0
    assert results.key_figure("lowest_voltage_v") == 1.0

    monkeypatch.undo()  # the other program lets go, and the next run cleans up
    write_run(voltage=2500.0)
    assert sorted(path.name for path in folder.iterdir()) == ["key_figures.json", "loads.parquet", "run.json"]
    assert Results.open(folder).table("loads")["voltage_v"].max() > 2400.0


def test_run_json_that_is_held_open(folder, write_run, hold, monkeypatch):
    write_run()
    hold("run.json")
    write_run(voltage=2500.0)
    assert Results.open(folder).table("loads")["voltage_v"].max() < 2600.0
    monkeypatch.undo()
    write_run(voltage=2000.0)
    assert sorted(path.name for path in folder.iterdir()) == ["key_figures.json", "loads.parquet", "run.json"]
    assert Results.open(folder).table("loads")["voltage_v"].max() < 2100.0
