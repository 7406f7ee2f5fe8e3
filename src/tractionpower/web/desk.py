"""The driver's desk: a thread in which a session keeps in step with the clock, obeys orders and tells what is the case."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import asdict
from queue import Empty, SimpleQueue
from typing import Any

from tractionpower.web.cab import Keeper, Publish, Session
from tractionpower.web.controls import Controls
from tractionpower.web.messages import chart_point
from tractionpower.web.orders import Action, Order, SetFactor
from tractionpower.web.pacing import FACTORS, Pace, Pacer, Rate

FRAME_TICKS = 4
"""Ticks of the model between two frames: 25 frames a second. Diagrams have a point for as much simulated time, or for a tick."""

STATISTICS_S = 1.0
"""Clock time between two messages of statistics [s]."""

KEEP_S = 1.0
"""Clock time after which what was recorded is handed on to be written [s]."""

MOST_WAITING = 200
"""Orders that wait at most; a page that sends more is not a person."""


class Desk:
    """Drives a session by the clock.

    Parameters
    ----------
    session, controls, keeper
        What is computed, what can be set, what is kept.
    publish
        Called in the thread of the desk with ``frame``, ``statistics``, ``notice`` and, once, ``over``.
    pacer
        Gives the instants.
    """

    def __init__(
        self,
        session: Session,
        controls: Controls,
        keeper: Keeper,
        publish: Publish,
        *,
        pacer: Pacer | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._session, self._controls, self._keeper, self._publish = session, controls, keeper, publish
        self._pacer = pacer or Pacer()
        self._clock = clock
        self._orders: SimpleQueue[Order] = SimpleQueue()
        self._stop = threading.Event()
        self._steps, self._frames = Rate(clock), Rate(clock)
        self._sent = self._ticks = 0
        self._points: list[list[Any]] = []
        self._aim_s = session.time_s
        self._statistics_at = self._keep_at = clock()
        self.paused, self.factor = True, FACTORS[0]
        self.failure: BaseException | None = None

    def order(self, order: Order) -> bool:
        """Hand an order over, from any thread; it is obeyed before the next tick. False: too many wait."""
        if self._orders.qsize() >= MOST_WAITING:
            return False
        self._orders.put(order)
        return True

    @property
    def longest_lag_s(self) -> float:
        """Longest lag behind the clock [s]."""
        return self._pacer.longest_lag_s

    @property
    def given_up_s(self) -> float:
        """Clock time that could not be caught up [s]."""
        return self._pacer.given_up_s

    def stop(self) -> None:
        """Ask the desk to end, from any thread."""
        self._stop.set()

    def run(self) -> None:
        """Drive until the session ends or somebody stops it; what goes wrong is kept in `failure`."""
        why = "failed"
        try:
            try:
                why = self._drive()
            finally:
                self._keeper.take()
        except BaseException as error:  # raised again by the thread that waits for this one
            self.failure = error
        self._publish("over", {"why": why, "time_s": self._session.time_s})

    def _drive(self) -> str:
        self._pacer.begin()
        finished = False
        while not self._stop.is_set():
            for _ in range(FRAME_TICKS):
                self._obey()
                self._pacer.wait()
                if not self.paused:
                    self._advance()
                self._pacer.done()
            finished = self._tell()
            if finished:
                return "finished"
        return "stopped"

    def _advance(self) -> None:
        """Compute what belongs to one tick; diagrams get a point as often as that, however fast time passes."""
        self._aim_s += self._pacer.tick_s * self.factor
        self._session.advance(self._aim_s)
        self._ticks += self.factor
        if self._ticks >= FRAME_TICKS:
            self._ticks = 0
            self._points.append(chart_point(self._session.snapshot(), self._session.take_peaks()))

    def _obey(self) -> None:
        while True:
            try:
                order = self._orders.get_nowait()
            except Empty:
                return
            if isinstance(order, SetFactor):
                self.factor = order.factor
            elif isinstance(order, Action) and self._act(order.name):
                continue
            else:
                self._set(order)

    def _act(self, name: str) -> bool:
        """Do what does not concern the train; False if it does."""
        if name in {"pause", "start"}:
            self.paused = not self.paused if name == "pause" else False
        elif name in {"slower", "faster"}:
            place = FACTORS.index(self.factor) + (1 if name == "faster" else -1)
            self.factor = FACTORS[min(max(place, 0), len(FACTORS) - 1)]
        elif name == "finish":
            self._stop.set()
        else:
            return False
        return True

    def _set(self, order: Order) -> None:
        setting, notice = self._controls.obey(order)
        if setting:
            if self._session.steps == 0:
                self.paused = False  # who moves a lever means to drive
            self._session.set(**setting)
            self._keeper.note(self._session.time_s, setting)
        if notice:
            self._publish("notice", {"text": notice})

    def _tell(self) -> bool:
        """Send a frame, statistics where they are due, and return whether the session has ended."""
        self._sent += 1
        snapshot = self._session.snapshot()
        pacer = self._pacer
        pace = Pace(
            lag_ms=1e3 * pacer.lag_s,
            longest_lag_ms=1e3 * pacer.longest_lag_s,
            given_up_s=pacer.given_up_s,
            steps_per_s=self._steps.note(self._session.steps),
            frames_per_s=self._frames.note(self._sent),
        )
        desk = {"paused": self.paused, "factor": self.factor, "levels": self._controls.levels} | asdict(pace)
        points, self._points = self._points, []
        self._publish("frame", {"snapshot": snapshot, "desk": desk, "points": points})
        now = self._clock()
        if now >= self._statistics_at:
            self._statistics_at = now + STATISTICS_S
            self._publish("statistics", self._session.statistics())
        if now >= self._keep_at:
            self._keep_at = now + KEEP_S
            self._keeper.take()
        return bool(snapshot.get("finished"))
