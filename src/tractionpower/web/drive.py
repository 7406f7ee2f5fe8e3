"""Driving a train from a page in the browser: the desk in a thread of its own, the server around it, and how both end."""

from __future__ import annotations

import asyncio
import errno
import gc
import socket
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from aiohttp import web

from tractionpower.errors import UsageError
from tractionpower.web.cab import Keeper, Session
from tractionpower.web.controls import Controls
from tractionpower.web.desk import Desk
from tractionpower.web.guard import LOOPBACK, Guard
from tractionpower.web.server import Hub, new_app

LEAVE_S = 15.0
"""Time after which driving ends when no page is open any more [s]; a page that is loaded again is back before."""

SHARE_S = 0.0005
"""Time for which another thread may keep the interpreter while the desk waits for it [s]; 5 ms are usual."""


@dataclass(frozen=True, slots=True)
class Drive:
    """What is driven, and how.

    Attributes
    ----------
    session, controls, keeper
        What is computed, what can be set, what is kept.
    hello
        What a page is told first.
    """

    session: Session
    controls: Controls
    keeper: Keeper
    hello: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Ended:
    """How driving has ended.

    Attributes
    ----------
    why
        ``finished`` (the case is over), ``stopped`` (on the page), ``left`` (no page is open), ``interrupted`` (Ctrl-C).
    longest_lag_s, given_up_s
        Longest lag behind the clock, and time that could not be caught up [s].
    """

    why: str
    longest_lag_s: float
    given_up_s: float


def drive(what: Drive, opened: Callable[[str], None], *, port: int = 0, leave_s: float | None = LEAVE_S) -> Ended:
    """Serve the page until the drive ends, on loopback only.

    Parameters
    ----------
    what
        What is driven.
    opened
        Called with the address of the page when it can be opened.
    port
        Port to listen on; 0: one that is free.
    leave_s
        Time [s] after which driving ends when no page is open any more; None: it goes on.

    Raises
    ------
    UsageError
        If the port cannot be had.
    """
    listening = listen(port)
    guard = Guard(listening.getsockname()[1])
    hub = Hub(what.hello)
    serving = _Serving(what, guard, hub, leave_s)
    try:
        with _without_hitches():
            why = asyncio.run(serving.run(listening, opened))
    except KeyboardInterrupt:
        why = "interrupted"
    finally:
        listening.close()
    if serving.desk.failure is not None:
        raise serving.desk.failure
    return Ended(why, serving.desk.longest_lag_s, serving.desk.given_up_s)


def listen(port: int) -> socket.socket:
    """Return a socket that listens on loopback, and there only.

    Raises
    ------
    UsageError
        If the port cannot be had.
    """
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        listening.bind((LOOPBACK, port))
    except OSError as error:
        listening.close()
        taken = error.errno in {errno.EADDRINUSE, errno.EACCES}
        reason = "another program has it" if taken else error.strerror or str(error)
        raise UsageError(f"port {port} of this machine cannot be had ({reason}); name another with --port") from None
    return listening


class _Serving:
    """The server and the desk of one drive."""

    def __init__(self, what: Drive, guard: Guard, hub: Hub, leave_s: float | None) -> None:
        self._guard, self._hub, self._leave_s = guard, hub, leave_s
        self._over = asyncio.Event()
        self._why = "stopped"
        self._loop: asyncio.AbstractEventLoop | None = None
        self.desk = Desk(what.session, what.controls, what.keeper, self._publish)

    async def run(self, listening: socket.socket, opened: Callable[[str], None]) -> str:
        """Serve until the desk is over or nobody is there; return why."""
        self._loop = asyncio.get_running_loop()
        runner = web.AppRunner(new_app(self._guard, self._hub, self.desk.order), access_log=None, shutdown_timeout=1.0)
        await runner.setup()
        await web.SockSite(runner, listening).start()
        thread = threading.Thread(target=self.desk.run, name="desk")
        thread.start()
        left = asyncio.create_task(self._left())
        over = asyncio.create_task(self._over.wait())
        try:
            opened(self._guard.address)
            await asyncio.wait({left, over}, return_when=asyncio.FIRST_COMPLETED)
            return self._why if over.done() else "left"
        finally:
            left.cancel()
            over.cancel()
            self.desk.stop()
            await asyncio.to_thread(thread.join)
            await asyncio.sleep(0)  # lets the last messages of the desk reach the pages
            self._hub.close()
            await asyncio.sleep(0.1)
            await runner.cleanup()

    def _publish(self, kind: str, content: Mapping[str, Any]) -> None:
        """Hand a message of the desk over to the thread of the server."""
        assert self._loop is not None  # the desk starts after it
        self._loop.call_soon_threadsafe(partial(self._send, kind, content))

    def _send(self, kind: str, content: Mapping[str, Any]) -> None:
        self._hub.send(kind, content)
        if kind == "over":
            self._why = str(content["why"])
            self._over.set()

    async def _left(self) -> None:
        """Return when a page was open, and none has been for a while."""
        hub = self._hub
        while True:
            await hub.changed.wait()
            hub.changed.clear()
            while self._leave_s is not None and hub.was_open and not hub.is_open:
                try:
                    await asyncio.wait_for(hub.changed.wait(), self._leave_s)
                except TimeoutError:
                    return
                hub.changed.clear()


@contextmanager
def _without_hitches() -> Iterator[None]:
    """Keep the interpreter from holding up the desk.

    Threads give way to each other sooner, for the desk must not wait for a message that is being written; and what is loaded
    by now is left out of the search for garbage, which would take some 50 ms.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(SHARE_S)
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
        sys.setswitchinterval(before)
