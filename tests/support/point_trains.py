"""Trains as point masses, made in a line."""

from __future__ import annotations

from typing import Any

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.polyline import Polyline
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.model.dynamics.point_mass import TrainCharacteristics

WITHOUT = {"a_n_per_kn": 0.0}
RUNNING = {"a_n_per_kn": 1.6, "b_n_per_kn_per_kmh": 0.004, "c_n_per_kn_per_kmh2": 0.00044}


def characteristics(**more: Any) -> TrainCharacteristics:
    """Return a train of 480 t with 270 kN and 2220 kW that brakes at 0.5 m/s2."""
    given: dict[str, Any] = {
        "locomotive_mass_t": 80.0,
        "hauled_mass_t": 400.0,
        "braking_mps2": 0.5,
        "max_speed_kmh": 120.0,
        "resistance": RUNNING,
        "rotating_mass_factor": 1.06,
    }
    if "effort" not in more:
        given |= {"starting_effort_kn": 270.0, "power_kw": 2220.0}
    return TrainCharacteristics.model_validate(given | more)


def constant_effort(effort_kn: float, **more: Any) -> TrainCharacteristics:
    """Return a train of 500 t without resistance and rotating masses, with one effort at all speeds."""
    plain = {"locomotive_mass_t": 500.0, "hauled_mass_t": 0.0, "rotating_mass_factor": 1.0, "resistance": WITHOUT}
    return characteristics(effort=[{"speed_kmh": 0.0, "effort_kn": effort_kn}], **(plain | more))


def line(length_m: float = 20_000.0, name: str = "line") -> Polyline:
    """Return a straight piece of track."""
    return Polyline.straight(name, length_m)


def add(core: TrainDynamics, given: TrainCharacteristics, name: str = "train", **more: Any) -> DynTrain:
    """Add a train to a core, on a line of its own unless it gets a route, and return it."""
    train = DynTrain(name, given, **({"route": (line(),)} | more))
    core.add_train(train)
    return train


def run_to(core: TrainDynamics, until_s: float, period_s: float = 1.0) -> None:
    """Calculate every `period_s` up to a time [s]."""
    first = core.time_s
    for k in range(1, round((until_s - first) / period_s) + 1):
        core.calculate_speeds(first + k * period_s)
