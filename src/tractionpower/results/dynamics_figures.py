"""Key figures of a train as many vehicles: forces in couplings, stops, energies; verdicts against endurable forces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.results.dynamics_ledger import EnergyLedger
from tractionpower.results.dynamics_tables import KN, KWH
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.stops import Stop
from tractionpower.results.verdicts import AT_MOST

Array = NDArray[Any]

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


BACKWARDS = "{place}, backwards"
"""A place of what happened while a vehicle rolled backwards."""


def motion_figures(movers: Array, names: Sequence[str]) -> Iterator[KeyFigure]:
    """Yield speed, distance, acceleration and relative movement from the extremes of all steps.

    Parameters
    ----------
    movers
        Records of `MOVER` at the end, shape (vehicles,).
    names
        Their names.
    """
    first = movers[0]
    definition = "greatest of the first vehicle and all steps, of either direction"
    yield _directed("greatest_speed_kmh", 3.6 * first["greatest_mps"], names[0], when(first["greatest_at_s"]), definition)
    definition = "how far the first vehicle is at the end from where it started"
    yield _directed("distance_m", first["s_m"] - first["start_m"], names[0], "", definition)
    hardest, farthest = np.abs(movers["sharpest_mps2"]).argmax(), np.abs(movers["furthest_m"]).argmax()
    value, at_s = movers[hardest]["sharpest_mps2"], movers[hardest]["sharpest_at_s"]
    definition = "of greatest magnitude of all vehicles and steps, mean of a step"
    yield KeyFigure("greatest_acceleration_mps2", float(value), *_place(names[hardest], value, at_s), definition)
    if len(names) > 1:
        value, at_s = movers[farthest]["furthest_m"], movers[farthest]["furthest_at_s"]
        definition = "farthest that a vehicle has moved against the first since the start, of all steps"
        yield KeyFigure("greatest_relative_movement_m", float(value), *_place(names[farthest], value, at_s), definition)


def _directed(name: str, value: float, vehicle: str, at: str, definition: str) -> KeyFigure:
    """Return a figure of the magnitude of a value, whose place tells when it went backwards."""
    place = f"vehicle {vehicle}"
    return KeyFigure(
        name, abs(float(value)), BACKWARDS.format(place=place) if value < 0.0 else place, at if value else "", definition
    )


def _place(vehicle: str, value: float, at_s: float) -> tuple[str, str]:
    """Return where and when a value was found; nothing for none."""
    return (f"vehicle {vehicle}", when(at_s)) if value else ("", "")


def stop_figures(stops: Sequence[Stop]) -> Iterator[KeyFigure]:
    """Yield stopping distance, time and mean deceleration of each stop that was braked."""
    for number, stop in enumerate(stops, 1):
        if not stop.is_braked:
            continue
        place, at = f"stop {number}", when(stop.braked_at_s)
        if stop.is_backwards:
            place = BACKWARDS.format(place=place)
        definition = "way of the first vehicle from the brake command to the standstill of the whole train; time of the command"
        yield KeyFigure("stopping_distance_m", stop.distance_m, place, at, definition)
        definition = "from the brake command to the standstill of the whole train, to the step; time of the command"
        yield KeyFigure("stopping_time_s", stop.time_s, place, at, definition)
        yield KeyFigure(
            "braked_from_kmh", abs(stop.speed_mps) * 3.6, place, at, "speed of the first vehicle at the brake command"
        )
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
