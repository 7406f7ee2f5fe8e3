import os
import signal
import threading
import time
from functools import partial

import pytest
from fake_cases import LIBRARY, loads_of, marks_in, measure_and_note, measure_load, measure_or_die, run_load
from small_studies import load, make_scenario

from tractionpower.errors import UsageError
from tractionpower.results.store import MemoryWriter
from tractionpower.studies.runner.bench import Bench, Task
from tractionpower.studies.runner.case import Case
from tractionpower.studies.runner.outcomes import write_cases
from tractionpower.studies.runner.processes import ProcessCrew
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore

BASE = make_scenario(load("depot"))


def tables_of(result):
    writer = MemoryWriter()
    write_cases(result, writer)
    return writer.tables()


def test_two_processes_give_the_tables_of_one_to_the_last_bit():
    cases = [*loads_of(5), Case("typo", ("supply.load=1",)), Case("no track", ("supply.loads[depot].track=9",))]
    one, two = (run_cases(BASE, LIBRARY, cases, run_load, CaseStore(), workers=count) for count in (1, 2))
    assert one.rows == two.rows
    assert (one.workers, two.workers) == (1, 2)
    assert [one.store.get(key) for key in one.keys.values()] == [two.store.get(key) for key in two.keys.values()]
    assert tables_of(one).keys() == tables_of(two).keys()
    for name, table in tables_of(one).items():
        assert table.equals(tables_of(two)[name]), name
    assert [row["status"] for row in two.rows] == ["complete"] * 5 + ["refused"] * 2
    voltages = [row["lowest_voltage_v"] for row in two.rows[:5]]
    assert voltages == sorted(voltages, reverse=True) and len({*voltages}) == 5, "more load, lower voltage"


@pytest.mark.parametrize("times", [1, 9])
def test_a_worker_that_dies_harms_no_other_case(tmp_path, times):
    work = partial(measure_or_die, folder=str(tmp_path), of=2.0, times=times)
    result = run_cases(BASE, LIBRARY, loads_of(6), work, CaseStore(), workers=2)
    statuses = [row["status"] for row in result.rows]
    died = len(list(tmp_path.glob("died-*")))
    if times == 1:
        assert statuses == ["complete"] * 6
        assert (died, marks_in(tmp_path)) == (1, ["1", "2", "3", "4", "5", "6"])
    else:
        assert statuses == ["complete", "failed", *["complete"] * 4]
        assert "the worker process died twice" in result.rows[1]["reason"]
        assert (died, marks_in(tmp_path)) == (2, ["1", "3", "4", "5", "6"])


def test_a_worker_that_dies_idle_is_replaced():
    crew = ProcessCrew(Bench(BASE, LIBRARY, measure_load), 1)
    try:
        for number, case in enumerate(loads_of(2)):
            crew.start(Task(number, case.changes))
            replies = []
            while not replies:
                replies = list(crew.finished())
            assert replies[0][0] == number and replies[0][1].data is not None
            if number == 0:
                os.kill(crew._staff[0].pid, signal.SIGTERM)
                time.sleep(0.2)
    finally:
        crew.close(is_stopped=False)


def test_workers_that_cannot_start_are_told(monkeypatch):
    monkeypatch.setattr("tractionpower.studies.runner.processes.pickle.dumps", lambda _: b"cos\n_exit\n(I3\ntR.")
    with pytest.raises(UsageError, match="__main__"):
        run_cases(BASE, LIBRARY, loads_of(4), measure_load, CaseStore(), workers=2)


def test_the_first_case_compiles_here_and_there_are_no_more_workers_than_other_cases(monkeypatch, tmp_path):
    monkeypatch.setattr("tractionpower.studies.runner.run.is_compiled", lambda kernel: False)
    store, before, work = CaseStore(), threading.active_count(), partial(measure_and_note, folder=str(tmp_path))
    assert run_cases(BASE, LIBRARY, loads_of(3), work, store, workers=8).workers == 2
    here = {path.name.split("-")[0] for path in tmp_path.iterdir() if int(path.name.split("-")[1]) == os.getpid()}
    assert here == {"1"}
    started = time.perf_counter()
    assert run_cases(BASE, LIBRARY, loads_of(3), work, store, workers=8).run == 0
    assert time.perf_counter() - started < 0.5, "for known cases nobody is started"
    assert threading.active_count() <= before
