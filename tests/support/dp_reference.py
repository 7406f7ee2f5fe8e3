"""The least energy for a running time by dynamic programming on a fine grid, from the declarations alone.

Nothing of the package's kernels or tables is used. State: the square of the speed on a grid at the ends of stages; every
state of the next stage that effort, power and service brake can reach is tried (no interpolation, no list of controls). The
way that a coarse grid gives is then the middle of a corridor with a finer grid, again and again until it stays (discrete
differential dynamic programming, Heidari et al. 1971, recalled). In a stage force and acceleration are constant:

    F = M (w' - w) / 2 ds + A + B v + C v2 + m g (z(s) - z(s - L)) / L ds + tunnels,      t = 2 ds / (v + v')
    E = F ds / eta where F > 0,    eta_b max(F, -F_b) ds where F < 0

A price of time (Lagrange) makes the time; between two prices the straight line of energy over time is taken. Each trajectory
is one that a train can run, so the reference is not below the least energy, but for the length of its stages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numba
import numpy as np

G = 9.80665
STAGE_M = 100.0
OVER_J = 1e12  # of a way that the train cannot run, so that none is chosen
RATIO, FINEST, ROUNDS, SIDE = 1.15, 0.1, 30, 6
NEAR_M = (5.0, 15.0, 30.0, 50.0, 80.0, 120.0)
TUNNEL = {"single_track": 2e-3, "double_track": 1e-3}


@dataclass(frozen=True)
class Least:
    """Running time [s] and net energy at the pantograph [J], auxiliaries left out."""

    time_s: float
    energy_j: float


class Reference:
    """One run of one vehicle over a line; legs between stops share the price of time."""

    def __init__(self, scenario: Any, cell: float = 6.0) -> None:
        line, car = scenario.line, scenario.vehicles[0]
        run, train = scenario.timetable.trains[0], scenario.trains[0]
        self.mass = car.mass_t * 1e3
        self.inertia = self.mass * car.rotating_mass_factor
        self.cell = cell
        self.spread = 0.0 if train.mass_distribution == "point" else car.length_m
        end = run.route[0].to_km * 1e3
        places = {station.id: station.km * 1e3 for station in line.stations}
        stops = sorted({0.0, end, *(places[call.station] for call in run.calls if call.stops)})
        slopes = [(row.from_km * 1e3, row.to_km * 1e3, row.permille / 1e3) for row in line.gradients]
        tunnels = [(row.from_km * 1e3, row.to_km * 1e3, TUNNEL[row.kind]) for row in line.tunnels]
        limits = [(row.from_km * 1e3, row.to_km * 1e3, row.kmh / 3.6) for row in line.speed_limits]
        self.ends = _stage_ends(stops, slopes + tunnels, limits, car.length_m, self.spread)
        length = np.diff(self.ends)
        middle = 0.5 * (self.ends[1:] + self.ends[:-1])
        rise = _integral(slopes, self.ends)
        height = _integral(slopes + tunnels, self.ends)
        if self.spread > 0.0:
            rise = _mean_behind(slopes, self.ends, self.spread)
            under = _mean_behind(slopes + tunnels, self.ends, self.spread)
        else:
            rise, under = np.diff(rise) / length, np.diff(height) / length
        static = np.full(len(length), min(car.max_speed_kmh / 3.6, 1e3))
        for low, high, v in limits:
            held = (middle > low) & (middle < high + car.length_m)
            static[held] = np.minimum(static[held], v)
        rate = car.brake.service_rate_mps2
        service = np.maximum(rate + self.mass * G / self.inertia * rise, 0.1 * rate)
        self.ceiling = _braked(static**2, service, length, np.isin(self.ends, stops))
        drag = car.resistance
        self.numbers = np.array(
            [
                self.inertia,
                drag.a_n + drag.specific_a_n_per_kn * self.mass * G / 1e3,
                drag.b_n_per_kmh * 3.6,
                drag.c_n_per_kmh2 * 3.6**2,
                car.drive.starting_effort_kn * 1e3,
                car.drive.power_kw * 1e3,
                car.drive.efficiency,
                car.brake.electric_effort_kn * 1e3,
                car.brake.electric_power_kw * 1e3,
                car.brake.efficiency if car.brake.efficiency is not None else car.drive.efficiency,
            ]
        )
        self.stages = np.column_stack((length, self.mass * G * under, service))
        self._known: dict[int, Least] = {}

    def at_price(self, step: int) -> Least:
        """Return time and energy for the price 1.15^step W for each kg."""
        if step not in self._known:
            levels = int(self.ceiling.max() / self.cell) + 3
            value, chosen = np.zeros((2, levels)), np.zeros((len(self.stages), levels), np.int32)
            price = self.inertia * RATIO**step
            way = np.zeros(len(self.ceiling))
            _search(self.stages, self.ceiling, self.numbers, price, self.cell, value, chosen, way)
            cell = self.cell
            while cell > FINEST:
                cell *= 0.5
                for _ in range(ROUNDS):
                    before = way.copy()
                    _refine(self.stages, self.ceiling, self.numbers, price, cell, way)
                    if np.abs(way - before).max() == 0.0:
                        break
            self._known[step] = Least(*_totals(self.stages, self.numbers, way))
        return self._known[step]

    def in_time(self, time_s: float) -> float:
        """Return the least energy for a running time [J]."""
        low, high = -20, 36  # slow and fast
        while high - low > 1:
            middle = (low + high) // 2
            if self.at_price(middle).time_s >= time_s:
                low = middle
            else:
                high = middle
        slow, fast = self.at_price(low), self.at_price(high)
        share = (time_s - fast.time_s) / (slow.time_s - fast.time_s)
        assert 0.0 <= share <= 1.0
        return fast.energy_j + share * (slow.energy_j - fast.energy_j)


def _stage_ends(stops: list[float], tilted: list, limits: list, length_m: float, spread_m: float) -> np.ndarray:
    end = stops[-1]
    fixed = {p for low, high, _ in limits for p in (low, high + length_m)} | set(stops)
    fixed |= {stop + sign * near for stop in stops for near in NEAR_M for sign in (-1.0, 1.0)}
    fixed = sorted(p for p in fixed if 0.0 <= p <= end)
    ends = [fixed[0]]
    for place in fixed[1:]:
        if place - ends[-1] < 1e-6:
            continue
        changes = sorted({p + tail for low, high, _ in tilted for p in (low, high) for tail in {0.0, spread_m}})
        for change in changes:
            if ends[-1] + 40.0 < change < place - 40.0:
                ends += _cut(ends[-1], change)
        ends += _cut(ends[-1], place)
    return np.array(ends)


def _cut(low: float, high: float) -> list[float]:
    count = max(math.ceil((high - low) / STAGE_M), 1)
    return [low + (high - low) * (n + 1) / count for n in range(count)]


def _integral(rows: list, places: np.ndarray) -> np.ndarray:
    total = np.zeros(len(places))
    for low, high, value in rows:
        total += value * np.clip(places - low, 0.0, high - low)
    return total


def _mean_behind(rows: list, ends: np.ndarray, spread_m: float) -> np.ndarray:
    """Return the mean over each stage of the mean of `rows` under a train that ends `spread_m` behind its front."""
    x, weight = np.polynomial.legendre.leggauss(12)
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    found = np.zeros(len(half))
    for node, share in zip(x, weight, strict=True):
        at = middle + node * half
        found += 0.5 * share * (_integral(rows, at) - _integral(rows, at - spread_m)) / spread_m
    return found


def _braked(static: np.ndarray, service: np.ndarray, length: np.ndarray, is_stop: np.ndarray) -> np.ndarray:
    """Return the square of the ceiling at the ends of stages: no higher than what is braked down to ahead."""
    count = len(length)
    ceiling = np.zeros(count + 1)
    for i in range(count - 1, -1, -1):
        here = min(static[i], ceiling[i + 1] + 2.0 * service[i] * length[i])
        before = static[i - 1] if i > 0 else np.inf
        ceiling[i] = 0.0 if is_stop[i] else min(here, before)
    return ceiling


@numba.njit(error_model="numpy")
def _stage(stage, numbers, w, after):
    """Return energy [J], time [s], and by which share effort and power do not suffice."""
    inertia, a, b, c, start, power, eta, brake, brake_w, eta_b = numbers
    length, gravity, _ = stage
    speeds = math.sqrt(w) + math.sqrt(after)
    if speeds == 0.0:
        return 0.0, 1e9, 0.0
    squares = 0.5 * (w + after)
    force = inertia * (after - w) / (2.0 * length) + a + b * math.sqrt(squares) + c * squares + gravity
    over = max(force / start, force * 0.5 * speeds / power, 1.0) - 1.0
    if force > 0.0:
        return force * length / eta, 2.0 * length / speeds, over
    return -eta_b * min(-force, brake, brake_w / (0.5 * speeds)) * length, 2.0 * length / speeds, over


@numba.njit(error_model="numpy")
def _search(stages, ceiling, numbers, price, cell, value, chosen, way):
    """Fill `way` with the best one on a grid."""
    count, levels = stages.shape[0], value.shape[1]
    value[:] = 0.0
    for i in range(count - 1, -1, -1):
        now, ahead = value[i % 2], value[(i + 1) % 2]
        for j in range(levels):
            w = min(j * cell, ceiling[i])
            best, goal = np.inf, 0
            lowest = int(max(w - 2.0 * stages[i, 2] * stages[i, 0], 0.0) / cell + 0.999)
            for k in range(lowest, levels):
                after = min(k * cell, ceiling[i + 1])
                work, time, over = _stage(stages[i], numbers, w, after)
                if over > 0.0 and k > lowest + 1:
                    break
                cost = work + price * time + OVER_J * over + ahead[k]
                if cost < best:
                    best, goal = cost, k
                if k * cell >= ceiling[i + 1]:
                    break
            now[j], chosen[i, j] = best, goal
            if j * cell >= ceiling[i]:
                break
    j = 0
    for i in range(count):
        j = chosen[i, j]
        way[i + 1] = min(j * cell, ceiling[i + 1])


@numba.njit(error_model="numpy")
def _refine(stages, ceiling, numbers, price, cell, way):
    """Improve `way` within `SIDE` cells on both sides of it; its ends at stops stay."""
    count, wide = stages.shape[0], 2 * SIDE + 1
    value, chosen = np.zeros((count + 1, wide)), np.zeros((count, wide), np.int32)
    for i in range(count - 1, -1, -1):
        for j in range(wide):
            w = min(max(way[i] + (j - SIDE) * cell, 0.0), ceiling[i])
            best, goal = np.inf, SIDE
            for k in range(wide):
                after = min(max(way[i + 1] + (k - SIDE) * cell, 0.0), ceiling[i + 1])
                work, time, over = _stage(stages[i], numbers, w, after)
                if after < w - 2.0 * stages[i, 2] * stages[i, 0] - 1e-9:
                    continue
                cost = work + price * time + OVER_J * over + value[i + 1, k]
                if cost < best or (cost == best and k == SIDE):
                    best, goal = cost, k
            value[i, j], chosen[i, j] = best, goal
    j = SIDE
    for i in range(count):
        j = chosen[i, j]
        way[i + 1] = min(max(way[i + 1] + (j - SIDE) * cell, 0.0), ceiling[i + 1])


@numba.njit(error_model="numpy")
def _totals(stages, numbers, way):
    time = energy = 0.0
    for i in range(stages.shape[0]):
        work, spent, _ = _stage(stages[i], numbers, way[i], way[i + 1])
        energy += work
        time += spent
    return time, energy
