"""How a delay is split by cause: from one timed call to the next, reserve absorbs new losses first, then knock-on."""

from __future__ import annotations

from dataclasses import dataclass

LOSSES = ("dwell", "driving", "current_limit", "voltage", "timetable")
"""New losses of a section, in the order in which its reserve absorbs them."""

ORIGINS = ("timetable", "current_limit", "voltage", "dwell", "driving")
"""Where seconds of a delay first arise."""


@dataclass(frozen=True, slots=True)
class Elapsed:
    """What lies between two timed calls [s].

    Attributes
    ----------
    planned, shortest, limited, recorded, actual
        Running times: of the timetable, alone at nominal voltage, the same with current limits, the same on the recorded
        voltages, and with the network.
    planned_dwell, dwell
        Time at stops by the timetable, and with the network.
    """

    planned: float
    shortest: float
    limited: float
    recorded: float
    actual: float
    planned_dwell: float = 0.0
    dwell: float = 0.0

    def losses(self) -> dict[str, float]:
        """Return the new losses, negative ones being gains [s]."""
        return {
            "dwell": self.dwell - self.planned_dwell,
            "driving": self.actual - self.recorded,
            "current_limit": self.limited - self.shortest,
            "voltage": self.recorded - self.limited,
            "timetable": max(0.0, self.shortest - self.planned),
        }

    @property
    def reserve(self) -> float:
        """What the timetable gives beyond the shortest running time [s], 0 if it gives less."""
        return max(0.0, self.planned - self.shortest)


@dataclass(frozen=True, slots=True)
class Lateness:
    """How late a train is at a timed call, and why.

    Attributes
    ----------
    late_s
        Computed less planned time [s]; negative is early.
    parts
        Parts of the delay [s]: ``knock_on`` and `LOSSES`.
    origins
        The delay by `ORIGINS` [s], knock-on followed back to where it first arose.
    """

    late_s: float
    parts: dict[str, float]
    origins: dict[str, float]

    @property
    def delay_s(self) -> float:
        """How late it is [s], 0 if it is early."""
        return max(self.late_s, 0.0)


def start_lateness(late_s: float, origins: dict[str, float]) -> Lateness:
    """Return the lateness with which a run starts; `origins` [s] need not add up, they are scaled."""
    delay, total = max(late_s, 0.0), sum(origins.values())
    share = {name: origins.get(name, 0.0) / total if total > 0.0 else float(name == "dwell") for name in ORIGINS}
    parts = dict.fromkeys(("knock_on", *LOSSES), 0.0) | {"knock_on": delay}
    return Lateness(late_s, parts, {name: delay * part for name, part in share.items()})


def carry_on(before: Lateness, elapsed: Elapsed) -> Lateness:
    """Return the lateness at the next timed call.

    What is absorbed is the reserve of the section, the time by which the train was early at its start, and what it gains:
    on voltages above the nominal one, or by a shorter dwell. It absorbs the losses of the section in the order of `LOSSES`;
    what is left of it recovers knock-on, of every origin the same share.
    """
    losses = elapsed.losses()
    gained = -sum(min(loss, 0.0) for loss in losses.values())
    absorber = elapsed.reserve + max(-before.late_s, 0.0) + gained
    parts = {}
    for name in LOSSES:
        absorbed = min(absorber, max(losses[name], 0.0))
        parts[name], absorber = max(losses[name], 0.0) - absorbed, absorber - absorbed
    brought = before.delay_s
    knock_on = max(brought - absorber, 0.0)
    kept = knock_on / brought if brought > 0.0 else 0.0
    origins = {name: kept * before.origins[name] + parts[name] for name in ORIGINS}
    late = sum(parts.values()) + knock_on
    return Lateness(late if late > 0.0 else min(brought - absorber, 0.0), {"knock_on": knock_on, **parts}, origins)
