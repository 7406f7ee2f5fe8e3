"""What the driving page wants of a session of train dynamics, whatever computes it, and of what keeps it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol


class Session(Protocol):
    """A train that is computed while it is driven; `tractionpower.dynamics.driven.DrivenSession` is one."""

    @property
    def time_s(self) -> float:
        """Simulated time that has been reached [s]."""

    @property
    def steps(self) -> int:
        """Steps computed so far."""

    def advance(self, until_s: float) -> Any:
        """Compute up to a simulated time [s]."""

    def set(
        self,
        *,
        drive: int | None = None,
        brake: int | str | None = None,
        electric: float | None = None,
        independent_bar: float | None = None,
    ) -> None:
        """Set controls from now on; `brake` is a level, ``emergency``, ``full_service`` or ``charge``."""

    def snapshot(self) -> Mapping[str, Any]:
        """Return what is the case now, in units of the boundary."""

    def take_peaks(self) -> tuple[float, float]:
        """Return least and greatest force of the first coupling [kN] in the steps since the last call."""

    def statistics(self) -> Mapping[str, Any]:
        """Return the distributions and cycles up to now, by name; see `tractionpower.web.messages.statistics_message`."""


class Keeper(Protocol):
    """Keeps what happens while driving."""

    def note(self, time_s: float, setting: Mapping[str, Any]) -> None:
        """Note what was set, and when [s]."""

    def take(self) -> None:
        """Take what the session has recorded since the last time; called in the thread of the desk, so it must be quick."""


Publish = Callable[[str, Mapping[str, Any]], None]
"""Takes the kind of a message and what it says."""
