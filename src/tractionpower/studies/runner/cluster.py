"""Cases on the workers of a Dask cluster that is there already: Dask's own scheduler moves them away from workers that die."""

from __future__ import annotations

import asyncio
import logging
import pickle
import queue
import threading
import time
import uuid
from collections.abc import Iterable, Mapping
from concurrent.futures import CancelledError
from contextlib import suppress
from typing import Any

import distributed
import distributed.comm.core as comm_core
from distributed import WorkerPlugin, get_worker
from distributed.comm.core import CommClosedError
from distributed.scheduler import KilledWorker

from tractionpower.errors import UsageError
from tractionpower.results.versions import NAMES, versions
from tractionpower.studies.runner.bench import Bench, Reply, Task
from tractionpower.studies.runner.identity import program

ANSWER_S = 10.0
"""How long a scheduler is waited for, and workers at the start [s]."""

NO_WORKERS_S = 60.0
"""How long workers are waited for that have all gone [s]."""

COUNT_S = 5.0
"""How often workers are counted: they come and go [s]."""

WAIT_S = 1.0
"""How long is waited at a time [s]."""

KEPT = "What was computed is kept; the same command goes on from there"

Client: Any = distributed.Client  # most of Dask has no types
Security: Any = distributed.Security
connect: Any = comm_core.connect

_LOST = (CancelledError, CommClosedError, OSError, TimeoutError)

_one_at_a_time = threading.Lock()


class ClusterCrew:
    """Runs cases on the workers of a cluster.

    Parameters
    ----------
    bench
        What is the same in all cases; each worker is sent it once.
    address
        Address of the scheduler.

    Raises
    ------
    UsageError
        If the scheduler does not answer, has no workers, or they have other versions than this process.
    """

    def __init__(self, bench: Bench, address: str) -> None:
        self._address, self._name = address, f"tractionpower-{uuid.uuid4().hex}"
        self._client: Any = _connect(address)
        self._replies: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        self._futures: dict[int, Any] = {}
        self.workers = self.most = 0
        self._seen_s = time.monotonic()
        try:
            self._await_workers()
            _refuse_other_versions(self._client)
            self._client.register_plugin(_Sent(pickle.dumps(bench), program()), name=self._name)
        except _LOST as error:
            self._client.close(timeout=1.0)
            raise self._lost() from error
        except BaseException:
            self._client.close(timeout=1.0)
            raise

    def start(self, task: Task) -> None:
        """Take a task."""
        try:
            future = self._client.submit(
                _run_there, self._name, task.number, list(task.changes), key=f"{self._name}-{task.number}"
            )
        except (*_LOST, RuntimeError) as error:  # a client that is closed
            raise self._lost() from error
        self._futures[task.number] = future
        future.add_done_callback(lambda done, number=task.number: self._replies.put((number, done)))

    def finished(self) -> Iterable[tuple[int, Reply]]:
        """Wait until a reply is there, a second at most, and yield all that are, by number."""
        self._count()
        with suppress(queue.Empty):
            number, future = self._replies.get(timeout=WAIT_S)
            yield number, self._reply(future)
            del self._futures[number]
            while True:
                number, future = self._replies.get_nowait()
                yield number, self._reply(future)
                del self._futures[number]

    def close(self, *, is_stopped: bool) -> None:
        """Let the workers go; cases that have not begun are taken back if that `is_stopped`."""
        with suppress(*_LOST, RuntimeError):
            if is_stopped:
                self._client.cancel(list(self._futures.values()), force=True)
            self._futures.clear()
            if self._client.status == "running":
                self._client.unregister_worker_plugin(self._name)
        with suppress(*_LOST, RuntimeError):
            self._client.close(timeout=1.0)

    def _reply(self, future: Any) -> Reply:
        try:
            reply: Reply = future.result()
        except KilledWorker as error:
            return Reply(None, f"worker after worker died while it was run; the last one was {error.last_worker.address}")
        except _LOST as error:
            raise self._lost() from error
        except UsageError:
            raise
        except Exception as error:  # Dask's own, such as of a scheduler that cannot read what it hands on
            raise UsageError(f"the cluster at {self._address} cannot run cases: {error}") from error
        return reply

    def _await_workers(self) -> None:
        until = time.monotonic() + ANSWER_S
        while True:
            self._count(at_once=True)
            if self.workers:
                return
            if time.monotonic() > until:
                raise UsageError(
                    f"the scheduler at {self._address} has no workers; start some with `dask worker {self._address}`"
                )
            time.sleep(0.1)

    def _count(self, *, at_once: bool = False) -> None:
        """Count the workers, and give up on a cluster that has none any more."""
        now = time.monotonic()
        if not at_once and now - self._seen_s < COUNT_S:
            return
        try:
            count = len(self._client.nthreads())
        except (*_LOST, RuntimeError) as error:
            raise self._lost() from error
        if count:
            self.workers, self.most, self._seen_s = count, 2 * count, now
        elif now - self._seen_s > NO_WORKERS_S:
            raise UsageError(f"the cluster at {self._address} has no workers any more. {KEPT}")

    def _lost(self) -> UsageError:
        return UsageError(f"the cluster at {self._address} does not answer any more. {KEPT}")


class _Sent(WorkerPlugin):
    """What each worker is sent once, those included that come later."""

    def __init__(self, sent: bytes, versions_there: Mapping[str, str]) -> None:
        self._sent, self._versions = sent, versions_there
        self._bench: Bench | None = None

    def bench(self) -> Bench:
        """Return the bench, once it is sure that all is computed by the same program."""
        if self._bench is None:
            told = _differences(self._versions, program())
            if told:
                raise UsageError(f"a worker of the cluster has other versions than this process: {told}. {KEPT}")
            self._bench = pickle.loads(self._sent)
        return self._bench


def _run_there(name: str, number: int, changes: list[str]) -> Reply:
    """Run a case on a worker; threads of one process take turns."""
    with _one_at_a_time:
        plugins: dict[str, Any] = get_worker().plugins
        plugin: _Sent = plugins[name]
        return plugin.bench().run(Task(number, tuple(changes)))


def _connect(address: str) -> Any:
    log = logging.getLogger("distributed")
    before = log.level
    log.setLevel(logging.CRITICAL)  # what it has to say is said here
    try:
        if _answers(address):
            return Client(address, timeout=ANSWER_S, set_as_default=False)
    except (*_LOST, ValueError, TypeError) as error:
        raise _no_answer(address) from error
    finally:
        log.setLevel(before)
    raise _no_answer(address)


def _no_answer(address: str) -> UsageError:
    return UsageError(
        f"no Dask scheduler answers at {address} within {ANSWER_S:g} s: name the address that `dask scheduler` prints,"
        " such as tcp://10.0.0.1:8786 (8787 is the port of its dashboard, not of the scheduler)"
    )


def _answers(address: str) -> bool:
    """Return whether a scheduler is there.

    Dask's client waits for ever for what takes a connection and never answers, and takes the first bytes of any other protocol
    for a length to be allocated. So this is asked first, in a thread that may be left behind.
    """
    answers: queue.SimpleQueue[bool] = queue.SimpleQueue()

    def ask() -> None:
        try:
            answers.put(asyncio.run(asyncio.wait_for(_is_scheduler(address), ANSWER_S)))
        except Exception:  # whatever it is that answers there: other bytes than a scheduler's end in any error
            answers.put(False)

    threading.Thread(target=ask, name="greet-scheduler", daemon=True).start()
    try:
        return answers.get(timeout=ANSWER_S + WAIT_S)
    except queue.Empty:
        return False


async def _is_scheduler(address: str) -> bool:
    comm = await connect(address, timeout=ANSWER_S, **Security().get_connection_args("client"))
    try:
        await comm.write({"op": "identity", "reply": True})
        told: Any = await comm.read()
    finally:
        comm.abort()
    return isinstance(told, dict) and told.get("type") == "Scheduler"


def _refuse_other_versions(client: Any) -> None:
    """Refuse workers that would compute something else, or nothing: the last digits of results hang on the versions."""
    found, own = client.get_versions(packages=list(NAMES)), versions()
    own_name = {"tractionpower": own["tractionpower"]}
    for place, there, needed in [
        ("the scheduler", found["scheduler"], own_name),  # it reads what it hands on
        *((f"worker {address}", there, own) for address, there in sorted(found["workers"].items())),
    ]:
        packages = there.get("packages", {}) if isinstance(there, dict) else {}
        told = _differences(needed, {name: packages.get(name) or "not installed" for name in NAMES})
        if told:
            raise UsageError(f"{place} has other versions than this process: {told}. Install the same there")


def _differences(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """Return what differs, in words.

    >>> _differences({"numpy": "2.1"}, {"numpy": "2.0"})
    'numpy 2.0, here 2.1'
    """
    return ", ".join(f"{name} {there.get(name)}, here {here[name]}" for name in here if here[name] != there.get(name))
