import json
import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pyarrow as pa
import pytest
from fake_cases import LIBRARY, loads_of, marks_in, measure_and_note, measure_load, measure_with_trouble, power_kw
from small_studies import load, make_scenario

from tractionpower.cosimulation.simulate import simulate
from tractionpower.errors import OutputError, UsageError
from tractionpower.model.change import apply_changes
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter
from tractionpower.studies.runner.case import Case
from tractionpower.studies.runner.outcomes import write_cases
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore

BASE = make_scenario(load("depot"))
SUPPORT = Path(__file__).parents[2] / "support"


def run(cases, work=measure_load, store=None, base=BASE, **more):
    return run_cases(base, LIBRARY, cases, work, store or CaseStore(), **more)


def column(result, name):
    return [row[name] for row in result.rows]


def written(result, **more):
    writer = MemoryWriter()
    write_cases(result, writer, **more)
    return writer.tables()


def test_every_case_has_a_row_and_its_rows_of_tables():
    cases = [Case("base", base=True, kind="base"), *loads_of(2, mode="open", grid="low")]
    tables = written(run(cases))
    told = tables["cases"].select(["case", "kind", "subject", "mode", "grid", "status", "reason"]).to_pylist()
    assert [tuple(row.values()) for row in told] == [
        ("base", "base", "", "", "normal", "complete", ""),
        ("case 0", "variant", "1 kW", "open", "low", "complete", ""),
        ("case 1", "variant", "2 kW", "open", "low", "complete", ""),
    ]
    assert tables["cases"].column("late_trains").to_pylist() == [3000, 1, 2]
    assert tables["cases"].column("energy_kwh").null_count == 3
    assert tables["case_changes"].to_pylist() == [
        {"case": f"case {k}", "path": "supply.loads[depot].power_kw", "value": str(k + 1)} for k in range(2)
    ]
    assert tables["case_profile"].column("case").to_pylist() == ["base"] * 3 + ["case 0"] * 3 + ["case 1"] * 3
    assert "case_rails" not in tables


def test_rows_are_completed_while_they_are_written():
    def complete(rows, row):
        return rows.set_column(3, rows.schema.field(3), pa.array([row["late_trains"] / 2.0] * len(rows), pa.float32()))

    tables = written(run(loads_of(2)), completed={"case_trains": complete})
    assert tables["case_trains"].column("added_late_s").to_pylist() == [0.5, 0.5, 1.0, 1.0]


def test_a_case_that_is_refused_or_fails_is_a_row_with_its_reason(caplog):
    cases = [*loads_of(4), Case("typo", ("supply.loads[dpot].power_kw=1", "supply.load=2")), Case("no change", ("x",))]
    result = run(cases, measure_with_trouble)
    assert column(result, "status") == ["complete", "refused", "failed", "complete", "refused", "refused"]
    assert result.rows[1]["reason"] == "supply.loads[depot]: too small; allowed: more | clock: too short"
    assert result.rows[2]["reason"] == "ZeroDivisionError: by nothing"
    assert "did you mean 'depot'" in result.rows[4]["reason"] and "did you mean 'loads'" in result.rows[4]["reason"]
    assert "measure_with_trouble" in caplog.text, "the traceback is logged"
    assert result.counts() == {"all": 6, "complete": 2, "flagged": 0, "refused": 3, "failed": 1, "reused": 0}
    assert written(result)["case_changes"].num_rows == 7


def test_kept_cases_are_reused_and_only_failed_ones_run_again(tmp_path):
    first = run(loads_of(4), measure_with_trouble, CaseStore(tmp_path))
    assert (first.run, first.reused) == (4, 0)
    again = run(loads_of(5), measure_with_trouble, CaseStore(tmp_path))
    assert (again.run, again.reused, again.failed) == (2, 3, 1)
    assert again.rows[:4] == first.rows
    assert [each.to_pydict() for each in again.tables("case_profile")][:2] == [
        each.to_pydict() for each in first.tables("case_profile")
    ]


def test_a_broken_file_is_run_again(tmp_path):
    notes, store = tmp_path / "notes", CaseStore(tmp_path)
    notes.mkdir()
    work = partial(measure_and_note, folder=str(notes))
    first = run(loads_of(3), work, store)
    file = store.folder / f"{first.keys['case 1']}.case"
    file.write_bytes(file.read_bytes()[:-30])
    again = run(loads_of(3), work, store)
    assert again.rows == first.rows
    assert marks_in(notes) == ["1", "2", "2", "3"]


def test_another_base_or_another_work_shares_nothing(tmp_path):
    store = CaseStore(tmp_path)
    run(loads_of(2), store=store)
    assert run(loads_of(2), partial(measure_load, rows=4), store).run == 2
    assert run(loads_of(2), store=store, base=make_scenario(load("depot", km=6.0))).run == 2
    assert run(loads_of(2), store=store).run == 0
    assert len(list(store.keys())) == 6


def test_equal_cases_are_run_once_and_both_told(tmp_path):
    change = "supply.loads[depot].power_kw="
    cases = [Case("base"), Case("same", (change + "3000",)), *loads_of(3), Case("again", (change + "3.0",), subject="x")]
    result = run(cases, partial(measure_and_note, folder=str(tmp_path)))
    assert marks_in(tmp_path) == ["1", "2", "3", "3000"]
    assert (result.rows[1]["reason"], result.rows[5]["reason"]) == ("same inputs as case base", "same inputs as case case 2")
    assert result.rows[5]["lowest_voltage_v"] == result.rows[4]["lowest_voltage_v"]
    assert result.rows[5]["subject"] == "x"
    assert [each.column("case")[0].as_py() for each in result.tables("case_profile")] == [case.id for case in cases]


def test_two_cases_of_one_name_are_refused():
    with pytest.raises(UsageError, match="more than one case is called 'a', 'b'"):
        run([Case("a"), Case("b"), Case("c"), Case("a"), Case("b")])


def test_an_outcome_that_cannot_be_kept_stops_all(tmp_path):
    (tmp_path / "cases").write_text("a file")
    with pytest.raises(OutputError, match="outcomes of cases cannot be written"):
        run(loads_of(2), store=CaseStore(tmp_path))


def test_progress_counts_and_estimates():
    told = []
    store = CaseStore()
    run(loads_of(2), store=store)
    run(loads_of(6), partial(measure_with_trouble), store, progress=told.append)
    assert [each.done for each in told] == [1, 2, 3, 4, 5, 6]
    assert told[-1].failed == 1
    assert told[-1].remaining_s == 0.0
    told.clear()
    run(loads_of(12), partial(measure_and_note_slowly), store, progress=told.append)
    seconds = [each.remaining_s for each in told]
    assert seconds[0] == pytest.approx(0.05 * 10.5, rel=0.3)
    assert seconds == sorted(seconds, reverse=True)


def measure_and_note_slowly(scenario):
    time.sleep(0.05)
    return measure_load(scenario)


def test_the_estimate_is_missing_until_a_case_was_run():
    store, told = CaseStore(), []
    run(loads_of(2), store=store)
    run(loads_of(3), store=store, progress=told.append)
    assert [each.remaining_s is None for each in told] == [True, True, False]
    assert [each.reused for each in told] == [1, 2, 2]


def test_ctrl_c_keeps_what_has_ended(tmp_path):
    def interrupted(scenario):
        if power_kw(scenario) == 3:
            raise KeyboardInterrupt
        return measure_load(scenario)

    result = run(loads_of(5), interrupted, CaseStore(tmp_path))
    assert result.interrupted
    assert column(result, "case") == ["case 0", "case 1"]
    assert written(result)["case_changes"].num_rows == 2
    assert len(list(CaseStore(tmp_path).keys())) == 2


SCRIPT = """
import sys, pathlib, functools
from fake_cases import LIBRARY, loads_of, measure_and_note
from small_studies import load, make_scenario
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore

if __name__ == "__main__":
    folder, workers = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    work = functools.partial(measure_and_note, folder=str(folder / "notes"), pause_s=float(sys.argv[3]))
    result = run_cases(make_scenario(load("depot")), LIBRARY, loads_of(12), work, CaseStore(folder), workers=workers)
    print(result.run, result.reused, result.interrupted)
"""


def start_script(tmp_path, workers, pause_s, **more):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    (tmp_path / "notes").mkdir(exist_ok=True)
    command = [sys.executable, str(script), str(tmp_path), str(workers), str(pause_s)]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(SUPPORT), *filter(None, sys.path)])}
    return subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)


def wait_for(condition, limit_s=60.0):
    until = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.01)


def is_alive(pid):
    status = Path(f"/proc/{pid}/stat")
    return status.exists() and status.read_text().rsplit(")", 1)[1].split()[0] != "Z"


def pids_in(notes):
    return {int(path.name.split("-")[1]) for path in notes.iterdir()}


@pytest.mark.parametrize("workers", [1, 2])
def test_a_killed_call_goes_on_and_repeats_nothing(tmp_path, workers):
    store = CaseStore(tmp_path)
    process = start_script(tmp_path, workers, 0.15)
    with process:
        wait_for(lambda: len(list(store.keys())) >= 4)
        process.kill()
    kept = len(list(store.keys()))
    if sys.platform == "linux":
        wait_for(lambda: not any(map(is_alive, pids_in(tmp_path / "notes"))), 10.0)  # workers do not outlive the call
    before = len(marks_in(tmp_path / "notes"))
    with start_script(tmp_path, 1, 0.15) as again:
        out, _ = again.communicate(timeout=60)
    assert out.split() == [str(12 - kept), str(kept), "False"]
    assert len(marks_in(tmp_path / "notes")) == before + 12 - kept
    assert before <= kept + workers


@pytest.mark.skipif(sys.platform == "win32", reason="a test cannot press Ctrl-C of another console there")
def test_ctrl_c_ends_workers_and_tells_what_has_ended(tmp_path):
    store = CaseStore(tmp_path)
    # What is started in the background of a shell ignores Ctrl-C.
    ready = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
    with start_script(tmp_path, 2, 0.3, start_new_session=True, preexec_fn=ready) as process:
        wait_for(lambda: len(list(store.keys())) >= 3)
        os.killpg(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=30)
    assert out.split()[1:] == ["0", "True"]
    assert int(out.split()[0]) == len(list(store.keys())) < 12
    assert "Traceback" not in err
    assert not any(map(is_alive, pids_in(tmp_path / "notes")))


def test_a_thousand_cases_need_no_more_memory_than_a_few(tmp_path):
    memory = pytest.importorskip("psutil").Process().memory_info
    used, arrow = {}, []

    def note(told):
        used[told.done] = memory().rss

    class Writer:
        def append(self, table, rows):
            arrow.append((table, rows.num_rows, pa.total_allocated_bytes()))

    store = CaseStore(tmp_path)
    result = run(loads_of(1000), partial(measure_load, rows=3000), store, progress=note)
    sizes = sum(path.stat().st_size for path in store.folder.iterdir())
    assert sizes > 25e6
    assert used[1000] - used[300] < sizes / 4, "rows of cases stay, their tables do not"
    write_cases(result, Writer())
    assert sum(rows for table, rows, _ in arrow if table == "case_profile") == 3_000_000
    assert max(size for _, _, size in arrow) < sizes / 2, "pieces of tables are written as they come"


def test_full_tables_are_results_of_each_case(tmp_path):
    cases = [*loads_of(2), Case("a/b", loads_of(2)[1].changes), Case("wrong", ("supply.loads[depot].track=9",))]
    result = run(cases, measure_load, CaseStore(tmp_path / "kept", tmp_path / "full"), workers=2)
    assert column(result, "status") == ["complete", "complete", "complete", "refused"]
    changed = apply_changes(BASE, cases[1].changes)
    for folder in ("case 1", "a%2Fb"):
        found = Results.open(tmp_path / "full" / folder)
        assert found.run["input_hash"] == changed.input_hash
        assert found.table("substations").equals(simulate(changed).table("substations"))
    again = run(cases, measure_load, CaseStore(tmp_path / "kept", tmp_path / "full"))
    assert (again.run, again.reused) == (0, 3)
    (tmp_path / "full" / "case 0" / "run.json").write_text(json.dumps({"input_hash": "other"}))
    assert run(cases[:3], measure_load, CaseStore(tmp_path / "kept", tmp_path / "full")).run == 1


def test_full_tables_are_no_work_for_a_cluster(tmp_path):
    with pytest.raises(UsageError, match="local workers only"):
        run(loads_of(1), store=CaseStore(None, tmp_path), scheduler="tcp://127.0.0.1:1")
