"""A scheduler and two workers on loopback, started here."""

import json
import os
import re
import socket
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest
from fake_cases import LIBRARY, loads_of, marks_in, measure_and_note, measure_or_die, measure_with_trouble, run_load
from small_studies import load, make_scenario

from tractionpower.errors import UsageError
from tractionpower.studies.runner.run import run_cases
from tractionpower.studies.runner.store import CaseStore

distributed = pytest.importorskip("distributed")

BASE = make_scenario(load("depot"))
SUPPORT = Path(__file__).parents[2] / "support"


def start(folder, kind, *more):
    # Without nannies: a worker that dies is not replaced, and a killed one leaves no process behind.
    code = f"from distributed.cli.dask_{kind} import main; main()"
    command = [sys.executable, "-c", code, "--host", "127.0.0.1", "--scheduler-file", "scheduler.json", "--no-dashboard", *more]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(SUPPORT), *filter(None, sys.path)])}
    return subprocess.Popen(command, cwd=folder, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@contextmanager
def cluster(folder, workers=2):
    """Yield the address of a scheduler, and the processes: the scheduler, then the workers."""
    processes = [start(folder, "scheduler", "--port", "0")]
    file = folder / "scheduler.json"
    try:
        processes += [start(folder, "worker", "--no-nanny", "--nthreads", "1") for _ in range(workers)]
        until = time.monotonic() + 60.0
        while not file.exists():
            assert time.monotonic() < until
            time.sleep(0.02)
        yield json.loads(file.read_text())["address"], processes
    finally:
        for process in reversed(processes):
            process.kill()
            process.wait()


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    """Wait longer for workers: a machine on which other tests run is slow to start them."""
    monkeypatch.setattr("tractionpower.studies.runner.cluster.ANSWER_S", 60.0)


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    with cluster(tmp_path_factory.mktemp("cluster")) as (address, _):
        yield address


def test_a_cluster_gives_the_tables_of_one_process_to_the_last_bit(address):
    cases = loads_of(6)
    one = run_cases(BASE, LIBRARY, cases, run_load, CaseStore())
    there = run_cases(BASE, LIBRARY, cases, run_load, CaseStore(), scheduler=address)
    assert there.rows == one.rows
    assert there.keys == one.keys
    assert [there.store.get(key) for key in there.keys.values()] == [one.store.get(key) for key in one.keys.values()]
    assert there.workers in (1, 2)  # the second one may have come while they were run


def test_reasons_are_those_of_one_process(address):
    one = run_cases(BASE, LIBRARY, loads_of(4), measure_with_trouble, CaseStore())
    there = run_cases(BASE, LIBRARY, loads_of(4), measure_with_trouble, CaseStore(), scheduler=address)
    assert there.rows == one.rows


def test_workers_with_other_versions_are_refused(address, monkeypatch):
    path = "tractionpower.studies.runner.cluster"
    with monkeypatch.context() as other:
        other.setattr(f"{path}.versions", lambda: {"tractionpower": "9.9", "numpy": "1.0"})
        with pytest.raises(UsageError, match=r"the scheduler has other versions than this process: tractionpower .*, here 9\.9"):
            run_cases(BASE, LIBRARY, loads_of(2), run_load, CaseStore(), scheduler=address)
    monkeypatch.setattr(f"{path}.program", lambda: {"source": "another"})
    with pytest.raises(UsageError, match=r"a worker of the cluster has other versions .*: source .*, here another"):
        run_cases(BASE, LIBRARY, loads_of(2), run_load, CaseStore(), scheduler=address)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "tcp://127.0.0.1:nine", "nonsense://a"])
def test_a_scheduler_that_does_not_answer_is_told(address, monkeypatch, tmp_path):
    monkeypatch.setattr("tractionpower.studies.runner.cluster.ANSWER_S", 0.5)
    store = CaseStore(tmp_path)
    run_cases(BASE, LIBRARY, loads_of(1), run_load, store)
    started = time.monotonic()
    with pytest.raises(UsageError, match=re.escape(f"no Dask scheduler answers at {address}")):
        run_cases(BASE, LIBRARY, loads_of(2), run_load, store, scheduler=address)
    assert time.monotonic() - started < 5.0
    assert len(list(store.keys())) == 1, "what is kept stays"


@pytest.mark.parametrize("said", [b"", b"HTTP/1.0 400 Bad request\r\n\r\n" + 99 * b"x"], ids=["silent", "other protocol"])
def test_what_answers_but_is_no_scheduler_is_told(said, monkeypatch):
    monkeypatch.setattr("tractionpower.studies.runner.cluster.ANSWER_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"

        def serve():
            connection, _ = server.accept()
            connection.sendall(said)
            with connection:  # held until the other end leaves
                while connection.recv(1024):
                    pass

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        started = time.monotonic()
        with pytest.raises(UsageError, match=re.escape(f"no Dask scheduler answers at {address}")):
            run_cases(BASE, LIBRARY, loads_of(2), run_load, CaseStore(), scheduler=address)
        assert time.monotonic() - started < 5.0
        thread.join(5.0)
        assert not thread.is_alive(), "the connection is not left open"


def test_a_worker_is_no_scheduler(address, monkeypatch):
    with distributed.Client(address, set_as_default=False) as client:
        worker = next(iter(client.nthreads()))
    monkeypatch.setattr("tractionpower.studies.runner.cluster.ANSWER_S", 5.0)
    with pytest.raises(UsageError, match=re.escape(f"no Dask scheduler answers at {worker}")):
        run_cases(BASE, LIBRARY, loads_of(2), run_load, CaseStore(), scheduler=worker)


def test_a_lost_worker_loses_nothing_and_a_lost_scheduler_is_told(tmp_path):
    store, notes = CaseStore(tmp_path), tmp_path / "notes"
    notes.mkdir()
    work = partial(measure_and_note, folder=str(notes), pause_s=0.1)
    with cluster(tmp_path) as (address, processes):
        died = partial(measure_or_die, folder=str(notes), of=2.0, times=1)
        result = run_cases(BASE, LIBRARY, loads_of(6), died, store, scheduler=address)
        assert [row["status"] for row in result.rows] == ["complete"] * 6
        assert [process.poll() is None for process in processes].count(False) == 1
        assert {*marks_in(notes)} == {"1", "2", "3", "4", "5", "6"}

        def end_scheduler(told):
            if told.done == 3:
                processes[0].kill()

        with pytest.raises(UsageError, match=r"does not answer any more\. What was computed is kept"):
            run_cases(BASE, LIBRARY, loads_of(30), work, store, scheduler=address, progress=end_scheduler)
    again = run_cases(BASE, LIBRARY, loads_of(4), work, store)
    assert again.reused >= 3
