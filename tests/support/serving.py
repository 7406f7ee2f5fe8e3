"""A driving page of a fake session, served in a thread."""

from __future__ import annotations

import threading
from typing import Any

from fake_session import HIGHEST, FakeKeeper, FakeSession, fake_hello

from tractionpower.web.controls import Controls
from tractionpower.web.drive import Drive, Ended, drive


class Serving:
    """A drive that ends soon after its page is closed; `ended` or `failure` tell how."""

    def __init__(self, session: FakeSession | None = None, hello: dict[str, Any] | None = None, leave_s: float = 0.15) -> None:
        self.session = session or FakeSession()
        self.keeper = FakeKeeper()
        what = Drive(self.session, Controls(HIGHEST, independent=True), self.keeper, hello or fake_hello())
        self.address = ""
        self.ended: Ended | None = None
        self.failure: BaseException | None = None
        self._opened = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(what, leave_s))
        self._thread.start()
        assert self._opened.wait(10)
        self.base, self.key = self.address.split("/?key=")

    @property
    def is_alive(self) -> bool:
        """Whether the drive goes on."""
        return self._thread.is_alive()

    def join(self) -> None:
        """Wait for the end of the drive."""
        self._thread.join(10)
        assert not self._thread.is_alive()

    def _run(self, what: Drive, leave_s: float) -> None:
        try:
            self.ended = drive(what, self._open, leave_s=leave_s)
        except BaseException as error:  # looked at by the test
            self.failure = error

    def _open(self, address: str) -> None:
        self.address = address
        self._opened.set()
