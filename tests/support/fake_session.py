"""A session that is driven, of simple physics: one mass, couplings that share its force, a brake pipe with one time constant."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from tractionpower.model.dynamics.case import CaseGradient
from tractionpower.web.hello import profile
from tractionpower.web.keys import key_map
from tractionpower.web.pacing import FACTORS
from tractionpower.web.quantities import panel

SPEED_EDGES_KMH = np.linspace(0.0, 160.0, 33)
FORCE_EDGES_KN = np.linspace(-600.0, 600.0, 61)
ACCELERATION_EDGES_MPS2 = np.linspace(-1.5, 1.5, 61)


class FakeSession:
    """A train of equal vehicles behind a locomotive; the couplings swing a little after each change of force.

    Parameters
    ----------
    vehicles
        Their number, the locomotive among them.
    step_s, end_s
        Step, and simulated time at which it has finished [s].
    blow_kn
        Force of all couplings in one early step, between two frames; 0: no such blow.
    """

    def __init__(self, vehicles: int = 21, step_s: float = 0.01, end_s: float = 600.0, blow_kn: float = 0.0) -> None:
        self.blow_kn = blow_kn
        self.vehicles, self.step_s, self.end_s = vehicles, step_s, end_s
        self.time_s, self.steps = 0.0, 0
        self.drive, self.brake = 0, 0
        self.electric = self.independent_bar = 0.0
        self.emergency = False
        self.speed_mps = self.place_m = self.acceleration_mps2 = 0.0
        self.effort_kn = self.cylinder_bar = self.energy_kwh = 0.0
        self.swing_kn = self.swung_s = 0.0
        self.extremes = np.zeros((2, vehicles - 1))
        self.peaks = (math.inf, -math.inf)
        self.turns: list[float] = []
        self.settings: list[tuple[float, dict[str, Any]]] = []
        self._counts = {
            "drive_speed": np.zeros((16, SPEED_EDGES_KMH.size + 1)),
            "brake_speed": np.zeros((17, SPEED_EDGES_KMH.size + 1)),
            "force": np.zeros(FORCE_EDGES_KN.size + 1),
            "acceleration": np.zeros(ACCELERATION_EDGES_MPS2.size + 1),
        }

    def set(self, **setting: Any) -> None:
        self.settings.append((self.time_s, dict(setting)))
        before = self._wanted_kn()
        brake = setting.pop("brake", None)
        if brake is not None:
            self.emergency = brake == "emergency"
            self.brake = {"emergency": 16, "full_service": 15, "charge": 0}.get(brake, brake)
        for name, value in setting.items():
            setattr(self, name, value)
        self.swing_kn, self.swung_s = 0.5 * (self._wanted_kn() - before), self.time_s

    def advance(self, until_s: float) -> int:
        while self.time_s + 0.5 * self.step_s < min(until_s, self.end_s):
            self._step()
        return 0

    def _wanted_kn(self) -> float:
        return min(270.0 * self.drive / 15.0, 2220.0 * self.drive / 15.0 / max(self.speed_mps, 0.1))

    def _step(self) -> None:
        h = self.step_s
        mass_t = 80.0 + 60.0 * (self.vehicles - 1)
        self.effort_kn += (self._wanted_kn() - self.effort_kn) * (1.0 - math.exp(-h / 0.3))
        wanted_bar = max(3.8 * min(self.brake, 15) / 15.0, self.independent_bar)
        self.cylinder_bar += (wanted_bar - self.cylinder_bar) * (1.0 - math.exp(-h / (0.8 if self.emergency else 1.4)))
        resisting = mass_t * 9.81e-3 * (1.6 + 0.0074 * self.speed_mps**2) + 0.07 * mass_t * self.cylinder_bar * 2.6 / 2.6
        force = self.effort_kn - resisting
        if self.speed_mps <= 0.0 and force <= 0.0:
            self.acceleration_mps2 = self.speed_mps = 0.0
        else:
            self.acceleration_mps2 = force / (1.06 * mass_t)
            speed = self.speed_mps + h * self.acceleration_mps2
            self.place_m += 0.5 * h * (self.speed_mps + max(speed, 0.0))
            self.speed_mps = max(speed, 0.0)
        self.energy_kwh += self.effort_kn * self.speed_mps * h / 3600.0
        self.steps += 1
        self.time_s = self.steps * h
        self._count(h)

    def forces_kn(self) -> list[float]:
        n = self.vehicles
        since = self.time_s - self.swung_s
        pulled = self.effort_kn - 25.0 * self.cylinder_bar * math.exp(-self.speed_mps / 20.0) * (self.speed_mps > 0.0)
        return [
            pulled * (1.0 - (j + 1) / n)
            + self.swing_kn * math.exp(-0.6 * since) * math.sin(4.0 * since - 0.25 * j) * math.sin(math.pi * (j + 1) / n)
            for j in range(n - 1)
        ]

    def _count(self, h: float) -> None:
        forces = np.full(self.vehicles - 1, self.blow_kn) if self.blow_kn and self.steps == 6 else np.array(self.forces_kn())
        force = float(forces[0])
        speed = np.searchsorted(SPEED_EDGES_KMH, 3.6 * self.speed_mps, side="right")
        self._counts["drive_speed"][self.drive, speed] += h
        self._counts["brake_speed"][self.brake, speed] += h
        self._counts["force"][np.searchsorted(FORCE_EDGES_KN, force, side="right")] += h
        self._counts["acceleration"][np.searchsorted(ACCELERATION_EDGES_MPS2, self.acceleration_mps2, side="right")] += h
        self.extremes = np.array([np.maximum(self.extremes[0], forces), np.minimum(self.extremes[1], forces)])
        self.peaks = (min(self.peaks[0], force), max(self.peaks[1], force))
        if self.steps % 50 == 0:
            self.turns.append(force)

    def snapshot(self) -> dict[str, Any]:
        forces = self.forces_kn()
        return {
            "time_s": self.time_s,
            "drive": self.drive,
            "brake": self.brake,
            "speed_kmh": 3.6 * self.speed_mps,
            "position_m": self.place_m,
            "acceleration_mps2": self.acceleration_mps2,
            "gradient_permille": 0.0,
            "tractive_force_kn": self.effort_kn,
            "brake_force_kn": 0.07 * self.cylinder_bar * (80.0 + 60.0 * (self.vehicles - 1)),
            "resistance_kn": 0.0157 * (80.0 + 60.0 * (self.vehicles - 1)),
            "independent_bar": self.independent_bar,
            "electric_percent": 100.0 * self.electric / HIGHEST["electric"],
            "first_coupling_kn": forces[0],
            "greatest_tension_kn": float(self.extremes[0].max()),
            "greatest_compression_kn": -float(self.extremes[1].min()),
            "greatest_kn": self.extremes[0].tolist(),
            "least_kn": self.extremes[1].tolist(),
            "cylinder_bar": (self.cylinder_bar, 0.96 * self.cylinder_bar),
            "pipe_bar": 5.0 - self.cylinder_bar * 1.5 / 3.8,
            "energy_kwh": self.energy_kwh,
            "damage_index": sum(count * (size / 100.0) ** 3 for size, _, count in self.cycles()),
            "forces_kn": forces,
            "finished": self.time_s >= self.end_s - 0.5 * self.step_s,
        }

    def take_peaks(self) -> tuple[float, float]:
        force = self.forces_kn()[0]
        (least, greatest), self.peaks = self.peaks, (math.inf, -math.inf)
        return min(least, force), max(greatest, force)

    def cycles(self) -> list[tuple[float, float, float]]:
        return [(abs(b - a), 0.5 * (a + b), 0.5) for a, b in pairwise(self.turns) if abs(b - a) > 0.1]

    def statistics(self) -> dict[str, Any]:
        total = max(self.time_s, 1e-9)
        edges = {
            "speed_edges_kmh": SPEED_EDGES_KMH,
            "force_edges_kn": FORCE_EDGES_KN,
            "acceleration_edges_mps2": ACCELERATION_EDGES_MPS2,
        }
        return {name: counts / total for name, counts in self._counts.items()} | edges | {"rainflow": self.cycles()}


class FakeKeeper:
    """Keeps what was set."""

    def __init__(self) -> None:
        self.notes: list[tuple[float, dict[str, Any]]] = []
        self.taken = 0

    def note(self, time_s: float, setting: Any) -> None:
        self.notes.append((time_s, dict(setting)))

    def take(self) -> None:
        self.taken += 1


HIGHEST = {"drive": 15, "brake": 15, "electric": 15}


def fake_hello(vehicles: int = 21, name: str = "Twenty wagons over a hill", folder: str = "reports/hill") -> dict[str, Any]:
    """Return what a page is told first of a fake session."""
    gradients = ((0.0, 400.0, 0.0), (400.0, 1200.0, 8.0), (1200.0, 1500.0, 0.0), (1500.0, 2600.0, -6.0))
    return {
        "name": name,
        "folder": folder,
        "vehicles": [f"{number + 1} wagon" for number in range(vehicles)],
        "powered": [True] + [False] * (vehicles - 1),
        "mass_t": 80.0 + 60.0 * (vehicles - 1),
        "limits": [{"tension_kn": None, "compression_kn": None}] * (vehicles - 1),
        "highest": HIGHEST,
        "independent": True,
        "highest_bar": 3.8,
        "profile": profile(tuple(CaseGradient(from_m=a, to_m=b, permille=p) for a, b, p in gradients)),
        "curves": [[500.0, 900.0, 400.0, "right"], [1700.0, 2100.0, 600.0, "left"]],
        "length_m": 15.0 * vehicles,
        "step_s": 0.01,
        "keys": key_map(),
        "panel": panel(),
        "factors": list(FACTORS),
    }
