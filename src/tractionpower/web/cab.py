"""What the driving page wants of a session of train dynamics, whatever computes it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol


class Session(Protocol):
    """A train that is computed while it is driven."""

    @property
    def time_s(self) -> float:
        """Simulated time that has been reached [s]."""

    @property
    def steps(self) -> int:
        """Steps computed so far."""

    def advance(self, until_s: float) -> int:
        """Compute up to a simulated time [s] and return why it came back, a reason of `kernels.chain_tables`."""

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

    def statistics(self) -> Mapping[str, Any]:
        """Return the distributions up to now, by name; see `tractionpower.web.messages.statistics_message`."""
