"""Key figures of a train as many vehicles: forces in couplings, stops, energies; verdicts against endurable forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.results.dynamics_tables import KN, KWH, relative_m
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.stops import Spell, Stop, find_stops
from tractionpower.results.verdicts import AT_MOST

Array = NDArray[Any]

CLOSES_SHARE = 1e-2
"""Part of the energy put in within which the ledger closes; methods of first order leave some thousandths."""

WORKS = {
    "traction_energy_kwh": ("traction", "work of the tractive effort, sum over the steps of force times speed"),
    "electric_brake_energy_kwh": ("electric", "work that the electric brakes have taken"),
    "air_brake_energy_kwh": ("brake", "work that the air brakes have taken"),
    "resistance_energy_kwh": ("resistance", "work that running, curve and tunnel resistance has taken"),
    "gravity_energy_kwh": ("gravity", "work against gravity; negative downhill"),
    "coupling_energy_kwh": (
        "coupling",
        "work that the couplings have taken in; what their springs hold at the end is part of it",
    ),
}


@dataclass(frozen=True, slots=True)
class EnergyLedger:
    """Where the energy has gone [J]: traction + kinetic at the start = all that took some + kinetic at the end.

    Attributes
    ----------
    traction, electric, brake, resistance, gravity, coupling
        Works since the start; gravity is negative downhill.
    kinetic_start, kinetic_end
        Kinetic energy with rotating parts.
    """

    traction: float
    electric: float
    brake: float
    resistance: float
    gravity: float
    coupling: float
    kinetic_start: float
    kinetic_end: float

    @classmethod
    def of(cls, ledger: Any, kinetic_start_j: float, kinetic_end_j: float) -> EnergyLedger:
        """Return the ledger from a record of `LEDGER` or `CHAIN_ROW`, and the kinetic energies [J]."""
        names = ("traction_j", "electric_j", "brake_j", "resistance_j", "grade_j", "coupling_j")
        traction, electric, brake, resistance, gravity, coupling = (float(ledger[name]) for name in names)
        return cls(traction, electric, brake, resistance, gravity, coupling, kinetic_start_j, kinetic_end_j)

    @property
    def gap(self) -> float:
        """What is left over [J]."""
        taken = self.electric + self.brake + self.resistance + self.gravity + self.coupling
        return self.traction + self.kinetic_start - taken - self.kinetic_end

    @property
    def put_in(self) -> float:
        """Energy put in [J]: traction, kinetic energy at the start, what a descent gives."""
        return max(self.traction, 0.0) + self.kinetic_start + max(-self.gravity, 0.0)

    @property
    def gap_share(self) -> float:
        """The gap over the energy put in; where nothing was put in, 0 without a gap and infinite with one."""
        if self.put_in == 0.0:
            return 0.0 if self.gap == 0.0 else float("inf")
        return abs(self.gap) / self.put_in

    def as_dict(self) -> dict[str, Any]:
        """Return energies [kWh] and how well they close; none where there is no number."""
        names = ("traction", "electric", "brake", "resistance", "gravity", "coupling", "kinetic_start", "kinetic_end")
        told = {"gap_kwh": self.gap / KWH, "gap_share": self.gap_share}
        told |= {f"{name}_kwh": getattr(self, name) / KWH for name in names}
        closes = bool(self.gap_share <= CLOSES_SHARE)  # not a number does not close
        return {"closes": closes} | {name: value if np.isfinite(value) else None for name, value in told.items()}


class Motion:
    """What the recorded rows of the vehicles tell, summed up as they come.

    Parameters
    ----------
    start_m
        Places of the vehicles at the start [m].
    standstill_mps
        Speed up to which a vehicle stands [m/s].
    """

    def __init__(self, start_m: Array, standstill_mps: float) -> None:
        self.start_m, self.standstill_mps = start_m, standstill_mps
        self.acceleration, self.relative = _Greatest(), _Greatest()
        self._pieces: list[tuple[Array, Array, Array, Array]] = []

    def add(self, time_s: Array, rows: Array) -> None:
        """Add rows: times [s], shape (rows,), records of `VEHICLE_ROW`, shape (rows, vehicles)."""
        if not len(time_s):
            return
        self.acceleration.add(time_s, rows["a_mps2"])
        self.relative.add(time_s, relative_m(rows, self.start_m))
        standing = np.abs(rows["v_mps"]).max(axis=1) <= self.standstill_mps
        self._pieces.append((time_s.copy(), rows["s_m"][:, 0].copy(), rows["v_mps"][:, 0].copy(), standing))

    def track(self) -> tuple[Array, Array, Array, Array]:
        """Return time [s], place [m] and speed [m/s] of the first vehicle, and whether the whole train stands."""
        if not self._pieces:
            return np.empty(0), np.empty(0), np.empty(0), np.empty(0, bool)
        return tuple(np.concatenate(parts) for parts in zip(*self._pieces, strict=True))  # type: ignore[return-value]

    def stops(self, spells: Sequence[Spell]) -> list[Stop]:
        """Return the stops of the train, braked in `spells`."""
        return find_stops(*self.track(), spells)


class _Greatest:
    """The value of greatest magnitude of several series, with its time and number."""

    def __init__(self) -> None:
        self.value, self.time_s, self.number = 0.0, np.nan, -1

    def add(self, time_s: Array, values: Array) -> None:
        row, number = np.unravel_index(np.abs(values).argmax(), values.shape)
        if abs(values[row, number]) > abs(self.value):
            self.value, self.time_s, self.number = float(values[row, number]), float(time_s[row]), int(number)


def when(time_s: float) -> str:
    """Return a time since the start in words; nothing for none.

    >>> when(83.456), when(float("nan"))
    ('83.46 s', '')
    """
    return f"{time_s:.2f} s" if np.isfinite(time_s) else ""


def coupling_figures(names: Sequence[str], links: Array) -> Iterator[KeyFigure]:
    """Yield the greatest tension and compression of a train, with coupling and time, and the most work absorbed."""
    if not len(links):
        return
    pulled, pushed, taken = int(links["greatest_n"].argmax()), int(links["least_n"].argmin()), int(links["absorbed_j"].argmax())
    for name, j, force, at_s in (
        ("greatest_tension_kn", pulled, links["greatest_n"][pulled], links["greatest_at_s"][pulled]),
        ("greatest_compression_kn", pushed, -links["least_n"][pushed], links["least_at_s"][pushed]),
    ):
        if force > 0.0:
            yield KeyFigure(name, float(force) / KN, f"coupling {names[j]}", when(at_s), "greatest of all couplings and steps")
        else:
            yield KeyFigure(name, 0.0, "", "", "greatest of all couplings and steps: there was none")
    definition = "most work that one coupling has taken in; what its springs hold at the end is part of it"
    yield KeyFigure("greatest_absorbed_kj", float(links["absorbed_j"][taken]) / 1e3, f"coupling {names[taken]}", "", definition)


def motion_figures(motion: Motion, names: Sequence[str]) -> Iterator[KeyFigure]:
    """Yield speed, distance, acceleration and relative movement from recorded rows."""
    time_s, place_m, speed_mps, _ = motion.track()
    if not len(time_s):
        return
    top = int(speed_mps.argmax())
    definition = "greatest of the first vehicle, recorded rows"
    yield KeyFigure("greatest_speed_kmh", float(speed_mps[top]) * 3.6, f"vehicle {names[0]}", when(time_s[top]), definition)
    run_m = float(place_m[-1] - motion.start_m[0])
    yield KeyFigure("distance_m", run_m, f"vehicle {names[0]}", "", "way of the first vehicle from the start to the end")
    for name, most, definition in (
        ("greatest_acceleration_mps2", motion.acceleration, "of greatest magnitude of all vehicles, recorded rows"),
        ("greatest_relative_movement_m", motion.relative, "farthest that a vehicle has moved against the first since the start"),
    ):
        if most is motion.relative and len(names) == 1:
            continue
        place = f"vehicle {names[most.number]}" if most.number >= 0 else ""
        yield KeyFigure(name, most.value, place, when(most.time_s), definition)


def stop_figures(stops: Sequence[Stop]) -> Iterator[KeyFigure]:
    """Yield stopping distance, time and mean deceleration of each stop that was braked."""
    for number, stop in enumerate(stops, 1):
        if not stop.is_braked:
            continue
        place, at = f"stop {number}", when(stop.braked_at_s)
        definition = "way of the first vehicle from the brake command to the standstill of the whole train; time of the command"
        yield KeyFigure("stopping_distance_m", stop.distance_m, place, at, definition)
        definition = "from the brake command to the standstill of the whole train, to the recorded row; time of the command"
        yield KeyFigure("stopping_time_s", stop.time_s, place, at, definition)
        yield KeyFigure("braked_from_kmh", stop.speed_mps * 3.6, place, at, "speed of the first vehicle at the brake command")
        definition = "v²/(2 s) of the speed at the brake command and the stopping distance"
        yield KeyFigure("mean_deceleration_mps2", stop.mean_deceleration_mps2, place, at, definition)


def energy_figures(ledger: EnergyLedger) -> Iterator[KeyFigure]:
    """Yield the energies and how well their ledger closes."""
    for name, (key, definition) in WORKS.items():
        yield KeyFigure(name, getattr(ledger, key) / KWH, definition=definition)
    change = (ledger.kinetic_end - ledger.kinetic_start) / KWH
    yield KeyFigure("kinetic_energy_change_kwh", change, definition="kinetic energy with rotating parts, end less start")
    definition = "magnitude of what the ledger leaves over, by the energy put in: traction, kinetic at the start, descent"
    yield KeyFigure("energy_closing_error_percent", 100.0 * ledger.gap_share, definition=definition)


def force_verdicts(names: Sequence[str], kinds: Sequence[Coupling], links: Array) -> Iterator[dict[str, Any]]:
    """Yield verdicts on the endurable forces of the couplings: for each kind of coupling its worst place.

    Parameters
    ----------
    names
        Couplings, length n.
    kinds
        What each of them is, length n.
    links
        Records of `LINK` at the end, shape (n,).
    """
    for kind in sorted({kind.id: kind for kind in kinds}.values(), key=lambda kind: kind.id):
        own = np.array([other.id == kind.id for other in kinds])
        for word, limit_kn, forces, times in (
            ("tension", kind.endurable_tension_kn, links["greatest_n"], links["greatest_at_s"]),
            ("compression", kind.endurable_compression_kn, -links["least_n"], links["least_at_s"]),
        ):
            if limit_kn is None:
                continue
            worst = int(np.where(own, forces, -np.inf).argmax())
            value = max(float(forces[worst]), 0.0) / KN
            yield {
                "name": f"greatest_{word}_kn",
                "value": value,
                "unit": "kN",
                "place": f"coupling {names[worst]}",
                "time": when(float(times[worst])) if value > 0.0 else "",
                "limit": f"endurable_{word} of {kind.id}",
                "limit_value": limit_kn,
                "source": kind.source,
                "status": kind.status,
                "sense": AT_MOST,
                "met": value <= limit_kn,
            }
